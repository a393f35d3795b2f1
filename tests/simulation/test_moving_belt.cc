// A belt that slides in its own plane takes along what lies on it.

#include <firn/core/error.h>
#include <firn/scene/load_scene.h>
#include <firn/simulation/simulation.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/belt.h"
#include "support/temporary_folder.h"

namespace firn {
namespace {

constexpr double kSpeed = 0.5;

/// A block of jelly on the belt.
std::string belt_scene(const std::string& collider, double seconds = 0.4) {
  return "end_time = " + std::to_string(seconds) +
         "\nframe_rate = 100\nresolution.cell_size = 0.05\n[material.jelly]\npreset = \"jelly\"\n"
         "[[body]]\nname = \"block\"\nshape = \"box\"\nfill = \"lattice\"\nsize = [0.2, 0.1, 0.2]\n"
         "position = [-0.4, 0.05, 0]\nmaterial = \"jelly\"\n"
         "[[collider]]\nname = \"belt\"\n" +
         collider;
}

class Belt : public testing::Test {
 protected:
  void SetUp() override {
    for (int k = 0; k < 2; ++k) test::write_obj(test::belt_mesh(k), folder_ / ("belt_" + std::to_string(k) + ".obj"));
    sequence_ = "shape = \"mesh_sequence\"\nmeshes = \"belt_#.obj\"\nat_end = \"cycle\"\nfps = " +
                std::to_string(kSpeed / test::belt_link()) + "\n";
  }

  std::unique_ptr<Simulation> make(const std::string& collider, const std::string& root = "") const {
    return Simulation::create(parse_scene(root + belt_scene(collider), folder_ / "scene.toml"));
  }

  /// The block's mean velocity in the second half of the time: it swings a little on what it stands on.
  Vec3d velocity_after(const std::string& collider, double seconds = 0.4) const {
    const auto simulation = Simulation::create(parse_scene(belt_scene(collider, seconds), folder_ / "scene.toml"));
    Vec3d sum = {};
    int frames = 0;
    while (simulation->frame() < simulation->frame_count()) {
      simulation->advance_frame();
      if (2 * simulation->frame() < simulation->frame_count()) continue;
      const Totals totals = simulation->totals();
      for (int i = 0; i < 3; ++i) sum[i] += totals.momentum[i] / totals.mass;
      ++frames;
    }
    return (1.0 / frames) * sum;
  }

  TemporaryFolder folder_;
  std::string sequence_;
};

TEST_F(Belt, CarriesWhatSticksToIt) {
  const Vec3d v = velocity_after(sequence_ + "contact = \"sticky\"\n");
  EXPECT_NEAR(v[0], kSpeed, 0.1 * kSpeed);
  EXPECT_NEAR(v[1], 0, 0.05 * kSpeed);
  EXPECT_NEAR(v[2], 0, 0.02 * kSpeed);
}

TEST_F(Belt, CarriesByFriction) {
  // mu g = 4.9 m/s^2 reaches the belt's speed in a tenth of a second. The soft block then swings about it, with a
  // period of 0.4 s, a quarter of its speed too fast at first; after half a second that has died down.
  EXPECT_NEAR(velocity_after(sequence_ + "friction = 0.5\n", 1)[0], kSpeed, 0.03 * kSpeed);
}

TEST_F(Belt, DoesWhatARigidBoxOfItsSpeedDoes) {
  const std::string box = "shape = \"box\"\nsize = [4, 0.3, 0.8]\nposition = [0, -0.15, 0]\nvelocity = [" +
                          std::to_string(kSpeed) + ", 0, 0]\n";
  for (const char* contact : {"contact = \"sticky\"\n", "contact = \"slip\"\nfriction = 0.3\n", "friction = 0.5\n"}) {
    const Vec3d belt = velocity_after(sequence_ + contact), rigid = velocity_after(box + contact);
    EXPECT_GT(rigid[0], 0.2 * kSpeed);
    // Slip and friction switch at single particles: measured 4e-4.
    EXPECT_LT(norm(belt - rigid), 1e-3 * kSpeed) << contact;
  }
}

TEST_F(Belt, WithoutFrictionTheBlockStaysWhereItIs) { EXPECT_NEAR(velocity_after(sequence_)[0], 0, 0.02 * kSpeed); }

TEST_F(Belt, ControlTheSameMeshAtRestLeavesTheBlockAtRest) {
  for (const char* contact : {"contact = \"sticky\"\n", "friction = 0.5\n"}) {
    // Once as a mesh that cannot move, once as a sequence whose meshes are all the same.
    EXPECT_NEAR(velocity_after(std::string("shape = \"mesh\"\nfile = \"belt_0.obj\"\n") + contact)[0], 0,
                0.02 * kSpeed);
    EXPECT_NEAR(velocity_after(std::string("shape = \"mesh_sequence\"\nmeshes = [\"belt_0.obj\", \"belt_0.obj\"]\n"
                                           "times = [0, 0.1]\n") +
                               contact)[0],
                0, 0.02 * kSpeed);
  }
}

TEST_F(Belt, TimeStepsSeeItsSpeed) {
  // In jelly so soft that the belt, and not its waves, decides.
  constexpr double kFast = 8;
  const auto shortest = [&](double speed) {
    const std::string collider =
        "shape = \"mesh_sequence\"\nmeshes = \"belt_#.obj\"\nat_end = \"cycle\"\n"
        "contact = \"sticky\"\nfps = " +
        std::to_string(speed / test::belt_link()) + "\n";
    // Single steps go no further than the end of the first frame, which must come later.
    const auto simulation = Simulation::create(parse_scene(belt_scene(collider), folder_ / "scene.toml",
                                                           {"material.jelly.youngs_modulus=2000", "frame_rate=10"}));
    double dt = 1;
    for (int s = 0; s < 3; ++s) dt = std::min(dt, simulation->step().dt);
    return dt;
  };
  const double dt = shortest(kFast);
  EXPECT_LE(dt * kFast, 0.5 * 0.05 * (1 + 1e-9)) << "not more than half a cell a step";
  EXPECT_GT(shortest(0.1), 1.5 * dt);
}

TEST_F(Belt, TheSameBitsOnAnyNumberOfThreads) {
  const auto hash = [&](int threads) {
    const auto simulation = make(sequence_ + "friction = 0.5\n", "threads = " + std::to_string(threads) + "\n");
    for (int s = 0; s < 40; ++s) simulation->step();
    return simulation->hash();
  };
  const std::uint64_t one = hash(1);
  EXPECT_EQ(one, hash(1));
  EXPECT_EQ(one, hash(3));
}

}  // namespace
}  // namespace firn
