#pragma once

#include <firn/scene/settings.h>

#include <map>
#include <string>
#include <vector>

namespace firn {

/// Every key that decides where particles go, with its final value as TOML: "material.snow.density" -> "400". A path
/// stands as the file's name with a hash of what is in it, a pattern of paths as all of its files, and each list of
/// bodies, colliders ... as the list of its names. Error(files) for a file that cannot be read.
std::map<std::string, std::string> scene_keys(const Scene& scene);

/// One line for each key that differs: "material.snow.density is 300 and was 400".
std::vector<std::string> differing_keys(const std::map<std::string, std::string>& before,
                                        const std::map<std::string, std::string>& now);

}  // namespace firn
