#include <firn/core/error.h>
#include <firn/io/height_map_file.h>
#include <firn/io/number_table.h>
#include <fmt/format.h>
#include <png.h>

#include <cstdio>
#include <memory>
#include <string>

namespace firn {
namespace {

/// libpng wants error callbacks not to return; an exception leaves its C frames, which hold nothing that needs closing.
[[noreturn]] void fail(png_structp png, png_const_charp message) {
  throw Error(ErrorKind::usage, fmt::format("{}: not a valid PNG picture: {}",
                                            *static_cast<const std::string*>(png_get_error_ptr(png)), message));
}

void ignore_warning(png_structp, png_const_charp) {}

/// Frees libpng's structures on every way out.
struct PngReader {
  explicit PngReader(std::string* name)
      : png(png_create_read_struct(PNG_LIBPNG_VER_STRING, name, fail, ignore_warning)) {
    if (png != nullptr) info = png_create_info_struct(png);
  }
  ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  png_structp png;
  png_infop info = nullptr;
};

HeightMap read_png(const std::filesystem::path& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  std::string name = path.string();
  if (!file) throw Error(ErrorKind::files, fmt::format("{}: cannot be read", name));
  PngReader reader(&name);
  if (reader.info == nullptr) throw Error(ErrorKind::resources, fmt::format("{}: out of memory", name));
  png_init_io(reader.png, file.get());
  png_read_png(reader.png, reader.info, PNG_TRANSFORM_EXPAND | PNG_TRANSFORM_STRIP_ALPHA, nullptr);
  HeightMap map;
  map.columns = png_get_image_width(reader.png, reader.info);
  map.rows = png_get_image_height(reader.png, reader.info);
  const std::size_t channels = png_get_channels(reader.png, reader.info);
  const std::size_t bytes = png_get_bit_depth(reader.png, reader.info) == 16 ? 2 : 1;
  const double white = (bytes == 2 ? 65535.0 : 255.0) * static_cast<double>(channels);
  const png_bytepp rows = png_get_rows(reader.png, reader.info);
  for (std::size_t r = 0; r < map.rows; ++r) {
    for (std::size_t c = 0; c < map.columns; ++c) {
      double sum = 0;
      for (std::size_t k = 0; k < channels; ++k) {
        const png_byte* sample = rows[r] + (c * channels + k) * bytes;
        sum += bytes == 2 ? sample[0] * 256.0 + sample[1] : sample[0];
      }
      map.heights.push_back(sum / white);
    }
  }
  return map;
}

}  // namespace

HeightMap read_height_map(const std::filesystem::path& path) {
  HeightMap map;
  if (path.extension() == ".png") {
    map = read_png(path);
  } else {
    NumberTable table = read_number_table(path);
    map = {table.columns, table.rows(), std::move(table.values)};
  }
  if (map.columns < 2 || map.rows < 2) {
    throw Error(ErrorKind::usage, fmt::format("{}: needs at least 2 x 2 heights, got {} rows of {}", path.string(),
                                              map.rows, map.columns));
  }
  return map;
}

}  // namespace firn
