#include <firn/core/error.h>
#include <firn/io/atomic_file.h>
#include <firn/core/child_process.h>
#include <firn/render/film.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>

namespace firn {

namespace {

/// Visually lossless for smooth shading, about 1 MB for 3 s at 960 x 540.
constexpr const char* kQuality = "18";

std::vector<std::string> ffmpeg_command(const std::string& output, int width, int height, double rate) {
  return {"ffmpeg", "-hide_banner", "-nostdin", "-loglevel", "error", "-y",
          // What comes in.
          "-f", "rawvideo", "-pixel_format", "rgb24", "-video_size", fmt::format("{}x{}", width, height), "-framerate",
          fmt::format("{}", rate), "-i", "pipe:0",
          // Players take colours of films without a matrix in the file for BT.709; ffmpeg's own default is BT.601.
          "-vf", "scale=out_color_matrix=bt709:out_range=tv:flags=accurate_rnd+full_chroma_int", "-colorspace", "bt709",
          "-color_primaries", "bt709", "-color_trc", "bt709", "-color_range", "tv",
          // One thread: the simulation needs the cores, and equal pictures give equal films.
          "-c:v", "libx264", "-preset", "medium", "-crf", kQuality, "-pix_fmt", "yuv420p", "-threads", "1", "-fflags",
          "+bitexact", "-flags:v", "+bitexact", "-map_metadata", "-1", "-movflags", "+faststart", "-f", "mp4",
          // A path that begins with "-" or contains ":" is still a file.
          "file:" + output};
}

int even(int size) { return size + size % 2; }

}  // namespace

struct Film::Encoder {
  std::filesystem::path path;
  int width, height;
  AtomicFile file;
  ChildProcess process;
  std::vector<std::uint8_t> padded;

  Encoder(const std::filesystem::path& place, int w, int h, double rate)
      : path(place),
        width(w),
        height(h),
        file(place),
        process(ffmpeg_command(file.part_path().string(), even(w), even(h), rate)) {}

  void finish() {
    if (process.finish()) return;
    throw Error(ErrorKind::files,
                fmt::format("{}: ffmpeg could not make the film: {}", path.string(), process.last_error_line()));
  }

  /// The image with its last column and row repeated where a size is odd.
  const std::vector<std::uint8_t>& even_bytes(const Image& image) {
    if (width % 2 == 0 && height % 2 == 0) return image.rgb;
    padded.clear();
    for (int y = 0; y < even(height); ++y) {
      const std::uint8_t* row = image.pixel(0, std::min(y, height - 1));
      padded.insert(padded.end(), row, row + 3 * width);
      if (width % 2 != 0) padded.insert(padded.end(), row + 3 * (width - 1), row + 3 * width);
    }
    return padded;
  }
};

Film::Film(const std::filesystem::path& path, int width, int height, double frames_per_second) {
  if (!(frames_per_second > 0) || !(frames_per_second <= 1000)) {
    throw Error(ErrorKind::usage,
                fmt::format("film: the frame rate must be in (0, 1000] per second, got {}", frames_per_second));
  }
  if (!program_exists("ffmpeg")) {
    throw Error(ErrorKind::resources, fmt::format("{}: cannot make the film: there is no ffmpeg; install the package "
                                                  "ffmpeg, or make pictures only",
                                                  path.string()));
  }
  encoder_ = std::make_unique<Encoder>(path, width, height, frames_per_second);
}

Film::~Film() = default;

void Film::add(const Image& image) {
  if (encoder_ == nullptr) throw Error(ErrorKind::usage, "film: a picture was added after the film was closed");
  if (image.width != encoder_->width || image.height != encoder_->height) {
    throw Error(ErrorKind::usage, fmt::format("film: pictures must be {} x {} pixels, got {} x {}", encoder_->width,
                                              encoder_->height, image.width, image.height));
  }
  const std::vector<std::uint8_t>& bytes = encoder_->even_bytes(image);
  if (encoder_->process.write(bytes.data(), bytes.size())) return;
  const std::unique_ptr<Encoder> encoder = std::move(encoder_);
  encoder->finish();
  throw Error(ErrorKind::files, fmt::format("{}: ffmpeg stopped before the end of the film", encoder->path.string()));
}

void Film::close() {
  if (encoder_ == nullptr) return;
  const std::unique_ptr<Encoder> encoder = std::move(encoder_);
  encoder->finish();
  encoder->file.commit();
}

bool program_exists(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (::access((std::filesystem::path(folder) / name).c_str(), X_OK) == 0) return true;
  }
  return false;
}

}  // namespace firn
