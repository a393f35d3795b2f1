// Shapes and motions of colliders as scenes say them.

#include <firn/core/log.h>
#include <firn/scene/build_world.h>
#include <firn/scene/collider_shape.h>
#include <firn/scene/resolved.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numbers>

#include "scene/scene_text.h"
#include "support/temporary_folder.h"

namespace firn::test {
namespace {

ShapePointer<3> shape_of(const Scene& scene, std::size_t collider = 0) {
  return collider_shape<3>(scene, scene.colliders[collider], 0.05);
}

TEST(SceneColliders, MakeEveryShape) {
  struct Case {
    const char* text;
    Vec3d inside, outside;
  };
  const Case cases[] = {
      {"shape = \"rounded_box\"\nsize = [2, 1, 2]\nradius = 0.1", {{0.95, 0, 0}}, {{0.99, 0.49, 0.99}}},
      {"shape = \"capsule\"\nradius = 0.2\nlength = 2\naxis = [1, 0, 0]", {{0.9, 0, 0}}, {{0, 0.9, 0}}},
      {"shape = \"cylinder\"\nradius = 0.2\nlength = 2", {{0, 0.9, 0}}, {{0.9, 0, 0}}},
      {"shape = \"cone\"\nradius = 1\nlength = 2", {{0.9, -0.95, 0}}, {{0.9, 0.9, 0}}},
      {"shape = \"cone\"\nradius = 1\nlength = 2\naxis = [0, -1, 0]", {{0.9, 0.95, 0}}, {{0.9, -0.9, 0}}},
      {"shape = \"torus\"\nradius = 1\ntube_radius = 0.2\naxis = [0, 0, 1]", {{0, 1, 0}}, {{0, 0, 1}}},
      {"shape = \"sphere\"\nradius = 1\ninverted = true", {{0, 2, 0}}, {{0, 0.5, 0}}},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.text);
    const Scene scene = parse(kMinimal + "[[collider]]\n" + c.text);
    EXPECT_LT(shape_of(scene)->distance(c.inside), 0);
    EXPECT_GT(shape_of(scene)->distance(c.outside), 0);
  }
}

const std::string kCup = R"(
[[part]]
name = "outer"
shape = "cylinder"
radius = 1
length = 2
[[part]]
name = "inner"
shape = "cylinder"
radius = 0.8
length = 2
position = [0, 0.2, 0]
[[collider]]
shape = "difference"
parts = ["outer", "inner"]
)";

TEST(SceneColliders, ACupIsADifferenceOfParts) {
  const Scene scene = parse(kMinimal + kCup);
  const auto cup = shape_of(scene);
  EXPECT_LT(cup->distance({{0.9, 0, 0}}), 0);
  EXPECT_GT(cup->distance({{0, 0, 0}}), 0);
  EXPECT_GT(cup->distance({{0, 0.95, 0}}), 0);
  EXPECT_LT(cup->distance({{0, -0.9, 0}}), 0);
}

TEST(SceneColliders, AHeightFieldHasTheHeightsOfItsFile) {
  const TemporaryFolder folder;
  setenv("XDG_CACHE_HOME", (folder.path() / "cache").c_str(), 1);
  std::ofstream(folder.path() / "heights.csv") << "0,0,0\n0,1,0\n0,0,0\n";
  const std::string text = kMinimal +
                           "[[collider]]\nshape = \"height_field\"\nfile = \"heights.csv\"\n"
                           "size = [4, 0.5, 4]\ndepth = 0.5\n";
  for (const bool again : {false, true}) {
    const Scene scene = parse_scene(text, folder.path() / "scene.toml");
    const auto field = shape_of(scene);
    // The middle is a peak of 0.5 m, the border lies at 0.
    EXPECT_LT(field->distance({{0, 0.4, 0}}), 0) << again;
    EXPECT_GT(field->distance({{0, 0.56, 0}}), 0) << again;
    EXPECT_GT(field->distance({{1.5, 0.3, 1.5}}), 0) << again;
    EXPECT_LT(field->distance({{1.5, -0.1, 1.5}}), 0) << again;
  }
  std::size_t kept = 0;
  for (const auto& file : std::filesystem::directory_iterator(folder.path() / "cache" / "firn")) {
    kept += file.path().extension() == ".levelset" ? 1 : 0;
  }
  EXPECT_EQ(kept, 1U);
  unsetenv("XDG_CACHE_HOME");
}

TEST(SceneColliders, MoveThroughKeyframes) {
  const Scene scene = parse(kMinimal + R"(
[[collider]]
shape = "box"
size = [1, 1, 1]
position = [0, 1, 0]
interpolation = "linear"
keyframes = [{ time = 0 }, { time = 2, position = [4, 1, 0], rotation = [0, 90, 0], scale = 3 }]
)");
  Collider<3> collider;
  set_motion<3>(scene, scene.colliders[0], collider);
  const Pose<3> pose = collider.pose_at(1);
  EXPECT_NEAR(pose.origin[0], 2, 1e-14);
  EXPECT_NEAR(pose.origin[1], 1, 1e-14);
  EXPECT_NEAR(pose.scale, 2, 1e-14);
  EXPECT_NEAR(pose.angular_velocity[1], std::numbers::pi / 4, 1e-14);
  // What a resolved scene says is the same motion.
  EXPECT_TRUE(
      contains(resolved_toml(scene, {}), "{ time = 0, position = [0, 1, 0], rotation = [0, 0, 0], scale = 1 }"));
  EXPECT_EQ(resolved_toml(parse(resolved_toml(scene, {})), {}), resolved_toml(scene, {}));
}

TEST(SceneColliders, FollowATrajectory) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "path.csv") << "t, x, y, z\n0, 0, 0, 0\n1, 2, 0, 0\n\n3, 2, 4, 0  # end\n";
  const Scene scene =
      parse_scene(kMinimal + "[[collider]]\nshape = \"sphere\"\nradius = 0.3\ntrajectory = \"path.csv\"\n",
                  folder.path() / "s.toml");
  Collider<3> collider;
  set_motion<3>(scene, scene.colliders[0], collider);
  EXPECT_NEAR(collider.pose_at(0.5).origin[0], 1, 1e-14);
  EXPECT_NEAR(collider.pose_at(2).origin[1], 2, 1e-14);
  EXPECT_NEAR(collider.pose_at(2).velocity[1], 2, 1e-14);

  std::ofstream(folder.path() / "path.csv") << "0 0 0\n1 1\n";
  try {
    set_motion<3>(scene, scene.colliders[0], collider);
    FAIL();
  } catch (const Error& error) {
    EXPECT_TRUE(contains(error.what(), "path.csv:2: 2 numbers instead of 3; every row must have as many as the first"));
  }
}

TEST(SceneColliders, ThinOnesAreNamedWithTheCellSizeThatHolds) {
  std::vector<std::string> warnings;
  const auto old = set_log_sink([&](LogLevel, std::string_view text) { warnings.emplace_back(text); });
  plan_world(parse(kMinimal + "[[collider]]\nname = \"plate\"\nshape = \"box\"\nsize = [2, 0.1, 2]\n"));
  set_log_sink(old);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(matches(warnings[0],
                      R"(collider "plate" is about 0\.1\d* m thick, 1\.?\d* cells: .*; make it two cells thick, or )"
                      R"(cells at most 0\.05\d* m)"))
      << warnings[0];
  // Twice as thick is enough.
  warnings.clear();
  const auto again = set_log_sink([&](LogLevel, std::string_view text) { warnings.emplace_back(text); });
  plan_world(parse(kMinimal + "[[collider]]\nname = \"plate\"\nshape = \"box\"\nsize = [2, 0.2, 2]\n"));
  set_log_sink(again);
  EXPECT_TRUE(warnings.empty());
}

TEST(SceneColliders, KnowHowThinTheyAre) {
  const auto thickness = [](const std::string& text) {
    const Scene scene = parse(kMinimal + "[[collider]]\n" + text);
    return make_collider<3>(scene, scene.colliders[0], 0.1).thickness;
  };
  EXPECT_NEAR(thickness("shape = \"box\"\nsize = [2, 0.1, 2]\n"), 0.1, 0.01);
  EXPECT_NEAR(thickness("shape = \"box\"\nsize = [2, 0.1, 2]\nkeyframes = [{ time = 0, scale = 2 }, { time = 1, "
                        "scale = 0.5 }]\n"),
              0.05, 0.005);
  EXPECT_TRUE(std::isinf(thickness("shape = \"half_space\"\n")));
}

struct Case {
  const char* name;
  std::string text;
  const char* message;
};

void PrintTo(const Case& c, std::ostream* os) { *os << c.name; }

class ColliderError : public testing::TestWithParam<Case> {};

TEST_P(ColliderError, SaysWhereWhatAndWhatToDo) { EXPECT_TRUE(matches(error_of(GetParam().text), GetParam().message)); }

std::string with_collider(const std::string& text) { return kMinimal + "[[collider]]\n" + text; }  // from line 10

const std::string kBall = "shape = \"sphere\"\nradius = 1\n";

INSTANTIATE_TEST_SUITE_P(
    Text, ColliderError,
    testing::Values(
        Case{"missing", with_collider("shape = \"torus\"\nradius = 1"),
             R"(scene.toml:9:1: required and not given: collider "0": tube_radius)"},
        Case{"not_of_the_shape", with_collider(kBall + "length = 2"),
             R"(scene.toml:12:10: collider "0": length applies only with shape = "capsule", "cylinder", "cone")"},
        Case{"flat", of_2d(with_collider("shape = \"cylinder\"\nradius = 1\nlength = 1")),
             R"(scene.toml:11:9: collider .*: this shape needs a 3D scene; in 2D use box, .*)"},
        Case{"no_file", with_collider("shape = \"mesh\"\nfile = \"none.obj\""),
             R"(scene.toml:11:8: collider .*: file "none.obj" is not a file .*)"},
        Case{"no_part", with_collider("shape = \"union\"\nparts = [\"a\"]"),
             R"(scene.toml:11:9: collider .*: no \[\[part\]\] has the name "a")"},
        Case{"part_of_itself", kMinimal + "[[part]]\nname = \"a\"\nshape = \"union\"\nparts = [\"a\"]",
             R"(scene.toml:12:9: part "a": the \[\[part\]\] "a" must stand before what it is a part of)"},
        Case{"axis", with_collider("shape = \"capsule\"\nradius = 1\nlength = 3\naxis = [0, 0, 0]"),
             R"(scene.toml:13:8: collider .*: axis must not be zero)"},
        Case{"keyframe_key", with_collider(kBall + "keyframes = [{ time = 1, postion = [0, 0, 0] }]"),
             R"(scene.toml:12:13: collider "0": keyframes entry 1: unknown key "postion"; did you mean "position"\?)"},
        Case{"keyframe_time", with_collider(kBall + "keyframes = [{ scale = 1 }]"),
             R"(scene.toml:12:13: collider "0": keyframes entry 1: time is required)"},
        Case{"keyframe_value", with_collider(kBall + "keyframes = [{ time = 1, scale = 0 }]"),
             R"(scene.toml:12:13: collider "0": keyframes entry 1: scale must be > 0, got 0)"},
        Case{"keyframe_order", with_collider(kBall + "keyframes = [{ time = 1 }, { time = 1 }]"),
             R"(scene.toml:12:13: collider .*: keyframes: entry 2: times must increase, got 1 s after 1 s)"},
        Case{"keyframe_turn", with_collider(kBall + "keyframes = [{ time = 0 }, { time = 1, rotation = [0, 360, 0] }]"),
             R"(scene.toml:12:13: .*: entry 2: rotation changes by 360 degrees about y; the shortest way .*)"},
        Case{"two_motions", with_collider(kBall + "velocity = [1, 0, 0]\nkeyframes = [{ time = 0 }]"),
             R"(scene.toml:12:12: collider .*: velocity excludes keyframes and trajectory; keep one)"}));

TEST(SceneColliders, SizesThatMakeNoSolidNameTheCollider) {
  const Scene scene = parse(with_collider("name = \"pill\"\nshape = \"capsule\"\nradius = 1\nlength = 1"));
  try {
    shape_of(scene);
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "\"pill\": capsule: length must be at least twice the radius, got 1 with radius 1");
  }
}

}  // namespace
}  // namespace firn::test
