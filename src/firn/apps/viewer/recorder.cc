#include <firn/apps/viewer/recorder.h>
#include <firn/core/error.h>
#include <fmt/format.h>

#include <system_error>
#include <utility>

namespace firn {
namespace {

constexpr int kMostNames = 1000000;

}  // namespace

Recorder::~Recorder() {
  try {
    stop();
  } catch (const Error&) {
  }
}

std::filesystem::path Recorder::free_name(const char* extension) const {
  for (int n = 1; n < kMostNames; ++n) {
    const std::filesystem::path path = fmt::format("{}_{:03}.{}", stem_.string(), n, extension);
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) return path;
  }
  throw Error(ErrorKind::files, fmt::format("{}_*.{}: every name is taken", stem_.string(), extension));
}

std::filesystem::path Recorder::picture(const Image& image) {
  const std::filesystem::path path = free_name("png");
  write_png(path, image);
  return path;
}

void Recorder::start(int width, int height, double frames_per_second) {
  stop();
  path_ = free_name("mp4");
  film_ = std::make_unique<Film>(path_, width, height, frames_per_second);
  width_ = width;
  height_ = height;
  pictures_ = 0;
}

void Recorder::add(const Image& image) {
  if (film_ == nullptr) return;
  if (image.width != width_ || image.height != height_) {
    stop();
    return;
  }
  film_->add(image);
  ++pictures_;
}

std::optional<std::filesystem::path> Recorder::stop() {
  const std::unique_ptr<Film> film = std::move(film_);
  if (film == nullptr || pictures_ == 0) return std::nullopt;
  film->close();
  return path_;
}

}  // namespace firn
