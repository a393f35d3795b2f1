#include <firn/io/frame_reader.h>
#include <firn/io/frame_series.h>

#include <filesystem>
#include <map>
#include <sstream>

#include "apps/run_program.h"
#include "support/temporary_folder.h"

namespace firn::test {
namespace {

namespace fs = std::filesystem;

/// A folder with a scene: a small mesh cube of snow that falls on sticky ground, 5 frames.
class RunScene : public testing::Test {
 protected:
  void SetUp() override { write("scene.toml", scene_text()); }

  static std::string scene_text(const std::string& mesh = FIRN_SOURCE_DIR "/scenes/meshes/cube.obj") {
    return "end_time = 0.1\nframe_rate = 40\n"
           "[resolution]\nparticles = 2000\n"
           "[material.snow]\npreset = \"snow\"\n"
           "[[body]]\nname = \"cube\"\nmesh = \"" +
           mesh +
           "\"\nscale = 0.3\nrotation = [30, 20, 10]\n"
           "position = [0, 0.3, 0]\nvelocity = [0, -4, 0]\nmaterial = \"snow\"\n"
           "[[collider]]\nname = \"ground\"\nshape = \"half_space\"\ncontact = \"sticky\"\n"
           "[render]\nwidth = 96\nheight = 54\nsamples = 1\n";
  }

  void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }
  std::string quoted(const fs::path& name) const { return test::quoted(folder_ / name); }
  fs::path out(const std::string& name = "") const { return folder_ / "out" / name; }
  ProgramResult run(const std::string& options = "", const std::string& environment = "") const {
    return run_firn("run " + quoted("scene.toml") + " -o " + quoted("out") + " " + options, environment);
  }
  static std::string bytes(const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
  }

  const TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

/// Rows of a CSV file by column name.
std::vector<std::map<std::string, std::string>> read_table(const fs::path& path) {
  std::ifstream file(path);
  const auto split = [](const std::string& line) {
    std::vector<std::string> cells;
    std::stringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    return cells;
  };
  std::string line;
  std::getline(file, line);
  const auto names = split(line);
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(file, line)) {
    const auto cells = split(line);
    std::map<std::string, std::string> row;
    for (std::size_t i = 0; i < names.size() && i < cells.size(); ++i) row[names[i]] = cells[i];
    rows.push_back(row);
  }
  return rows;
}

TEST_F(RunScene, SourcesAndProbesHaveTheirNumbers) {
  write("scene.toml",
        scene_text() +
            "film = false\nevery_nth = 0\n[[emitter]]\nname = \"gun\"\nshape = \"sphere\"\nradius = 0.05\n"
            "position = [0, 0.8, 0]\nmaterial = \"snow\"\nvelocity = [0, -1, 0]\nmass_rate = 2\n"
            "[[sink]]\nname = \"pit\"\nshape = \"box\"\nsize = [0.1, 2, 2]\nstart = 0.05\n"
            "[[probe]]\nname = \"column\"\nshape = \"line\"\nposition = [0.1, 0.3, 0]\n"
            "end = [0.1, 0.9, 0]\ncount = 2\n");
  const ProgramResult result = run();
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const ProgramResult check = run_firn("check " + quoted(out("scene.resolved.toml")));
  EXPECT_NE(check.output.find("emitter     gun: "), std::string::npos) << check.output << check.errors;
  const auto rows = read_table(out("stats.csv"));
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_NEAR(std::stod(rows[4].at("gun.emitted_mass")), 0.2, 0.01);
  EXPECT_EQ(rows[1].at("pit.removed_particles"), "0");
  EXPECT_GT(std::stod(rows[4].at("pit.removed_mass")), 1);
  EXPECT_NEAR(std::stod(rows[4].at("mass")),
              std::stod(rows[0].at("mass")) + std::stod(rows[4].at("gun.emitted_mass")) -
                  std::stod(rows[4].at("pit.removed_mass")),
              1e-3);
  const auto values = read_table(out("probes/column.csv"));
  ASSERT_EQ(values.size(), 10u);
  EXPECT_NEAR(std::stod(values[0].at("density")), 400, 80);
  EXPECT_EQ(values[0].at("velocity_y"), "-4");
  EXPECT_EQ(values[1].at("density"), "0");
  EXPECT_EQ(values[1].at("velocity_y"), "");
}

TEST_F(RunScene, MeshBecomesFramesPicturesFilmAndStatistics) {
  const ProgramResult result = run();
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(matches(result.output, R"(frame 0001/0005 [^]*frame 0005/0005 [^]*steps, dt [^]*done in [^]*film[^]*)"));

  const auto series = read_frame_series(out("particles") / kFrameSeriesName);
  ASSERT_EQ(series.size(), 5u);
  EXPECT_EQ(series[0].name, "particles.0001.hdf");
  EXPECT_EQ(series[0].time, 0);
  EXPECT_DOUBLE_EQ(series[4].time, 0.1);
  const Snapshot first = read_frame(out("particles") / series[0].name),
                 last = read_frame(out("particles") / series[4].name);
  EXPECT_NEAR(static_cast<double>(first.size()), 2000, 40);
  EXPECT_EQ(first.size(), last.size());
  for (const char* column : {"velocity", "id", "body", "material", "J", "von_mises_stress", "pressure", "Jp"}) {
    EXPECT_NE(last.find(column), nullptr) << column;
  }
  double lowest = 1;
  for (std::size_t p = 0; p < last.size(); ++p) lowest = std::min(lowest, last.position(p)[1]);
  EXPECT_GT(lowest, -0.5 * last.cell_size) << "particles stay above the ground";
  EXPECT_LT(lowest, 0.05) << "the cube has reached the ground";

  const auto rows = read_table(out("stats.csv"));
  ASSERT_EQ(rows.size(), 5u);
  const double mass = std::stod(rows[0].at("mass"));
  EXPECT_NEAR(mass, 400 * 0.3 * 0.3 * 0.3, 1e-5 * mass) << "density times mesh volume, in single precision";
  EXPECT_EQ(rows[0].at("mass"), rows[4].at("mass"));
  EXPECT_LT(std::stod(rows[4].at("min_J")), 1) << "snow packs";
  EXPECT_NE(rows[2].at("limit").find("\"snow\""), std::string::npos);

  for (int frame = 1; frame <= 5; ++frame) {
    EXPECT_TRUE(fs::exists(out("images") / ("image.000" + std::to_string(frame) + ".png")));
  }
  EXPECT_GT(fs::file_size(out("film.mp4")), 500u);
  EXPECT_NE(bytes(out("run.json")).find("\"finished\""), std::string::npos);
  EXPECT_EQ(run_firn("check " + quoted(out("scene.resolved.toml"))).exit_code, 0);
}

TEST_F(RunScene, EqualRunsGiveEqualBytesOnAnyNumberOfThreadsAndWithPictures) {
  ASSERT_EQ(run("--threads 1").exit_code, 0);
  const std::string name = "particles/particles.0005.hdf", one = bytes(out(name));
  ASSERT_EQ(run("--threads 3 --force").exit_code, 0);
  EXPECT_TRUE(bytes(out(name)) == one);
  ASSERT_EQ(run("--threads 2 --force --set render.every_nth=0").exit_code, 0);
  EXPECT_TRUE(bytes(out(name)) == one);
  EXPECT_FALSE(fs::exists(out("images")));
  ASSERT_EQ(run("--force --set seed=2").exit_code, 0);
  EXPECT_FALSE(bytes(out(name)) == one) << "another seed must not give the same particles";
}

TEST_F(RunScene, ResultsAreNeverOverwrittenUnasked) {
  ASSERT_EQ(run("--set end_time=0.025").exit_code, 0);
  std::ofstream(out("mine.txt")) << "keep";
  const std::string before = bytes(out("stats.csv"));
  const ProgramResult again = run();
  EXPECT_EQ(again.exit_code, 3);
  EXPECT_TRUE(matches(again.errors,
                      "firn: .*out already holds results \\(2 frames, 2 pictures, film.mp4, stats.csv, .*\\); firn "
                      "resume .*--force .*\n"));
  EXPECT_EQ(bytes(out("stats.csv")), before);
  EXPECT_EQ(run("--force --set end_time=0.025").exit_code, 0);
  EXPECT_EQ(bytes(out("mine.txt")), "keep");
}

TEST_F(RunScene, UnwritableFolderIsRefusedBeforeAnythingIsComputed) {
  std::ofstream(folder_ / "occupied") << "a file";
  const ProgramResult result = run_firn("run " + quoted("scene.toml") + " -o " + quoted("occupied"));
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_TRUE(
      matches(result.errors, "firn: cannot create the output folder .*occupied: .*choose another one with -o\n"));
  EXPECT_EQ(result.output, "");
  EXPECT_EQ(run_firn("run " + quoted("scene.toml") + " -o /proc/firn").exit_code, 3);
}

TEST_F(RunScene, BadMeshesAreNamed) {
  EXPECT_EQ(run_firn("run " + quoted("none.toml")).exit_code, 3);
  write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\n");
  write("scene.toml", scene_text("open.obj"));
  const ProgramResult open = run("--set end_time=0.025 --set resolution.particles=300");
  EXPECT_EQ(open.exit_code, 0) << open.errors;
  EXPECT_TRUE(matches(open.errors, "[^]*warning: .*open.obj.*open[^]*")) << open.errors;
  const ProgramResult strict = run("--force --set strict_mesh=true");
  EXPECT_EQ(strict.exit_code, 2);
  EXPECT_TRUE(matches(strict.errors, "[^]*open.obj.*3 .*edges[^]*")) << strict.errors;
  write("bad.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
  write("scene.toml", scene_text("bad.obj"));
  const ProgramResult bad = run("--force");
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_TRUE(matches(bad.errors, "firn: .*bad.obj:4:.*vertex 9.*\n")) << bad.errors;
  write("tiny.obj", "v 0 0 0\nv 1e-5 0 0\nv 0 1e-5 0\nv 0 0 1e-5\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  write("scene.toml", scene_text("tiny.obj"));
  const ProgramResult none = run("--force --set resolution.cell_size=0.1");
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_TRUE(matches(none.errors, "firn: .*cube.*no particle.*cells wide.*\n")) << none.errors;
}

TEST_F(RunScene, ProgressForMachinesIsOneObjectALine) {
  const ProgramResult result = run("--progress json --set end_time=0.025 --set render.every_nth=0");
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  std::istringstream lines(result.output);
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    EXPECT_TRUE(matches(line, R"(\{"frame":[0-9]+,"frames":2,"time":.*"eta_seconds":.*\})")) << line;
  }
  EXPECT_EQ(count, 2);
}

TEST_F(RunScene, RenderDrawsAFinishedRunInAnyColour) {
  ASSERT_EQ(run("--set render.every_nth=0").exit_code, 0);
  const std::string folder = quoted(out());
  const ProgramResult result = run_firn("render " + folder + " --frame 5 --set 'render.color_by=\"velocity\"'");
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(fs::exists(out("images/image.0005.png")));
  EXPECT_FALSE(fs::exists(out("images/image.0004.png")));
  EXPECT_EQ(run_firn("render " + folder + " --frame 6").exit_code, 2);
  EXPECT_EQ(run_firn("render " + quoted("nowhere")).exit_code, 3);
}

TEST_F(RunScene, AFailingRunEndsWithAReportAndKeepsItsFrames) {
  // Gravity pulls the cube by more than a cell within the first, elastic, time step.
  std::string text = scene_text();
  text.replace(text.find("preset = \"snow\""), 15, "model = \"neo_hookean\"\nyoungs_modulus = 1e4");
  text.replace(text.find("[0, 0.3, 0]"), 11, "[0, 0.2, 0]");
  text.replace(text.find("[0, -4, 0]"), 10, "[0, 0, 0]");
  write("scene.toml",
        "rollback = \"off\"\ngravity = [0, -30000, 0]\n" + text + "[limits]\nparticle_cfl = 1\nelastic_cfl = 1\n");
  const ProgramResult result = run();
  EXPECT_EQ(result.exit_code, 4) << result.output << result.errors;
  EXPECT_TRUE(
      matches(result.errors,
              "[^]*firn: step [0-9]+ at t = .* s with dt = .*particle [0-9]+ of \"snow\".*F = .*J = .*lower.*\n"))
      << result.errors;
  EXPECT_GE(read_frame_series(out("particles") / kFrameSeriesName).size(), 1u);
  EXPECT_NE(bytes(out("run.json")).find("cannot go on"), std::string::npos);
}

}  // namespace
}  // namespace firn::test
