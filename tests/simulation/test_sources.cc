#include "simulation/source_scenes.h"

#include <firn/core/error.h>
#include <firn/core/log.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace firn {
namespace {

TEST(Emitter, MassIsRateTimesTime) {
  const auto by_mass = make(scene(emitter("velocity = [0, -1]\nmass_rate = 100\nstart = 0.03\nstop = 0.9\n"), 1));
  run(*by_mass);
  const SourceCount count = by_mass->report().emitted.at(0);
  EXPECT_NEAR(count.mass, 100 * 0.87, 1e-3 * 87);
  EXPECT_NEAR(by_mass->totals().mass, count.mass, 1e-9);
  EXPECT_EQ(by_mass->particle_count(), count.particles);
  const auto by_volume = make(scene(emitter("velocity = [0, -1]\nvolume_rate = 0.1\nstart = 0.03\nstop = 0.9\n"), 1));
  run(*by_volume);
  EXPECT_EQ(by_volume->hash(), by_mass->hash());
}

/// Distances along the stream between consecutive particles that came in one straight stream without gravity.
std::vector<double> gaps(const Simulation& simulation) {
  const Snapshot snapshot = simulation.snapshot();
  std::vector<double> places, result;
  for (std::size_t p = 0; p < snapshot.size(); ++p) places.push_back(snapshot.position(p)[1]);
  std::sort(places.begin(), places.end());
  for (std::size_t i = 1; i < places.size(); ++i) result.push_back(places[i] - places[i - 1]);
  return result;
}

TEST(Emitter, LeavesNoStripes) {
  // A tenth of what would fill the section, so that nothing but the emitter moves the particles apart.
  const std::string tap = emitter("velocity = [0, -1]\nvolume_rate = 0.01\n");
  for (const char* root : {"gravity = [0, 0]\n", "gravity = [0, 0]\nlimits.max_dt = 7e-4\n"}) {
    for (const char* frames : {"frame_rate = 20\n", "frame_rate = 50\n"}) {
      std::string text = scene(tap, 0.2, root);
      text.replace(text.find("frame_rate = 20\n"), 16, frames);
      const auto simulation = make(text);
      run(*simulation);
      ASSERT_EQ(simulation->particle_count(), 20);
      for (const double gap : gaps(*simulation)) EXPECT_NEAR(gap, 0.01, 1e-4);
    }
  }
}

/// Standard deviation over mean of the number of places in slices of this length, of those that lie in [from, to).
double unevenness(const std::vector<double>& places, double from, double to, double slice) {
  std::vector<double> counts(static_cast<std::size_t>(std::llround((to - from) / slice)));
  for (const double y : places) {
    if (y >= from && y < to) ++counts[static_cast<std::size_t>((y - from) / slice)];
  }
  double mean = 0, square = 0;
  for (const double count : counts) mean += count / static_cast<double>(counts.size());
  for (const double count : counts) square += (count - mean) * (count - mean) / static_cast<double>(counts.size());
  return std::sqrt(square) / mean;
}

TEST(Emitter, DensityOfAFullStreamIsEven) {
  // As much as the section passes: a frame takes 5 cm, a step about 1 mm, a slice has 2 cm and 20 particles.
  const auto simulation = make(scene(emitter("velocity = [0, -1]\nvolume_rate = 0.1\n"), 1, "gravity = [0, 0]\n"));
  run(*simulation);
  const Snapshot snapshot = simulation->snapshot();
  std::vector<double> places, if_frames_only;
  for (std::size_t p = 0; p < snapshot.size(); ++p) {
    places.push_back(snapshot.position(p)[1]);
    // The same particles, had each come at the end of the frame in which it was due.
    const double due = (value(*snapshot.find("id"), p) + 0.5) / 1000;
    if_frames_only.push_back(1 - (1 - std::ceil(due * 20) / 20));
  }
  EXPECT_LT(unevenness(places, 0.1, 0.9, 0.02), 0.06) << "a particle more or less";
  EXPECT_GT(unevenness(if_frames_only, 0.1, 0.9, 0.02), 1) << "the measure sees stripes";
  std::vector<Vec3d> line;
  for (int i = 0; i < 80; ++i) line.push_back({{0, 0.1 + 0.01 * i, 0}});
  for (const ProbeValue& value : simulation->probe(line)) EXPECT_NEAR(value.density, 1000, 10);
}

TEST(Emitter, KeepsFull) {
  const auto still = make(scene(emitter("keep_full = true\n"), 0.1, "gravity = [0, 0]\n"));
  const std::int64_t full = still->particle_count();
  EXPECT_EQ(full, 200);
  EXPECT_EQ(still->report().particles, full);
  run(*still);
  EXPECT_EQ(still->particle_count(), full) << "a full region takes no more";

  // Material that moves on makes room for as much as flows out: section times speed.
  const auto flow = make(scene(emitter("keep_full = true\nvelocity = [0, -1]\n"), 1, "gravity = [0, 0]\n"));
  const double before = flow->report().emitted[0].mass;
  run(*flow);
  EXPECT_NEAR(flow->report().emitted[0].mass - before, 1000 * 0.1 * 1, 0.02 * 100);
}

TEST(Emitter, NamesWhatItsParticlesAre) {
  const auto simulation = make(scene(body() + emitter("velocity = [0, -1]\nmass_rate = 50\n")));
  const std::int64_t bodies = simulation->particle_count();
  run(*simulation);
  const Snapshot snapshot = simulation->snapshot();
  EXPECT_EQ(snapshot.bodies, (std::vector<std::string>{"block", "tap"}));
  ASSERT_GT(simulation->particle_count(), bodies + 50);
  for (std::size_t p = 0; p < snapshot.size(); ++p) {
    EXPECT_EQ(value(*snapshot.find("id"), p), static_cast<double>(p));
    EXPECT_EQ(value(*snapshot.find("body"), p), static_cast<std::int64_t>(p) < bodies ? 0 : 1);
  }
}

TEST(Emitter, WarnsOfMoreThanTheSectionPasses) {
  std::vector<std::string> lines;
  const LogSink before = set_log_sink([&](LogLevel, const std::string& line) { lines.push_back(line); });
  make(scene(emitter("velocity = [0, -1]\nvolume_rate = 0.1\n")));
  EXPECT_TRUE(lines.empty());
  make(scene(emitter("velocity = [0, -1]\nvolume_rate = 0.2\n")));
  set_log_sink(before);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(
      lines[0],
      "emitter \"tap\": its rate is 2 times what its section of 0.1 m^1 passes at 1 m/s, so the material comes out "
      "compressed without knowing it; raise velocity or the size, or lower the rate");
}

/// Everything at once.
std::string busy_scene(int threads) {
  return scene(body() + emitter("velocity = [0.2, -1]\nmass_rate = 90\n") +
                   "[[emitter]]\nshape = \"disk\"\nradius = 0.05\nposition = [0.3, 0.3]\nmaterial = \"liquid\"\n"
                   "keep_full = true\nstart = 0.05\n"
                   "[[sink]]\nshape = \"box\"\nsize = [2, 0.1]\nposition = [0, -0.05]\n"
                   "[[field]]\ntype = \"vortex\"\nposition = [0, 0.5]\nradius = 0.2\nstrength = 20\n"
                   "[[field]]\ntype = \"wind\"\nvelocity = [\"y\", 0]\nresponse_time = 0.5\n"
                   "[[collider]]\nname = \"paddle\"\nshape = \"box\"\nsize = [0.3, 0.06]\nposition = [0, 0.5]\n"
                   "angular_velocity = 5\nvelocity = [0.1, 0]\n"
                   "[[emitter]]\nname = \"nozzle\"\nshape = \"disk\"\nradius = 0.03\nposition = [0.2, 0.5]\n"
                   "material = \"liquid\"\nmass_rate = 60\nvelocity = [1, 0]\nmoves_with = \"paddle\"\n"
                   "[[sink]]\nshape = \"disk\"\nradius = 0.06\nkeyframes = [{ time = 0, position = [-0.2, 0.05] }, "
                   "{ time = 0.2, position = [0.2, 0.05], scale = 1.5 }]\n"
                   "[[pin]]\nshape = \"sphere\"\nradius = 0.05\nposition = [0, 0.1]\nstop = 0.1\n"
                   "[[pin]]\nshape = \"box\"\nsize = [0.05, 0.05]\nposition = [0.1, 0.5]\nmoves_with = \"paddle\"\n"
                   "[[traction]]\nshape = \"box\"\nsize = [1, 0.02]\nposition = [0, 0.2]\npressure = \"500 * t\"\n",
               0.2, "threads = " + std::to_string(threads) + "\n");
}

TEST(Sources, TheSameBitsOnAnyNumberOfThreads) {
  std::uint64_t one = 0;
  for (const int threads : {1, 2, 3}) {
    const auto simulation = make(busy_scene(threads));
    run(*simulation);
    const FrameReport report = simulation->report();
    EXPECT_GT(report.emitted[0].particles, 100);
    EXPECT_GT(report.emitted[1].particles, 50);
    EXPECT_GT(report.emitted[2].particles, 50);
    EXPECT_GT(report.removed[0].particles, 50);
    EXPECT_GT(report.removed[1].particles, 10);
    if (threads == 1) one = simulation->hash();
    EXPECT_EQ(simulation->hash(), one) << threads;
  }
}

TEST(Sources, TheSameBitsOnAnyNumberOfThreadsIn3D) {
  std::uint64_t one = 0;
  for (const int threads : {1, 2, 3}) {
    const auto simulation =
        make("threads = " + std::to_string(threads) +
             "\nend_time = 0.1\nframe_rate = 20\nresolution.cell_size = 0.04\n[material.snow]\npreset = \"snow\"\n"
             "youngs_modulus = { value = 1e5, spread = 0.2 }\n"
             "[[collider]]\nname = \"arm\"\nshape = \"box\"\nsize = [0.4, 0.1, 0.1]\nangular_velocity = [0, 9, 1]\n"
             "velocity = [0, 0.3, 0]\n"
             "[[emitter]]\nshape = \"sphere\"\nradius = 0.06\nposition = [0.3, 0, 0]\nmaterial = \"snow\"\n"
             "mass_rate = 6\nvelocity = [1, 1, 0]\nmoves_with = \"arm\"\n"
             "[[emitter]]\nshape = \"box\"\nsize = [0.2, 0.1, 0.1]\nposition = [0, 0.2, 0.4]\nmaterial = \"snow\"\n"
             "keep_full = true\nvelocity = [0, -2, 0]\n"
             "[[sink]]\nshape = \"box\"\nsize = [1, 0.1, 2]\nposition = [0, -0.05, 0]\n");
    run(*simulation);
    const FrameReport report = simulation->report();
    EXPECT_GT(report.emitted[0].particles, 100);
    EXPECT_GT(report.emitted[1].particles, 100);
    EXPECT_GT(report.removed[0].particles, 50);
    if (threads == 1) one = simulation->hash();
    EXPECT_EQ(simulation->hash(), one) << threads;
  }
}

TEST(Sources, AFrameThatIsTakenBackTakesItsParticlesBack) {
  const LogSink before = set_log_sink([](LogLevel, const std::string&) {});
  // A soft disk under a gravity that turns it inside out in the first elastic step; half as long a step does.
  const auto simulation = make(
      "dimension = 2\nend_time = 0.02\nframe_rate = 100\nresolution.particles = 600\ngravity = [0, -3000]\n"
      "limits.particle_cfl = 1\nlimits.elastic_cfl = 1\n"
      "[material.stuff]\nmodel = \"neo_hookean\"\nyoungs_modulus = 1e4\n"
      "[[body]]\nname = \"disk\"\nshape = \"disk\"\nradius = 0.2\nposition = [0, 0.2]\nmaterial = \"stuff\"\n"
      "[[emitter]]\nshape = \"box\"\nsize = [0.1, 1]\nposition = [2, 5]\nvelocity = [0.5, 0]\nvolume_rate = 0.5\n"
      "material = \"stuff\"\n"
      "[[sink]]\nshape = \"box\"\nsize = [0.1, 0.1]\nposition = [0, 0.3]\n"
      "[[collider]]\nshape = \"half_space\"\ncontact = \"sticky\"\n");
  const std::int64_t bodies = simulation->plan().particles;
  int retries = 0;
  for (int frame = 2; frame <= 3 && retries == 0; ++frame) retries = simulation->advance_frame().retries;
  set_log_sink(before);
  ASSERT_GT(retries, 0) << "the scene was meant to fail";
  const FrameReport report = simulation->report();
  const double due = 0.5 * report.time / simulation->plan().particle_volume;
  EXPECT_NEAR(static_cast<double>(report.emitted[0].particles), due, 0.6);
  EXPECT_GT(report.removed[0].particles, 20);
  EXPECT_EQ(report.particles, bodies + report.emitted[0].particles - report.removed[0].particles);
  std::vector<double> ids;
  const Snapshot snapshot = simulation->snapshot();
  for (std::size_t p = 0; p < snapshot.size(); ++p) ids.push_back(value(*snapshot.find("id"), p));
  std::sort(ids.begin(), ids.end());
  EXPECT_EQ(std::adjacent_find(ids.begin(), ids.end()), ids.end()) << "each id once";
}

TEST(Sources, CountWhatThereIs) {
  const auto simulation = make(busy_scene(1));
  const std::int64_t bodies = simulation->plan().particles;
  const double particle_mass = 1000 * simulation->plan().particle_volume;
  while (simulation->frame() < simulation->frame_count()) {
    const FrameReport report = simulation->advance_frame();
    std::int64_t particles = bodies;
    double mass = 200 * 0.2;
    for (const SourceCount& count : report.emitted) {
      particles += count.particles;
      mass += count.mass;
    }
    for (const SourceCount& count : report.removed) {
      particles -= count.particles;
      mass -= count.mass;
    }
    EXPECT_EQ(report.particles, particles);
    EXPECT_NEAR(report.emitted[0].mass, static_cast<double>(report.emitted[0].particles) * particle_mass, 1e-9);
    EXPECT_NEAR(simulation->totals().mass, mass, 1e-6);
  }
}

TEST(Sink, RemovesWhatIsInside) {
  const std::string sink = "[[sink]]\nname = \"drain\"\nshape = \"box\"\nsize = [1, 0.1]\nposition = [0, 0.05]\n";
  const auto simulation = make(scene(body() + sink + "start = 0.1\nstop = 0.12\n", 0.2, "gravity = [0, 0]\n"));
  const double mass = simulation->totals().mass;
  EXPECT_EQ(simulation->advance_frame().removed[0].particles, 0);
  const FrameReport at_start = simulation->advance_frame();
  EXPECT_NEAR(at_start.removed[0].mass, mass / 2, 0.05 * mass);
  EXPECT_NEAR(simulation->totals().mass + at_start.removed[0].mass, mass, 1e-9);
  const Snapshot snapshot = simulation->snapshot();
  for (std::size_t p = 0; p < snapshot.size(); ++p) EXPECT_GT(snapshot.position(p)[1], 0.1 - 1e-9);
}

TEST(Sink, FallingMaterialDoesNotPass) {
  const auto simulation = make(scene(
      body("velocity = [0, -3]\n") + "[[sink]]\nshape = \"box\"\nsize = [1, 0.06]\nposition = [0, -0.03]\n", 0.2));
  run(*simulation);
  EXPECT_EQ(simulation->particle_count(), 0);
  EXPECT_NEAR(simulation->report().removed[0].mass, 40, 1e-6);
}

/// Mean velocity of a cloud in a field alone.
Vec3d mean_velocity(const std::string& field, double time, const std::string& velocity = "[0, 0]") {
  const auto simulation = make(scene(body("velocity = " + velocity + "\n") + field, time, "gravity = [0, 0]\n"));
  run(*simulation);
  const Totals totals = simulation->totals();
  return (1 / totals.mass) * totals.momentum;
}

TEST(Field, FormulaOfTimeActsForItsTime) {
  const std::string field = "[[field]]\ntype = \"acceleration\"\nacceleration = [\"t\", 2]\n";
  const Vec3d v = mean_velocity(field, 0.2);
  EXPECT_NEAR(v[0], 0.02, 1e-3);  // forces of the step's begin: first order in the step
  EXPECT_NEAR(v[1], 0.4, 1e-10);
  EXPECT_NEAR(mean_velocity(field + "start = 0.05\nstop = 0.15\n", 0.2)[1], 0.2, 1e-6);
  EXPECT_NEAR(mean_velocity(field + "box = [[-9, 0.1], [9, 9]]\n", 0.05)[1], 0.05, 5e-3);
}

TEST(Field, WindTakesAlong) {
  const Vec3d v = mean_velocity("[[field]]\ntype = \"wind\"\nvelocity = [3, 0]\nresponse_time = 0.1\n", 0.2, "[0, 1]");
  EXPECT_NEAR(v[0], 3 * (1 - std::exp(-2.0)), 0.03);
  EXPECT_NEAR(v[1], std::exp(-2.0), 0.01);
}

TEST(Pin, HoldsUntilItStops) {
  const auto simulation =
      make(scene(body() + "[[pin]]\nshape = \"box\"\nsize = [1, 1]\nposition = [0, 0.1]\nstop = 0.1\n"));
  simulation->advance_frame();
  simulation->advance_frame();
  EXPECT_EQ(simulation->totals().max_speed, 0);
  run(*simulation);
  EXPECT_NEAR(simulation->totals().momentum[1], -40 * 9.81 * 0.1, 1e-6);
}

TEST(Pin, CarriesAlong) {
  const auto simulation = make(
      scene(body() + "[[pin]]\nshape = \"box\"\nsize = [1, 1]\nposition = [0, 0.1]\nvelocity = [0.5, 0]\nstart = 0.1\n",
            0.2, "gravity = [0, 0]\n"));
  const auto middle = [&] {
    const Snapshot snapshot = simulation->snapshot();
    double sum = 0;
    for (std::size_t p = 0; p < snapshot.size(); ++p) sum += snapshot.position(p)[0];
    return sum / static_cast<double>(snapshot.size());
  };
  const double before = middle();
  run(*simulation);
  EXPECT_NEAR(middle() - before, 0.05, 1e-9);
}

TEST(Probe, MeasuresABlock) {
  const auto simulation = make(scene(body("velocity = [\"2 + 3 * y\", -1]\nfill = \"lattice\"\n")));
  const std::vector<Vec3d> points = {{{0, 0.1, 0}}, {{0.033, 0.07, 0}}, {{0, 0.2, 0}}, {{0.5, 0.1, 0}}};
  const std::vector<ProbeValue> values = simulation->probe(points);
  for (int i = 0; i < 2; ++i) {
    // A lattice of two particles per cell is not felt by the spline to 3 %.
    EXPECT_NEAR(values[static_cast<std::size_t>(i)].density, 1000, 30);
    EXPECT_NEAR(values[static_cast<std::size_t>(i)].velocity[0], 2 + 3 * points[static_cast<std::size_t>(i)][1], 0.01);
    EXPECT_NEAR(values[static_cast<std::size_t>(i)].velocity[1], -1, 1e-12);
    EXPECT_EQ(values[static_cast<std::size_t>(i)].pressure, 0);
  }
  EXPECT_NEAR(values[2].density, 500, 30) << "half of the neighbourhood is air";
  EXPECT_EQ(values[3].density, 0);
  EXPECT_TRUE(std::isnan(values[3].velocity[0]));
  EXPECT_TRUE(std::isnan(values[3].pressure));
}

TEST(Probe, FeelsHydrostaticPressure) {
  const auto simulation =
      make(scene("[[body]]\nname = \"tank\"\nshape = \"box\"\nsize = [0.32, 0.4]\nposition = [0.16, 0.2]\nfill = "
                 "\"lattice\"\nmaterial = \"liquid\"\n[[collider]]\nshape = \"half_space\"\ncontact = \"slip\"\n"
                 // A little above the nodes, so that the lowest layer of them is inside.
                 "position = [0, 1e-4]\n[[field]]\ntype = \"wind\"\nvelocity = [0, 0]\nresponse_time = 0.05\n",
                 1, "method.periodic = [0.32, 0]\n"));
  run(*simulation);
  // Also across the periodic border.
  const std::vector<ProbeValue> values = simulation->probe(std::vector<Vec3d>{{{0.16, 0.1, 0}}, {{0, 0.1, 0}}});
  // dp/dy = -rho g with p = K (rho / rho_0 - 1), which the exponent is close to, and the weight of the column at its
  // bottom.
  const double K = 2e4, expected = (1000 * 9.81 * 0.4 + K) * std::exp(-0.1 * 1000 * 9.81 / K) - K;
  for (const ProbeValue& value : values) EXPECT_NEAR(value.pressure, expected, 0.01 * expected);
}

}  // namespace
}  // namespace firn
