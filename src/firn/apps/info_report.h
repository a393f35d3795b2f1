#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace firn {

struct InfoOptions {
  bool all = false;  ///< read every frame and checkpoint, and not only the newest
};

/// What is in a frame, a checkpoint or the folder of a run. "whole" is false where something is damaged or missing, and
/// "damage" then says what. Throws Error (files) for a path that is none of these.
nlohmann::ordered_json info_of(const std::filesystem::path& path, const InfoOptions& options);

/// The same for people.
std::string info_text(const nlohmann::ordered_json& info);

}  // namespace firn
