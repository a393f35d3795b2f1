#include <firn/apps/commands.h>
#include <firn/core/error.h>
#include <firn/core/log.h>
#include <firn/scene/value_text.h>

#include <malloc.h>

#include <cstdio>
#include <filesystem>
#include <new>

namespace {

constexpr int kInterrupted = 130, kUnexpected = 1;

int report(const char* message, int exit_code) {
  // Names of files and objects may hold line ends; a message is one line.
  std::fprintf(stderr, "firn: %s\n", firn::one_line(message).c_str());
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace firn;
  // Left alone, the C library learns to keep what large arrays give back: 2 % of a run's memory.
  mallopt(M_MMAP_THRESHOLD, 1 << 17);
  set_log_sink([](LogLevel level, const std::string& line) {
    std::fprintf(stderr, "firn: %s%s\n", level == LogLevel::warning ? "warning: " : "", one_line(line).c_str());
  });
  CLI::App program("Firn simulates snow, jelly and other materials by the material point method.", "firn");
  program.set_version_flag("--version", "firn " FIRN_VERSION);
  program.footer(
      "`firn COMMAND --help` shows the options of a command; `firn explain` lists the keys of a scene file.");
  add_commands(program);
  try {
    if (argc == 1) {
      std::fputs(program.help().c_str(), stderr);
      return static_cast<int>(ErrorKind::usage);
    }
    return run_command_line(program, argc, argv);
  } catch (const Error& error) {
    return report(error.what(), error.exit_code());
  } catch (const Interrupted& stop) {
    return report(stop.what(), kInterrupted);
  } catch (const std::bad_alloc&) {
    return report("out of memory; use fewer particles or a larger cell size", static_cast<int>(ErrorKind::resources));
  } catch (const std::filesystem::filesystem_error& error) {
    return report(error.what(), static_cast<int>(ErrorKind::files));
  } catch (const std::exception& error) {
    return report(error.what(), kUnexpected);
  }
}
