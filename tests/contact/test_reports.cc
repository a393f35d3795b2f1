// What a frame says of each collider.

#include <firn/scene/load_scene.h>
#include <firn/simulation/simulation.h>
#include <gtest/gtest.h>

#include <bit>
#include <string>
#include <vector>

namespace firn {
namespace {

/// A block of jelly that lies on a table whose own origin is half a metre to the left of the block's middle.
std::string table_scene(const std::string& more = "") {
  return "dimension = 2\nend_time = 3\nframe_rate = 2\nresolution.cell_size = 0.05\nprecision = \"double\"\n"
         "[material.stuff]\nmodel = \"fixed_corotated\"\nyoungs_modulus = 1e5\npoisson_ratio = 0.3\ndensity = 1000\n"
         "[[body]]\nname = \"block\"\nshape = \"box\"\nsize = [0.4, 0.2]\nposition = [0.5, 0.1]\nmaterial = "
         "\"stuff\"\nfill = \"lattice\"\n"
         "[[collider]]\nname = \"table\"\nshape = \"box\"\nsize = [4, 1]\nposition = [0, -0.5]\ncontact = "
         "\"sticky\"\n" +
         more;
}

std::unique_ptr<Simulation> make(const std::string& text) { return Simulation::create(parse_scene(text, "test.toml")); }

TEST(Reports, ATableWeighsWhatLiesOnIt) {
  const auto simulation = make(table_scene());
  ASSERT_EQ(simulation->report().colliders.size(), 1u);
  EXPECT_EQ(norm(simulation->report().colliders[0].force), 0);
  const double weight = simulation->totals().mass * 9.81;
  Vec3d force = {}, torque = {};
  for (int frame = 2; frame <= 7; ++frame) {
    const double before = simulation->totals().momentum[1];
    const FrameReport report = simulation->advance_frame();
    const ColliderReport& table = report.colliders.at(0);
    // Newton's second law, frame by frame, while the block still trembles.
    EXPECT_NEAR(table.force[1], -weight - (simulation->totals().momentum[1] - before) / 0.5, 1e-9 * weight);
    force = force + (1 / 6.0) * table.force;
    torque = torque + (1 / 6.0) * table.torque;
  }
  EXPECT_NEAR(force[1], -weight, 0.01 * weight);
  EXPECT_NEAR(force[0], 0, 0.01 * weight);
  EXPECT_NEAR(torque[2], -0.5 * weight, 0.01 * weight);
  EXPECT_EQ(torque[0], 0);
}

TEST(Reports, ParticlesInsideAreCountedAndPushedOutWhereAskedFor) {
  const std::string stone =
      "[[collider]]\nname = \"stone\"\nshape = \"sphere\"\nradius = 0.06\nposition = [0.5, 0.1]\n";
  for (const bool push_out : {false, true}) {
    const auto simulation = make(table_scene(stone + (push_out ? "push_out = true\n" : "")));
    const Penetration start = simulation->report().colliders.at(1).inside;
    EXPECT_GT(start.particles, 5);
    EXPECT_GT(start.depth, 0.02);
    EXPECT_LE(start.depth, 0.06);
    EXPECT_EQ(simulation->report().colliders.at(0).inside.particles, 0);
    const Penetration end = simulation->advance_frame().colliders.at(1).inside;
    if (push_out) {
      EXPECT_EQ(end.particles, 0);
      EXPECT_EQ(end.depth, 0);
    } else {
      EXPECT_GT(end.particles, 5);
    }
  }
}

std::vector<std::uint64_t> report_bits(int threads) {
  const std::string paddle =
      "[[collider]]\nname = \"paddle\"\nshape = \"box\"\nsize = [0.5, 0.01]\nposition = [0.5, 0.26]\n"
      "angular_velocity = 6\n";
  const auto simulation = make("threads = " + std::to_string(threads) + "\n" + table_scene(paddle));
  std::vector<std::uint64_t> bits = {simulation->hash()};
  for (const ColliderReport& collider : simulation->advance_frame().colliders) {
    for (const double number : collider.force.e) bits.push_back(std::bit_cast<std::uint64_t>(number));
    for (const double number : collider.torque.e) bits.push_back(std::bit_cast<std::uint64_t>(number));
    bits.push_back(std::bit_cast<std::uint64_t>(collider.inside.depth));
  }
  bits.push_back(simulation->hash());
  return bits;
}

TEST(Reports, TheSameBitsOnAnyNumberOfThreads) {
  const auto serial = report_bits(1);
  for (const int threads : {2, 3}) EXPECT_EQ(report_bits(threads), serial) << threads;
}

}  // namespace
}  // namespace firn
