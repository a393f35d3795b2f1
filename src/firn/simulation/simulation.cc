#include <firn/core/error.h>
#include <firn/core/log.h>
#include <firn/core/simd.h>
#include <firn/integrators/step.h>
#include <firn/integrators/verbs.h>
#include <firn/materials/model_info.h>
#include <firn/scene/force_fields.h>
#include <firn/scene/vary_parameters.h>
#include <firn/simulation/checkpoint_state.h>
#include <firn/simulation/endless_step.h>
#include <firn/simulation/frame_state.h>
#include <firn/simulation/live_changes.h>
#include <firn/simulation/runaways.h>
#include <firn/simulation/simulation.h>
#include <firn/simulation/sources.h>
#include <firn/simulation/world_change.h>
#include <firn/simulation/world_report.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace firn {
namespace {

constexpr int kMaxTries = 3;

template <class Real, int dim>
class SimulationOf final : public Simulation {
 public:
  SimulationOf(const Scene& scene, const PlanCheck& check)
      : Simulation(scene),
        arena_(scene.threads > 0 ? scene.threads : static_cast<int>(tbb::task_arena::automatic)),
        guard_(scene.limits) {
    if (scene.threads > 0) {
      // An arena alone does not get more threads than the machine has processors.
      thread_limit_.emplace(
          tbb::global_control::max_allowed_parallelism,
          std::max<std::size_t>(static_cast<std::size_t>(scene.threads),
                                tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism)));
    }
    auto built = build_world<Real, dim>(scene_, check);
    plan_ = std::move(built.plan);
    tractions_ = std::move(built.tractions);
    world_ = std::make_unique<World<Real, dim>>(std::move(built.world));
    set_limits();
    for (const auto& material : world_->materials) material_names_.push_back(material.name);
    sources_ = std::make_unique<Sources<Real, dim>>(scene_, plan_, *world_);
    StepReport prepared;
    arena_.execute([&] {
      prepared = prepare(*world_);
      if (!prepared.failure) sources_->act(*world_);
    });
    if (prepared.failure) fail(*prepared.failure, 0);
    report_.limit = "start";
    report_.colliders = collider_reports(0);
    note_particles();
  }

  double time() const override { return world_->t; }
  std::int64_t particle_count() const override { return static_cast<std::int64_t>(world_->particle_count()); }
  FrameReport report() const override { return report_; }
  VerbTimes verb_times() const override { return world_->verb_times; }

  StepOutlook outlook() const override {
    const TimeStep step = choose_step(world_->t, std::nullopt);
    StepOutlook outlook = {step.dt, step.describe(material_names_)};
    for (const auto& material : world_->materials) outlook.wave_speeds.push_back(material.wave_speed);
    return outlook;
  }

  TimeStep step() override {
    const double until = frame_time(frame_ + 1);
    TimeStep taken;
    std::optional<ParticleFailure> failure;
    arena_.execute([&] {
      sources_->set_pins(*world_);
      taken = choose_step(world_->t, until);
      failure = step_explicit(*world_, taken.dt).failure;
      if (failure) return;
      guard_.park_fast(*world_);
      sources_->act(*world_);
    });
    if (failure) fail(*failure, taken.dt);
    return taken;
  }

  std::optional<FrameReport> advance_frame(const Pause& pause) override {
    const auto start = std::chrono::steady_clock::now();
    failed_particle_.reset();
    int attempt = 0;
    double seconds_before = 0;
    std::optional<TimeStep> promised;
    if (paused_) {
      attempt = paused_->attempt;
      seconds_before = report_.wall_seconds;
      promised = paused_->next;
      paused_.reset();
    } else {
      keep();
    }
    std::optional<ParticleFailure> failure;
    for (;; ++attempt) {
      failure = try_frame(promised, pause);
      report_.wall_seconds =
          seconds_before + std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      if (paused_) {
        paused_->attempt = attempt;
        return std::nullopt;
      }
      if (!failure) {
        report_.retries = attempt;
        return report_;
      }
      if (!kept_ || attempt + 1 == kMaxTries || failure->cause == kTooFast) break;
      retry(*failure);
      promised.reset();
    }
    const std::string text = describe(*failure, report_.dt);
    failed_particle_ = {failure->id, material_names_[failure->material], {}};
    std::copy_n(failure->position.begin(), dim, failed_particle_->position.e);
    if (kept_) {
      take_back();
      report_ = kept_->report;
    }
    throw Error(ErrorKind::numerical, text);
  }

  Checkpoint checkpoint() const override {
    if (!world_->drained) throw Error(ErrorKind::usage, "a checkpoint must be taken where a frame ends or pauses");
    Checkpoint checkpoint;
    checkpoint.arithmetic = simd_target() == "baseline" ? "separate" : "fused";
    checkpoint.layout = layout_text(*world_);
    checkpoint.state = present_state();
    if (paused_ && kept_) checkpoint.frame_start = saved(*kept_, {kept_->particles.begin(), kept_->particles.end()});
    return checkpoint;
  }

  void restore(const Checkpoint& checkpoint) override {
    if (const std::string layout = layout_text(*world_); layout != checkpoint.layout) {
      throw Error(ErrorKind::files,
                  fmt::format("the checkpoint cannot be used: it is {}, and the scene {}", checkpoint.layout, layout));
    }
    // Everything that can be refused comes before the first change.
    Restored restored = read_state(checkpoint.state);
    std::optional<FrameState<Real, dim>> frame_start;
    if (checkpoint.frame_start) frame_start = read_state(*checkpoint.frame_start).state;
    std::optional<Paused> paused;
    if (checkpoint.state.texts.contains("next.limit")) paused = read_paused(checkpoint.state);
    const auto& state = restored.state;
    const std::string found = fmt::format(
        "{:016x}",
        hash_of<Real, dim>({state.particles.begin(), state.particles.end()}, state.t, state.steps, restored.frame));
    if (const std::string& expected = text_of(checkpoint.state, "hash"); found != expected) {
      throw Error(ErrorKind::files, fmt::format("the checkpoint cannot be used: it does not lead to the state that was "
                                                "saved (its hash is {}, and was {})",
                                                found, expected));
    }

    kept_ = std::move(restored.state);
    take_back();
    frame_ = restored.frame;
    halvings_ = restored.halvings;
    set_limits();
    report_ = kept_->report;
    kept_ = std::move(frame_start);
    paused_ = std::move(paused);
    if (!paused_) return;
    limit_name_ = paused_->next.limit;
    paused_->next.limit = limit_name_;
  }

  Snapshot snapshot(Snapshot memory) const override {
    Snapshot snapshot;
    arena_.execute([&] { snapshot = snapshot_of<Real, dim>(*world_, scene_, plan_, std::move(memory)); });
    return snapshot;
  }

  void change(const Scene& scene) override {
    if (paused_) throw Error(ErrorKind::usage, "a scene cannot be changed in the middle of a frame");
    if (!is_all_live(scene_, scene)) {
      throw Error(ErrorKind::usage, "the scene differs in what cannot change while it is simulated; reset begins anew");
    }
    // Everything that can be refused comes before the first change.
    check_materials(scene, plan_.cell_size);
    const std::vector<Collider<dim>> added = new_colliders<dim>(scene_, scene, plan_.cell_size);
    const BodyForce<dim> force = force_of<dim>(scene, tractions_);
    arena_.execute([&] {
      const std::size_t before = world_->materials.size();
      const Scene old = std::exchange(scene_, scene);
      add_new_materials<Real, dim>(*world_, scene_, plan_.cell_size, force);
      auto counts = sources_->counts();
      try {
        sources_ = std::make_unique<Sources<Real, dim>>(scene_, plan_, *world_);
      } catch (...) {
        world_->materials.erase(world_->materials.begin() + static_cast<std::ptrdiff_t>(before),
                                world_->materials.end());
        scene_ = old;
        sources_ = std::make_unique<Sources<Real, dim>>(scene_, plan_, *world_);
        sources_->restore(counts);
        throw;
      }
      counts.emitted.resize(scene_.emitters.size());
      counts.last_slot.resize(scene_.emitters.size(), -1);
      sources_->restore(counts);
      goes_on_after_change(change_world<Real, dim>(*world_, old, scene_, plan_.cell_size, added));
    });
    kept_.reset();
  }

  GridValues grid() const override {
    GridSampler<Real, dim> sampler(world_->grid, world_->transfer.affine);
    for (const auto& material : world_->materials) sampler.add(material.particles);
    return sampler.values();
  }

  Totals totals() const override {
    Totals sum;
    arena_.execute([&] { sum = totals_of(*world_); });
    return sum;
  }

  std::vector<ProbeValue> probe(std::span<const Vec3d> points) const override {
    std::vector<ProbeValue> values;
    arena_.execute([&] { values = probe_values(*world_, points); });
    return values;
  }

  std::uint64_t hash() const override { return hash_of(particles_of(*world_), world_->t, world_->steps, frame_); }

 private:
  /// Where a frame has paused.
  struct Paused {
    TimeStep next;
    int attempt = 0;
  };

  struct Restored {
    FrameState<Real, dim> state;
    std::int64_t frame;
    int halvings;
  };

  FrameState<Real, dim> present() const {
    FrameState<Real, dim> state = state_without_particles(*world_);
    state.parked = guard_.parked();
    state.counts = sources_->counts();
    state.loads_since = loads_since_;
    state.report = report_;
    return state;
  }

  void goes_on_after_change(bool other_stress) {
    report_.colliders.resize(scene_.colliders.size());
    for (std::size_t m = material_names_.size(); m < world_->materials.size(); ++m) {
      material_names_.push_back(world_->materials[m].name);
    }
    const std::int64_t parked = guard_.parked();
    guard_ = RunawayGuard<Real, dim>(scene_.limits);
    guard_.restore(parked);
    set_limits();
    activate_blocks(*world_);
    // Only where it must be: what time step control knows of a run that goes on is more than what it begins with.
    if (other_stress) {
      if (const StepReport prepared = prepare(*world_); prepared.failure) fail(*prepared.failure, 0);
    }
    sources_->act(*world_);
    note_particles();
  }

  void keep() {
    if (scene_.rollback == Scene::Rollback::off) return;
    kept_ = present();
    for (const auto& material : world_->materials) kept_->particles.push_back(material.particles);
  }

  CheckpointState saved(const FrameState<Real, dim>& state, const ParticleList<Real, dim>& particles) const {
    CheckpointState saved = save_state(state, particles, scene_, *world_);
    saved.counters["frame"] = frame_;
    saved.counters["halvings"] = halvings_;
    return saved;
  }

  CheckpointState present_state() const {
    CheckpointState state = saved(present(), particles_of(*world_));
    state.texts["hash"] = fmt::format("{:016x}", hash());
    if (paused_) {
      state.numbers["next.dt"] = paused_->next.dt;
      state.texts["next.limit"] = paused_->next.limit;
      state.counters["next.material"] = paused_->next.material;
      state.counters["attempt"] = paused_->attempt;
    }
    return state;
  }

  Restored read_state(const CheckpointState& saved) const {
    Restored restored = {{}, counter_of(saved, "frame"), static_cast<int>(counter_of(saved, "halvings"))};
    arena_.execute([&] { restored.state = load_state<Real, dim>(saved, scene_, *world_); });
    return restored;
  }

  Paused read_paused(const CheckpointState& state) const {
    Paused paused;
    paused.next.dt = number_of(state, "next.dt");
    paused.next.limit = text_of(state, "next.limit");
    paused.next.material = static_cast<int>(counter_of(state, "next.material"));
    if (paused.next.material >= static_cast<int>(material_names_.size()) || !(paused.next.dt > 0)) {
      throw Error(ErrorKind::files, "the checkpoint cannot be used: its next step is not one of this scene");
    }
    paused.attempt = static_cast<int>(counter_of(state, "attempt"));
    return paused;
  }

  void take_back() {
    arena_.execute([&] { put_back(*kept_, *world_); });
    guard_.restore(kept_->parked);
    sources_->restore(kept_->counts);
    loads_since_ = kept_->loads_since;
  }

  void retry(const ParticleFailure& failure) {
    log_warning(
        fmt::format("{}; taking frame {} back and halving the time step", describe(failure, report_.dt), frame_ + 1));
    take_back();
    ++halvings_;
    set_limits();
  }

  void set_limits() {
    limits_.particle_cfl = std::ldexp(scene_.limits.particle_cfl, -halvings_);
    limits_.elastic_cfl = std::ldexp(scene_.limits.elastic_cfl, -halvings_);
    limits_.max_dt = std::ldexp(scene_.limits.max_dt.value_or(std::numeric_limits<double>::infinity()), -halvings_);
  }

  /// @param promised the next step, where a paused frame goes on
  std::optional<ParticleFailure> try_frame(const std::optional<TimeStep>& promised, const Pause& pause) {
    std::optional<ParticleFailure> failure;
    if (!promised) {
      loads_since_ = world_->t;
      world_->collider_loads.assign(world_->colliders.size(), {});
    }
    arena_.execute([&] { failure = try_steps(frame_time(frame_ + 1), promised, pause); });
    if (failure || paused_) return failure;
    arena_.execute([&] { guard_.park_far(*world_); });
    ++frame_;
    report_.frame = frame_;
    report_.time = world_->t;
    report_.colliders = collider_reports(world_->t - loads_since_);
    note_particles();
    return std::nullopt;
  }

  void note_particles() {
    report_.particles = particle_count();
    report_.parked = guard_.parked();
    report_.emitted = sources_->counts().emitted;
    report_.removed = sources_->counts().removed;
  }

  /// How long a step from time t is, of those that lead to the next event or to the end of the frame; without `until`,
  /// as long as it may be.
  TimeStep choose_step(double t, std::optional<double> until) const {
    const auto bound = sources_->longest_step(*world_, t, limits_.particle_cfl);
    TimeStepLimits limits = limits_;
    limits.max_dt = std::min(limits_.max_dt, bound.dt);
    TimeStep step = until ? choose_time_step(*world_, limits, std::min(*until, sources_->next_event(t)) - t)
                          : choose_time_step(*world_, limits);
    if (step.limit == "max_dt" && bound.dt < limits_.max_dt) step.limit = bound.limit;
    return step;
  }

  /// @param duration how long the loads have been counted, s; 0 for not at all
  std::vector<ColliderReport> collider_reports(double duration) const {
    std::vector<ColliderReport> reports;
    arena_.execute([&] { reports = reports_of_colliders(*world_, scene_.colliders.size(), duration); });
    return reports;
  }

  std::optional<ParticleFailure> try_steps(double until, const std::optional<TimeStep>& promised, const Pause& pause) {
    if (!promised) {
      report_ = {};
      report_.dt = std::numeric_limits<double>::infinity();
    }
    TimeStep next = promised ? *promised : choose_step(world_->t, until);
    while (world_->t < until) {
      const TimeStep taken = next;
      if (is_endless(taken, scene_.frame_rate)) {
        note_step(taken, true);
        return fastest_particle(*world_);
      }
      bool drained = false, stop = false;
      sources_->set_pins(*world_);
      const StepReport step = step_explicit(*world_, taken.dt, [&] {
        stop = pause && pause();
        // What is left behind the last step of a frame is round-off.
        const double remaining = until - (world_->t + taken.dt);
        const bool due = sources_->due(*world_, taken.dt);
        drained = remaining < 1e-9 * taken.dt || guard_.may_park(*world_) || due;
        if (drained) return 0.0;
        next = choose_step(world_->t + taken.dt, until);
        drained = !(next.dt > 0) || is_endless(next, scene_.frame_rate);
        // To stop drains the state as well, but the next step stays the one that is chosen here: the step after a pause
        // must be as long as without it.
        return stop ? 0.0 : next.dt;
      });
      note_step(taken, step.failure.has_value());
      if (step.failure) return step.failure;
      if (drained) {
        guard_.park_fast(*world_);
        // The last step of a frame lands on its time.
        const bool is_last = until - world_->t < 1e-9 * taken.dt;
        if (is_last) world_->t = until;
        sources_->act(*world_);
        if (!is_last) next = choose_step(world_->t, until);
      }
      if (stop && world_->t < until) {
        paused_ = {next, 0};
        break;
      }
    }
    return std::nullopt;
  }

  void note_step(const TimeStep& taken, bool failed) {
    ++report_.steps;
    // That the frame ends is a reason only where nothing else is.
    if (failed || report_.limit == "frame" || report_.limit.empty() ||
        (taken.dt < report_.dt && taken.limit != "frame")) {
      report_.dt = taken.dt;
      report_.limit = taken.describe(material_names_);
    }
  }

  std::string describe(const ParticleFailure& failure, double dt) const {
    if (failure.cause == kTooFast) {
      return describe_endless(failure, world_->materials[failure.material].name, report_.limit, world_->steps,
                              world_->t, dt);
    }
    return failure_text<Real, dim>(*world_, failure, dt);
  }

  [[noreturn]] void fail(const ParticleFailure& failure, double dt) const {
    throw Error(ErrorKind::numerical, describe(failure, dt));
  }

  mutable tbb::task_arena arena_;
  std::optional<tbb::global_control> thread_limit_;
  std::unique_ptr<World<Real, dim>> world_;
  std::unique_ptr<Sources<Real, dim>> sources_;
  std::shared_ptr<const Tractions<dim>> tractions_;
  TimeStepLimits limits_;
  RunawayGuard<Real, dim> guard_;
  std::vector<std::string> material_names_;
  int halvings_ = 0;  ///< of the limits, since frames were taken back
  std::optional<FrameState<Real, dim>> kept_;
  std::optional<Paused> paused_;
  std::string limit_name_;  ///< of a restored next step, which refers to it
  FrameReport report_;
  double loads_since_ = 0;  ///< s; when the loads of colliders were last set to zero
};

}  // namespace

std::int64_t Simulation::frame_count() const {
  // A frame that would come a rounding error after the end still belongs to the run.
  return static_cast<std::int64_t>(std::floor(scene_.end_time * scene_.frame_rate * (1 + 1e-12))) + 1;
}

std::unique_ptr<Simulation> Simulation::create(const Scene& scene, const PlanCheck& check) {
  const bool single = scene.precision == Scene::Precision::single;
  if (scene.dimension == 2) {
    if (single) return std::make_unique<SimulationOf<float, 2>>(scene, check);
    return std::make_unique<SimulationOf<double, 2>>(scene, check);
  }
  if (single) return std::make_unique<SimulationOf<float, 3>>(scene, check);
  return std::make_unique<SimulationOf<double, 3>>(scene, check);
}

}  // namespace firn
