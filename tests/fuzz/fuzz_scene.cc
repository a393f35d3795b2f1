#include <firn/scene/load_scene.h>
#include <firn/scene/resolved.h>

#include "fuzz/fuzz_target.h"

using namespace firn;

namespace {

constexpr std::string_view kOverrideMark = "#--set ";

/// Overrides stand at the end of the input as lines "#--set path.to.key=value", which are comments of TOML too.
std::vector<std::string> overrides_of(std::string_view bytes) {
  std::vector<std::string> overrides;
  for (std::size_t at = bytes.find(kOverrideMark); at != bytes.npos && overrides.size() < 4;
       at = bytes.find(kOverrideMark, at)) {
    at += kOverrideMark.size();
    overrides.emplace_back(bytes.substr(at, bytes.find('\n', at) - at));
  }
  return overrides;
}

}  // namespace

FIRN_FUZZ_TARGET(scene) {
  const Scene scene = parse_scene(std::string(bytes), "scene.toml", overrides_of(bytes));
  const std::string resolved = resolved_toml(scene);
  const Scene again =
      fuzz::must_accept("a resolved scene is refused", [&] { return parse_scene(resolved, "scene.toml"); });
  const std::string twice = resolved_toml(again);
  fuzz::require(twice == resolved, "a resolved scene changes when it is read:\n" + resolved + "\n---\n" + twice);
  fuzz::require(scene_hash(again) == scene_hash(scene), "a resolved scene has another hash");
}
