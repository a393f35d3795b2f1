#include <algorithm>
#include <cstdlib>

#include "export/export_run.h"

namespace firn::test {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> files_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  std::ranges::sort(names);
  return names;
}

using Names = std::vector<std::string>;

TEST_F(ExportRun, WritesAFileForEachFrameAndSaysWhatTheyAre) {
  const ProgramResult result = firn("export", "--for houdini -o " + in_shell(out("o")));
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(files_in(out("o")), (Names{"particles.0001.ply", "particles.0002.ply", "particles.0003.ply",
                                       "particles.ply.series.json", "particles.series.json"}));
  EXPECT_NE(result.output.find("3/3  "), std::string::npos) << result.output;
  EXPECT_NE(result.output.find("particles.$F4.ply"), std::string::npos) << result.output;
  const nlohmann::json series = read_json(out("o/particles.ply.series.json"));
  EXPECT_EQ(series["up"], "y");
  EXPECT_EQ(series["for"], "houdini");
  EXPECT_EQ(series["frames_per_second"], 100);
  EXPECT_EQ(series["meters_per_unit"], 1);
  EXPECT_EQ(series["files"].size(), 3u);
  EXPECT_EQ(series["files"][2]["frame"], 3);
  EXPECT_DOUBLE_EQ(series["files"][2]["time"].get<double>(), 0.02);
  const std::string header = file_bytes(out("o/particles.0001.ply")).substr(0, 500);
  EXPECT_NE(header.find("property float vx\nproperty float vy\nproperty float vz\nproperty int id\n"
                        "property int material\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
                        "property float pscale\nend_header\n"),
            std::string::npos)
      << header;
}

TEST_F(ExportRun, ParaViewGetsAllColumnsAndASeries) {
  ASSERT_EQ(firn("export", "--for paraview -o " + in_shell(out("o"))).exit_code, 0);
  const std::string vtp = file_bytes(out("o/particles.0002.vtp")).substr(0, 3000);
  for (const char* name : {"velocity", "id", "J", "pressure", "von_mises_stress"}) {
    EXPECT_NE(vtp.find("Name=\"" + std::string(name) + "\""), std::string::npos) << name;
  }
  const std::string pvd = file_bytes(out("o/particles.pvd"));
  EXPECT_NE(pvd.find("timestep=\"0.01\" part=\"0\" file=\"particles.0002.vtp\""), std::string::npos) << pvd;
}

TEST_F(ExportRun, AttributesAreChosenAndWrongNamesAreTold) {
  ASSERT_EQ(firn("export", "--frames 2 --format csv --attributes id,J -o " + in_shell(out("a.csv"))).exit_code, 0);
  EXPECT_EQ(file_bytes(out("a.csv")).substr(0, 11), "x,y,z,id,J\n");
  EXPECT_FALSE(fs::exists(out("a.csv.series.json"))) << "one file is no series";
  const ProgramResult wrong = firn("export", "--attributes velocty -o " + in_shell(out("w")));
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_EQ(wrong.errors, "firn: --attributes: there is no attribute \"velocty\"; did you mean \"velocity\"?\n");
  EXPECT_FALSE(fs::exists(out("w")));
}

TEST_F(ExportRun, FramesAreChosen) {
  const auto chosen = [&](const std::string& text) {
    const fs::path to = out("f" + std::to_string(std::rand()));
    const ProgramResult result = firn("export", "--format csv --frames " + text + " -o " + in_shell(to));
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    std::string numbers;
    for (const std::string& name : files_in(to)) {
      if (name.ends_with(".csv")) numbers += name[13];
    }
    return numbers;
  };
  EXPECT_EQ(chosen("2"), "2");
  EXPECT_EQ(chosen("1:3:2"), "13");
  EXPECT_EQ(chosen("2:"), "23");
  EXPECT_EQ(chosen(":2"), "12");
  EXPECT_EQ(chosen("3,1"), "13");
  EXPECT_EQ(chosen("last"), "3");
  EXPECT_EQ(chosen("2:99"), "23");
  const auto error = [&](const std::string& text) { return firn("export", "--frames " + text).errors; };
  EXPECT_EQ(error("4"), "firn: --frames: there is no frame 4; there are 1 to 3\n");
  EXPECT_EQ(error("7:9"), "firn: --frames: no frame is in 7:9; there are 1 to 3\n");
  EXPECT_EQ(error("x"),
            "firn: --frames: \"x\" in \"x\" is no number of a frame; write 5, 1:24, 1:240:10, 1,5,9 or last\n");
  EXPECT_EQ(error("1:2:3:4"), "firn: --frames: \"1:2:3:4\" has too many colons; write A:B or A:B:STEP\n");
}

TEST_F(ExportRun, FilesAreNotReplacedUnasked) {
  const fs::path file = folder_.write("particles.0002.csv", "mine");
  const std::string options = "--format csv -o " + in_shell(out());
  const ProgramResult refused = firn("export", options);
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_EQ(refused.errors, "firn: " + file.string() + " exists; use --force to replace it, or -o for another place\n");
  EXPECT_EQ(files_in(out()), Names{"particles.0002.csv"}) << "something was written before";
  EXPECT_EQ(file_bytes(file), "mine");
  EXPECT_EQ(firn("export", options + " --force").exit_code, 0);
  EXPECT_NE(file_bytes(file), "mine");
}

TEST_F(ExportRun, TheRunsOwnFolderIsTheDefault) {
  const fs::path copy = out("run");
  fs::copy(run(), copy, fs::copy_options::recursive);
  ASSERT_EQ(run_firn("export " + in_shell(copy) + " --frames last --format vdb").exit_code, 0);
  EXPECT_TRUE(fs::exists(copy / "export/volume.0003.vdb"));
  ASSERT_EQ(run_firn("export " + in_shell(copy / "particles/particles.0002.hdf")).exit_code, 0);
  EXPECT_TRUE(fs::exists(copy / "export/particles.0002.ply"));
}

TEST_F(ExportRun, EqualFramesGiveEqualBytes) {
  for (const std::string format : {"ply", "vtp", "csv", "vdb"}) {
    const std::string options = "--frames 2 --format " + format + " -o ";
    ASSERT_EQ(firn("export", options + in_shell(out("a." + format))).exit_code, 0);
    ASSERT_EQ(firn("export", options + in_shell(out("b." + format))).exit_code, 0);
    EXPECT_EQ(file_bytes(out("a." + format)), file_bytes(out("b." + format))) << format;
  }
}

TEST_F(ExportRun, MistakesAreTold) {
  const auto error = [&](const std::string& options) { return firn("export", options).errors; };
  EXPECT_EQ(error("--format plx"), "firn: --format: no format \"plx\"; did you mean \"ply\"?\n");
  EXPECT_EQ(error("--for blendr"), "firn: --for: no client \"blendr\"; did you mean \"blender\"?\n");
  EXPECT_EQ(error("--up x"), "firn: --up must be y or z, got \"x\"\n");
  EXPECT_EQ(error("--format vdb --voxel 0"), "firn: --voxel must be above 0, got 0\n");
  EXPECT_TRUE(matches(error("-o " + in_shell(out("all.ply"))),
                      "firn: -o .*all.ply is one file and there are 3 frames; name a folder, or one frame with "
                      "--frames\n"));
  const ProgramResult missing = run_firn("export " + in_shell(out("nowhere")));
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_TRUE(matches(missing.errors, "firn: .*nowhere: there is no such file or folder\n"));
  const ProgramResult other = run_firn("export " + in_shell(out()));
  EXPECT_EQ(other.exit_code, 3);
  EXPECT_TRUE(matches(other.errors,
                      "firn: .* is not the folder of a run: it holds no particles.hdf.series; name a "
                      "run's folder or frames \\(\\*.hdf\\)\n"));
  EXPECT_EQ(run_firn("export " + in_shell(run()) + " " + in_shell(run())).errors,
            "firn: name one run, or frames of one; several runs take a command each\n");
  const std::string twice = in_shell(frame(1)) + " " + in_shell(frame(1));
  EXPECT_NE(run_firn("export " + twice).errors.find("have the same frame number, 1"), std::string::npos);
}

TEST_F(ExportRun, FullDiskIsAnError) {
  for (const std::string format : {"ply", "vtp", "csv", "vdb"}) {
    fs::create_symlink("/dev/full", out("full." + format));
    const ProgramResult result =
        firn("export", "--frames 1 --format " + format + " -o " + in_shell(out("full." + format)));
    EXPECT_EQ(result.exit_code, 3) << format;
    EXPECT_NE(result.errors.find("No space left on device"), std::string::npos) << result.errors;
  }
}

TEST_F(ExportRun, UsdWithoutItsPackageSaysWhatToInstall) {
  const ProgramResult result = firn("export", "--format usd -o " + in_shell(out("u")), "FIRN_PYTHON=/bin/false");
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_NE(result.errors.find("pip install usd-core, and let FIRN_PYTHON name the Python that has it"),
            std::string::npos)
      << result.errors;
  const ProgramResult none = firn("export", "--format usd -o " + in_shell(out("u")), "FIRN_PYTHON=/no/such/python");
  EXPECT_EQ(none.exit_code, 5);
  EXPECT_NE(none.errors.find("pip install usd-core"), std::string::npos) << none.errors;
  EXPECT_FALSE(fs::exists(out("u/particles.usdc")));
}

/// A Python that has the package: FIRN_PYTHON, or that of the tests; "" if there is none.
std::string usd_python() {
  const char* chosen = std::getenv("FIRN_PYTHON");
  for (const std::string python : {chosen != nullptr ? chosen : "", FIRN_PYTHON}) {
    if (python.empty()) continue;
    if (std::system((python + " -c 'import pxr.Usd' 2>/dev/null").c_str()) == 0) return python;
  }
  return "";
}

TEST_F(ExportRun, UsdHasTheFramesAndTheirConventions) {
  const std::string python = usd_python();
  if (python.empty()) GTEST_SKIP() << "no Python with usd-core; set FIRN_PYTHON to one that has it";
  if (!fs::exists(FIRN_SOURCE_DIR "/tools/usd/firn_to_usd.py")) GTEST_SKIP() << "no tools/usd/firn_to_usd.py";
  const ProgramResult result =
      firn("export", "--for blender --format usd -o " + in_shell(out("l.usda")), "FIRN_PYTHON=" + python);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const std::string text = file_bytes(out("l.usda"));
  EXPECT_NE(text.find("upAxis = \"Z\""), std::string::npos);
  EXPECT_NE(text.find("metersPerUnit = 1"), std::string::npos);
  EXPECT_NE(text.find("def Points"), std::string::npos);
}

}  // namespace
}  // namespace firn::test
