#include <firn/core/error.h>
#include <firn/integrators/verbs.h>
#include <firn/simulation/frame_state.h>
#include <fmt/format.h>
#include <xxhash.h>

#include <string>

namespace firn {
namespace {

std::string last_slot_name(const EmitterSettings& emitter) { return fmt::format("emitter.{}.last_slot", emitter.name); }

}  // namespace

template <class Real, int dim>
ParticleList<Real, dim> particles_of(const World<Real, dim>& world) {
  ParticleList<Real, dim> list;
  for (const auto& material : world.materials) list.push_back(material.particles);
  return list;
}

template <class Real, int dim>
FrameState<Real, dim> state_without_particles(const World<Real, dim>& world) {
  FrameState<Real, dim> state;
  for (const auto& material : world.materials) {
    state.speeds.push_back({material.max_speed, material.wave_speed, material.kinematic_viscosity});
  }
  state.t = world.t;
  state.max_speed = world.max_speed;
  state.max_collider_speed = world.max_collider_speed;
  state.steps = world.steps;
  state.loads = world.collider_loads;
  return state;
}

template <class Real, int dim>
void put_back(const FrameState<Real, dim>& state, World<Real, dim>& world) {
  for (std::size_t m = 0; m < world.materials.size(); ++m) {
    auto& material = world.materials[m];
    material.particles = state.particles[m];
    material.max_speed = state.speeds[m][0];
    material.wave_speed = state.speeds[m][1];
    material.kinematic_viscosity = state.speeds[m][2];
  }
  world.t = state.t;
  world.max_speed = state.max_speed;
  world.max_collider_speed = state.max_collider_speed;
  world.steps = state.steps;
  world.collider_loads = state.loads;
  world.scattered_dt.reset();
  world.drained = true;
  activate_blocks(world);
}

template <class Real, int dim>
std::uint64_t hash_of(const ParticleList<Real, dim>& particles, double t, std::uint64_t steps, std::int64_t frame) {
  const std::uint64_t clock[2] = {steps, static_cast<std::uint64_t>(frame)};
  std::uint64_t hash = XXH64(clock, sizeof(clock), XXH64(&t, sizeof(t), 1));
  for (const Particles<Real, dim>& each : particles) {
    const std::uint64_t part = each.hash();
    hash = XXH64(&part, sizeof(part), hash);
  }
  return hash;
}

template <class Real, int dim>
CheckpointState save_state(const FrameState<Real, dim>& state, const ParticleList<Real, dim>& particles,
                           const Scene& scene, const World<Real, dim>& world) {
  CheckpointState saved;
  saved.numbers["time"] = state.t;
  saved.numbers["max_speed"] = state.max_speed;
  saved.numbers["max_collider_speed"] = state.max_collider_speed;
  saved.numbers["travelled"] = state.counts.travelled;
  saved.numbers["loads_since"] = state.loads_since;
  saved.counters["steps"] = static_cast<std::int64_t>(state.steps);
  saved.counters["parked"] = state.parked;
  save_report(state.report, scene, saved);
  save_loads(state.loads, scene, saved);
  save_counts(state.counts.emitted, scene.emitters, "emitter", saved);
  save_counts(state.counts.removed, scene.sinks, "sink", saved);
  for (std::size_t e = 0; e < scene.emitters.size(); ++e) {
    saved.counters[last_slot_name(scene.emitters[e])] = state.counts.last_slot[e];
  }
  for (std::size_t m = 0; m < world.materials.size(); ++m) {
    saved.materials.push_back(save_material<Real, dim>(world.materials[m], particles[m], state.speeds[m]));
  }
  return saved;
}

template <class Real, int dim>
FrameState<Real, dim> load_state(const CheckpointState& saved, const Scene& scene, const World<Real, dim>& world) {
  if (saved.materials.size() != world.materials.size()) {
    throw Error(ErrorKind::files, fmt::format("the checkpoint cannot be used: it has {} materials, and the scene {}",
                                              saved.materials.size(), world.materials.size()));
  }
  FrameState<Real, dim> state;
  state.t = number_of(saved, "time");
  state.max_speed = number_of(saved, "max_speed");
  state.max_collider_speed = number_of(saved, "max_collider_speed");
  state.steps = static_cast<std::uint64_t>(counter_of(saved, "steps"));
  state.parked = counter_of(saved, "parked");
  state.counts.emitted = load_counts(saved, scene.emitters, "emitter");
  state.counts.removed = load_counts(saved, scene.sinks, "sink");
  for (const EmitterSettings& emitter : scene.emitters) {
    state.counts.last_slot.push_back(counter_of(saved, last_slot_name(emitter)));
  }
  state.counts.travelled = number_of(saved, "travelled");
  state.loads_since = number_of(saved, "loads_since");
  state.loads = load_loads(saved, scene);
  state.report = load_report(saved, scene);
  state.report.emitted = state.counts.emitted;
  state.report.removed = state.counts.removed;
  for (std::size_t m = 0; m < saved.materials.size(); ++m) {
    state.speeds.push_back(load_speeds(saved.materials[m]));
    state.particles.push_back(load_particles<Real, dim>(saved.materials[m], world.materials[m], world.transfer.flip > 0,
                                                        scene.bodies.size() + scene.emitters.size()));
  }
  return state;
}

#define FIRN_INSTANTIATE(Real, dim)                                                                               \
  template ParticleList<Real, dim> particles_of<Real, dim>(const World<Real, dim>&);                              \
  template FrameState<Real, dim> state_without_particles<Real, dim>(const World<Real, dim>&);                     \
  template void put_back<Real, dim>(const FrameState<Real, dim>&, World<Real, dim>&);                             \
  template std::uint64_t hash_of<Real, dim>(const ParticleList<Real, dim>&, double, std::uint64_t, std::int64_t); \
  template CheckpointState save_state<Real, dim>(const FrameState<Real, dim>&, const ParticleList<Real, dim>&,    \
                                                 const Scene&, const World<Real, dim>&);                          \
  template FrameState<Real, dim> load_state<Real, dim>(const CheckpointState&, const Scene&, const World<Real, dim>&);
FIRN_INSTANTIATE(float, 2)
FIRN_INSTANTIATE(float, 3)
FIRN_INSTANTIATE(double, 2)
FIRN_INSTANTIATE(double, 3)
#undef FIRN_INSTANTIATE

}  // namespace firn
