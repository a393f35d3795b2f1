#include <firn/apps/commands.h>
#include <firn/apps/info_report.h>
#include <firn/core/error.h>
#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace firn {
namespace {

struct Options : InfoOptions {
  std::vector<std::string> paths;
  bool json = false;
};

void print_info(const Options& options) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  std::size_t damaged = 0;
  for (const std::string& path : options.paths) {
    const nlohmann::ordered_json info = info_of(path, options);
    if (!info["whole"].get<bool>()) ++damaged;
    if (!options.json) {
      std::fputs(info_text(info).c_str(), stdout);
      std::fflush(stdout);
    }
    all.push_back(info);
  }
  if (options.json) {
    const auto text =
        (all.size() == 1 ? all.front() : all).dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
    std::fputs((text + "\n").c_str(), stdout);
    std::fflush(stdout);
  }
  if (damaged == 0) return;
  throw Error(ErrorKind::files, options.paths.size() == 1
                                    ? fmt::format("{} is damaged", options.paths.front())
                                    : fmt::format("{} of {} are damaged", damaged, options.paths.size()));
}

}  // namespace

void add_info(CLI::App& program) {
  CLI::App* command = program.add_subcommand("info", "What is in a run's folder, a frame or a checkpoint");
  const auto options = std::make_shared<Options>();
  command->add_option("path", options->paths, "Folders of runs, frames (*.hdf) and checkpoints (*.h5)")->required();
  command->add_flag("--json", options->json, "For scripts");
  command->add_flag("--all", options->all, "Read every frame and checkpoint of a run, not only the newest");
  command->callback([options] { print_info(*options); });
}

}  // namespace firn
