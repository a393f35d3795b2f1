#include <firn/apps/commands.h>
#include <firn/core/error.h>
#include <firn/scene/explain.h>

#include <cstdio>
#include <memory>

namespace firn {
namespace {

struct ExplainOptions {
  std::string what;
  bool schema = false, reference = false;
};

void print(const std::string& text) { std::fwrite(text.data(), 1, text.size(), stdout); }

void run_explain(const ExplainOptions& options) {
  if (options.schema) {
    print(scene_json_schema());
  } else if (options.reference) {
    print(scene_reference());
  } else {
    print(explain(options.what));
  }
}

}  // namespace

void add_explain(CLI::App& program) {
  CLI::App* command = program.add_subcommand("explain", "What a key of the scene file means");
  const auto options = std::make_shared<ExplainOptions>();
  CLI::Option* what =
      command->add_option("what", options->what,
                          "Key (limits.speed, material.snow.density, density), section, model or preset; "
                          "without it: all keys");
  CLI::Option* schema =
      command->add_flag("--schema", options->schema, "Print the JSON Schema of scene files, for editors")
          ->excludes(what);
  command->add_flag("--reference", options->reference, "Print the reference page in Markdown")
      ->excludes(what)
      ->excludes(schema);
  command->callback([options] { run_explain(*options); });
}

}  // namespace firn
