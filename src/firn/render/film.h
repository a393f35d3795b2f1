#pragma once

#include <firn/render/image.h>

#include <filesystem>
#include <memory>
#include <string>

namespace firn {

/// An H.264 film (MP4, 4:2:0) that is encoded by the program ffmpeg while frames come in. It appears under its name
/// when it is closed; a film that is not closed leaves nothing behind. Sizes are made even by repeating the last row or
/// column.
class Film {
 public:
  /// Starts ffmpeg. Throws Error (resources) that names the package if there is no ffmpeg, Error (files) if the folder
  /// does not exist, Error (usage) if frames_per_second is not in (0, 1000].
  Film(const std::filesystem::path& path, int width, int height, double frames_per_second);
  ~Film();
  Film(const Film&) = delete;
  Film& operator=(const Film&) = delete;

  /// Throws Error (usage) if the image has another size, Error (files) with ffmpeg's last line if it has stopped.
  void add(const Image& image);

  /// Waits for ffmpeg and moves the film to its name. Throws Error (files) with ffmpeg's last line if it failed.
  void close();

 private:
  struct Encoder;
  std::unique_ptr<Encoder> encoder_;
};

/// True if there is a program of this name in one of the folders of PATH.
bool program_exists(const std::string& name);

}  // namespace firn
