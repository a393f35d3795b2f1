#include <signal.h>
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>
#include <vector>

#include "apps/run_program.h"
#include "support/temporary_folder.h"

namespace firn::test {
namespace {

namespace fs = std::filesystem;

/// A folder with a scene that takes a fraction of a second: 2D snow on a floor beside a paddle on keyframes, 7 frames,
/// checkpoints at each.
class ResumeRun : public testing::Test {
 protected:
  void SetUp() override { write(scene_text()); }

  static std::string scene_text() {
    return "dimension = 2\nend_time = 0.06\nframe_rate = 100\n"
           "[resolution]\nparticles = 600\n"
           "[material.snow]\npreset = \"snow\"\n"
           "[[body]]\nname = \"ball\"\nshape = \"disk\"\nradius = 0.1\nposition = [0, 0.12]\nvelocity = [0, -3]\n"
           "material = \"snow\"\n"
           "[[collider]]\nname = \"ground\"\nshape = \"half_space\"\n"
           "[[collider]]\nname = \"paddle\"\nshape = \"box\"\nsize = [0.05, 0.2]\nposition = [-0.3, 0.1]\n"
           "keyframes = [{time = 0, position = [-0.3, 0.1]}, {time = 0.06, position = [-0.1, 0.1]}]\n"
           "[render]\nwidth = 64\nheight = 36\nsamples = 1\nevery_nth = 0\n"
           "[checkpoint]\nevery_frames = 1\nkeep = 0\n";
  }
  void write(const std::string& text) const { std::ofstream(folder_ / "scene.toml") << text; }
  fs::path out(const std::string& name = "out") const { return folder_ / name; }
  ProgramResult run(const std::string& name = "out", const std::string& options = "") const {
    return run_firn("run " + quoted(folder_ / "scene.toml") + " -o " + quoted(out(name)) + " " + options);
  }
  ProgramResult resume(const std::string& options = "", const std::string& name = "out") const {
    return run_firn("resume " + quoted(out(name)) + " " + options);
  }
  static std::string bytes(const fs::path& path) { return file_bytes(path); }
  static std::string frame_name(int frame) { return "particles/particles.000" + std::to_string(frame) + ".hdf"; }

  static std::vector<std::string> fields(const std::string& line) {
    std::vector<std::string> list;
    std::stringstream stream(line);
    for (std::string field; std::getline(stream, field, ',');) list.push_back(field);
    return list;
  }

  /// stats.csv without the column of the wall clock.
  static std::string statistics(const fs::path& folder) {
    std::ifstream file(folder / "stats.csv");
    std::string all;
    std::ptrdiff_t clock = -1;
    for (std::string line; std::getline(file, line);) {
      std::vector<std::string> row = fields(line);
      if (clock < 0) clock = std::find(row.begin(), row.end(), "wall_seconds") - row.begin();
      row.erase(row.begin() + clock);
      for (const std::string& field : row) all += field + ",";
      all += "\n";
    }
    return all;
  }
  void expect_equal_results(const std::string& a, const std::string& b, int frames) const {
    for (int frame = 1; frame <= frames; ++frame) {
      EXPECT_FALSE(bytes(out(a) / frame_name(frame)).empty()) << a << frame;
      EXPECT_TRUE(bytes(out(a) / frame_name(frame)) == bytes(out(b) / frame_name(frame))) << "frame " << frame;
    }
    EXPECT_FALSE(fs::exists(out(a) / frame_name(frames + 1)));
    EXPECT_FALSE(statistics(out(a)).empty());
    EXPECT_EQ(statistics(out(a)), statistics(out(b)));
    for (const char* probe : {"probes/row.csv", "probes/place.csv"}) {
      EXPECT_EQ(fs::exists(out(a) / probe), fs::exists(out(b) / probe));
      EXPECT_EQ(bytes(out(a) / probe), bytes(out(b) / probe));
    }
    EXPECT_EQ(bytes(out(a) / "particles/particles.hdf.series"), bytes(out(b) / "particles/particles.hdf.series"));
  }

  /// Starts a run in the background; in a scene that would take minutes, unless told otherwise.
  pid_t start(const std::string& name, const std::vector<std::string>& options) const {
    const pid_t child = fork();
    if (child != 0) return child;
    freopen((out(name).string() + ".log").c_str(), "w", stdout);
    freopen((out(name).string() + ".err").c_str(), "w", stderr);
    const std::string scene = (folder_ / "scene.toml").string(), folder = out(name).string();
    std::vector<const char*> arguments = {FIRN_PROGRAM, "run", scene.c_str(), "-o", folder.c_str()};
    for (const std::string& option : options) arguments.push_back(option.c_str());
    arguments.push_back(nullptr);
    execv(FIRN_PROGRAM, const_cast<char**>(arguments.data()));
    _exit(99);
  }
  static int exit_code_of(pid_t child) {
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  }
  static void wait_for(const fs::path& path) {
    for (int i = 0; i < 3000 && !fs::exists(path); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    ASSERT_TRUE(fs::exists(path)) << path;
  }

  /// Until a checkpoint counts.
  void wait_for_checkpoint() const {
    wait_for(out() / "checkpoints/checkpoint.0001.h5");
    const auto is_listed = [&] { return bytes(out() / "run.json").find("checkpoint.0001.h5") != std::string::npos; };
    for (int i = 0; i < 3000 && !is_listed(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    ASSERT_TRUE(is_listed());
  }

  const TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

TEST_F(ResumeRun, AStoppedRunGoesOnToTheSameFilesOnAnyNumberOfThreads) {
  // Slow enough to be stopped on its way.
  ASSERT_EQ(run("whole", "--threads 1 --set limits.max_dt=5e-6").exit_code, 0);
  const pid_t child = start("out", {"--threads", "2", "--set", "limits.max_dt=5e-6"});
  wait_for(out() / frame_name(2));
  kill(child, SIGINT);
  ASSERT_EQ(exit_code_of(child), 130) << bytes(folder_ / "out.err");
  EXPECT_TRUE(matches(bytes(folder_ / "out.err"), "firn: stopped after frame [0-9]+; .* and firn resume goes on\n"));
  EXPECT_NE(bytes(out() / "run.json").find("\"interrupted\""), std::string::npos);
  EXPECT_FALSE(fs::exists(out() / frame_name(7)));
  const ProgramResult result = resume("--threads 3");
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(matches(result.errors, "[^]*going on after frame [0-9]+, t = .*checkpoint.*\n")) << result.errors;
  expect_equal_results("out", "whole", 7);
  EXPECT_NE(bytes(out() / "run.json").find("\"finished\""), std::string::npos);
}

TEST_F(ResumeRun, AnInterruptedLongFrameGoesOnFromItsMiddle) {
  // One frame of ten thousand steps.
  const std::string slow = "--set limits.max_dt=1e-6 --set end_time=0.01 --set checkpoint.every_frames=0";
  const pid_t child =
      start("out", {"--set", "limits.max_dt=1e-6", "--set", "end_time=0.01", "--set", "checkpoint.every_frames=0"});
  wait_for_checkpoint();
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  kill(child, SIGTERM);
  ASSERT_EQ(exit_code_of(child), 130);
  const std::string info = bytes(out() / "run.json");
  EXPECT_TRUE(matches(info, "[^]*\"file\": \"checkpoint.0002.h5\",\\s*\"frame\": 1,\\s*\"inside_frame\": true[^]*"))
      << info;
  EXPECT_EQ(resume().exit_code, 0);
  ASSERT_EQ(run("whole", slow).exit_code, 0);
  expect_equal_results("out", "whole", 2);
}

/// Emitters, a sink, a pin, a traction, probes and a thin wall that moves.
std::string sources_text() {
  return "[[emitter]]\nname = \"gun\"\nshape = \"box\"\nsize = [0.1, 0.1]\nposition = [0.3, 0.3]\nvelocity = [-3, 0]\n"
         "material = \"snow\"\nmass_rate = 100\n"
         "[[sink]]\nname = \"drain\"\nshape = \"box\"\nsize = [0.08, 0.1]\nposition = [0.05, 0.05]\n"
         "[[collider]]\nname = \"blade\"\nshape = \"box\"\nsize = [0.008, 0.2]\nposition = [0.14, 0.12]\n"
         "velocity = [-2, 0]\n"
         "[[pin]]\nshape = \"sphere\"\nradius = 0.04\nposition = [-0.05, 0.15]\nstart = 0.003\nstop = 0.02\n"
         "[[traction]]\nshape = \"box\"\nsize = [1, 0.1]\nposition = [0, 0.22]\npressure = \"2e4 * t\"\n"
         "[[probe]]\nname = \"row\"\nshape = \"line\"\nposition = [-0.2, 0.1]\nend = [0.2, 0.1]\ncount = 5\n"
         "[[probe]]\nname = \"place\"\nposition = [0, 0.1]\n";
}

TEST_F(ResumeRun, SourcesAndProbesGoOnFromTheMiddleOfAFrame) {
  write(scene_text() + sources_text());
  const std::string slow = "--set limits.max_dt=1e-6 --set end_time=0.01 --set checkpoint.every_frames=0";
  const pid_t child =
      start("out", {"--set", "limits.max_dt=1e-6", "--set", "end_time=0.01", "--set", "checkpoint.every_frames=0"});
  wait_for_checkpoint();
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  kill(child, SIGTERM);
  ASSERT_EQ(exit_code_of(child), 130) << bytes(folder_ / "out.err");
  EXPECT_NE(bytes(out() / "run.json").find("\"inside_frame\": true"), std::string::npos);
  ASSERT_EQ(resume().exit_code, 0);
  ASSERT_EQ(run("whole", slow).exit_code, 0);
  expect_equal_results("out", "whole", 2);
}

TEST_F(ResumeRun, SourcesAndProbesGoOnFromAFrame) {
  write(scene_text() + sources_text());
  ASSERT_EQ(run("whole").exit_code, 0);
  ASSERT_EQ(run("out", "--set end_time=0.05").exit_code, 0);
  const ProgramResult first = resume("--frames 7 --threads 2");
  ASSERT_EQ(first.exit_code, 0) << first.errors;
  expect_equal_results("out", "whole", 7);
  const std::string names = bytes(out() / "stats.csv").substr(0, bytes(out() / "stats.csv").find('\n'));
  for (const char* name : {"blade.force_x", "gun.emitted_mass", "drain.removed_particles"}) {
    EXPECT_NE(names.find(name), std::string::npos) << names;
  }
  // Rows after the frame are replaced by their like; those of a run that was killed on the way are not counted twice.
  std::ofstream(out() / "probes/row.csv", std::ios::app) << "8,0.07,0,";
  ASSERT_EQ(resume("--from-frame 3").exit_code, 0);
  expect_equal_results("out", "whole", 7);

  for (const char* renamed : {"emitter.0.name='\"hose\"'", "sink.0.name='\"hole\"'"}) {
    const ProgramResult refused = resume(std::string("--frames 9 --allow-changed --set ") + renamed);
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_TRUE(matches(refused.errors, "firn: (emitter|sink) is .*: this cannot change on the way; .*\n"))
        << refused.errors;
  }
  // Probes decide nothing; a new one begins where the run goes on.
  write(scene_text() + sources_text() + "[[probe]]\nname = \"late\"\nposition = [0, 0.05]\n");
  const ProgramResult more = resume("--frames 8 --scene " + quoted(folder_ / "scene.toml"));
  EXPECT_EQ(more.exit_code, 0) << more.errors;
  const std::string late = bytes(out() / "probes/late.csv");
  EXPECT_EQ(std::count(late.begin(), late.end(), '\n'), 2) << late;
  EXPECT_NE(late.find("\n8,"), std::string::npos) << late;
}

TEST_F(ResumeRun, ASecondSignalEndsAtOnce) {
  const pid_t child = start("out", {"--set", "limits.max_dt=2e-7"});
  wait_for_checkpoint();
  kill(child, SIGSTOP);  // both arrive before the step ends
  kill(child, SIGINT);
  kill(child, SIGTERM);
  kill(child, SIGCONT);
  EXPECT_EQ(exit_code_of(child), 130);
  EXPECT_NE(bytes(out() / "run.json").find("\"running\""), std::string::npos) << "no checkpoint was waited for";
  EXPECT_EQ(resume("--set gravity='[0,-1]'").exit_code, 2) << "the list of checkpoints and the newest are whole";
}

TEST_F(ResumeRun, FinishedRunsAreExtended) {
  ASSERT_EQ(run("whole").exit_code, 0);
  ASSERT_EQ(run("out", "--set end_time=0.03").exit_code, 0);
  const ProgramResult nothing = resume();
  EXPECT_EQ(nothing.exit_code, 0);
  EXPECT_TRUE(matches(nothing.output, "the run is finished with frame 4; --frames extends it\n"));
  const ProgramResult result = resume("--frames 7");
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  expect_equal_results("out", "whole", 7);
  EXPECT_EQ(resume("--frames 3").exit_code, 2);
  EXPECT_EQ(resume("--frames 1").exit_code, 2);
}

TEST_F(ResumeRun, FromAnEarlierFrameWritesTheSameFilesAgain) {
  ASSERT_EQ(run("whole").exit_code, 0);
  ASSERT_EQ(run().exit_code, 0);
  fs::remove(out() / frame_name(5));
  std::ofstream(out() / frame_name(6)) << "damaged";
  EXPECT_EQ(resume("--from-frame 4 --threads 2").exit_code, 0);
  expect_equal_results("out", "whole", 7);
  fs::remove_all(out("few"));
  ASSERT_EQ(run("few", "--set checkpoint.every_frames=0 --set checkpoint.keep=1").exit_code, 0);
  const ProgramResult none = resume("--from-frame 3", "few");
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_TRUE(matches(none.errors, "firn: .*no checkpoint at or before frame 3; there are ones of frames 7\n"))
      << none.errors;
}

TEST_F(ResumeRun, AChangedSceneIsListedAndRefusedUnlessAllowed) {
  ASSERT_EQ(run("out", "--set end_time=0.03").exit_code, 0);
  const std::string before = bytes(out() / "scene.resolved.toml");
  const ProgramResult refused =
      resume("--frames 7 --set material.snow.youngs_modulus=1e5 --set gravity='[0,-5]' --set render.width=80");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(matches(refused.errors,
                      "firn: the scene is not the one .*: gravity is \\[0, -5\\] and was \\[0, -9.81\\]; "
                      "material.snow.youngs_modulus is 1e5 and was 140000\\. Undo that, or use --allow-changed .*\n"))
      << refused.errors;
  EXPECT_EQ(bytes(out() / "scene.resolved.toml"), before) << "nothing is touched";
  EXPECT_EQ(resume("--set frame_rate=50 --allow-changed").exit_code, 2);
  EXPECT_EQ(resume("--set resolution.particles=900 --allow-changed").exit_code, 3) << "other cells";

  // Keys that decide nothing may change: pictures, threads.
  ASSERT_EQ(resume("--frames 5 --set render.every_nth=2").exit_code, 0);
  EXPECT_TRUE(fs::exists(out() / "images/image.0005.png"));

  const ProgramResult allowed = resume("--frames 7 --set gravity='[0,-5]' --allow-changed --from-frame 3");
  EXPECT_EQ(allowed.exit_code, 0) << allowed.errors;
  EXPECT_TRUE(matches(allowed.errors, "[^]*warning: going on with another scene .*gravity[^]*")) << allowed.errors;
  EXPECT_NE(bytes(out() / "scene.resolved.toml").find("gravity = [0, -5]"), std::string::npos);
  ASSERT_EQ(run("whole").exit_code, 0);
  EXPECT_TRUE(bytes(out() / frame_name(3)) == bytes(out("whole") / frame_name(3)));
  EXPECT_FALSE(bytes(out() / frame_name(7)) == bytes(out("whole") / frame_name(7)));
  EXPECT_EQ(resume("--frames 8").exit_code, 0) << "the change is the run's own now";
}

TEST_F(ResumeRun, AChangedMeshCountsAsAChange) {
  fs::copy(FIRN_SOURCE_DIR "/scenes/meshes/cube.obj", folder_ / "cube.obj");
  write(
      "end_time = 0.02\nframe_rate = 100\nresolution.particles = 200\nrender.every_nth = 0\n"
      "[material.snow]\npreset = \"snow\"\n"
      "[[body]]\nname = \"cube\"\nmesh = \"cube.obj\"\nscale = 0.1\nmaterial = \"snow\"\n");
  ASSERT_EQ(run().exit_code, 0);
  std::ofstream(folder_ / "cube.obj", std::ios::app) << "# a remark\n";
  const ProgramResult refused = resume("--frames 4");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(matches(refused.errors, "firn: .*body.cube.mesh is \"cube.obj\" with the hash .* and was .*\n"))
      << refused.errors;
}

TEST_F(ResumeRun, DamagedCheckpointsAreNamedAndTheOneBeforeIsTaken) {
  ASSERT_EQ(run("whole").exit_code, 0);
  ASSERT_EQ(run("out", "--set end_time=0.05").exit_code, 0);
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(out() / "checkpoints")) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  ASSERT_EQ(files.size(), 6u);
  std::string damaged = bytes(files.back());
  damaged[damaged.size() / 2] ^= 1;
  std::ofstream(files.back(), std::ios::binary) << damaged;
  const ProgramResult result = resume("--frames 7");
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(matches(result.errors,
                      "[^]*warning: .*checkpoint.0006.h5: cannot use the checkpoint: its hash is .*; "
                      "trying the one before\n[^]*"))
      << result.errors;
  expect_equal_results("out", "whole", 7);

  for (const auto& entry : fs::directory_iterator(out() / "checkpoints")) std::ofstream(entry.path()) << "";
  const ProgramResult none = resume("--frames 8");
  EXPECT_EQ(none.exit_code, 3);
  EXPECT_TRUE(matches(none.errors, "[^]*no checkpoint can be used; start the run again with firn run --force\n"));
  EXPECT_TRUE(bytes(out() / frame_name(7)) == bytes(out("whole") / frame_name(7))) << "never begun anew by itself";
  std::ofstream(out() / "run.json") << "{}";
  EXPECT_EQ(resume().exit_code, 3);
  EXPECT_EQ(run_firn("resume " + quoted(folder_)).exit_code, 3);
  EXPECT_EQ(run_firn("resume " + quoted(folder_ / "nowhere")).exit_code, 3);
}

TEST_F(ResumeRun, AFolderIsUsedByOneProcessAtATime) {
  const pid_t child = start("out", {"--set", "limits.max_dt=2e-7"});
  wait_for_checkpoint();
  for (const ProgramResult& second : {run("out", "--force"), resume()}) {
    EXPECT_EQ(second.exit_code, 3);
    EXPECT_TRUE(matches(second.errors, "firn: .*out is in use: process " + std::to_string(child) +
                                           " on .*; wait until it has ended, end it, or choose another folder.*\n"))
        << second.errors;
  }
  kill(child, SIGKILL);
  EXPECT_EQ(exit_code_of(child), 1000 + SIGKILL);
  EXPECT_EQ(run("out", "--force").exit_code, 0) << "the lock of a killed process is free";
}

TEST_F(ResumeRun, TheFilmHoldsThePicturesOfBothParts) {
  const std::string pictures = "--set render.every_nth=1 ";
  ASSERT_EQ(run("whole", pictures).exit_code, 0);
  ASSERT_EQ(run("out", pictures + "--set end_time=0.03").exit_code, 0);
  fs::remove(out() / "images/image.0002.png");
  ASSERT_EQ(resume("--frames 7").exit_code, 0);
  for (int frame = 1; frame <= 7; ++frame) {
    const std::string name = "images/image.000" + std::to_string(frame) + ".png";
    EXPECT_TRUE(bytes(out() / name) == bytes(out("whole") / name)) << frame;
  }
  if (!fs::exists(out("whole") / "film.mp4")) GTEST_SKIP() << "no ffmpeg";
  EXPECT_TRUE(bytes(out() / "film.mp4") == bytes(out("whole") / "film.mp4"));
}

TEST_F(ResumeRun, OldCheckpointsGoAndTheNewestStay) {
  ASSERT_EQ(run("out", "--set checkpoint.keep=2").exit_code, 0);
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(out() / "checkpoints")) files.push_back(entry.path().filename());
  std::sort(files.begin(), files.end());
  EXPECT_EQ(files, (std::vector<std::string>{"checkpoint.0006.h5", "checkpoint.0007.h5"}));
}

TEST_F(ResumeRun, CheckSaysWhatACrashWouldCost) {
  const std::string scene = quoted(folder_ / "scene.toml");
  const auto line = [&](const std::string& options) { return run_firn("check " + scene + " " + options).output; };
  EXPECT_TRUE(matches(line("--set checkpoint.every_frames=0"),
                      "[^]*checkpoint .* [MG]iB each, .*a crash loses 5 min of computing at most\n[^]*"));
  EXPECT_TRUE(matches(line("--set checkpoint.every_frames=3 --set checkpoint.every_minutes=0"),
                      "[^]*a crash loses 3 frames at most\n[^]*"));
  EXPECT_TRUE(matches(line("--set checkpoint.every_frames=0 --set checkpoint.every_minutes=0"),
                      "[^]*a crash loses the whole run at most\n[^]*"));
}

}  // namespace
}  // namespace firn::test
