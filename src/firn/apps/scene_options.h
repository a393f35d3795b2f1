#pragma once

#include <firn/scene/settings.h>
#include <CLI/CLI.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace firn {

/// The scene of a command line, with what its options change.
struct SceneOptions {
  std::string file;
  std::vector<std::string> set;
  std::string folder;
  std::optional<int> threads;
  std::int64_t particles = 0;
  bool preview = false;
};

/// Declares SCENE, --set, -o, --threads, --particles and --preview.
std::shared_ptr<SceneOptions> add_scene_options(CLI::App& command);

/// Loads it. --preview takes an eighth of the particles and pictures of half the size, into a folder of its own.
Scene load(const SceneOptions& options);

}  // namespace firn
