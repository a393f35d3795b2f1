#include <firn/apps/viewer/orbit_camera.h>
#include <firn/apps/viewer/point_thinning.h>
#include <firn/apps/viewer/simulation_player.h>
#include <firn/apps/viewer/view_controls.h>
#include <firn/scene/load_scene.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

namespace firn {
namespace {

using namespace std::chrono_literals;

/// Where a world point lands in the picture, in [-1, 1], and its depth.
std::array<double, 3> seen(const OrbitCamera& camera, const Vec3d& x, double aspect = 1, const Vec3d& origin = {}) {
  const Matrix4 m = product(camera.projection_matrix(aspect), camera.view_matrix(origin));
  double clip[4];
  const Vec3d local = x - origin;
  for (std::size_t i = 0; i < 4; ++i) {
    clip[i] = m[12 + i];
    for (std::size_t j = 0; j < 3; ++j) clip[i] += m[4 * j + i] * local[static_cast<int>(j)];
  }
  return {clip[0] / clip[3], clip[1] / clip[3], clip[2] / clip[3]};
}

OrbitCamera front_camera(int dimension = 3) {
  return OrbitCamera({{{0, 0, 5}}, {{0, 0, 0}}, {{0, 1, 0}}, 60}, {{0, 1, 0}}, dimension);
}

TEST(OrbitCamera, ProjectsAsAPinhole) {
  const OrbitCamera camera = front_camera();
  const double top = 5 * std::tan(std::numbers::pi / 6);
  EXPECT_NEAR(seen(camera, {{0, 0, 0}})[0], 0, 1e-6);
  EXPECT_NEAR(seen(camera, {{0, top, 0}})[1], 1, 1e-6);
  EXPECT_NEAR(seen(camera, {{2 * top, 0, 0}}, 2)[0], 1, 1e-6);
  EXPECT_LT(seen(camera, {{0, 0, 1}})[2], seen(camera, {{0, 0, 0}})[2]) << "what is nearer has less depth";
  EXPECT_NEAR(seen(camera, {{0, 0, 4.9}})[2], -1, 1e-5);
}

TEST(OrbitCamera, KeepsItsPrecisionFarFromTheOrigin) {
  const Vec3d far = {{1e7, -3e7, 2e7}};
  const OrbitCamera camera({far + Vec3d{{0, 0, 5}}, far, {{0, 1, 0}}, 60}, {{0, 1, 0}}, 3);
  const auto at = seen(camera, far + Vec3d{{0.5, 0.25, 0}}, 1, far);
  const auto near = seen(front_camera(), {{0.5, 0.25, 0}});
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(at[i], near[i], 1e-6);
}

TEST(OrbitCamera, OrbitsAboutTheUpAxisAndStopsShortOfThePole) {
  OrbitCamera camera = front_camera();
  camera.orbit(std::numbers::pi / 2, 0);
  EXPECT_NEAR(camera.camera().position[0], 5, 1e-12);
  EXPECT_NEAR(camera.camera().position[2], 0, 1e-12);
  camera.orbit(0, std::numbers::pi / 6);
  EXPECT_NEAR(camera.camera().position[1], 2.5, 1e-12);
  camera.orbit(0, 100);
  EXPECT_NEAR(camera.distance(), 5, 1e-12);
  EXPECT_GT(camera.camera().position[1], 4.99);
  const Matrix4 view = camera.view_matrix({});
  for (const float entry : view) EXPECT_TRUE(std::isfinite(entry));
  camera.orbit(0, -100);
  EXPECT_LT(camera.camera().position[1], -4.99);
}

TEST(OrbitCamera, PansThePointUnderTheMouse) {
  OrbitCamera camera = front_camera();
  camera.pan(0.25, 0.1);  // of the height, which is 2 in these units
  EXPECT_NEAR(seen(camera, {{0, 0, 0}})[0], 0.5, 1e-6);
  EXPECT_NEAR(seen(camera, {{0, 0, 0}})[1], 0.2, 1e-6);
  EXPECT_NEAR(camera.distance(), 5, 1e-12);
}

TEST(OrbitCamera, ZoomsTowardsTheTarget) {
  OrbitCamera camera = front_camera();
  const double before = seen(camera, {{0.1, 0, 0}})[0];
  camera.zoom(0.5);
  EXPECT_NEAR(camera.distance(), 2.5, 1e-12);
  EXPECT_NEAR(seen(camera, {{0.1, 0, 0}})[0], 2 * before, 1e-6);
}

TEST(OrbitCamera, In2DHasNoPerspectiveAndDoesNotTurn) {
  OrbitCamera camera = front_camera(2);
  const auto near = seen(camera, {{0.5, 0.5, 1}}), far = seen(camera, {{0.5, 0.5, -1}});
  EXPECT_NEAR(near[0], far[0], 1e-7);
  camera.orbit(1, 1);
  EXPECT_EQ(camera.camera().position[2], 5);
  // At the target's distance a picture shows as much as the one with perspective does.
  EXPECT_NEAR(seen(camera, {{0.5, 0, 0}})[0], seen(front_camera(), {{0.5, 0, 0}})[0], 1e-6);
}

TEST(OrbitCamera, FramesAllParticlesFromAnyDirection) {
  Snapshot snapshot;
  std::vector<float> positions;
  for (int i = 0; i < 1000; ++i) {
    for (const int n : {i % 10, i / 10 % 10, i / 100}) positions.push_back(20 + 0.1F * static_cast<float>(n));
  }
  snapshot.particle_spacing = 0.1;
  snapshot.materials = {{"stuff", "snow", "", 0, 1000}};
  snapshot.columns.push_back({"position", "m", "", 3, positions});
  for (const double angle : {0.0, 1.0, 2.5}) {
    OrbitCamera camera = front_camera();
    camera.orbit(angle, 0.4);
    camera.zoom(7);
    const Vec3d direction = normalized(camera.camera().position - camera.camera().target);
    camera.frame_all(snapshot, View());
    double largest = 0;
    for (std::size_t p = 0; p < 1000; ++p) {
      const auto at = seen(camera, snapshot.position(p));
      largest = std::max({largest, std::abs(at[0]), std::abs(at[1])});
    }
    EXPECT_LT(largest, 1);
    EXPECT_GT(largest, 0.5) << "they fill the picture";
    EXPECT_NEAR(dot(direction, normalized(camera.camera().position - camera.camera().target)), 1, 1e-12);
  }
}

TEST(Thinning, DrawsAllWithinTheBudgetAndKeepsTheVolumeBeyond) {
  EXPECT_EQ(thin(1000, 0, 3).every, 1U);
  EXPECT_EQ(thin(1000, 1000, 3).every, 1U);
  EXPECT_EQ(thin(1000, 1000, 3).radius, 1);
  for (const std::size_t count : {1001UL, 5000UL, 8000UL, 123456UL, 10000000UL}) {
    const Thinning all = thin(count, 1000, 3);
    EXPECT_LE(count / all.every, 1000U);
    EXPECT_GE(count / all.every, 300U);
    EXPECT_NEAR(std::pow(all.radius, 3), static_cast<double>(all.every), 1e-9 * static_cast<double>(all.every));
    EXPECT_NEAR(std::pow(thin(count, 1000, 2).radius, 2), static_cast<double>(all.every), 1e-6);
    for (std::size_t d = 2; d < all.every; ++d) ASSERT_NE(all.every % d, 0U) << "a common factor makes patterns";
  }
}

class Controls : public testing::Test {
 protected:
  const Scene scene_ = parse_scene(
      "dimension = 2\nend_time = 0.1\nframe_rate = 20\nresolution.particles = 300\n[material.stuff]\npreset = "
      "\"jelly\"\n"
      "[[body]]\nshape = \"disk\"\nradius = 0.2\nposition = [0, 0.3]\nmaterial = \"stuff\"\n"
      "[render]\ncolor_by = \"velocity\"\nrange = [0, 3]\n",
      "test.toml");
  SimulationPlayer player_{[this] { return Simulation::create(scene_); }};
  ViewControls controls_{scene_, player_};

  bool reaches(PlayState state) {
    return player_.wait([&](const SourceStatus& s) { return s.state == state && !s.busy; }, 60s);
  }
};

TEST_F(Controls, KeysCommandTheSource) {
  EXPECT_FALSE(controls_.key('x'));
  ASSERT_TRUE(reaches(PlayState::paused));
  EXPECT_TRUE(controls_.key('.'));
  ASSERT_TRUE(player_.wait([](const SourceStatus& s) { return s.frame.frame == 2; }, 60s));
  EXPECT_TRUE(controls_.key(' '));
  ASSERT_TRUE(reaches(PlayState::finished));
  EXPECT_TRUE(controls_.key('r'));
  EXPECT_TRUE(reaches(PlayState::paused));
  EXPECT_TRUE(controls_.key('f'));
}

TEST_F(Controls, ColoursAreTheScenesUntilOneChooses) {
  ASSERT_TRUE(reaches(PlayState::paused));
  EXPECT_TRUE(controls_.update());
  EXPECT_FALSE(controls_.update()) << "no second time for the same frame";
  EXPECT_EQ(controls_.view().color_by, "velocity");
  EXPECT_EQ((*controls_.view().color_range)[1], 3);
  const auto choices = controls_.choices();
  EXPECT_EQ(choices.front(), "");
  EXPECT_NE(std::find(choices.begin(), choices.end(), "pressure"), choices.end());
  EXPECT_EQ(std::find(choices.begin(), choices.end(), "position"), choices.end());
  controls_.color_by = "no such column";
  EXPECT_EQ(controls_.view().color_by, "");
}

TEST_F(Controls, TheCameraMovesForAQuarterOfASecond) {
  EXPECT_FALSE(controls_.moving(1));
  controls_.scroll(1);
  EXPECT_TRUE(controls_.moving(2));
  EXPECT_TRUE(controls_.moving(2.2));
  EXPECT_FALSE(controls_.moving(2.3));
  controls_.drag(ViewControls::Drag::orbit, 0.1, 0);
  EXPECT_TRUE(controls_.moving(3));
}

}  // namespace
}  // namespace firn
