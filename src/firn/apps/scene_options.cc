#include <firn/apps/scene_options.h>
#include <firn/scene/build_world.h>
#include <firn/scene/load_scene.h>
#include <firn/scene/value_text.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>

namespace firn {
namespace {

constexpr std::int64_t kFewestPreviewParticles = 1000;

}  // namespace

std::shared_ptr<SceneOptions> add_scene_options(CLI::App& command) {
  const auto options = std::make_shared<SceneOptions>();
  command.add_option("scene", options->file, "Scene file (TOML)")->required();
  command.add_option("--set", options->set, "Change a key of the scene: material.snow.youngs_modulus=2e5")
      ->type_name("KEY=VALUE")
      ->take_all()
      ->expected(1)
      ->allow_extra_args(false);
  command.add_option("-o,--output", options->folder, "Output folder instead of the scene's")->type_name("FOLDER");
  command.add_option("--threads", options->threads, "Threads to compute with; 0, or not given: all of them")
      ->check(CLI::Range(0, 1000000));
  command.add_option("--particles", options->particles, "Number of particles instead of the scene's resolution")
      ->check(CLI::Range(std::int64_t(1), std::int64_t(std::numeric_limits<std::int32_t>::max())));
  command.add_flag("--preview", options->preview, "Quick look: an eighth of the particles, pictures of half the size");
  return options;
}

Scene load(const SceneOptions& options) {
  std::vector<std::string> set = options.set;
  if (options.particles > 0) set.push_back(fmt::format("resolution.particles={}", options.particles));
  if (options.threads) set.push_back(fmt::format("threads={}", *options.threads));
  if (!options.folder.empty()) set.push_back("output.folder=" + in_quotes(options.folder));
  Scene scene = load_scene(options.file, set);
  if (!options.preview) return scene;
  set.push_back(
      fmt::format("resolution.particles={}", std::max(plan_world(scene).particles / 8, kFewestPreviewParticles)));
  set.push_back(fmt::format("render.width={}", std::max(scene.render.width / 2, 16)));
  set.push_back(fmt::format("render.height={}", std::max(scene.render.height / 2, 16)));
  if (options.folder.empty()) set.push_back("output.folder=" + in_quotes(scene.output.folder + "_preview"));
  return load_scene(options.file, set);
}

}  // namespace firn
