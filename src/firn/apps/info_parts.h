#pragma once

#include <firn/scene/settings.h>

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace firn {

struct InfoOptions;

/// "whole" becomes false, and "damage" gets a line.
void note_damage(nlohmann::ordered_json& info, const std::string& what);

/// What a frame says of itself and its columns. Throws Error (files) as read_frame().
void add_frame(nlohmann::ordered_json& info, const std::filesystem::path& file);

/// Kernel, transfer and form of a scene.
void add_method(nlohmann::ordered_json& info, const Scene& scene);

/// 0 for what is not there.
std::uint64_t file_bytes(const std::filesystem::path& path);
/// Throws Error (files).
std::string file_text(const std::filesystem::path& path);

nlohmann::ordered_json info_of_file(const std::filesystem::path& path);
nlohmann::ordered_json info_of_run(const std::filesystem::path& path, const InfoOptions& options);

}  // namespace firn
