#pragma once

#include <firn/render/image.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace firn {

/// A scene that comes with Firn.
struct GalleryEntry {
  std::string group;  ///< "gallery", "obstacles", "classroom"
  std::string title;
  std::string text;  ///< what there is to see: the comment at the top of the scene file
  std::filesystem::path scene;
  std::filesystem::path picture;  ///< may not exist
};

/// The folder that holds scenes/ and docs/: beside the program, above it, the present folder, or where the program was
/// built; nothing if there is none.
std::optional<std::filesystem::path> find_share(const std::filesystem::path& program);

/// The scenes of these groups, by name. A file that cannot be read is left out.
std::vector<GalleryEntry> list_gallery(const std::filesystem::path& share);

/// A picture file (JPEG, PNG) reduced to at most this width; nothing if it cannot be read.
std::optional<Image> read_thumbnail(const std::filesystem::path& path, int width);

}  // namespace firn
