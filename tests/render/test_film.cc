#include <firn/core/error.h>
#include <firn/render/film.h>
#include <gtest/gtest.h>
#include "support/temporary_folder.h"

#include <cstdio>
#include <cstdlib>

namespace firn {
namespace {

/// Sets PATH while it lives.
class PathGuard {
 public:
  explicit PathGuard(const std::string& path) : before_(std::getenv("PATH")) { ::setenv("PATH", path.c_str(), 1); }
  ~PathGuard() { ::setenv("PATH", before_.c_str(), 1); }

 private:
  std::string before_;
};

Image gray_image(int width, int height, int shade) {
  Image image(width, height);
  std::fill(image.rgb.begin(), image.rgb.end(), static_cast<std::uint8_t>(shade));
  return image;
}

void make_film(const std::filesystem::path& path) {
  Film film(path, 101, 67, 24);
  for (int i = 0; i < 13; ++i) film.add(gray_image(101, 67, 20 * i));
  film.close();
}

std::string output_of(const std::string& command) {
  FILE* pipe = ::popen(command.c_str(), "r");
  std::string text;
  for (int c = 0; pipe != nullptr && (c = std::fgetc(pipe)) != EOF;) text.push_back(static_cast<char>(c));
  if (pipe != nullptr) ::pclose(pipe);
  return text;
}

template <class Call>
std::string message_of(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Film, HasItsFramesSizeAndRate) {
  const TemporaryFolder folder;
  make_film(folder / "a film: 1.mp4");
  const std::string probed = output_of(
      "ffprobe -v error -count_frames -select_streams v:0 -show_entries "
      "stream=codec_name,width,height,pix_fmt,color_space,r_frame_rate,nb_read_frames -of csv=p=0 'file:" +
      (folder / "a film: 1.mp4").string() + "'");
  EXPECT_EQ(probed, "h264,102,68,yuv420p,bt709,24/1,13\n");
}

TEST(Film, EqualPicturesGiveEqualBytes) {
  const TemporaryFolder folder;
  make_film(folder / "a.mp4");
  make_film(folder / "b.mp4");
  EXPECT_GT(file_bytes(folder / "a.mp4").size(), 1000U);
  EXPECT_EQ(file_bytes(folder / "a.mp4"), file_bytes(folder / "b.mp4"));
}

TEST(Film, NotClosedLeavesNothing) {
  const TemporaryFolder folder;
  {
    Film film(folder / "film.mp4", 64, 64, 24);
    film.add(gray_image(64, 64, 100));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Film, MissingEncoderIsAnErrorThatNamesThePackage) {
  const TemporaryFolder folder;
  const PathGuard guard(folder.path().string());
  const std::string message = message_of([&] { Film(folder / "film.mp4", 64, 64, 24); });
  EXPECT_NE(message.find("install the package ffmpeg"), std::string::npos) << message;
}

TEST(Film, FailingEncoderIsAnErrorWithItsLastLine) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "bin");
  std::ofstream(folder / "bin/ffmpeg") << "#!/bin/sh\necho first >&2\necho 'no such encoder: x264' >&2\nexit 1\n";
  std::filesystem::permissions(folder / "bin/ffmpeg", std::filesystem::perms::owner_all);
  const PathGuard guard((folder / "bin").string());
  // Many frames: the program is gone while we still write, which must not kill us by SIGPIPE.
  const std::string message = message_of([&] {
    Film film(folder / "film.mp4", 640, 480, 24);
    for (int i = 0; i < 20; ++i) film.add(gray_image(640, 480, i));
    film.close();
  });
  EXPECT_NE(message.find("film.mp4: ffmpeg could not make the film: no such encoder: x264"), std::string::npos)
      << message;
  EXPECT_FALSE(std::filesystem::exists(folder / "film.mp4"));
  EXPECT_FALSE(std::filesystem::exists(folder / "film.mp4.part"));
}

TEST(Film, WrongInputsAreErrors) {
  const TemporaryFolder folder;
  EXPECT_THROW(Film(folder / "film.mp4", 64, 64, 0), Error);
  EXPECT_THROW(Film(folder / "absent/film.mp4", 64, 64, 24), Error);
  Film film(folder / "film.mp4", 64, 64, 24);
  EXPECT_NE(message_of([&] { film.add(gray_image(32, 64, 0)); }).find("64 x 64 pixels, got 32 x 64"),
            std::string::npos);
}

}  // namespace
}  // namespace firn
