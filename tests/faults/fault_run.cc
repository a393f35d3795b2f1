#include "fault_run.h"

#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace firn::test {

namespace fs = std::filesystem;

namespace {

constexpr const char* kScene =
    "dimension = 2\nend_time = 0.003\nframe_rate = 1000\n"
    "[resolution]\nparticles = 150\n"
    "[material.snow]\npreset = \"snow\"\n"
    "[[body]]\nname = \"ball\"\nshape = \"disk\"\nradius = 0.1\nposition = [0, 0.11]\nvelocity = [0, -5]\n"
    "material = \"snow\"\n"
    "[[collider]]\nname = \"ground\"\nshape = \"half_space\"\n"
    "[[probe]]\nname = \"place\"\nposition = [0, 0.1]\n"
    "[render]\nevery_nth = 0\n"
    "[checkpoint]\nevery_frames = 1\n";

constexpr const char* kSeries = "particles/particles.hdf.series";
constexpr const char* kProbe = "probes/place.csv";

std::string frame_name(int frame) { return "particles/particles.000" + std::to_string(frame) + ".hdf"; }

}  // namespace

double Numbers::next() {
  state_ += 0x9e3779b97f4a7c15u;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

void FaultRun::SetUp() {
  std::ofstream(folder_ / "scene.toml") << kScene;
  const auto begin = std::chrono::steady_clock::now();
  const Ended ended = firn(run_arguments());
  seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  ASSERT_EQ(ended.exit_code, 0) << ended.errors;
  for (int frame = 1; frame <= kFrames; ++frame) good_[frame_name(frame)] = file_bytes(out() / frame_name(frame));
  for (const char* name : {kSeries, kProbe}) good_[name] = file_bytes(out() / name);
  for (const auto& [name, bytes] : good_) ASSERT_FALSE(bytes.empty()) << name;
  clear();
}

std::vector<std::string> FaultRun::run_arguments(bool force) const {
  std::vector<std::string> arguments = {"run", (folder_ / "scene.toml").string(), "-o", out().string(), "--threads",
                                        "1"};
  if (force) arguments.emplace_back("--force");
  return arguments;
}

pid_t FaultRun::start(const std::vector<std::string>& arguments, const std::map<std::string, std::string>& environment,
                      const std::function<void()>& prepare) const {
  const std::string output = (folder_ / "stdout").string(), errors = (folder_ / "stderr").string();
  std::vector<const char*> list = {FIRN_PROGRAM};
  for (const std::string& argument : arguments) list.push_back(argument.c_str());
  list.push_back(nullptr);
  const pid_t child = fork();
  if (child != 0) return child;
  if (freopen(output.c_str(), "w", stdout) == nullptr || freopen(errors.c_str(), "w", stderr) == nullptr) _exit(98);
  for (const auto& [name, value] : environment) setenv(name.c_str(), value.c_str(), 1);
  if (prepare) prepare();
  execv(FIRN_PROGRAM, const_cast<char**>(list.data()));
  _exit(99);
}

Ended FaultRun::wait(pid_t child) const {
  int status = 0;
  waitpid(child, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status), file_bytes(folder_ / "stdout"),
          file_bytes(folder_ / "stderr")};
}

Ended FaultRun::firn(const std::vector<std::string>& arguments, const std::map<std::string, std::string>& environment,
                     const std::function<void()>& prepare) const {
  return wait(start(arguments, environment, prepare));
}

bool FaultRun::run_with(const Fault& fault, const std::vector<std::string>& arguments, Ended* ended) const {
  const fs::path mark = folder_ / "mark";
  fs::remove(mark);
  *ended = firn(arguments, {{"LD_PRELOAD", FIRN_FAULT_SHIM},
                            {"FIRN_FAULT_FOLDER", out().string()},
                            {"FIRN_FAULT_KIND", fault.kind},
                            {"FIRN_FAULT_NUMBER", std::to_string(fault.number)},
                            {"FIRN_FAULT_ERRNO", std::to_string(fault.reason)},
                            {"FIRN_FAULT_FOREVER", fault.forever ? "1" : "0"},
                            {"FIRN_FAULT_MARK", mark.string()}});
  return fs::exists(mark);
}

void FaultRun::expect_good_frames(const std::string& where) const {
  for (int frame = 1; frame <= kFrames; ++frame) {
    const std::string name = frame_name(frame);
    if (!fs::exists(out() / name)) continue;
    EXPECT_TRUE(file_bytes(out() / name) == good_.at(name)) << name << ": " << where;
  }
}

void FaultRun::expect_recovery(const std::string& where) const {
  Ended ended = firn(resume_arguments());
  if (ended.exit_code != 0) {
    // A run that had no checkpoint yet has nothing to go on from, and says so.
    EXPECT_EQ(ended.exit_code, 3) << where << ": " << ended.errors;
    const bool is_said = ended.errors.find("no checkpoint yet") != std::string::npos ||
                         ended.errors.find("is not the output folder of a run") != std::string::npos;
    EXPECT_TRUE(is_said) << where << ": " << ended.errors;
    ended = firn(run_arguments(true));
  }
  EXPECT_EQ(ended.exit_code, 0) << where << ": " << ended.errors;
  for (const auto& [name, bytes] : good_) EXPECT_TRUE(file_bytes(out() / name) == bytes) << name << ": " << where;
}

void FaultRun::expect_clear_end(const Ended& ended, const std::string& where) const {
  EXPECT_TRUE(ended.exit_code == 0 || ended.exit_code == 3) << where << ": " << ended.exit_code << "\n" << ended.errors;
  if (ended.exit_code == 0) return;
  EXPECT_EQ(ended.errors.rfind("firn: ", 0), 0u) << where << ": " << ended.errors;
  EXPECT_NE(ended.errors.find(out().string()), std::string::npos) << where << " names no file: " << ended.errors;
  EXPECT_EQ(ended.errors.find("HDF5-DIAG"), std::string::npos) << where << ": " << ended.errors;
}

}  // namespace firn::test
