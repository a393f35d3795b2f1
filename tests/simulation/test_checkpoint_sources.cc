#include <firn/core/error.h>
#include <firn/core/log.h>
#include <firn/io/checkpoint_file.h>
#include <firn/scene/probe_points.h>
#include <gtest/gtest.h>
#include "support/temporary_folder.h"

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "simulation/source_scenes.h"

namespace firn {
namespace {

/// All that adds, removes, holds, loads and measures, with a thin wall that moves through the material. The frames have
/// so many steps that emitters and sinks act, and a pin and an emitter begin and end, in their middle.
std::string full_scene(int dimension, const char* precision, int threads, const std::string& root = "") {
  const bool flat = dimension == 2;
  const auto at = [&](const std::string& x, const std::string& y, const char* z = "0") {
    return "[" + x + ", " + y + (flat ? "]" : std::string(", ") + z + "]");
  };
  const std::string ball = std::string("shape = \"") + (flat ? "disk" : "sphere") + "\"\nradius = ";
  std::string text = root + "dimension = " + std::to_string(dimension) + "\nprecision = \"" + precision +
                     "\"\nframe_rate = 20\nend_time = 0.15\nresolution.cell_size = " + (flat ? "0.02" : "0.04") +
                     "\nthreads = " + std::to_string(threads) +
                     "\n[material.liquid]\nmodel = \"newtonian_fluid\"\ndensity = 1000\nbulk_modulus = 2e4\n"
                     "viscosity = 0.1\n[material.jelly]\npreset = \"jelly\"\nyoungs_modulus = 2e4\n";
  text += "[[body]]\nname = \"block\"\nshape = \"box\"\nsize = " + at("0.2", "0.2", "0.2") +
          "\nposition = " + at("0", "0.1") + "\nmaterial = \"liquid\"\n";
  text += "[[body]]\nname = \"cube\"\nshape = \"box\"\nsize = " + at("0.16", "0.16", "0.16") +
          "\nposition = " + at("0.4", "0.1") + "\nmaterial = \"jelly\"\nvelocity = " + at("-0.5", "0") + "\n";
  text += "[[emitter]]\nname = \"tap\"\nshape = \"box\"\nsize = " + at("0.1", "0.2", "0.1") +
          "\nposition = " + at("0", "0.5") + "\nvelocity = " + at("0.2", "-1") +
          "\nmaterial = \"liquid\"\nmass_rate = " + (flat ? "90" : "9") + "\n";
  text += "[[emitter]]\nname = \"pulse\"\n" + ball + "0.05\nposition = " + at("-0.4", "0.3") +
          "\nvelocity = " + at("0.4", "0") + "\nmaterial = \"liquid\"\nmass_rate = " + (flat ? "30" : "3") +
          "\nstop = 0.06\n";
  text += "[[emitter]]\nname = \"spring\"\n" + ball + "0.06\nposition = " + at("-0.3", "0.1") +
          "\nvelocity = " + at("0", "0.3") + "\nmaterial = \"liquid\"\nkeep_full = true\nstart = 0.07\n";
  text += "[[sink]]\nname = \"drain\"\nshape = \"box\"\nsize = " + at("0.3", "0.1", "0.3") +
          "\nposition = " + at("0", "0") + "\n";
  text += "[[field]]\ntype = \"wind\"\nvelocity = " + at("\"y\"", "0") + "\nresponse_time = 0.5\n";
  text += "[[collider]]\nname = \"ground\"\nshape = \"half_space\"\nfriction = 0.3\n";
  text +=
      "[[collider]]\nname = \"plate\"\nshape = \"box\"\nsize = " +
      (flat ? std::string("[0.012, 0.3]") : std::string("[0.024, 0.3, 0.4]")) + "\nposition = " + at("-0.2", "0.1") +
      "\ninterpolation = \"smooth\"\nkeyframes = [{time = 0, position = " + at("-0.2", "0.1") +
      "}, {time = 0.15, position = " + at("-0.02", "0.12") + ", rotation = " + (flat ? "20" : "[0, 0, 20]") + "}]\n";
  text +=
      "[[pin]]\nshape = \"sphere\"\nradius = 0.05\nposition = " + at("0.4", "0.1") + "\nstart = 0.065\nstop = 0.12\n";
  text += "[[traction]]\nbody = \"cube\"\nshape = \"box\"\nsize = " + at("1", "0.1", "1") +
          "\nposition = " + at("0.4", "0.18") + "\npressure = \"500 * t\"\n";
  text += "[[probe]]\nname = \"row\"\nshape = \"line\"\nposition = " + at("-0.3", "0.1") +
          "\nend = " + at("0.5", "0.1") + "\ncount = 9\n";
  return text;
}

/// What stats.csv and the files of probes are made of.
struct Outcome {
  std::uint64_t hash = 0;
  std::int64_t frame = 0, steps = 0, particles = 0;
  double dt = 0;
  std::string limit;
  std::vector<double> numbers = {};
  std::string error = "";
  bool operator==(const Outcome&) const = default;
};

Outcome outcome_of(const Simulation& simulation) {
  const FrameReport report = simulation.report();
  Outcome outcome = {simulation.hash(), report.frame, report.steps, report.particles, report.dt, report.limit};
  for (const ColliderReport& collider : report.colliders) {
    for (const Vec3d& v : {collider.force, collider.torque})
      outcome.numbers.insert(outcome.numbers.end(), v.e, v.e + 3);
    outcome.numbers.push_back(static_cast<double>(collider.inside.particles));
    outcome.numbers.push_back(collider.inside.depth);
    outcome.numbers.push_back(static_cast<double>(collider.caught));
  }
  for (const auto* counts : {&report.emitted, &report.removed}) {
    for (const SourceCount& count : *counts) {
      outcome.numbers.push_back(static_cast<double>(count.particles));
      outcome.numbers.push_back(count.mass);
    }
  }
  for (const ProbeSettings& probe : simulation.scene().probes) {
    for (const ProbeValue& value : simulation.probe(probe_points(probe))) {
      outcome.numbers.push_back(value.density);
      if (value.density == 0) continue;
      outcome.numbers.insert(outcome.numbers.end(), value.velocity.e, value.velocity.e + 3);
      outcome.numbers.push_back(value.pressure);
    }
  }
  return outcome;
}

/// Runs so many steps on, over ends of frames.
void take_steps(Simulation& simulation, std::int64_t steps) {
  while (steps > 0 && simulation.frame() < simulation.frame_count()) {
    std::int64_t taken = 0;
    simulation.advance_frame([&] { return ++taken >= steps; });
    steps -= taken;
  }
}

/// The outcomes of all frames that are left.
std::vector<Outcome> rest_of(Simulation& simulation) {
  std::vector<Outcome> outcomes;
  while (simulation.frame() < simulation.frame_count()) {
    simulation.advance_frame();
    outcomes.push_back(outcome_of(simulation));
  }
  return outcomes;
}

std::vector<Outcome> last(const std::vector<Outcome>& all, std::size_t count) {
  return {all.end() - static_cast<std::ptrdiff_t>(count), all.end()};
}

/// Steps of the whole run; and that the scene has all that it is for.
std::int64_t steps_of(const std::vector<Outcome>& whole, const Simulation& simulation) {
  const FrameReport report = simulation.report();
  for (const SourceCount& count : report.emitted) EXPECT_GT(count.particles, 0);
  EXPECT_GT(report.removed.at(0).particles, 0);
  for (const ColliderReport& collider : report.colliders) EXPECT_GT(norm(collider.force), 0);
  std::int64_t steps = 0;
  for (const Outcome& outcome : whole) steps += outcome.steps;
  EXPECT_GT(steps, 20);
  return steps;
}

TEST(ResumeSources, AtStepsOfEachFrameGivesTheBitsAndTheNumbersOfOneRun) {
  const auto whole = make(full_scene(2, "single", 1));
  const std::vector<Outcome> expected = rest_of(*whole);
  const std::int64_t steps = steps_of(expected, *whole);
  int in_frames = 0;
  const auto first = make(full_scene(2, "single", 2));
  for (std::int64_t step = 0; step < steps; step += 5, take_steps(*first, 5)) {
    const Checkpoint checkpoint = first->checkpoint();
    in_frames += checkpoint.frame_start.has_value();
    const auto second = make(full_scene(2, "single", 1));
    second->restore(checkpoint);
    const std::vector<Outcome> rest = rest_of(*second);
    ASSERT_TRUE(rest == last(expected, rest.size())) << "after step " << step;
  }
  EXPECT_GT(in_frames, steps / 8);
}

TEST(ResumeSources, ThroughAFileInBothDimensionsAndPrecisions) {
  std::int64_t number = 7;
  for (const int dimension : {2, 3}) {
    for (const char* precision : {"single", "double"}) {
      const auto whole = make(full_scene(dimension, precision, 1));
      const std::vector<Outcome> expected = rest_of(*whole);
      const std::int64_t steps = steps_of(expected, *whole);
      for (int i = 0; i < 3; ++i) {
        number = (number * 48271) % 2147483647;
        const std::int64_t step = 1 + number % (steps - 1);
        const auto first = make(full_scene(dimension, precision, 2)),
                   second = make(full_scene(dimension, precision, 3));
        take_steps(*first, step);
        const TemporaryFolder folder;
        const CheckpointStamp stamp = write_checkpoint(folder / "checkpoint.h5", first->checkpoint());
        second->restore(read_checkpoint(folder / "checkpoint.h5", stamp));
        const std::vector<Outcome> rest = rest_of(*second);
        EXPECT_TRUE(rest == last(expected, rest.size())) << dimension << "D " << precision << " after step " << step;
      }
    }
  }
}

TEST(ResumeSources, APauseAddsAndRemovesNothing) {
  const auto whole = make(full_scene(2, "double", 1)), paused = make(full_scene(2, "double", 1));
  const std::vector<Outcome> expected = rest_of(*whole);
  while (paused->frame() < paused->frame_count()) take_steps(*paused, 1);
  EXPECT_TRUE(outcome_of(*paused) == expected.back());
}

TEST(ResumeSources, AFramesEndHasItsReportAgain) {
  const auto first = make(full_scene(2, "single", 1)), second = make(full_scene(2, "single", 1));
  first->advance_frame();
  second->restore(first->checkpoint());
  EXPECT_TRUE(outcome_of(*second) == outcome_of(*first));
  EXPECT_EQ(second->report().colliders.size(), 2u);
}

TEST(ResumeSources, FramesAreTakenBackToTheirCounts) {
  const LogSink before = set_log_sink({});
  // A pull that moves particles by more than a cell within the first step.
  const auto violent = [] {
    return make(
        "dimension = 2\nend_time = 0.02\nframe_rate = 100\nresolution.particles = 600\nthreads = 1\n"
        "gravity = [0, -3000]\nlimits.particle_cfl = 1\nlimits.elastic_cfl = 1\n"
        "[material.stuff]\nmodel = \"neo_hookean\"\nyoungs_modulus = 1e4\n"
        "[[body]]\nshape = \"disk\"\nradius = 0.2\nposition = [0, 0.2]\nmaterial = \"stuff\"\n"
        "[[collider]]\nname = \"ground\"\nshape = \"half_space\"\ncontact = \"sticky\"\n"
        "[[emitter]]\nname = \"tap\"\nshape = \"box\"\nsize = [0.1, 0.1]\nposition = [0.6, 0.5]\nvelocity = [0, -5]\n"
        "start = 0.015\nmass_rate = 400\nmaterial = \"stuff\"\n"
        "[[sink]]\nname = \"drain\"\nshape = \"box\"\nsize = [0.1, 0.1]\nposition = [0, 0.1]\n");
  };
  const auto whole = violent();
  int retries = 0;
  std::int64_t steps = 0;
  std::vector<Outcome> expected;
  while (whole->frame() < whole->frame_count()) {
    const FrameReport report = whole->advance_frame();
    retries += report.retries;
    steps += report.steps;
    expected.push_back(outcome_of(*whole));
  }
  ASSERT_GT(retries, 0) << "the scene must take frames back";
  EXPECT_GT(whole->report().emitted.at(0).particles, 0);
  EXPECT_GT(whole->report().removed.at(0).particles, 0);
  for (std::int64_t step = 1; step < steps; step += 3) {
    const auto first = violent(), second = violent();
    take_steps(*first, step);
    second->restore(first->checkpoint());
    const std::vector<Outcome> rest = rest_of(*second);
    EXPECT_TRUE(rest == last(expected, rest.size())) << step;
  }
  set_log_sink(before);
}

/// The frame that a checkpoint lies in, or the error.
Outcome next_frame(const Checkpoint& checkpoint) {
  const auto simulation = make(full_scene(2, "single", 1));
  try {
    simulation->restore(checkpoint);
  } catch (const Error& error) {
    Outcome refused;
    refused.error = error.what();
    return refused;
  }
  simulation->advance_frame();
  return outcome_of(*simulation);
}

TEST(SourceEntries, ALostOneIsRefusedByName) {
  const auto simulation = make(full_scene(2, "single", 1));
  simulation->advance_frame();
  for (const bool in_a_frame : {false, true}) {
    if (in_a_frame) take_steps(*simulation, 9);
    const Checkpoint good = simulation->checkpoint();
    ASSERT_EQ(next_frame(good).error, "");
    const auto expect_refused = [&](const std::string& name, const std::function<void(Checkpoint&)>& drop) {
      Checkpoint damaged = good;
      drop(damaged);
      const std::string error = next_frame(damaged).error;
      EXPECT_NE(error.find("\"" + name + "\""), std::string::npos) << name << ": " << error;
    };
    for (const auto& [name, value] : good.state.numbers) {
      expect_refused(name, [&](Checkpoint& c) { c.state.numbers.erase(name); });
    }
    for (const auto& [name, value] : good.state.counters) {
      expect_refused(name, [&](Checkpoint& c) { c.state.counters.erase(name); });
    }
    if (!in_a_frame) continue;
    ASSERT_TRUE(good.frame_start.has_value());
    for (const auto& [name, value] : good.frame_start->counters) {
      expect_refused(name, [&](Checkpoint& c) { c.frame_start->counters.erase(name); });
    }
  }
}

TEST(SourceEntries, EachOneCounts) {
  // Some entries act only where something is due: each must act at some step of a frame.
  struct Change {
    const char* name;
    std::function<void(CheckpointState&)> apply;
    int effects = 0;
  };
  const auto add = [](const char* name, double more) {
    return Change{name, [=](CheckpointState& state) {
                    if (const auto number = state.numbers.find(name); number != state.numbers.end()) {
                      number->second += more;
                    } else {
                      state.counters.at(name) += static_cast<std::int64_t>(more);
                    }
                  }};
  };
  std::vector<Change> changes = {add("emitter.tap.particles", 1),
                                 add("emitter.pulse.mass", 1),
                                 add("emitter.tap.last_slot", 1000),
                                 add("sink.drain.particles", 1),
                                 add("sink.drain.mass", 1),
                                 add("travelled", 1),
                                 add("loads_since", 0.001),
                                 add("collider.ground.caught", 1),
                                 add("collider.plate.impulse_x", 1),
                                 add("collider.plate.impulse_y", 1),
                                 add("collider.plate.impulse_z", 1),
                                 add("collider.plate.angular_impulse_x", 1),
                                 add("collider.plate.angular_impulse_y", 1),
                                 add("collider.plate.angular_impulse_z", 1)};
  const auto simulation = make(full_scene(2, "single", 1));
  simulation->advance_frame();
  simulation->advance_frame();
  for (int i = 0; i < 4; ++i) {
    take_steps(*simulation, 3);
    const Checkpoint good = simulation->checkpoint();
    const Outcome expected = next_frame(good);
    ASSERT_EQ(expected.error, "");
    for (Change& change : changes) {
      Checkpoint changed = good;
      change.apply(changed.state);
      change.effects += next_frame(changed) != expected;
    }
  }
  for (const Change& change : changes) EXPECT_GT(change.effects, 0) << change.name << " has no effect";
}

TEST(SourceEntries, ACountBelowZeroIsRefused) {
  const auto simulation = make(full_scene(2, "single", 1));
  Checkpoint checkpoint = simulation->checkpoint();
  checkpoint.state.counters.at("sink.drain.particles") = -1;
  EXPECT_EQ(next_frame(checkpoint).error, "the checkpoint cannot be used: \"sink.drain.particles\" is -1");
}

TEST(SourceEntries, AColliderThatIsNewHasTakenNothing) {
  const auto before = make(full_scene(2, "single", 1));
  take_steps(*before, 5);
  const auto more = make(full_scene(2, "single", 1) +
                         "[[collider]]\nname = \"ceiling\"\nshape = \"half_space\"\nnormal = [0, -1]\n"
                         "position = [0, 9]\n");
  more->restore(before->checkpoint());
  rest_of(*before);
  rest_of(*more);
  EXPECT_EQ(more->hash(), before->hash());
  EXPECT_EQ(norm(more->report().colliders.at(2).force), 0);
  EXPECT_EQ(more->report().colliders.at(1).force[0], before->report().colliders.at(1).force[0]);
}

}  // namespace
}  // namespace firn
