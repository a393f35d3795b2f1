#include "scene/scene_text.h"

#include <firn/scene/document.h>

#include <filesystem>
#include <fstream>

namespace firn::test {
namespace {

struct Case {
  const char* name;
  std::string text;
  const char* message;
};

void PrintTo(const Case& c, std::ostream* os) { *os << c.name; }

class TomlError : public testing::TestWithParam<Case> {};

TEST_P(TomlError, IsLocatedAndInPlainWords) { EXPECT_TRUE(matches(error_of(GetParam().text), GetParam().message)); }

INSTANTIATE_TEST_SUITE_P(
    Syntax, TomlError,
    testing::Values(
        Case{"decimal_comma", "end_time = 1,5\n",
             R"(scene.toml:1:13: not TOML: .*; a decimal number is written with a point.*)"},
        Case{"bare_word", "up = y\n", R"(scene.toml:1:6: not TOML: .*; text needs quotes)"},
        // The parser's behaviour is undefined for these.
        Case{"bare_letter", "end_time = ü\n", R"(scene.toml:1:12: not TOML: 'ü' outside of quotes; text needs quotes)"},
        Case{"letter_in_a_key", "\n[material.Größe]\n",
             R"(scene.toml:2:13: not TOML: 'ö' outside of quotes; text needs quotes)"},
        Case{"no_break_space", "up =\u00a0\"y\"\n", R"(scene.toml:1:5: not TOML: .* outside of quotes.*)"},
        Case{"unclosed_list", "gravity = [0, 1\n", R"(scene.toml:[12]:[0-9]+: not TOML: .*)"},
        Case{"not_utf8", "title = \"\xff\xfe\"\n", R"(scene.toml:1:[0-9]+: not TOML: .*utf-8.*)"},
        Case{"too_large_integer", "seed = 99999999999999999999\n", R"(scene.toml:1:[0-9]+: not TOML: .*64 bits)"}));

INSTANTIATE_TEST_SUITE_P(
    Duplicates, TomlError,
    testing::Values(
        Case{"at_root", "up = \"y\"\n\n  up = \"z\"\n", R"(scene.toml:3:[0-9]+: "up" is given twice; first on line 1)"},
        Case{"in_section", "[limits]\nspeed = 1\nmax_dt = 1\n[output]\n[material.a]\ndensity = 1\ndensity = 2\n",
             R"(scene.toml:7:[0-9]+: "density" is given twice; first on line 6)"},
        Case{"in_second_body", "[[body]]\nradius = 1\n[[body]]\nname = \"b\"\nradius = 1\nradius = 2\n",
             R"(scene.toml:6:[0-9]+: "radius" is given twice; first on line 5)"},
        Case{"section", "[limits]\nspeed = 1\n[output]\n[limits]\n",
             R"(scene.toml:4:[0-9]+: "limits" is given twice; first on line 1)"},
        Case{"dotted", "limits.speed = 1\nlimits.speed = 2\n",
             R"(scene.toml:2:[0-9]+: "limits.speed" is given twice; first on line 1)"},
        Case{"inline", "limits = {speed = 1, speed = 2}\n", R"(scene.toml:1:[0-9]+: "speed" is given twice.*)"}));

INSTANTIATE_TEST_SUITE_P(
    Limits, TomlError,
    testing::Values(
        Case{"nul", std::string("seed = 1\nup = \0", 15), R"(scene.toml:2:6: a NUL byte; a scene is UTF-8 text)"},
        Case{"nul_in_comment", std::string("# \0", 3), R"(scene.toml:1:3: a NUL byte.*)"},
        Case{"nul_in_text", std::string("title = \"\0\"", 11), R"(scene.toml:1:10: a NUL byte.*)"},
        Case{"deep_list", "x = " + std::string(100000, '['), R"(scene.toml:1:37: nested more than 32 deep.*)"},
        Case{"deep_tables",
             [] {
               std::string s;
               for (int i = 0; i < 100000; ++i) s += "a={";
               return s;
             }(),
             R"(scene.toml:1:[0-9]+: nested more than 32 deep.*)"},
        Case{"deep_dots",
             "[a" +
                 [] {
                   std::string s;
                   for (int i = 0; i < 100000; ++i) s += ".a";
                   return s;
                 }() +
                 "]",
             R"(scene.toml:1:[0-9]+: nested more than 32 deep.*)"}));

TEST(Document, DotsAndBracketsInTextsAndCommentsAreNoNesting) {
  const std::string many = std::string(100, '[') + std::string(100, '.');
  check_text_limits("f", "# " + many + "\na = \"" + many + "\\\"" + many + "\"\nb = '" + many + "'\nc = \"\"\"" + many +
                             "\n\"" + many + "\"\"\"\nd = '''" + many + "\n'''\n");
}

TEST(Document, ManyShortNestingsAreNotDeep) {
  std::string text = "x = [";
  for (int i = 0; i < 1000; ++i) text += "[0.5, 1.5],";
  check_text_limits("f", text + "]\n");
}

TEST(Document, AcceptsAByteOrderMarkAndWindowsLineEnds) {
  std::string text = "\xEF\xBB\xBF";
  for (const char c : kMinimal) {
    if (c == '\n') text += '\r';
    text += c;
  }
  EXPECT_EQ(error_of(text), "");
}

TEST(Document, RefusesFilesThatAreTooLarge) {
  const std::filesystem::path path = testing::TempDir() + "/firn_large_scene.toml";
  std::ofstream(path) << std::string(kMaxSceneBytes + 1, '#');
  try {
    read_scene_text(path);
    ADD_FAILURE() << "read more than the limit";
  } catch (const Error& error) {
    EXPECT_TRUE(contains(error.what(), "at most 16 MiB"));
  }
  std::filesystem::resize_file(path, kMaxSceneBytes);
  EXPECT_EQ(read_scene_text(path).size(), kMaxSceneBytes);
  std::filesystem::remove(path);
}

TEST(Document, ReadsPathsWithUnusualCharacters) {
  const std::filesystem::path folder = testing::TempDir() + "/firn scene \"quoted\" äöü 雪";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "scene 1.toml") << kMinimal;
  const Scene scene = load_scene(folder / "scene 1.toml");
  EXPECT_EQ(scene.output.folder, "out/scene 1");
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace firn::test
