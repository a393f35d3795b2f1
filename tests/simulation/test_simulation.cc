#include <firn/core/error.h>
#include <firn/core/log.h>
#include <firn/scene/load_scene.h>
#include <firn/simulation/simulation.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace firn {
namespace {

std::string disk_scene(const std::string& model_lines, const std::string& more = "") {
  return "dimension = 2\nend_time = 0.1\nframe_rate = 20\nresolution.particles = 600\n" + more + "[material.stuff]\n" +
         model_lines +
         "[[body]]\nname = \"disk\"\nshape = \"disk\"\nradius = 0.2\nposition = [0, 0.3]\nvelocity = [1, -2]\n"
         "angular_velocity = 4\nmaterial = \"stuff\"\n"
         "[[collider]]\nshape = \"half_space\"\ncontact = \"slip\"\n";
}

const std::string kJelly = "preset = \"jelly\"\n";

std::unique_ptr<Simulation> make(const std::string& text) { return Simulation::create(parse_scene(text, "test.toml")); }

TEST(Simulation, FramesLandOnTheirTimes) {
  const auto simulation = make(disk_scene(kJelly));
  EXPECT_EQ(simulation->frame_count(), 3);
  EXPECT_EQ(simulation->frame(), 1);
  EXPECT_EQ(simulation->time(), 0);
  for (int frame = 2; frame <= 3; ++frame) {
    const FrameReport report = simulation->advance_frame();
    EXPECT_EQ(report.frame, frame);
    EXPECT_EQ(report.time, 0.05 * (frame - 1));
    EXPECT_GT(report.steps, 10);
    EXPECT_EQ(report.limit, "elastic_wave of \"stuff\"");
    EXPECT_NEAR(report.dt * static_cast<double>(report.steps), 0.05, 0.02);
  }
}

TEST(Simulation, StepsOfEqualLengthEndAFrameEvenWhereTheUserSetsThem) {
  const auto simulation = make(disk_scene(kJelly, "limits.max_dt = 1e-4\n"));
  const FrameReport report = simulation->advance_frame();
  EXPECT_EQ(report.limit, "max_dt");
  EXPECT_EQ(report.steps, 500);
  EXPECT_EQ(report.time, 0.05);
}

TEST(Simulation, StartsWithTheBodysMassMomentumAndSpin) {
  for (const char* precision : {"single", "double"}) {
    const auto simulation = make(disk_scene(kJelly, "precision = \"" + std::string(precision) + "\"\n"));
    const double tolerance = std::string(precision) == "single" ? 1e-5 : 1e-12;
    const double area = M_PI * 0.04, mass = 1000 * area;
    const Totals totals = simulation->totals();
    EXPECT_NEAR(totals.mass, mass, tolerance * mass);
    EXPECT_NEAR(totals.momentum[0], mass, tolerance * mass);
    EXPECT_NEAR(totals.momentum[1], -2 * mass, 2 * tolerance * mass);
    // L about the origin = m (x v_y - y v_x) + I omega, with I = m R^2 / 2.
    EXPECT_NEAR(totals.angular_momentum[2], mass * (-0.3) + 0.5 * mass * 0.04 * 4, 0.03 * mass);
    EXPECT_EQ(totals.min_J, 1);
    EXPECT_NEAR(totals.volume, area, tolerance * area);
    EXPECT_EQ(totals.volume_drift(), 0);
  }
}

TEST(Simulation, VolumeDriftIsTheMeanOfTheVolumeRatios) {
  const auto simulation = make(disk_scene(kJelly));
  while (std::abs(simulation->totals().volume_drift()) < 1e-3 && simulation->frame() < 20) simulation->advance_frame();
  const Snapshot snapshot = simulation->snapshot();
  double sum = 0;
  for (std::size_t p = 0; p < snapshot.size(); ++p) sum += value(*snapshot.find("J"), p);
  const double drift = sum / static_cast<double>(snapshot.size()) - 1;  // all particles of the disk are equal
  EXPECT_GT(std::abs(drift), 1e-3);
  EXPECT_NEAR(simulation->totals().volume_drift(), drift, 1e-6);
}

TEST(Simulation, PeriodicLengthsAreWholeBlocksWhateverTheNumberOfParticles) {
  const auto simulation = make(disk_scene(kJelly, "method.periodic = [1.3, 0]\n"));
  const double blocks = 1.3 / (4 * simulation->plan().cell_size);
  EXPECT_NEAR(blocks, std::round(blocks), 1e-9);
  EXPECT_NEAR(simulation->plan().cell_size, std::sqrt(M_PI * 0.04 * 4 / 600), 0.004);
  EXPECT_THROW(make(disk_scene(kJelly, "method.periodic = [1.3, 0.91]\n")), Error);
}

TEST(Simulation, SnapshotIsOrderedByIdAndHasTheDocumentedColumns) {
  const auto simulation = make(disk_scene(kJelly));
  simulation->advance_frame();
  const Snapshot snapshot = simulation->snapshot();
  ASSERT_EQ(snapshot.columns.front().name, "position");
  const SnapshotColumn* id = snapshot.find("id");
  ASSERT_NE(id, nullptr);
  for (std::size_t p = 0; p < snapshot.size(); ++p) EXPECT_EQ(value(*id, p), static_cast<double>(p));
  EXPECT_EQ(snapshot.bodies, std::vector<std::string>{"disk"});
  EXPECT_EQ(snapshot.materials.front().preset, "jelly");
  double pressure = 0;
  for (std::size_t p = 0; p < snapshot.size(); ++p)
    pressure = std::max(pressure, std::abs(value(*snapshot.find("pressure"), p)));
  EXPECT_GT(pressure, 0);
}

TEST(Simulation, TheSameBitsOnAnyNumberOfThreads) {
  const auto hash = [](int threads) {
    const auto simulation = make(disk_scene(kJelly, "threads = " + std::to_string(threads) + "\n"));
    simulation->advance_frame();
    return simulation->hash();
  };
  const std::uint64_t one = hash(1);
  for (const int threads : {2, 3, 8}) EXPECT_EQ(hash(threads), one) << threads;
}

/// Lines that were logged while it lived.
class LogCapture {
 public:
  LogCapture() : before_(set_log_sink([this](LogLevel, const std::string& line) { lines.push_back(line); })) {}
  ~LogCapture() { set_log_sink(before_); }
  std::vector<std::string> lines;

 private:
  LogSink before_;
};

/// A soft disk at rest on sticky ground under a gravity that pulls it by more than a cell within the first, elastic,
/// time step: what hangs on the ground is turned inside out. Steps a quarter as long would do.
std::string crash_scene(const std::string& more) {
  return more +
         "dimension = 2\nend_time = 0.02\nframe_rate = 100\nresolution.particles = 600\ngravity = [0, -3000]\n"
         "limits.particle_cfl = 1\nlimits.elastic_cfl = 1\n"
         "[material.stuff]\nmodel = \"neo_hookean\"\nyoungs_modulus = 1e4\n"
         "[[body]]\nname = \"disk\"\nshape = \"disk\"\nradius = 0.2\nposition = [0, 0.2]\nmaterial = \"stuff\"\n"
         "[[collider]]\nshape = \"half_space\"\ncontact = \"sticky\"\n";
}

TEST(Simulation, AFailingFrameIsTakenBackAndComputedWithSmallerSteps) {
  const LogCapture log;
  const auto simulation = make(crash_scene(""));
  int retries = 0;
  for (int frame = 2; frame <= 3 && retries == 0; ++frame) retries = simulation->advance_frame().retries;
  ASSERT_GT(retries, 0) << "the scene was meant to fail";
  ASSERT_FALSE(log.lines.empty());
  EXPECT_NE(log.lines.back().find("taking frame"), std::string::npos) << log.lines.back();
  EXPECT_TRUE(std::isfinite(simulation->totals().kinetic_energy));
}

TEST(Simulation, AFrameThatFailsWithAllStepsLeavesTheLastGoodOne) {
  const LogCapture log;
  std::string text = crash_scene("");
  text.replace(text.find("-3000"), 5, "-3e6");
  const auto simulation = make(text);
  const std::uint64_t before = simulation->hash();
  const std::int64_t particles = simulation->report().particles;
  EXPECT_THROW(
      {
        for (int frame = 2; frame <= 3; ++frame) simulation->advance_frame();
      },
      Error);
  EXPECT_EQ(simulation->hash(), before);
  EXPECT_EQ(simulation->report().frame, 1);
  EXPECT_EQ(simulation->report().time, 0);
  EXPECT_EQ(simulation->report().particles, particles);
}

TEST(Simulation, WithoutRollbackAFailureIsAReport) {
  const auto simulation = make(crash_scene("rollback = \"off\"\n"));
  try {
    for (int frame = 2; frame <= 3; ++frame) simulation->advance_frame();
    FAIL() << "the scene was meant to fail";
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), 4);
    const std::string text = error.what();
    for (const char* part :
         {"step ", " at t = ", "particle ", "\"stuff\"", "F = (", "J = ", "lower limits.elastic_cfl"}) {
      EXPECT_NE(text.find(part), std::string::npos) << part << " is missing in: " << text;
    }
  }
}

TEST(Simulation, RunawaysAreParkedCountedAndNamed) {
  const LogCapture log;
  const auto simulation = make(disk_scene(kJelly, "limits.box = [[-1, -1], [0.21, 1]]\n"));
  const std::int64_t before = simulation->particle_count();
  const FrameReport report = simulation->advance_frame();
  EXPECT_GT(report.parked, 10);
  EXPECT_EQ(report.particles, before - report.parked);
  ASSERT_FALSE(log.lines.empty());
  EXPECT_NE(log.lines.front().find("outside limits.box"), std::string::npos);
  const Snapshot snapshot = simulation->snapshot();
  for (std::size_t p = 0; p < snapshot.size(); ++p) EXPECT_LE(snapshot.position(p)[0], 0.21 + 1e-6);
  EXPECT_GT(simulation->advance_frame().frame, 2) << "the run goes on";

  const auto none = make(disk_scene(kJelly, "gravity = [3000, 0]\nlimits.box = [[-1, -1], [1, 1]]\n"));
  EXPECT_EQ(none->advance_frame().particles, 0);
  EXPECT_EQ(none->advance_frame().frame, 3) << "also with nothing left";

  const auto fast = make(disk_scene(kJelly, "limits.speed = 2.5\n"));
  EXPECT_GT(fast->advance_frame().parked, 0);
  EXPECT_LE(fast->totals().max_speed, 2.5);
}

}  // namespace
}  // namespace firn
