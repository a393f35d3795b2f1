#include <firn/apps/viewer/gallery.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <system_error>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_JPEG
#define STBI_ONLY_PNG
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

namespace firn {
namespace {

constexpr const char* kGroups[] = {"gallery", "obstacles", "classroom"};

/// The comment before the first key, without what is for editors and tools, and the title.
void read_head(GalleryEntry& entry) {
  std::ifstream stream(entry.scene);
  for (std::string line; std::getline(stream, line);) {
    if (line.rfind("#:", 0) == 0 || line.rfind("# Pictures at", 0) == 0) continue;
    if (!line.empty() && line[0] == '#') {
      const std::string text = line.substr(line.size() > 1 && line[1] == ' ' ? 2 : 1);
      entry.text += entry.text.empty() ? text : " " + text;
    }
    if (line.rfind("title", 0) != 0) continue;
    const auto from = line.find('"'), to = line.rfind('"');
    if (from != std::string::npos && to > from) entry.title = line.substr(from + 1, to - from - 1);
    return;
  }
}

std::filesystem::path picture_of(const std::filesystem::path& share, const std::string& stem) {
  for (const char* extension : {".jpg", ".png"}) {
    const auto path = share / "docs" / "images" / "gallery" / (stem + extension);
    std::error_code ignored;
    if (std::filesystem::exists(path, ignored)) return path;
  }
  return {};
}

/// Mean of the pixels of `large` that each pixel of the result covers.
Image reduced(const Image& large, int width) {
  const int height = std::max(1, large.height * width / large.width);
  Image small(width, height);
  for (int y = 0; y < height; ++y) {
    const int y0 = y * large.height / height, y1 = std::max(y0 + 1, (y + 1) * large.height / height);
    for (int x = 0; x < width; ++x) {
      const int x0 = x * large.width / width, x1 = std::max(x0 + 1, (x + 1) * large.width / width);
      int sum[3] = {};
      for (int j = y0; j < y1; ++j) {
        for (int i = x0; i < x1; ++i) {
          for (int c = 0; c < 3; ++c) sum[c] += large.pixel(i, j)[c];
        }
      }
      for (int c = 0; c < 3; ++c) small.pixel(x, y)[c] = static_cast<std::uint8_t>(sum[c] / ((x1 - x0) * (y1 - y0)));
    }
  }
  return small;
}

}  // namespace

std::optional<std::filesystem::path> find_share(const std::filesystem::path& program) {
  const std::filesystem::path beside = program.parent_path();
  for (const std::filesystem::path& folder : {beside, beside / "..", beside / ".." / "share" / "firn",
                                              std::filesystem::path("."), std::filesystem::path(FIRN_SHARE_DIR)}) {
    std::error_code ignored;
    if (std::filesystem::is_directory(folder / "scenes" / "gallery", ignored)) return folder.lexically_normal();
  }
  return std::nullopt;
}

std::vector<GalleryEntry> list_gallery(const std::filesystem::path& share) {
  std::vector<GalleryEntry> entries;
  for (const char* group : kGroups) {
    std::vector<std::filesystem::path> files;
    std::error_code error;
    for (const auto& file : std::filesystem::directory_iterator(share / "scenes" / group, error)) {
      if (file.path().extension() == ".toml") files.push_back(file.path());
    }
    std::sort(files.begin(), files.end());
    for (const std::filesystem::path& file : files) {
      GalleryEntry entry = {group, file.stem().string(), "", file, picture_of(share, file.stem().string())};
      read_head(entry);
      entries.push_back(std::move(entry));
    }
  }
  return entries;
}

std::optional<Image> read_thumbnail(const std::filesystem::path& path, int width) {
  Image image;
  int channels = 0;
  const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> pixels(
      stbi_load(path.c_str(), &image.width, &image.height, &channels, 3), &stbi_image_free);
  if (pixels == nullptr || image.width < 1 || image.height < 1) return std::nullopt;
  image.rgb.assign(pixels.get(),
                   pixels.get() + 3UL * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  return image.width > width ? reduced(image, width) : image;
}

}  // namespace firn
