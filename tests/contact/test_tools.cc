// Tools of whole scenes: nothing gets into them, and they do their work.

#include <firn/scene/load_scene.h>
#include <firn/simulation/simulation.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace firn {
namespace {

std::unique_ptr<Simulation> make(const std::string& text) {
  return Simulation::create(parse_scene(text, std::string(FIRN_SOURCE_DIR) + "/scenes/obstacles/scene.toml"));
}

/// Runs to the end; the first collider is the tool. Returns the largest number of particles that were inside it.
std::int64_t most_inside(Simulation& simulation) {
  std::int64_t most = 0;
  while (simulation.frame() < simulation.frame_count()) {
    const FrameReport& report = simulation.advance_frame();
    most = std::max(most, report.colliders[0].inside.particles);
    EXPECT_EQ(report.colliders[0].caught, 0);
  }
  return most;
}

/// Particles behind the tip of the plough, within the width of its lane.
int in_lane(const Simulation& simulation, double tip) {
  const Snapshot snapshot = simulation.snapshot();
  int count = 0;
  for (std::size_t p = 0; p < snapshot.size(); ++p) {
    const Vec3d x = snapshot.position(p);
    count += x[0] < tip - 0.4 && std::abs(x[2]) < 0.15 && x[1] < 0.1 ? 1 : 0;
  }
  return count;
}

/// A blade of a mesh, thinner than two cells, at 4 m/s.
std::string plough_scene(const std::string& more) {
  return "end_time = 0.25\nframe_rate = 40\nresolution.cell_size = 0.04\n[material.snow]\npreset = \"snow\"\n"
         "[[body]]\nshape = \"box\"\nsize = [0.8, 0.16, 0.7]\nposition = [0, 0.08, 0]\nmaterial = \"snow\"\n"
         "[[collider]]\nname = \"plough\"\nshape = \"mesh\"\nfile = \"../meshes/plough.obj\"\nfriction = 0.1\n" +
         more + "[[collider]]\nname = \"ground\"\nshape = \"half_space\"\nfriction = 0.1\n";
}

TEST(Tools, AMeshPloughClearsALaneAndLetsNoSnowThrough) {
  const auto simulation = make(plough_scene(
      "keyframes = [{ time = 0, position = [-0.8, 0.005, 0] }, { time = 0.25, position = [0.2, 0.005, 0] }]\n"));
  const int before = in_lane(*simulation, 0.5);
  EXPECT_EQ(most_inside(*simulation), 0);
  EXPECT_LT(in_lane(*simulation, 0.5), 0.15 * before);
  EXPECT_LT(simulation->report().colliders[0].force[0], 0) << "the snow resists";
}

TEST(Tools, ControlSnowPlacedInThePloughIsCounted) {
  const auto simulation = make(plough_scene("position = [0, 0.005, 0]\n"));
  EXPECT_GT(simulation->report().colliders[0].inside.particles, 10);
}

TEST(Tools, AFastPaddleStirsSand) {
  // A tenth of a cell thick, its ends at 5 m/s.
  const auto simulation = make(
      "dimension = 2\nend_time = 0.3\nframe_rate = 60\nresolution.cell_size = 0.02\n[material.sand]\n"
      "preset = \"sand\"\n[[body]]\nshape = \"box\"\nsize = [0.96, 0.22]\nposition = [0, 0.121]\n"
      "material = \"sand\"\n"
      "[[collider]]\nname = \"paddle\"\nshape = \"box\"\nsize = [0.5, 0.002]\nposition = [0, 0.27]\n"
      "angular_velocity = 20\nfriction = 0.4\n"
      "[[collider]]\nname = \"box\"\nshape = \"box\"\nsize = [1, 2]\nposition = [0, 1]\ninverted = true\n");
  const double start = simulation->totals().kinetic_energy;
  EXPECT_EQ(most_inside(*simulation), 0);
  EXPECT_GT(simulation->totals().kinetic_energy, start + 1);
  EXPECT_EQ(simulation->report().colliders[1].inside.particles, 0);
}

}  // namespace
}  // namespace firn
