#pragma once

#include <firn/render/film.h>
#include <firn/render/image.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace firn {

/// Pictures and films of what the window shows. They get names that are not taken yet, NAME_001.png and NAME_001.mp4.
class Recorder {
 public:
  /// @param stem folder and beginning of the names
  explicit Recorder(std::filesystem::path stem) : stem_(std::move(stem)) {}
  /// A film that was not stopped is closed; what goes wrong then is lost.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Writes a picture and returns its name. Throws Error (files).
  std::filesystem::path picture(const Image& image);

  /// Begins a film. Throws Error as Film.
  void start(int width, int height, double frames_per_second);
  bool recording() const { return film_ != nullptr; }
  /// Adds a picture; one of another size ends the film there. Throws Error as Film.
  void add(const Image& image);
  /// Ends the film and returns its name; nothing if none was being made, or it has no picture yet. Throws Error as
  /// Film.
  std::optional<std::filesystem::path> stop();
  std::int64_t pictures() const { return pictures_; }
  const std::filesystem::path& film_path() const { return path_; }

 private:
  std::filesystem::path free_name(const char* extension) const;

  std::filesystem::path stem_, path_;
  std::unique_ptr<Film> film_;
  int width_ = 0, height_ = 0;
  std::int64_t pictures_ = 0;
};

}  // namespace firn
