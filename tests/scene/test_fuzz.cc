#include "scene/scene_text.h"

#include <firn/scene/document.h>

#include <cstdint>
#include <filesystem>

namespace firn::test {
namespace {

/// splitmix64: the same numbers everywhere.
struct Random {
  std::uint64_t state;
  std::uint64_t next() {
    state += 0x9e3779b97f4a7c15u;
    std::uint64_t z = state;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  std::size_t below(std::size_t n) { return next() % n; }
};

std::string damaged(std::string text, Random& random) {
  static const std::string kFragments[] = {"[",
                                           "]",
                                           "[[",
                                           "{",
                                           "}",
                                           "=",
                                           ".",
                                           ",",
                                           "\"",
                                           "'",
                                           "\"\"\"",
                                           "\n",
                                           "#",
                                           "\\",
                                           "1e999",
                                           "nan",
                                           "-",
                                           "-1e30",
                                           "0x1",
                                           "\xff",
                                           "body",
                                           "a.b",
                                           "\r",
                                           "\t",
                                           "[]",
                                           "{}",
                                           "true",
                                           "1,5",
                                           "99999999999999999999",
                                           "1979-05-27"};
  for (std::size_t edits = 1 + random.below(3); edits > 0; --edits) {
    const std::size_t at = random.below(text.size());
    switch (random.below(4)) {
      case 0:
        text.erase(at, 1 + random.below(20));
        break;
      case 1:
        text.insert(at, kFragments[random.below(std::size(kFragments))]);
        break;
      case 2:
        text[at] = static_cast<char>(random.below(256));
        break;
      default:
        text.insert(at, text.substr(random.below(text.size()), random.below(40)));
        break;
    }
    if (text.empty()) return "x";
  }
  return text;
}

TEST(Fuzz, DamagedScenesLoadOrFailInOneLine) {
  const std::filesystem::path path = std::filesystem::path(FIRN_SOURCE_DIR) / "scenes" / "snow_cube.toml";
  const std::string text = read_scene_text(path);
  Random random{1};
  int loaded = 0, refused = 0;
  for (int i = 0; i < 4000; ++i) {
    const std::string scene = damaged(text, random);
    try {
      parse_scene(scene, path);
      ++loaded;
    } catch (const Error& error) {
      ++refused;
      const std::string message = error.what();
      EXPECT_EQ(message.find('\n'), std::string::npos) << scene;
      EXPECT_TRUE(message.starts_with(path.string() + ":")) << message;
    }
  }
  EXPECT_GT(loaded, 100);
  EXPECT_GT(refused, 1000);
}

TEST(Fuzz, DamagedOverridesApplyOrFailInOneLine) {
  Random random{2};
  for (int i = 0; i < 4000; ++i) {
    const std::string text = damaged("material.snow.youngs_modulus=[2e5, 1]", random);
    const std::string message = error_of(kMinimal, {text});
    EXPECT_EQ(message.find('\n'), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace firn::test
