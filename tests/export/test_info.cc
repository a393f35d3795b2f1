#include <algorithm>

#include "export/export_run.h"

namespace firn::test {
namespace {

namespace fs = std::filesystem;

class Info : public ExportRun {
 protected:
  static nlohmann::json info(const fs::path& path, const std::string& options = "") {
    return nlohmann::json::parse(run_firn("info --json " + in_shell(path) + " " + options).output);
  }
  fs::path copy_run() const {
    fs::copy(run(), out("run"), fs::copy_options::recursive);
    return out("run");
  }
  static fs::path newest_checkpoint(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder / "checkpoints")) files.push_back(entry.path());
    return *std::ranges::max_element(files);
  }
  static void damage(const fs::path& path) {
    std::string bytes = file_bytes(path);
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 4);
    std::ofstream(path, std::ios::binary) << bytes;
  }
};

TEST_F(Info, OfARun) {
  const nlohmann::json run_info = info(run());
  EXPECT_EQ(run_info["kind"], "run");
  EXPECT_EQ(run_info["whole"], true);
  EXPECT_EQ(run_info["status"], "finished");
  EXPECT_EQ(run_info["firn_version"], FIRN_VERSION);
  EXPECT_EQ(run_info["frames"]["numbers"], "1 to 3");
  EXPECT_EQ(run_info["planned_frames"], 3);
  EXPECT_EQ(run_info["kernel"], "quadratic");
  EXPECT_EQ(run_info["transfer"], "apic");
  EXPECT_EQ(run_info["checkpoints"]["newest"]["frame"], 3);
  const auto particles = run_info["particles"].get<double>();
  EXPECT_NEAR(particles, 0.06 / (0.05 * 0.05 * 0.05 / 8), 0.05 * particles);
  EXPECT_EQ(run_info["newest_frame"]["bytes"], fs::file_size(frame(3)));
  const ProgramResult text = run_firn("info " + in_shell(run()));
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_NE(text.output.find("frames      1 to 3 of 3; t = 0.0 to 0.02 s at 100.0 per second"), std::string::npos)
      << text.output;
  EXPECT_NE(text.output.find("next        firn resume "), std::string::npos) << text.output;
}

TEST_F(Info, OfAFrame) {
  const nlohmann::json frame_info = info(frame(2));
  EXPECT_EQ(frame_info["kind"], "frame");
  EXPECT_EQ(frame_info["frame"], 2);
  EXPECT_DOUBLE_EQ(frame_info["time"].get<double>(), 0.01);
  EXPECT_EQ(frame_info["precision"], "single");
  EXPECT_EQ(frame_info["up"], "y");
  EXPECT_EQ(frame_info["kernel"], "quadratic");
  EXPECT_EQ(frame_info["materials"][0]["name"], "snow");
  const nlohmann::json& position = frame_info["columns"][0];
  EXPECT_EQ(position["name"], "position");
  EXPECT_EQ(position["unit"], "m");
  EXPECT_EQ(position["type"], "float");
  EXPECT_NEAR(position["max"][1].get<double>(), 1.02, 0.03);
  EXPECT_NEAR(position["min"][0].get<double>(), 0.01, 0.02);
  EXPECT_NEAR(frame_info["bytes_per_particle"].get<double>() * frame_info["particles"].get<double>(),
              static_cast<double>(fs::file_size(frame(2))), 1);
}

TEST_F(Info, OfACheckpointInItsRunAndByItself) {
  const fs::path file = newest_checkpoint(run());
  const nlohmann::json listed = info(file);
  EXPECT_EQ(listed["kind"], "checkpoint");
  EXPECT_EQ(listed["listed"], true);
  EXPECT_EQ(listed["frame"], 3);
  fs::copy_file(file, out("other.h5"));
  const nlohmann::json alone = info(out("other.h5"));
  EXPECT_EQ(alone["kind"], "checkpoint");
  EXPECT_EQ(alone["listed"], false);
  EXPECT_EQ(alone["particles"], listed["particles"]);
  EXPECT_EQ(alone["kernel"], "quadratic");
}

TEST_F(Info, DamageIsFoundAndIsAnExitCode) {
  const fs::path copy = copy_run();
  damage(copy / "particles/particles.0003.hdf");
  const ProgramResult text = run_firn("info " + in_shell(copy));
  EXPECT_EQ(text.exit_code, 3);
  EXPECT_NE(text.output.find("DAMAGED"), std::string::npos) << text.output;
  EXPECT_NE(text.output.find("particles.0003.hdf: damaged"), std::string::npos) << text.output;
  EXPECT_NE(text.output.find("--from-frame"), std::string::npos) << text.output;
  EXPECT_EQ(info(copy)["newest_frame"]["frame"], 2);
  const nlohmann::json of_frame = info(copy / "particles/particles.0003.hdf");
  EXPECT_EQ(of_frame["whole"], false);
  EXPECT_EQ(run_firn("info " + in_shell(copy / "particles/particles.0003.hdf")).exit_code, 3);
}

TEST_F(Info, OlderFilesAreCheckedOnDemand) {
  const fs::path copy = copy_run();
  damage(copy / "particles/particles.0001.hdf");
  EXPECT_EQ(run_firn("info " + in_shell(copy)).exit_code, 0);
  EXPECT_EQ(run_firn("info --all " + in_shell(copy)).exit_code, 3);
}

TEST_F(Info, GapsAndLostCheckpointsAreTold) {
  const fs::path copy = copy_run();
  fs::remove(copy / "particles/particles.0002.hdf");
  damage(newest_checkpoint(copy));
  const nlohmann::json of_run = info(copy);
  EXPECT_EQ(of_run["frames"]["numbers"], "1, 3");
  EXPECT_EQ(of_run["frames"]["missing"], nlohmann::json::array({2}));
  EXPECT_EQ(of_run["whole"], false);
  EXPECT_EQ(of_run["checkpoints"]["newest"]["frame"], 1);
}

TEST_F(Info, OtherThingsAreRefused) {
  const fs::path text = folder_.write("scene.toml", "end_time = 1\n");
  EXPECT_TRUE(matches(run_firn("info " + in_shell(text)).errors,
                      "firn: .*scene.toml is neither a frame nor a checkpoint of Firn: it does not begin as HDF5\n"));
  EXPECT_TRUE(matches(run_firn("info " + in_shell(out("x"))).errors, "firn: .*x: there is no such file or folder\n"));
  const ProgramResult folder = run_firn("info " + in_shell(out()));
  EXPECT_EQ(folder.exit_code, 3);
  EXPECT_TRUE(matches(folder.errors,
                      "firn: .* is not the folder of a run: it holds neither run.json nor "
                      "scene.resolved.toml\n"));
}

}  // namespace
}  // namespace firn::test
