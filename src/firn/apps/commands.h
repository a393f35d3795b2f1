#pragma once

#include <firn/apps/progress.h>
#include <CLI/CLI.hpp>

#include <stdexcept>

/// The subcommands of `firn`. Each add_* function declares one: its options, its help and, as its callback, what it
/// does. A callback ends by returning (exit code 0) or by throwing firn::Error or Interrupted; main.cc maps these to
/// exit codes.
namespace firn {

/// The user asked the program to stop (SIGINT, SIGTERM) and it did so in good order: exit code 130.
struct Interrupted : std::runtime_error {
  using std::runtime_error::runtime_error;
};

void add_run(CLI::App& program);
void add_resume(CLI::App& program);
void add_check(CLI::App& program);
void add_view(CLI::App& program);
void add_render(CLI::App& program);
void add_info(CLI::App& program);
void add_export(CLI::App& program);
void add_surface(CLI::App& program);
void add_explain(CLI::App& program);
void add_sample(CLI::App& program);
void add_materials(CLI::App& program);
void add_point(CLI::App& program);
void add_doctor(CLI::App& program);
void add_bench(CLI::App& program);

/// --progress, of the commands that compute frames.
void add_progress_option(CLI::App& command, Progress::Style& style);

/// All of them.
void add_commands(CLI::App& program);

/// Parses and runs. Returns the exit code for --help and --version; throws Error(usage) for a command line that is not
/// understood, with the nearest name, and whatever the command throws.
int run_command_line(CLI::App& program, int argc, const char* const* argv);

}  // namespace firn
