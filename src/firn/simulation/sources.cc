#include <firn/core/error.h>
#include <firn/core/log.h>
#include <firn/integrators/step.h>
#include <firn/integrators/verbs.h>
#include <firn/scene/force_fields.h>
#include <firn/scene/pin_collider.h>
#include <firn/scene/vary_parameters.h>
#include <firn/simulation/sources.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace firn {
namespace {

/// Share of a lattice's spacing that must be free around a new particle. 1 would leave gaps wherever the flow has
/// stretched a little less than the lattice; at 0.7 and below, a flow that drifts against it gets denser than full.
constexpr double kRoom = 0.85;
/// Of the response time of wind: explicit drag overshoots at 1 and is unstable at 2.
constexpr double kDragShare = 0.25;

template <int dim>
Vec<double, dim> cut(const Vec3d& v) {
  Vec<double, dim> result;
  for (int i = 0; i < dim; ++i) result[i] = v[i];
  return result;
}

/// Number of particles that lie in blocks; those behind them were appended since.
template <class Real, int dim>
std::size_t sorted_count(const Particles<Real, dim>& particles) {
  const std::size_t blocks = particles.block_count();
  return blocks == 0 ? 0 : particles.first_of_block(blocks - 1) + particles.block_size(blocks - 1);
}

/// Calls visit(p) for the particles of blocks that overlap the bounds, in order.
template <class Real, int dim, class Visit>
void for_each_near(const Particles<Real, dim>& particles, const Grid<Real, dim>& grid, const Bounds<dim>& bounds,
                   const Visit& visit) {
  for (std::size_t b = 0; b < particles.block_count(); ++b) {
    const Index<dim> origin = block_origin<dim>(particles.block_key(b));
    bool near = true;
    for (int d = 0; d < dim; ++d) {
      const double low =
          grid.dx() * (static_cast<double>(origin[static_cast<std::size_t>(d)]) + cell_offset(grid.kernel()));
      // A cell more, for offsets that were rounded up to the next cell.
      const double high = low + grid.dx() * (kBlockSide<dim> + 1);
      near = near && low <= bounds.upper[d] && high >= bounds.lower[d];
    }
    if (!near) continue;
    const std::size_t first = particles.first_of_block(b);
    for (std::size_t p = first; p < first + particles.block_size(b); ++p) visit(static_cast<std::uint32_t>(p));
  }
}

}  // namespace

template <class Real, int dim>
Sources<Real, dim>::Sources(const Scene& scene, const WorldPlan& plan, World<Real, dim>& world)
    : scene_(scene),
      particle_volume_(plan.particle_volume),
      spacing_(lattice_spacing<dim>(plan.particle_volume)),
      tolerance_(1e-9 / scene.frame_rate),
      first_id_(plan.particles),
      collider_count_(world.colliders.size()) {
  for (const EmitterSettings& emitter : scene_.emitters) add_emitter(emitter, world);
  for (const SinkSettings& sink : scene_.sinks) {
    Carried<dim> frame(scene_, sink);
    auto region = frame.region(scene_);
    sink_speed_ =
        std::max(sink_speed_, frame.fastest(region->bounds(), sink.start, sink.stop.value_or(scene.end_time)));
    sinks_.push_back({std::move(frame), std::move(region)});
  }
  for (const PinSettings& pin : scene_.pins) pins_.push_back(pin_collider<dim>(scene_, pin, plan.cell_size));
  const auto add_events = [&](const auto& objects) {
    for (const auto& object : objects) {
      events_.push_back(object.start);
      if (object.stop) events_.push_back(*object.stop);
    }
  };
  add_events(scene_.emitters);
  add_events(scene_.sinks);
  add_events(scene_.fields);
  add_events(scene_.pins);
  add_events(scene_.tractions);
  std::sort(events_.begin(), events_.end());
  counts_.emitted.resize(emitters_.size());
  counts_.removed.resize(sinks_.size());
  counts_.last_slot.resize(emitters_.size(), -1);
}

template <class Real, int dim>
void Sources<Real, dim>::add_emitter(const EmitterSettings& settings, const World<Real, dim>& world) {
  const std::string name = fmt::format("emitter \"{}\"", settings.name);
  Emitter emitter = {&settings, Carried<dim>(scene_, settings), nullptr, {}};
  emitter.region = emitter.frame.region(scene_);
  emitter.velocity = transpose(emitter.frame.pose_at(0).rotation) * cut<dim>(settings.velocity);
  emitter.body = scene_.bodies.size() + emitters_.size();
  const auto material = std::find_if(world.materials.begin(), world.materials.end(),
                                     [&](const auto& m) { return m.name == settings.material; });
  emitter.material = static_cast<std::size_t>(material - world.materials.begin());
  const double speed = norm(emitter.velocity);
  emitter.fastest =
      speed + emitter.frame.fastest(emitter.region->bounds(), settings.start, settings.stop.value_or(scene_.end_time));
  const double fall = settings.keep_full ? std::sqrt(norm(world.gravity) * spacing_) : 0;
  emitter.interval = std::min(0.5 * spacing_ / std::max(emitter.fastest, fall), 1 / scene_.frame_rate);

  if (!settings.keep_full) {
    const double volume_rate =
        settings.volume_rate ? *settings.volume_rate : *settings.mass_rate / material->parameters.density;
    emitter.stream.emplace(emitter.region, emitter.velocity, volume_rate / particle_volume_, name);
    const double filled = volume_rate / (emitter.stream->area() * speed);
    if (filled > 1.05) {
      log_warning(
          fmt::format("{}: its rate is {:.3g} times what its section of {:.3g} m^{} passes at {:.3g} m/s, so the "
                      "material comes out compressed without knowing it; raise velocity or the size, or lower "
                      "the rate",
                      name, filled, emitter.stream->area(), dim - 1, speed));
    }
  }
  if (material->parameters.varied.empty()) {
    measure_limits(world, emitter, {{emitter.region->bounds().center(), {}}}, 0);
  }
  emitters_.push_back(std::move(emitter));
}

template <class Real, int dim>
bool Sources<Real, dim>::is_active(double start, const std::optional<double>& stop, double t) const {
  return t + tolerance_ >= start && (!stop || t + tolerance_ < *stop);
}

template <class Real, int dim>
std::int64_t Sources<Real, dim>::slot(const Emitter& emitter, double t) const {
  const EmitterSettings& settings = *emitter.settings;
  const double age =
      std::min(t + tolerance_, settings.stop.value_or(std::numeric_limits<double>::infinity())) - settings.start;
  return age >= 0 ? static_cast<std::int64_t>(std::floor(age / emitter.interval)) : -1;
}

template <class Real, int dim>
void Sources<Real, dim>::resume(std::vector<SourceCount> emitted, std::vector<SourceCount> removed, double t) {
  counts_ = {std::move(emitted), std::move(removed), {}, 0};
  for (const Emitter& emitter : emitters_) counts_.last_slot.push_back(slot(emitter, t));
}

template <class Real, int dim>
auto Sources<Real, dim>::longest_step(const World<Real, dim>& world, double t, double particle_cfl) const -> Bound {
  Bound bound = {std::numeric_limits<double>::infinity(), "wind"};
  for (const FieldSettings& field : scene_.fields) {
    // A step that ends where a wind begins does not feel it.
    if (field.type != FieldSettings::Type::wind || !is_active(field.start, field.stop, t)) continue;
    bound.dt = std::min(bound.dt, kDragShare * field.response_time);
  }
  for (const Emitter& emitter : emitters_) {
    if (!is_active(emitter.settings->start, emitter.settings->stop, t)) continue;
    const double dt = emitter.fastest > 0 ? particle_cfl * world.grid.dx() / emitter.fastest : emitter.interval;
    if (dt < bound.dt) bound = {dt, "emitter"};
  }
  for (std::size_t i = 0; i < pins_.size(); ++i) {
    // Later the grid has seen it.
    if (std::abs(t - scene_.pins[i].start) > tolerance_ || !pins_[i].shape->is_bounded()) continue;
    const double dt = particle_cfl * world.grid.dx() / fastest_in<dim>(pins_[i].pose_at(t), pins_[i].shape->bounds());
    if (dt < bound.dt) bound = {dt, "pin"};
  }
  return bound;
}

template <class Real, int dim>
double Sources<Real, dim>::next_event(double t) const {
  const auto next = std::upper_bound(events_.begin(), events_.end(), t + tolerance_);
  return next == events_.end() ? std::numeric_limits<double>::infinity() : *next;
}

template <class Real, int dim>
bool Sources<Real, dim>::due(const World<Real, dim>& world, double dt) {
  const double t = world.t + dt;
  counts_.travelled += dt * (world.max_speed + sink_speed_);
  for (std::size_t e = 0; e < emitters_.size(); ++e) {
    if (slot(emitters_[e], t) > counts_.last_slot[e]) return true;
  }
  if (counts_.travelled < 0.5 * world.grid.dx()) return false;
  return std::any_of(scene_.sinks.begin(), scene_.sinks.end(),
                     [&](const SinkSettings& sink) { return is_active(sink.start, sink.stop, t); });
}

template <class Real, int dim>
void Sources<Real, dim>::act(World<Real, dim>& world) {
  bool changed = false;
  for (std::size_t s = 0; s < sinks_.size(); ++s) changed = remove(world, s) || changed;
  for (std::size_t e = 0; e < emitters_.size(); ++e) {
    changed = emit(world, e) || changed;
    counts_.last_slot[e] = slot(emitters_[e], world.t);
  }
  counts_.travelled = 0;
  if (changed) sort_by_block(world);
}

template <class Real, int dim>
void Sources<Real, dim>::set_pins(World<Real, dim>& world) const {
  if (pins_.empty()) return;
  world.colliders.erase(world.colliders.begin() + static_cast<std::ptrdiff_t>(collider_count_), world.colliders.end());
  for (std::size_t i = 0; i < pins_.size(); ++i) {
    if (is_active(scene_.pins[i].start, scene_.pins[i].stop, world.t)) world.colliders.push_back(pins_[i]);
  }
}

template <class Real, int dim>
bool Sources<Real, dim>::emit(World<Real, dim>& world, std::size_t e) {
  Emitter& emitter = emitters_[e];
  SourceCount& count = counts_.emitted[e];
  const std::vector<Emitted<dim>> particles = new_particles(world, emitter, count.particles);
  if (particles.empty()) return false;
  std::int64_t id = first_id_;
  for (const SourceCount& other : counts_.emitted) id += other.particles;
  if (id + static_cast<std::int64_t>(particles.size()) > std::numeric_limits<std::int32_t>::max()) {
    throw Error(ErrorKind::resources,
                fmt::format("emitter \"{}\": at t = {:.6g} s the run has had {} particles, more than Firn can number; "
                            "lower its rate or use larger cells",
                            emitter.settings->name, world.t, id));
  }
  auto& material = world.materials[emitter.material];
  if (!material.parameters.varied.empty()) measure_limits(world, emitter, particles, static_cast<std::uint32_t>(id));
  append(material, world, emitter, particles, static_cast<std::uint32_t>(id));
  material.wave_speed = std::max(material.wave_speed, emitter.wave_speed);
  material.kinematic_viscosity = std::max(material.kinematic_viscosity, emitter.viscosity);
  double fastest = 0;
  for (const Emitted<dim>& particle : particles) fastest = std::max(fastest, norm(particle.v));
  material.max_speed = std::max(material.max_speed, fastest);
  world.max_speed = std::max(world.max_speed, fastest);
  count.particles += static_cast<std::int64_t>(particles.size());
  count.mass = static_cast<double>(count.particles) * particle_volume_ * material.parameters.density;
  return true;
}

template <class Real, int dim>
std::vector<Emitted<dim>> Sources<Real, dim>::new_particles(const World<Real, dim>& world, Emitter& emitter,
                                                            std::int64_t already) const {
  const EmitterSettings& settings = *emitter.settings;
  if (!emitter.stream) return fill_up(world, emitter);
  const double age = world.t - settings.start;
  const double last = settings.stop ? std::min(age, *settings.stop - settings.start) : age;
  PoseAt<dim> frame;
  if (emitter.frame.moves()) frame = [&](double time) { return emitter.frame.pose_at(settings.start + time); };
  // The tolerance makes a particle that comes at the end of a frame come in that frame whatever the rounding.
  return emitter.stream->between(already, emitter.stream->count_at(last + tolerance_), age, world.gravity, frame);
}

template <class Real, int dim>
std::vector<Emitted<dim>> Sources<Real, dim>::fill_up(const World<Real, dim>& world, const Emitter& emitter) const {
  const EmitterSettings& settings = *emitter.settings;
  if (!is_active(settings.start, settings.stop, world.t)) return {};
  const Pose<dim> pose = emitter.frame.pose_at(world.t);
  const auto in_frame = moving_lattice<dim>(*emitter.region, spacing_ / pose.scale, (1 / pose.scale) * emitter.velocity,
                                            world.t - settings.start);
  std::vector<PosedCollider<dim>> solids;
  for (const Collider<dim>& collider : world.colliders) {
    if (!collider.is_filled) solids.emplace_back(collider, world.t);
  }
  std::vector<Vec<double, dim>> points;
  for (const Vec<double, dim>& place : in_frame) {
    const Vec<double, dim> x = to_world<dim>(pose, place);
    if (std::none_of(solids.begin(), solids.end(), [&](const auto& solid) { return solid.distance(x) < 0; })) {
      points.push_back(x);
    }
  }
  const auto taken = occupied(world, bounds_in_world<dim>(pose, emitter.region->bounds()));
  std::vector<Emitted<dim>> particles;
  for (const auto& x : with_room<dim>(points, taken, kRoom * spacing_)) {
    particles.push_back({x, pose.rotation * emitter.velocity + pose.velocity_at(x)});
  }
  return particles;
}

template <class Real, int dim>
std::vector<Vec<double, dim>> Sources<Real, dim>::occupied(const World<Real, dim>& world,
                                                           const Bounds<dim>& bounds) const {
  const auto margin = constant_vector<double, dim>(spacing_);
  const Bounds<dim> wider = {bounds.lower - margin, bounds.upper + margin};
  std::vector<Vec<double, dim>> places;
  for (const auto& material : world.materials) {
    for_each_near(material.particles, world.grid, wider, [&](std::uint32_t p) {
      places.push_back(material.particles.position(p, world.grid.dx(), world.grid.kernel()));
    });
    // What another emitter has just added has no block yet.
    for (std::size_t p = sorted_count(material.particles); p < material.particles.size(); ++p) {
      places.push_back(material.particles.position(p, world.grid.dx(), world.grid.kernel()));
    }
  }
  return places;
}

template <class Real, int dim>
void Sources<Real, dim>::append(MaterialSet<Real, dim>& material, const World<Real, dim>& world, const Emitter& emitter,
                                const std::vector<Emitted<dim>>& particles, std::uint32_t first_id) const {
  std::vector<Vec<double, dim>> positions;
  for (const Emitted<dim>& particle : particles) positions.push_back(particle.x);
  const std::size_t first = material.particles.size();
  material.particles.append(positions, world.grid.dx(), world.transfer.kernel, world.grid.period(), particle_volume_,
                            first_id, static_cast<std::uint32_t>(emitter.body));
  for (int d = 0; d < dim; ++d) {
    const auto velocity = material.particles.real(Field::velocity, d);
    for (std::size_t i = 0; i < particles.size(); ++i) velocity[first + i] = static_cast<Real>(particles[i].v[d]);
  }
  BodySettings body;
  body.name = emitter.settings->name;
  vary_parameters<Real, dim>(scene_, *scene_.find_material(material.name), body,
                             {material, first, first_id, positions});
}

template <class Real, int dim>
void Sources<Real, dim>::measure_limits(const World<Real, dim>& world, Emitter& emitter,
                                        const std::vector<Emitted<dim>>& particles, std::uint32_t first_id) const {
  const auto& material = world.materials[emitter.material];
  World<Real, dim> alone(world.grid.dx(), world.transfer, world.grid.period());
  auto& sample = alone.add_material(material.name, material.model, material.parameters);
  append(sample, alone, emitter, particles, first_id);
  prepare(alone);
  emitter.wave_speed = sample.wave_speed;
  emitter.viscosity = sample.kinematic_viscosity;
}

template <class Real, int dim>
bool Sources<Real, dim>::remove(World<Real, dim>& world, std::size_t s) {
  if (!is_active(scene_.sinks[s].start, scene_.sinks[s].stop, world.t)) return false;
  const Region<dim>& region = *sinks_[s].region;
  const Pose<dim> pose = sinks_[s].frame.pose_at(world.t);
  SourceCount& count = counts_.removed[s];
  const std::int64_t before = count.particles;
  for (auto& material : world.materials) {
    std::vector<std::uint32_t> places;
    for_each_near(material.particles, world.grid, bounds_in_world<dim>(pose, region.bounds()), [&](std::uint32_t p) {
      const auto x = material.particles.position(p, world.grid.dx(), world.grid.kernel());
      if (!region.contains(to_frame<dim>(pose, x))) return;
      places.push_back(p);
      count.mass += material.particles.mass(p);
    });
    count.particles += static_cast<std::int64_t>(places.size());
    if (!places.empty()) material.particles.remove(places);
  }
  return count.particles > before;
}

template class Sources<float, 2>;
template class Sources<float, 3>;
template class Sources<double, 2>;
template class Sources<double, 3>;

}  // namespace firn
