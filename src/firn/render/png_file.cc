#include <firn/core/error.h>
#include <firn/io/atomic_file.h>
#include <firn/render/image.h>
#include <fmt/format.h>
#include <png.h>

#include <string>

namespace firn {

namespace {

void append(png_structp png, png_bytep bytes, png_size_t size) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(bytes), size);
}

void ignore_flush(png_structp) {}

/// libpng wants error callbacks not to return; an exception leaves its C frames, which hold nothing that needs closing.
[[noreturn]] void fail(png_structp, png_const_charp message) {
  throw Error(ErrorKind::resources, fmt::format("cannot encode a picture: {}", message));
}

void ignore_warning(png_structp, png_const_charp) {}

/// Frees libpng's structures on every way out.
struct PngWriter {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, fail, ignore_warning);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  ~PngWriter() { png_destroy_write_struct(&png, &info); }
};

}  // namespace

void write_png(const std::filesystem::path& path, const Image& image) {
  PngWriter writer;
  if (writer.info == nullptr) throw Error(ErrorKind::resources, "cannot encode a picture: out of memory");
  std::string bytes;
  png_set_write_fn(writer.png, &bytes, append, ignore_flush);
  png_set_IHDR(writer.png, writer.info, static_cast<png_uint_32>(image.width), static_cast<png_uint_32>(image.height),
               8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_compression_level(writer.png, 4);  // twice as fast as the default for files 4 % larger
  png_set_sRGB(writer.png, writer.info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_write_info(writer.png, writer.info);
  for (int y = 0; y < image.height; ++y) png_write_row(writer.png, image.pixel(0, y));
  png_write_end(writer.png, nullptr);
  write_file_atomically(path, bytes);
}

std::optional<Image> read_png(const std::filesystem::path& path) {
  png_image png = {};
  png.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&png, path.c_str()) == 0) return std::nullopt;
  png.format = PNG_FORMAT_RGB;
  Image image(static_cast<int>(png.width), static_cast<int>(png.height));
  const int is_read = png_image_finish_read(&png, nullptr, image.rgb.data(), 0, nullptr);
  png_image_free(&png);
  if (is_read == 0) return std::nullopt;
  return image;
}

}  // namespace firn
