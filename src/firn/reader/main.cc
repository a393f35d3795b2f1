// Opens files with the libraries of others, for firn: what they do wrong ends this program and not that one.

#include <firn/core/error.h>
#include <firn/io/foreign_reader.h>
#include <firn/reader/foreign_mesh.h>
#include <firn/reader/vdb_level_sets.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <charconv>
#include <csignal>
#include <cstdio>
#include <new>
#include <string>
#include <vector>

namespace firn {
namespace {

constexpr int kUsage = 64;  // not one of Firn's: the caller is at fault

int fail(const std::string& message, ErrorKind kind) {
  send_foreign_refusal(stderr, message);
  return static_cast<int>(kind);
}

int read_files(const std::vector<std::string>& arguments, std::FILE* output) {
  const std::vector<std::filesystem::path> files(arguments.begin() + (arguments[0] == "mesh" ? 1 : 2), arguments.end());
  if (arguments[0] == "mesh") {
    for (const auto& file : files) send_foreign_answer(output, ply_bytes(read_foreign_mesh_here(file)));
    return 0;
  }
  double scale = 0;
  const auto [end, error] = std::from_chars(arguments[1].data(), arguments[1].data() + arguments[1].size(), scale);
  if (error != std::errc() || end != arguments[1].data() + arguments[1].size()) return kUsage;
  read_vdb_level_sets(files, scale,
                      [&](const LevelSetParts& parts) { send_foreign_answer(output, level_set_bytes(parts)); });
  return 0;
}

/// Standard output is for answers only: what libraries print there goes to standard error.
std::FILE* take_standard_output() {
  const int answers = ::dup(STDOUT_FILENO);
  ::dup2(STDERR_FILENO, STDOUT_FILENO);
  return ::fdopen(answers, "wb");
}

int run(const std::vector<std::string>& arguments) {
  if (arguments.size() == 1 && arguments[0] == "versions") {
    fmt::print("assimp {}\nOpenVDB {}\n", assimp_version(), vdb_version());
    return 0;
  }
  const bool is_mesh = arguments.size() >= 2 && arguments[0] == "mesh";
  const bool is_level_sets = arguments.size() >= 3 && arguments[0] == "level-sets";
  if (!is_mesh && !is_level_sets) {
    fmt::print(stderr,
               "firn opens files of other programs with this: firn-reader mesh FILE | level-sets SCALE FILE...\n");
    return kUsage;
  }
  std::FILE* output = take_standard_output();
  if (output == nullptr) return kUsage;
  const std::string& file = arguments.back();
  try {
    return read_files(arguments, output);
  } catch (const Error& error) {
    return fail(error.what(), error.kind());
  } catch (const std::bad_alloc&) {
    return kReaderOutOfMemory;
  } catch (const std::exception& error) {
    return fail(fmt::format("{}: cannot be read: {}", file, error.what()), ErrorKind::usage);
  }
}

}  // namespace
}  // namespace firn

int main(int argc, char** argv) {
  // Nobody waits for it without firn, and nobody wants its core.
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  const rlimit no_core = {0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  return firn::run({argv + 1, argv + argc});
}
