#include <firn/apps/commands.h>
#include <firn/core/error.h>
#include <firn/scene/nearest.h>
#include <firn/scene/value_text.h>

#include <fmt/format.h>

namespace firn {
namespace {

std::vector<std::string> command_names(const CLI::App& program) {
  std::vector<std::string> names;
  for (const CLI::App* command : program.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

/// The first argument that nothing wanted, and what may have been meant.
std::string unexpected_argument(const CLI::App& program) {
  const std::vector<CLI::App*> parsed = program.get_subcommands();
  const std::vector<std::string> rest = program.remaining(true);
  const std::string argument = rest.empty() ? "" : rest.front();
  if (parsed.empty() && !argument.starts_with('-')) {
    return fmt::format("no command \"{}\"{}", argument, suggestion(argument, command_names(program)));
  }
  const CLI::App& command = parsed.empty() ? program : *parsed.front();
  const std::string where = parsed.empty() ? "" : command.get_name() + ": ";
  if (!argument.starts_with('-')) return fmt::format("{}\"{}\" is one argument too many", where, argument);
  const std::string name = argument.substr(0, argument.find('='));
  return fmt::format("{}no option \"{}\"{}", where, name, suggestion(name, option_names(command)));
}

}  // namespace

void add_commands(CLI::App& program) {
  add_run(program);
  add_resume(program);
  add_check(program);
  add_view(program);
  add_render(program);
  add_info(program);
  add_export(program);
  add_surface(program);
  add_sample(program);
  add_explain(program);
  add_materials(program);
  add_point(program);
  add_doctor(program);
  add_bench(program);
}

int run_command_line(CLI::App& program, int argc, const char* const* argv) {
  for (int i = 1; i < argc; ++i) {
    // Names end up in scenes and lists of frames, which are UTF-8.
    if (is_utf8(argv[i])) continue;
    throw Error(ErrorKind::usage,
                fmt::format("argument {} is not UTF-8 text; rename the file or folder, or write the name in UTF-8", i));
  }
  try {
    program.parse(argc, argv);
    return 0;
  } catch (const CLI::Success& success) {  // --help, --version
    return program.exit(success);
  } catch (const CLI::ExtrasError&) {
    throw Error(ErrorKind::usage, unexpected_argument(program));
  } catch (const CLI::ParseError& error) {
    const std::vector<CLI::App*> parsed = program.get_subcommands();
    const std::string command = parsed.empty() ? "" : " " + parsed.front()->get_name();
    throw Error(ErrorKind::usage, fmt::format("{}; firn{} --help shows how to use it", error.what(), command));
  }
}

}  // namespace firn
