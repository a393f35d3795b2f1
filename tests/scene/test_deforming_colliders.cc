// Sequences of meshes and level sets as scenes say them.

#include <firn/core/log.h>
#include <firn/scene/build_world.h>
#include <firn/scene/collider_shape.h>
#include <firn/scene/resolved.h>

#include <fstream>

#include "scene/scene_text.h"
#include "support/belt.h"
#include "support/temporary_folder.h"

namespace firn::test {
namespace {

class DeformingColliders : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_ / "belt");
    for (int k = 0; k < 3; ++k) write_obj(belt_mesh(k), folder_ / ("belt/belt_000" + std::to_string(k) + ".obj"));
    write_obj(belt_mesh(0, 48), folder_ / "belt/coarse.obj");
  }

  Scene scene(const std::string& collider) const {
    return parse_scene(kMinimal + "[[collider]]\nname = \"belt\"\n" + collider, folder_ / "scene.toml");
  }
  std::string error(const std::string& collider, ErrorKind* kind = nullptr) const {
    try {
      const Scene read = scene(collider);
      make_collider<3>(read, read.colliders[0], 0.1);
    } catch (const Error& error) {
      if (kind) *kind = error.kind();
      std::string text = error.what();
      // Where the folder is differs from run to run.
      for (const std::string path = folder_.path().string() + "/"; text.find(path) != text.npos;) {
        text.replace(text.find(path), path.size(), "");
      }
      return text;
    }
    return "";
  }
  template <class Body>
  static std::vector<std::string> warnings_of(const Body& body) {
    std::vector<std::string> warnings;
    const auto old = set_log_sink([&](LogLevel, std::string_view text) { warnings.emplace_back(text); });
    body();
    set_log_sink(old);
    return warnings;
  }

  TemporaryFolder folder_;
};

const std::string kBelt = "shape = \"mesh_sequence\"\nmeshes = \"belt/belt_####.obj\"\n";

TEST_F(DeformingColliders, APatternAndAListGiveTheSameBelt) {
  const Scene pattern = scene(kBelt + "fps = 2\n");
  const Scene list = scene(
      "shape = \"mesh_sequence\"\nmeshes = [\"belt/belt_0000.obj\", \"belt/belt_0001.obj\", \"belt/belt_0002.obj\"]\n"
      "times = [0, 0.5, 1]\n");
  const Vec3d x = {{0.1, -0.01, 0}};
  for (const Scene& read : {pattern, list}) {
    const Collider<3> belt = make_collider<3>(read, read.colliders[0], 0.1);
    ASSERT_TRUE(belt.deforming);
    const PosedCollider<3> posed(belt, 0.7);
    EXPECT_NEAR(posed.distance(x), -0.01, 1e-12);
    EXPECT_NEAR(posed.velocity(x)[0], 2 * belt_link(), 1e-12);
    EXPECT_NEAR(posed.velocity(x)[1], 0, 1e-12);
    EXPECT_EQ(norm(PosedCollider<3>(belt, 1.1).velocity(x)), 0);
  }
}

TEST_F(DeformingColliders, PlaceScaleAndMotionOfTheFrameAreAdded) {
  const Scene read = scene(kBelt +
                           "fps = 2\nscale = 2\nposition = [0, 3, 0]\nrotation = [0, 90, 0]\nvelocity = [0, 1, 0]\n"
                           "at_end = \"cycle\"\n");
  const Collider<3> belt = make_collider<3>(read, read.colliders[0], 0.1);
  const PosedCollider<3> posed(belt, 10.2);
  const Vec3d x = {{0, 3 + 10.2 - 0.02, 0.2}};
  EXPECT_NEAR(posed.distance(x), -0.02, 1e-12);
  EXPECT_NEAR(posed.velocity(x)[1], 1, 1e-12);
  EXPECT_NEAR(posed.velocity(x)[2], -4 * belt_link(), 1e-12);
}

TEST_F(DeformingColliders, InvertedIsOutside) {
  const Scene read = scene(kBelt + "fps = 2\ninverted = true\n");
  const Collider<3> belt = make_collider<3>(read, read.colliders[0], 0.1);
  EXPECT_GT(PosedCollider<3>(belt, 0).distance({{0, -0.1, 0}}), 0);
  EXPECT_LT(PosedCollider<3>(belt, 0).distance({{0, 5, 0}}), 0);
}

TEST_F(DeformingColliders, ResolveToTheSameScene) {
  const Scene read = scene(kBelt + "times = [0, 0.5, 1]\nat_end = \"cycle\"\n");
  const std::string text = resolved_toml(read, folder_ / "elsewhere");
  EXPECT_TRUE(contains(text, "meshes = [\"../belt/belt_####.obj\"]\n"));
  EXPECT_TRUE(contains(text, "times = [0, 0.5, 1]\n"));
  std::filesystem::create_directories(folder_ / "elsewhere");
  const Scene again = parse_scene(text, folder_ / "elsewhere/scene.toml");
  EXPECT_EQ(again.colliders[0].times, read.colliders[0].times);
  EXPECT_EQ(resolved_toml(again, folder_ / "elsewhere"), text);
}

TEST_F(DeformingColliders, SayWhatIsWrong) {
  const auto expect = [&](const std::string& collider, const std::string& pattern) {
    EXPECT_TRUE(matches(error(collider), pattern));
  };
  expect(kBelt, R"(scene.toml:11:9: collider "belt": a sequence needs one of fps and times, got none)");
  expect(kBelt + "fps = 1\ntimes = [0, 1, 2]",
         R"(scene.toml:14:9: collider "belt": a sequence needs one of fps and times, got both)");
  expect(kBelt + "times = [0, 1]", R"(scene.toml:13:9: collider "belt": times has 2 numbers for 3 files of meshes)");
  expect(kBelt + "times = [0, 2, 2]", R"(scene.toml:13:9: .*: times must increase, got 2 s after 2 s)");
  expect(kBelt + "times = 3", R"(scene.toml:13:9: collider "belt": times must be a list of numbers, got .*)");
  expect(kBelt + "fps = 0", R"(scene.toml:13:7: collider "belt": fps must be > 0 1/s, got 0)");
  expect("shape = \"mesh_sequence\"\nfps = 1", R"(scene.toml:9:1: required and not given: collider "?belt"?: meshes)");
  expect("shape = \"mesh_sequence\"\nmeshes = []\nfps = 1",
         R"(scene.toml:12:10: collider "belt": meshes: must name at least one file)");
  expect("shape = \"mesh_sequence\"\nmeshes = 4\nfps = 1",
         R"(scene.toml:12:10: collider "belt": meshes must be a text in quotes or a list of them, got .*)");
  expect("shape = \"mesh_sequence\"\nmeshes = \"belt/band_##.obj\"\nfps = 1",
         R"(scene.toml:12:10: collider "belt": meshes: belt/band_##.obj: no file has such a name, .*)");
  expect("shape = \"mesh_sequence\"\nmeshes = \"belt/coarse.obj\"\nfps = 1\nat_end = \"cycle\"",
         R"(scene.toml:14:10: .*: a cycle needs at least 2 entries, meshes has 1)");
  expect("shape = \"mesh\"\nfile = \"belt/coarse.obj\"\nfps = 1",
         R"(scene.toml:13:7: collider .*: fps applies only with shape = "mesh_sequence", "level_set_sequence")");
  expect("shape = \"mesh_sequence\"\nmeshes = [\"belt/belt_0000.obj\", \"belt/coarse.obj\"]\nfps = 1",
         R"re(collider "belt": belt/coarse.obj: has 98 vertices and 192 triangles, but belt/belt_0000.obj has )re"
         "194 vertices and 384 triangles; all meshes of a sequence need the same vertices and triangles in the same "
         "order");

  std::filesystem::remove(folder_ / "belt/belt_0001.obj");
  ErrorKind kind = ErrorKind::usage;
  EXPECT_TRUE(matches(error(kBelt + "fps = 1", &kind),
                      R"(scene.toml:12:10: .*: number 1 is missing between belt_0000.obj and belt_0002.obj; .*)"));
  EXPECT_EQ(kind, ErrorKind::files);

  std::ofstream(folder_ / "none.vdb") << "none";
  const std::string level_set = "shape = \"level_set_sequence\"\nlevel_sets = \"none.vdb\"\nfps = 1\n";
  expect(level_set, R"(collider "belt": none.vdb: cannot be read as an OpenVDB file: .*)");
  expect(level_set + "interpolation = \"smooth\"", R"(scene.toml:14:17: .*: level sets are interpolated linearly, .*)");
}

TEST_F(DeformingColliders, AreNoPartsAndNeedThreeDimensions) {
  EXPECT_TRUE(matches(error_of(kMinimal + "[[part]]\nname = \"a\"\nshape = \"mesh_sequence\""),
                      R"(scene.toml:11:9: part "a": a sequence cannot be a part of other shapes; .*)"));
  EXPECT_TRUE(matches(error_of(of_2d(kMinimal + "[[collider]]\n" + kBelt + "fps = 1")),
                      R"(scene.toml:11:9: collider .*: this shape needs a 3D scene; .*)"));
}

TEST_F(DeformingColliders, ACycleThatDoesNotCloseIsNamed) {
  TriangleMesh moved = belt_mesh(0);
  for (Vec3d& x : moved.vertices) x[1] += 0.25;
  write_obj(moved, folder_ / "moved.obj");
  const std::string meshes = "shape = \"mesh_sequence\"\nmeshes = [\"belt/belt_0000.obj\", \"moved.obj\"]\nfps = 1\n";
  const auto warnings = [&](const std::string& text) {
    return warnings_of([&] {
      const Scene read = scene(text);
      make_collider<3>(read, read.colliders[0], 0.1);
    });
  };
  const auto open = warnings(meshes + "at_end = \"cycle\"\n");
  ASSERT_EQ(open.size(), 1U);
  EXPECT_TRUE(contains(open[0],
                       "collider \"belt\": the last mesh of the cycle, moved.obj, is up to 0.25 m away from the "
                       "first, belt_0000.obj: the surface jumps"));
  EXPECT_TRUE(warnings(meshes).empty());
}

TEST_F(DeformingColliders, AWallThatGetsThinIsNamed) {
  TriangleMesh thick = belt_mesh(0), thin = thick;
  for (Vec3d& x : thin.vertices) x[1] *= 0.4;
  write_obj(thick, folder_ / "wall_1.obj");
  write_obj(thin, folder_ / "wall_2.obj");
  const auto warnings = [&](const std::string& files) {
    return warnings_of([&] {
      const Scene read = scene("shape = \"mesh_sequence\"\nmeshes = " + files + "\nfps = 1\n");
      plan_world(read);
    });
  };
  // 0.3 m are three cells, 0.12 m are not two.
  EXPECT_TRUE(warnings("[\"wall_1.obj\", \"wall_1.obj\"]").empty());
  const auto found = warnings("\"wall_#.obj\"");
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(matches(found[0], R"(collider "belt" is about 0\.1[0-2]\d* m thick, 1\.\d cells: .*)")) << found[0];
}

}  // namespace
}  // namespace firn::test
