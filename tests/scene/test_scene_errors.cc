#include "scene/scene_text.h"

#include <firn/core/log.h>

namespace firn::test {
namespace {

struct Case {
  const char* name;
  std::string text;
  const char* message;  ///< extended regular expression for the whole message
};

void PrintTo(const Case& c, std::ostream* os) { *os << c.name; }

class SceneError : public testing::TestWithParam<Case> {};

TEST_P(SceneError, SaysWhereWhatAndWhatToDo) {
  ErrorKind kind = ErrorKind::resources;
  const std::string message = error_of(GetParam().text, {}, &kind);
  EXPECT_TRUE(matches(message, GetParam().message));
  EXPECT_EQ(message.find('\n'), std::string::npos);
  EXPECT_EQ(kind, ErrorKind::usage);
}

const std::string kSnowHead =
    "end_time = 1\nresolution.cell_size = 0.1\n[[body]]\nshape = \"sphere\"\nradius = 0.5\n"
    "material = \"snow\"\n[material.snow]\nmodel = \"snow\"\n";  // 8 lines

INSTANTIATE_TEST_SUITE_P(
    Text, SceneError,
    testing::Values(Case{"unknown_key", kSnowHead + "  densty = 3",
                         R"(scene.toml:9:3: unknown key "densty"; did you mean "density"\?)"},
                    Case{"unknown_key_at_root", with_root("colider = 3"),
                         R"(scene.toml:1:1: unknown key "colider"; did you mean "collider"\?)"},
                    Case{"unknown_section", kMinimal + "[limit]\nspeed = 1",
                         R"(scene.toml:9:2: unknown key "limit"; did you mean "limits"\?)"},
                    Case{"key_of_another_section", with_root("particles = 5"),
                         R"(scene.toml:1:1: unknown key "particles"; did you mean resolution.particles\?)"},
                    Case{"nothing_near", kMinimal + "[output]\nzzz = 1",
                         R"(scene.toml:10:1: unknown key "zzz"; known: "folder")"},
                    Case{"wrong_type", kSnowHead + "density = \"abc\"",
                         R"(scene.toml:9:11: material "snow": density must be a number, got the text "abc")"},
                    Case{"bool_for_number", with_root("frame_rate = true"),
                         R"(scene.toml:1:14: frame_rate must be a number, got true)"},
                    Case{"date_for_number", with_root("frame_rate = 2020-01-01"),
                         R"(scene.toml:1:14: frame_rate must be a number, got a date or time)"},
                    Case{"number_for_bool", with_root("strict_mesh = 1"),
                         R"(scene.toml:1:15: strict_mesh must be true or false, got 1)"},
                    Case{"fraction_for_integer", with_root("seed = 1.5"),
                         R"(scene.toml:1:8: seed must be a whole number, got 1.5)"},
                    Case{"list_length", with_root("gravity = [0, -1]"),
                         R"(scene.toml:1:11: gravity must be a list of 3 numbers, got a list of 2 values)"},
                    Case{"table_for_list", kMinimal + "[collider]\nradius = 1",
                         R"(scene.toml:9:2: collider must be written as \[\[collider\]\], once for each collider)"},
                    Case{"value_for_section", with_root("limits = 3"),
                         R"(scene.toml:1:1: limits must be a section \[limits\], got 3)"},
                    Case{"value_for_material", with_root("material.sand = 3"),
                         R"(scene.toml:1:10: "sand" in \[material\] must be a section \[material.sand\], got 3)"}));

INSTANTIATE_TEST_SUITE_P(
    Ranges, SceneError,
    testing::Values(
        Case{"density", kSnowHead + "density = -400",
             R"(scene.toml:9:11: material "snow": density must be (> 0|in \(0, .*\]) kg/m\^3, got -400.*)"},
        Case{"density_zero", kSnowHead + "density = 0",
             R"(scene.toml:9:11: material "snow": density must be .*, got 0;.*)"},
        Case{"poisson_ratio", kSnowHead + "poisson_ratio = 0.5",
             R"(scene.toml:9:17: material "snow": poisson_ratio must be in \(-1, 0.5\), got 0.5; .*fluid.*)"},
        Case{"stiffness", kSnowHead + "youngs_modulus = 1e30",
             R"(scene.toml:9:18: material "snow": youngs_modulus must be .* Pa, got 1e\+30.*)"},
        Case{"nan", kSnowHead + "density = nan", R"(scene.toml:9:11: material "snow": density must be .*, got nan.*)"},
        Case{"infinite_vector", with_root("gravity = [0, -inf, 0]"),
             R"(scene.toml:1:11: gravity must be a finite number, got -inf)"},
        Case{"dimension", with_root("dimension = 4"), R"(scene.toml:1:13: dimension must be in \[2, 3\], got 4)"},
        Case{"end_time", "end_time = -1\n" + kMinimal.substr(kMinimal.find('\n')),
             R"(scene.toml:1:12: end_time must be > 0 s, got -1)"},
        Case{"frame_rate", with_root("frame_rate = 0"),
             R"(scene.toml:1:14: frame_rate must be in \(0, 1e6\] 1/s, got 0)"},
        Case{"max_dt", with_root("limits.max_dt = 0"), R"(scene.toml:1:17: limits: max_dt must be > 0 s, got 0)"},
        Case{"particles", "resolution.particles = 0\n" + kMinimal.substr(kMinimal.find("[mat")),
             R"(scene.toml:1:24: resolution: particles must be >= 1, got 0)"},
        Case{"friction", kMinimal + "[[collider]]\nshape = \"sphere\"\nradius = 1\nfriction = -0.1",
             R"(scene.toml:12:12: collider "0": friction must be >= 0, got -0.1)"},
        Case{"flip_blend", with_root("method = {transfer = \"pic_flip\", flip_blend = 1.5}"),
             R"(scene.toml:1:47: method: flip_blend must be in \[0, 1\], got 1.5)"},
        Case{"box_order", with_root("limits.box = [[0, 0, 0], [1, 0, 1]]"),
             R"(scene.toml:1:14: limits: box must have its lowest corner first; on axis y got 0 and 0)"},
        Case{"range_order", with_root("render.range = [2, 1]"),
             R"(scene.toml:1:16: render: range must have its lower value first, got 2 and 1)"}));

INSTANTIATE_TEST_SUITE_P(
    Names, SceneError,
    testing::Values(
        Case{
            "choice", kMinimal + "[[collider]]\nshape = \"half_space\"\ncontact = \"stikcy\"",
            R"(scene.toml:11:11: collider "0": contact must be one of "sticky", "slip", "separate", got "stikcy"; did you mean "sticky"\?)"},
        Case{"preset", with_root("material.a.preset = \"snwo\""),
             R"(scene.toml:1:21: material "a": preset must be one of .*, got "snwo"; did you mean "snow"\?)"},
        Case{"material", kMinimal.substr(0, kMinimal.rfind("\"snow\"")) + "\"snwo\"",
             R"(scene.toml:8:12: body "body0": no \[material.snwo\]; did you mean "snow"\?)"},
        Case{"same_name_twice",
             kMinimal + "[[body]]\nname = \"body0\"\nshape = \"sphere\"\nradius = 1\nmaterial = \"snow\"",
             R"(scene.toml:10:8: body "body0": an earlier body has the same name; names must differ)"}));

INSTANTIATE_TEST_SUITE_P(
    Missing, SceneError,
    testing::Values(
        Case{
            "empty", "",
            R"(scene.toml:1:1: required and not given: end_time; resolution: cell_size or particles; a \[\[body\]\] or \[\[emitter\]\])"},
        Case{"only_comments", "# nothing\n", R"(scene.toml:1:1: required and not given: end_time; .*)"},
        Case{
            "all_at_once", "[[body]]\n[material.goo]\n[[collider]]\n",
            R"(scene.toml:1:1: required and not given: end_time; resolution: cell_size or particles; material "goo": preset or model; body "0": material, mesh or polygon or shape; collider "0": shape)"},
        Case{"size_of_box", with_root("") + "[[collider]]\nshape = \"box\"",
             R"(scene.toml:10:1: required and not given: collider "0": size)"}));

INSTANTIATE_TEST_SUITE_P(
    Combinations, SceneError,
    testing::Values(
        Case{
            "two_resolutions", with_root("resolution.particles = 100"),
            R"(scene.toml:1:1: resolution: cell_size \(scene.toml:3:12\) and particles \(scene.toml:1:12\) exclude each other; keep one)"},
        Case{"unused_parameter", kSnowHead + "[material.rubber]\nmodel = \"neo_hookean\"\nhardening = 3",
             R"(scene.toml:11:13: material "rubber": hardening applies only with model = "snow")"},
        Case{"unused_size", kMinimal + "size = [1, 1, 1]",
             R"(scene.toml:9:8: body "0": size applies only with shape = "box")"},
        Case{"unused_blend", with_root("method.flip_blend = 0.5"),
             R"(scene.toml:1:21: method: flip_blend applies only with transfer = "pic_flip")"},
        Case{"preset_of_another_model", kMinimal + "[material.x]\npreset = \"jelly\"\nmodel = \"snow\"",
             R"(scene.toml:11:9: material "x": preset "jelly" has the model "fixed_corotated", got "snow"; .*)"},
        Case{"mls_linear", with_root("method.kernel = \"linear\""),
             R"(scene.toml:1:17: method: kernel "linear" does not work with form "mls".*form = "gradient".*)"},
        Case{"period", with_root("method.periodic = [0.85, 0, 0]"),
             R"(scene.toml:1:19: method: periodic must be a multiple of 4 cells, 0.4 m, on each axis, got 0.85)"},
        Case{"sphere_in_2d", "dimension = 2\n" + kMinimal,
             R"(scene.toml:7:9: body "body0": shape "sphere" needs a 3D scene; in 2D use "disk")"},
        Case{"up_in_2d", "dimension = 2\nup = \"z\"\n" + kMinimal, R"(scene.toml:2:6: up must be "y" in a 2D scene)"},
        Case{"zero_normal", kMinimal + "[[collider]]\nshape = \"half_space\"\nnormal = [0, 0, 0]",
             R"(scene.toml:11:10: collider "collider0": normal must not be zero)"},
        Case{"camera_inside_target", kMinimal + "[camera]\nposition = [1, 1, 1]\ntarget = [1, 1, 1]",
             R"(scene.toml:11:10: camera: target must differ from position)"}));

TEST(SceneErrors, TheMinimalSceneHasNone) { EXPECT_EQ(error_of(kMinimal), ""); }

TEST(SceneErrors, MissingMeshNamesTheKeyAndWhereItLooked) {
  const std::string text = kMinimal + "[[body]]\nmesh = \"no/such.obj\"\nmaterial = \"snow\"\n";
  ErrorKind kind = ErrorKind::usage;
  const std::string message = error_of(text, {}, &kind);
  EXPECT_TRUE(matches(
      message, R"(scene.toml:10:8: body "body1": mesh "no/such.obj" is not a file \(looked for /.*no/such.obj\).*)"));
  EXPECT_EQ(kind, ErrorKind::files);
}

TEST(SceneErrors, MissingFileIsNamedAsGivenAndResolved) {
  try {
    load_scene("no_such_scene.toml");
    FAIL() << "read a file that does not exist";
  } catch (const Error& error) {
    EXPECT_TRUE(matches(error.what(),
                        R"(no_such_scene.toml \(/.*no_such_scene.toml\): cannot read the scene: No such file.*)"));
    EXPECT_EQ(error.exit_code(), 3);
  }
}

TEST(SceneErrors, FolderIsRefused) {
  try {
    load_scene("/");
    FAIL() << "read a folder";
  } catch (const Error& error) {
    EXPECT_TRUE(contains(error.what(), "is a folder"));
    EXPECT_EQ(error.exit_code(), 3);
  }
}

TEST(SceneErrors, HugeGravityIsWarnedAbout) {
  std::string lines;
  const LogSink before = set_log_sink([&](LogLevel, const std::string& line) { lines += line; });
  parse(with_root("gravity = [0, -9810, 0]"));
  set_log_sink(before);
  EXPECT_TRUE(contains(lines, "scene.toml: gravity is 9810 m/s^2, 1000 times the Earth's; lengths are in metres"));
}

TEST(SceneErrors, NamesMayHoldAnyCharacters) {
  const std::string text =
      "end_time = 1\nresolution.cell_size = 0.1\n[material.\"Schnee \u2603 \\\"neu\\\"\"]\npreset = \"snow\"\n"
      "[[body]]\nname = \"Würfel\\n\"\nshape = \"sphere\"\nradius = 0.5\nmaterial = \"Schnee \u2603 \\\"neu\\\"\"\n";
  const Scene scene = parse(text);
  EXPECT_EQ(scene.materials[0].name, "Schnee \u2603 \"neu\"");
  EXPECT_EQ(error_of(text, {"body.0.radius=-1"}).find('\n'), std::string::npos);
}

}  // namespace
}  // namespace firn::test
