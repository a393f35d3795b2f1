#include <firn/core/error.h>
#include <firn/core/log.h>
#include <firn/io/checkpoint_file.h>
#include <firn/materials/model_info.h>
#include <firn/scene/load_scene.h>
#include <firn/simulation/simulation.h>
#include <gtest/gtest.h>
#include "support/temporary_folder.h"

#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace firn {
namespace {

struct Variant {
  std::string name = {};
  int dimension = 2;
  std::string precision = "single";
  std::string first = "preset = \"snow\"\n";  ///< keys of the first material
  std::string transfer = "apic";
  std::string more = "";
};

/// Two bodies of two materials that meet each other, a floor, and a paddle on keyframes that stirs them: every kind of
/// state that goes from step to step.
std::string scene_text(const Variant& v, int threads) {
  const bool flat = v.dimension == 2;
  const auto at = [&](const char* x, const char* y) { return std::string("[") + x + ", " + y + (flat ? "]" : ", 0]"); };
  std::string text = "dimension = " + std::to_string(v.dimension) + "\nprecision = \"" + v.precision +
                     "\"\nend_time = 0.03\nframe_rate = 100\nthreads = " + std::to_string(threads) +
                     "\nresolution.particles = " + (flat ? "500" : "900") + "\nmethod.transfer = \"" + v.transfer +
                     "\"\n" + v.more;
  text += "[material.first]\n" + v.first + "[material.second]\npreset = \"jelly\"\n";
  const std::string shape = flat ? "disk" : "sphere";
  text += "[[body]]\nname = \"left\"\nshape = \"" + shape + "\"\nradius = 0.1\nposition = " + at("-0.12", "0.13") +
          "\nvelocity = " + at("3", "-4") + "\nmaterial = \"first\"\n";
  text += "[[body]]\nname = \"right\"\nshape = \"" + shape + "\"\nradius = 0.1\nposition = " + at("0.12", "0.13") +
          "\nvelocity = " + at("-3", "-4") + "\nmaterial = \"second\"\n";
  text += "[[collider]]\nshape = \"half_space\"\nfriction = 0.3\n";
  text += std::string("[[collider]]\nname = \"paddle\"\nshape = \"box\"\nsize = ") +
          (flat ? "[0.05, 0.1]" : "[0.05, 0.1, 0.3]") + "\nposition = " + at("-0.35", "0.1") +
          "\ninterpolation = \"smooth\"\nkeyframes = [{time = 0, position = " + at("-0.35", "0.1") +
          "}, {time = 0.03, position = " + at("-0.15", "0.12") + ", rotation = " + (flat ? "40" : "[0, 0, 40]") +
          "}]\n";
  return text;
}

std::unique_ptr<Simulation> make(const Variant& v, int threads = 1) {
  return Simulation::create(parse_scene(scene_text(v, threads), "test.toml"));
}

/// Stops after this many steps.
Pause after(std::int64_t steps) {
  return [steps]() mutable { return --steps <= 0; };
}

void finish(Simulation& simulation) {
  while (simulation.frame() < simulation.frame_count()) simulation.advance_frame();
}

bool equal(const FrameReport& a, const FrameReport& b) {
  return a.frame == b.frame && a.time == b.time && a.steps == b.steps && a.dt == b.dt && a.limit == b.limit &&
         a.particles == b.particles && a.parked == b.parked && a.retries == b.retries;
}

/// Steps in the first two frames, for choosing one of them.
std::int64_t count_steps(const Variant& v) {
  const auto simulation = make(v);
  return simulation->advance_frame().steps + simulation->advance_frame().steps;
}

/// A step that follows from the variant's name: another one for each, the same in each run of the test.
std::int64_t chosen_step(const std::string& name, std::int64_t steps) {
  std::uint64_t number = 1469598103934665603u;
  for (const char c : name) number = (number ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return 1 + static_cast<std::int64_t>(number % static_cast<std::uint64_t>(steps));
}

/// Runs so many steps from the start, over ends of frames.
void take_steps(Simulation& simulation, std::int64_t steps) {
  while (steps > 0) {
    std::int64_t taken = 0;
    simulation.advance_frame([&] { return ++taken >= steps; });
    steps -= taken;
  }
}

class Resume : public testing::TestWithParam<Variant> {};

TEST_P(Resume, AtAnyStepGivesTheBitsOfOneRun) {
  const Variant& v = GetParam();
  const auto whole = make(v, 1);
  finish(*whole);

  const std::int64_t step = chosen_step(v.name, count_steps(v));
  const TemporaryFolder folder;
  CheckpointStamp stamp;
  {
    const auto first = make(v, 2);
    take_steps(*first, step);
    stamp = write_checkpoint(folder / "checkpoint.h5", first->checkpoint());
  }
  const auto second = make(v, 3);
  second->restore(read_checkpoint(folder / "checkpoint.h5", stamp));
  finish(*second);
  EXPECT_EQ(second->hash(), whole->hash()) << "after step " << step;
  EXPECT_TRUE(equal(second->report(), whole->report())) << "after step " << step;
}

/// Soft enough for a few hundred steps.
std::vector<Variant> models() {
  const std::string soft = "density = 1000\nyoungs_modulus = 2e5\n";
  const std::vector<std::pair<std::string, std::string>> first = {
      {"fixed_corotated", "preset = \"jelly\"\n"},
      {"neo_hookean", "preset = \"rubber\"\n"},
      {"hencky", "model = \"hencky\"\n" + soft},
      {"linear_corotated", "model = \"linear_corotated\"\n" + soft},
      {"snow", "preset = \"snow\"\n"},
      {"drucker_prager", "preset = \"sand\"\n"},
      {"von_mises", "preset = \"plasticine\"\n"},
      {"cam_clay", "preset = \"clay\"\n"},
      {"herschel_bulkley", "preset = \"yogurt\"\n"},
      {"oldroyd_b", "model = \"oldroyd_b\"\ndensity = 1000\n"},
      {"newtonian_fluid", "preset = \"water\"\n"},
      {"rankine_damage", "preset = \"concrete\"\nyoungs_modulus = 2e6\ncracking_stress = 5e3\n"},
  };
  std::vector<Variant> list;
  for (const auto& [name, lines] : first) {
    for (const int dimension : {2, 3}) {
      list.push_back({.name = name + "_" + std::to_string(dimension) + "D",
                      .dimension = dimension,
                      .precision = dimension == 2 ? "single" : "double",
                      .first = lines});
    }
  }
  return list;
}

std::vector<Variant> methods() {
  std::vector<Variant> list;
  for (const char* transfer : {"pic", "flip", "pic_flip", "apic"}) {
    for (const int dimension : {2, 3}) {
      for (const char* precision : {"single", "double"}) {
        list.push_back({.name = std::string(transfer) + "_" + std::to_string(dimension) + "D_" + precision,
                        .dimension = dimension,
                        .precision = precision,
                        .transfer = transfer});
      }
    }
  }
  list.push_back({.name = "gradient_form", .more = "method.form = \"gradient\"\n"});
  list.push_back({.name = "cubic_kernel", .transfer = "flip", .more = "method.kernel = \"cubic\"\n"});
  list.push_back({.name = "periodic", .more = "method.periodic = [1.6, 0]\n"});
  list.push_back({.name = "without_rollback", .more = "rollback = \"off\"\n"});
  list.push_back({.name = "parked", .more = "limits.speed = 4.6\n"});
  list.push_back({.name = "varied", .first = "preset = \"snow\"\nyoungs_modulus = {value = 1e5, spread = 0.3}\n"});
  return list;
}

std::string name_of(const testing::TestParamInfo<Variant>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Models, Resume, testing::ValuesIn(models()), name_of);
INSTANTIATE_TEST_SUITE_P(Methods, Resume, testing::ValuesIn(methods()), name_of);

TEST(ResumeModels, AllOfThemAreTested) { EXPECT_EQ(models().size(), 2 * all_models().size()); }

TEST(ResumeEverywhere, AtEveryStepOfAFrame) {
  const Variant v = {.transfer = "flip"};
  const auto whole = make(v);
  finish(*whole);
  const std::int64_t steps = make(v)->advance_frame().steps;
  ASSERT_GT(steps, 10);
  for (std::int64_t step = 1; step <= steps + 1; ++step) {
    const auto first = make(v);
    take_steps(*first, step);
    const auto second = make(v);
    second->restore(first->checkpoint());
    finish(*second);
    ASSERT_EQ(second->hash(), whole->hash()) << step;
  }
}

TEST(ResumeEverywhere, APauseChangesNothing) {
  const Variant v;
  const auto whole = make(v), paused = make(v);
  finish(*whole);
  while (paused->frame() < paused->frame_count()) paused->advance_frame(after(3));
  EXPECT_EQ(paused->hash(), whole->hash());
  EXPECT_TRUE(equal(paused->report(), whole->report()));
}

/// A soft disk at rest on sticky ground that, in the middle of the second frame, a field pulls down by more than a
/// cell within a time step, so that the frame is taken back.
std::unique_ptr<Simulation> make_violent(const char* pull) {
  return Simulation::create(parse_scene(
      std::string("dimension = 2\nend_time = 0.02\nframe_rate = 100\nresolution.particles = 600\nthreads = 1\n") +
          "limits.particle_cfl = 1\nlimits.elastic_cfl = 1\nlimits.max_dt = 1e-3\n"
          "[material.stuff]\nmodel = \"neo_hookean\"\nyoungs_modulus = 1e4\n"
          "[[body]]\nshape = \"disk\"\nradius = 0.2\nposition = [0, 0.2]\nmaterial = \"stuff\"\n"
          "[[field]]\ntype = \"acceleration\"\nacceleration = [\"0\", \"t > 0.0145 ? -" +
          pull + " : 0\"]\n[[collider]]\nshape = \"half_space\"\ncontact = \"sticky\"\n",
      "test.toml"));
}

/// Goes on to the end; the error that ended it, if one did.
std::string end_of(Simulation& simulation, int* retries = nullptr) {
  try {
    while (simulation.frame() < simulation.frame_count()) {
      const FrameReport report = simulation.advance_frame();
      if (retries) *retries += report.retries;
    }
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(ResumeAfterRollback, ReducedLimitsAndTheFramesBeginningComeBack) {
  const LogSink before = set_log_sink({});
  for (const char* pull : {"1e5", "3e5"}) {
    const auto whole = make_violent(pull);
    int retries = 0;
    EXPECT_EQ(end_of(*whole, &retries), "");
    ASSERT_GT(retries, 0) << "the scene must take frames back";
    int restored = 0;
    // In the middle of attempts that fail, of later ones, and after them.
    for (std::int64_t step = 1;; step += 2) {
      const auto first = make_violent(pull), second = make_violent(pull);
      take_steps(*first, step);
      if (first->frame() == first->frame_count()) break;
      second->restore(first->checkpoint());
      ++restored;
      EXPECT_EQ(end_of(*second), "") << step;
      EXPECT_EQ(second->hash(), whole->hash()) << step;
      EXPECT_TRUE(equal(second->report(), whole->report())) << step;
    }
    EXPECT_GT(restored, 10);
  }
  // Control: without the frame's beginning there is nothing to take an attempt that fails back to.
  int failed = 0;
  for (std::int64_t step = 1; step <= 20; ++step) {
    const auto first = make_violent("3e5"), second = make_violent("3e5");
    take_steps(*first, step);
    Checkpoint without = first->checkpoint();
    if (!without.frame_start) continue;
    without.frame_start.reset();
    second->restore(without);
    failed += !end_of(*second).empty();
  }
  EXPECT_GT(failed, 0);
  set_log_sink(before);
}

// ---- each stored value is needed, and what does not fit is refused

Checkpoint in_a_frame(const Variant& v) {
  const auto simulation = make(v);
  take_steps(*simulation, count_steps(v) - 5);
  return simulation->checkpoint();
}

/// The final state after going on from a checkpoint, or the error.
struct Outcome {
  std::uint64_t hash = 0;
  FrameReport report;
  std::string error;
  bool operator==(const Outcome& other) const {
    return error == other.error && hash == other.hash && equal(report, other.report);
  }
};

Outcome outcome_of(const Variant& v, const Checkpoint& checkpoint) {
  const auto simulation = make(v);
  const std::uint64_t before = simulation->hash();
  try {
    simulation->restore(checkpoint);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::files) << error.what();
    EXPECT_EQ(simulation->hash(), before) << "a refused checkpoint leaves the state as it was: " << error.what();
    return {0, {}, error.what()};
  }
  const std::optional<FrameReport> report = simulation->advance_frame(Pause());
  return {simulation->hash(), *report, ""};
}

TEST(CheckpointEntries, ALostOneIsRefusedByName) {
  const Variant v;
  const Checkpoint good = in_a_frame(v);
  ASSERT_EQ(outcome_of(v, good).error, "");
  const auto expect_refused = [&](const std::string& name, const std::function<void(Checkpoint&)>& drop) {
    Checkpoint damaged = good;
    drop(damaged);
    const std::string error = outcome_of(v, damaged).error;
    EXPECT_NE(error.find(name), std::string::npos) << name << ": " << error;
  };
  for (const auto& [name, value] : good.state.numbers) {
    expect_refused(name, [&](Checkpoint& c) { c.state.numbers.erase(name); });
  }
  for (const auto& [name, value] : good.state.counters) {
    expect_refused(name, [&](Checkpoint& c) { c.state.counters.erase(name); });
  }
  for (const auto& [name, value] : good.state.texts) {
    if (name != "next.limit") expect_refused(name, [&](Checkpoint& c) { c.state.texts.erase(name); });
  }
  for (const auto& [name, value] : good.state.materials[0].numbers) {
    expect_refused(name, [&](Checkpoint& c) { c.state.materials[0].numbers.erase(name); });
  }
  for (std::size_t i = 0; i < good.state.materials[0].columns.size(); ++i) {
    expect_refused(good.state.materials[0].columns[i].name, [&](Checkpoint& c) {
      auto& columns = c.state.materials[0].columns;
      columns.erase(columns.begin() + static_cast<std::ptrdiff_t>(i));
    });
  }
  expect_refused("materials", [](Checkpoint& c) { c.state.materials.pop_back(); });
}

TEST(CheckpointEntries, EveryBitOfAColumnCounts) {
  for (const Variant& v : {Variant{}, Variant{.dimension = 3, .precision = "double", .transfer = "flip"}}) {
    const Checkpoint good = in_a_frame(v);
    for (std::size_t m = 0; m < 2; ++m) {
      for (std::size_t i = 0; i < good.state.materials[m].columns.size(); ++i) {
        Checkpoint damaged = good;
        CheckpointColumn& column = damaged.state.materials[m].columns[i];
        std::visit(
            [&](auto& values) {
              auto* bytes = reinterpret_cast<unsigned char*>(&values[values.size() / 2]);
              *bytes = static_cast<unsigned char>(*bytes ^ 1u);
            },
            column.values);
        EXPECT_NE(outcome_of(v, damaged).error, "") << column.name;
      }
    }
  }
}

TEST(CheckpointEntries, EveryNumberOfTheClockCounts) {
  // Bounds so wide that a frame's last step is not the only one that is left.
  const Variant v = {.more = "limits.speed = 100\n"};
  const auto simulation = make(v);
  take_steps(*simulation, count_steps(v) / 3);
  const Checkpoint good = simulation->checkpoint();
  const Outcome expected = outcome_of(v, good);
  ASSERT_EQ(expected.error, "");
  const auto expect_other = [&](const std::string& name, const std::function<void(Checkpoint&)>& change) {
    Checkpoint changed = good;
    change(changed);
    EXPECT_FALSE(outcome_of(v, changed) == expected) << name << " has no effect";
  };
  for (const char* name : {"time", "report.dt", "next.dt"}) {
    expect_other(name, [&](Checkpoint& c) { c.state.numbers.at(name) *= 0.5; });
  }
  for (const char* name : {"steps", "parked", "frame", "halvings", "report.steps", "attempt"}) {
    expect_other(name, [&](Checkpoint& c) { ++c.state.counters.at(name); });
  }
  // The reason for the shortest step stays where that step was before the checkpoint.
  Checkpoint short_step = good, other_reason = good;
  for (Checkpoint* each : {&short_step, &other_reason}) each->state.numbers.at("report.dt") = 1e-12;
  other_reason.state.texts.at("report.limit") = "another reason";
  EXPECT_FALSE(outcome_of(v, short_step) == outcome_of(v, other_reason));
}

TEST(CheckpointEntries, EverySpeedCounts) {
  // At the end of a frame, where the speeds choose the next step.
  const Variant v;
  const auto simulation = make(v);
  simulation->advance_frame();
  const Checkpoint good = simulation->checkpoint();
  const Outcome expected = outcome_of(v, good);
  const auto expect_other = [&](const std::string& name, const std::function<void(Checkpoint&)>& change) {
    Checkpoint changed = good;
    change(changed);
    EXPECT_FALSE(outcome_of(v, changed) == expected) << name << " has no effect";
  };
  expect_other("max_speed", [](Checkpoint& c) { c.state.numbers.at("max_speed") *= 2; });
  expect_other("max_collider_speed", [](Checkpoint& c) { c.state.numbers.at("max_collider_speed") = 1e3; });
  expect_other("kinematic_viscosity",
               [](Checkpoint& c) { c.state.materials[0].numbers.at("kinematic_viscosity") = 1e2; });
  expect_other("wave_speed", [](Checkpoint& c) {
    for (CheckpointMaterial& material : c.state.materials) material.numbers.at("wave_speed") *= 2;
  });
  // Of a material: what FLIP adds to.
  const Variant flip = {.transfer = "flip"};
  const auto other = make(flip);
  other->advance_frame();
  Checkpoint changed = other->checkpoint();
  const Outcome before = outcome_of(flip, changed);
  for (CheckpointMaterial& material : changed.state.materials) material.numbers.at("max_speed") *= 10;
  EXPECT_FALSE(outcome_of(flip, changed) == before);
}

TEST(CheckpointEntries, WhatDoesNotFitIsRefusedAndLeavesTheStateAlone) {
  const Variant v;
  const Checkpoint good = in_a_frame(v);
  const auto expect_refused = [&](const Variant& other, const std::string& words) {
    const std::string error = outcome_of(other, good).error;
    EXPECT_NE(error.find(words), std::string::npos) << words << ": " << error;
  };
  expect_refused({.precision = "double"}, "2D, single precision");
  expect_refused({.dimension = 3}, "3D, single precision");
  expect_refused({.more = "method.kernel = \"cubic\"\n"}, "cubic kernel");
  expect_refused({.more = "method.form = \"gradient\"\n"}, "grad_v");
  expect_refused({.first = "preset = \"water\"\n"}, "newtonian_fluid");
  expect_refused({.first = "preset = \"snow\"\nyoungs_modulus = {value = 1e5, spread = 0.3}\n"},
                 "history.youngs_modulus");
}

TEST(CheckpointEntries, OtherLimitsActOnWhatComesNext) {
  const Variant v;
  const Checkpoint good = in_a_frame(v);
  const auto slow = make({.more = "limits.max_dt = 1e-5\n"});
  slow->restore(good);
  slow->advance_frame();
  EXPECT_EQ(slow->advance_frame().limit, "max_dt");
}

}  // namespace
}  // namespace firn
