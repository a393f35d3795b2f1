#include <firn/core/error.h>
#include <firn/core/log.h>
#include <firn/integrators/step.h>
#include <firn/integrators/verbs.h>
#include <firn/materials/model_info.h>
#include <firn/measure/output_columns.h>
#include <firn/scene/vary_parameters.h>
#include <firn/simulation/runaways.h>
#include <firn/simulation/simulation.h>
#include <firn/simulation/sources.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
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
  explicit SimulationOf(const Scene& scene)
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
    auto built = build_world<Real, dim>(scene_);
    plan_ = std::move(built.plan);
    world_ = std::make_unique<World<Real, dim>>(std::move(built.world));
    limits_.particle_cfl = scene.limits.particle_cfl;
    limits_.elastic_cfl = scene.limits.elastic_cfl;
    if (scene.limits.max_dt) limits_.max_dt = *scene.limits.max_dt;
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

  FrameReport advance_frame() override {
    const auto start = std::chrono::steady_clock::now();
    keep();
    std::optional<ParticleFailure> failure;
    for (int attempt = 0; attempt < kMaxTries; ++attempt) {
      if (attempt > 0) retry(*failure);
      failure = try_frame();
      if (!failure) {
        report_.retries = attempt;
        report_.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        return report_;
      }
      if (!kept_) break;
    }
    const std::string text = describe(*failure, report_.dt);
    if (kept_) {
      restore();
      report_ = kept_->report;
    }
    throw Error(ErrorKind::numerical, text);
  }

  Snapshot snapshot() const override {
    Snapshot snapshot;
    snapshot.dimension = dim;
    snapshot.time = world_->t;
    snapshot.cell_size = world_->grid.dx();
    for (const BodySettings& body : scene_.bodies) snapshot.bodies.push_back(body.name);
    for (const EmitterSettings& emitter : scene_.emitters) snapshot.bodies.push_back(emitter.name);
    double smallest = scene_.emitters.empty() ? 0 : plan_.particle_volume;
    for (const WorldPlan::Body& body : plan_.bodies) {
      const double each = body.volume / static_cast<double>(body.particles);
      smallest = smallest == 0 ? each : std::min(smallest, each);
    }
    snapshot.particle_spacing = std::pow(smallest, 1.0 / dim);
    const std::vector<Parameter> varied = varied_parameters(scene_);
    arena_.execute([&] {
      for (std::size_t m = 0; m < world_->materials.size(); ++m) {
        const auto& material = world_->materials[m];
        const MaterialSettings& settings = scene_.materials[m];
        append_to_snapshot<Real, dim>(snapshot, material.particles, material.model, material.parameters,
                                      {material.name, settings.model, settings.preset, varied}, world_->grid.dx(),
                                      world_->transfer.kernel);
      }
    });
    return snapshot;
  }

  Totals totals() const override {
    Totals sum;
    arena_.execute([&] {
      for (const auto& material : world_->materials) {
        sum += measure_totals<Real, dim>(
            material.particles, material.model, material.parameters,
            {world_->grid.dx(), world_->transfer.kernel, world_->transfer.affine, world_->gravity});
      }
    });
    return sum;
  }

  std::vector<ProbeValue> probe(std::span<const Vec3d> points) const override {
    std::vector<Vec<double, dim>> places(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) std::copy_n(points[i].e, dim, places[i].e);
    std::vector<ProbeSums> sums(points.size());
    arena_.execute([&] {
      for (const auto& material : world_->materials) {
        add_to_probes<Real, dim>(places, material.particles, material.model, material.parameters, world_->grid.dx(),
                                 world_->transfer.kernel, world_->grid.period(), sums);
      }
    });
    std::vector<ProbeValue> values;
    for (const ProbeSums& sum : sums) values.push_back(probe_value(sum, world_->grid.dx(), dim));
    return values;
  }

  std::uint64_t hash() const override {
    const std::uint64_t clock[2] = {world_->steps, static_cast<std::uint64_t>(frame_)};
    std::uint64_t hash = XXH64(clock, sizeof(clock), XXH64(&world_->t, sizeof(world_->t), 1));
    for (const auto& material : world_->materials) {
      const std::uint64_t part = material.particles.hash();
      hash = XXH64(&part, sizeof(part), hash);
    }
    return hash;
  }

 private:
  /// What a frame can be taken back to.
  struct Kept {
    std::vector<Particles<Real, dim>> particles;
    std::vector<std::array<double, 3>> speeds;  ///< largest, of waves, viscosity
    double t, max_speed, max_collider_speed;
    std::uint64_t steps;
    std::int64_t parked;
    typename Sources<Real, dim>::Counts counts;
    FrameReport report;
  };

  void keep() {
    if (scene_.rollback == Scene::Rollback::off) return;
    kept_.emplace();
    for (const auto& material : world_->materials) {
      kept_->particles.push_back(material.particles);
      kept_->speeds.push_back({material.max_speed, material.wave_speed, material.kinematic_viscosity});
    }
    kept_->t = world_->t;
    kept_->max_speed = world_->max_speed;
    kept_->max_collider_speed = world_->max_collider_speed;
    kept_->steps = world_->steps;
    kept_->parked = guard_.parked();
    kept_->counts = sources_->counts();
    kept_->report = report_;
  }

  void restore() {
    for (std::size_t m = 0; m < world_->materials.size(); ++m) {
      auto& material = world_->materials[m];
      material.particles = kept_->particles[m];
      material.max_speed = kept_->speeds[m][0];
      material.wave_speed = kept_->speeds[m][1];
      material.kinematic_viscosity = kept_->speeds[m][2];
    }
    world_->t = kept_->t;
    world_->max_speed = kept_->max_speed;
    world_->max_collider_speed = kept_->max_collider_speed;
    world_->scattered_dt.reset();
    world_->drained = true;
    arena_.execute([&] { activate_blocks(*world_); });
    world_->steps = kept_->steps;
    guard_.restore(kept_->parked);
    sources_->restore(kept_->counts);
  }

  void retry(const ParticleFailure& failure) {
    log_warning(
        fmt::format("{}; taking frame {} back and halving the time step", describe(failure, report_.dt), frame_ + 1));
    restore();
    limits_.particle_cfl /= 2;
    limits_.elastic_cfl /= 2;
    limits_.max_dt /= 2;
  }

  std::optional<ParticleFailure> try_frame() {
    std::optional<ParticleFailure> failure;
    const double start = world_->t;
    world_->collider_loads.assign(world_->colliders.size(), {});
    arena_.execute([&] { failure = try_steps(frame_time(frame_ + 1)); });
    if (failure) return failure;
    arena_.execute([&] { guard_.park_far(*world_); });
    ++frame_;
    report_.frame = frame_;
    report_.time = world_->t;
    report_.colliders = collider_reports(world_->t - start);
    note_particles();
    return std::nullopt;
  }

  void note_particles() {
    report_.particles = particle_count();
    report_.parked = guard_.parked();
    report_.emitted = sources_->counts().emitted;
    report_.removed = sources_->counts().removed;
  }

  /// How long a step from time t is, of those that lead to the next event or to the end of the frame.
  TimeStep choose_step(double t, double until) const {
    const auto bound = sources_->longest_step(*world_, t, limits_.particle_cfl);
    TimeStepLimits limits = limits_;
    limits.max_dt = std::min(limits_.max_dt, bound.dt);
    TimeStep step = choose_time_step(*world_, limits, std::min(until, sources_->next_event(t)) - t);
    if (step.limit == "max_dt" && bound.dt < limits_.max_dt) step.limit = bound.limit;
    return step;
  }

  /// Of the scene's colliders, behind which the world has its pins.
  /// @param duration how long the loads have been counted, s; 0 for not at all
  std::vector<ColliderReport> collider_reports(double duration) const {
    const auto solids = std::span<const Collider<dim>>(world_->colliders).first(scene_.colliders.size());
    std::vector<ColliderReport> reports(solids.size());
    for (std::size_t k = 0; k < reports.size() && duration > 0; ++k) {
      const ColliderLoad& load = world_->collider_loads[k];
      reports[k].force = (1 / duration) * load.impulse;
      reports[k].torque = (1 / duration) * load.angular_impulse;
      reports[k].caught = load.caught;
    }
    arena_.execute([&] {
      for (const auto& material : world_->materials) {
        const auto inside = measure_penetration<Real, dim>(material.particles, world_->grid.dx(),
                                                           world_->transfer.kernel, solids, world_->t);
        for (std::size_t k = 0; k < reports.size(); ++k) reports[k].inside += inside[k];
      }
    });
    return reports;
  }

  std::optional<ParticleFailure> try_steps(double until) {
    report_ = {};
    report_.dt = std::numeric_limits<double>::infinity();
    TimeStep next = choose_step(world_->t, until);
    while (world_->t < until) {
      const TimeStep taken = next;
      bool drained = false;
      sources_->set_pins(*world_);
      const StepReport step = step_explicit(*world_, taken.dt, [&] {
        // What is left behind the last step of a frame is round-off.
        const double remaining = until - (world_->t + taken.dt);
        const bool due = sources_->due(*world_, taken.dt);
        drained = remaining < 1e-9 * taken.dt || guard_.may_park(*world_) || due;
        if (drained) return 0.0;
        next = choose_step(world_->t + taken.dt, until);
        drained = !(next.dt > 0);
        return next.dt;
      });
      note_step(taken, step.failure.has_value());
      if (step.failure) return step.failure;
      if (!drained) continue;
      guard_.park_fast(*world_);
      // The last step of a frame lands on its time.
      const bool is_last = until - world_->t < 1e-9 * taken.dt;
      if (is_last) world_->t = until;
      sources_->act(*world_);
      if (!is_last) next = choose_step(world_->t, until);
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
    const auto& material = world_->materials[failure.material];
    Mat<double, dim> F;
    std::copy_n(failure.strain.begin(), dim * dim, F.e);
    Vec<double, dim> v;
    std::copy_n(failure.velocity.begin(), dim, v.e);
    return fmt::format(
        "step {} at t = {:.6g} s with dt = {:.3g} s: particle {} of \"{}\" cannot go on, {}; x = ({:.4g}) m, speed "
        "{:.4g} m/s, "
        "F = ({:.4g}), J = {:.4g}. The likely cause is a time step too long for what happens there: lower "
        "limits.elastic_cfl or limits.max_dt, use a smaller cell size, or soften material.{}",
        world_->steps, world_->t, dt, failure.id, material.name, failure.cause, fmt::join(failure.position, ", "),
        norm(v), fmt::join(failure.strain, ", "), determinant(F), material.name);
  }

  [[noreturn]] void fail(const ParticleFailure& failure, double dt) const {
    throw Error(ErrorKind::numerical, describe(failure, dt));
  }

  mutable tbb::task_arena arena_;
  std::optional<tbb::global_control> thread_limit_;
  std::unique_ptr<World<Real, dim>> world_;
  std::unique_ptr<Sources<Real, dim>> sources_;
  TimeStepLimits limits_;
  RunawayGuard<Real, dim> guard_;
  std::vector<std::string> material_names_;
  std::optional<Kept> kept_;
  FrameReport report_;
};

}  // namespace

std::int64_t Simulation::frame_count() const {
  // A frame that would come a rounding error after the end still belongs to the run.
  return static_cast<std::int64_t>(std::floor(scene_.end_time * scene_.frame_rate * (1 + 1e-12))) + 1;
}

std::unique_ptr<Simulation> Simulation::create(const Scene& scene) {
  const bool single = scene.precision == Scene::Precision::single;
  if (scene.dimension == 2) {
    if (single) return std::make_unique<SimulationOf<float, 2>>(scene);
    return std::make_unique<SimulationOf<double, 2>>(scene);
  }
  if (single) return std::make_unique<SimulationOf<float, 3>>(scene);
  return std::make_unique<SimulationOf<double, 3>>(scene);
}

}  // namespace firn
