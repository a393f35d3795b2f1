#include <firn/core/error.h>
#include <firn/materials/model_info.h>
#include <firn/simulation/checkpoint_state.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <map>
#include <type_traits>
#include <utility>
#include <vector>

namespace firn {
namespace {

constexpr std::array<const char*, 3> kSpeedNames = {"max_speed", "wave_speed", "kinematic_viscosity"};

template <class T>
const T& entry(const std::map<std::string, T>& entries, std::string_view name) {
  const auto found = entries.find(std::string(name));
  if (found != entries.end()) return found->second;
  throw Error(ErrorKind::files, fmt::format("the checkpoint cannot be used: it lacks \"{}\"", name));
}

/// body(name, components, element of the stored type (T()), column of component c) for everything that is saved. The
/// columns of a const Particles are read only.
template <class Set, class Body>
void for_each_column(Set& particles, const Body& body) {
  using Real = std::remove_cvref_t<decltype(particles.real(Field::offset)[0])>;
  for (int f = 0; f < kFieldCount; ++f) {
    const auto field = static_cast<Field>(f);
    const char* name = kFields[static_cast<std::size_t>(f)].name;
    if (field == Field::acceleration || !particles.has(field)) continue;
    const auto components = static_cast<std::size_t>(particles.component_count(field));
    if (field == Field::id) {
      body(name, components, std::uint32_t(), [&](std::size_t) { return particles.id(); });
    } else if (field != Field::cell && field != Field::origin) {
      body(name, components, Real(), [&](std::size_t c) { return particles.real(field, static_cast<int>(c)); });
    }
  }
  for (int h = 0; h < particles.history_count(); ++h) {
    body("history." + particles.history_spec(h).name, std::size_t(1), Real(),
         [&](std::size_t) { return particles.history(h); });
  }
}

/// Columns that stand for others: numbers of origins mean nothing outside.
constexpr const char *kBodyColumn = "body", *kVolumeColumn = "rest_volume", *kCellColumn = "cell";

std::string shape_text(const std::string& name, std::size_t components) {
  return components == 1 ? name : fmt::format("{}[{}]", name, components);
}

template <class Real, int dim>
void require_same_columns(const CheckpointMaterial& saved, const MaterialSet<Real, dim>& material) {
  const std::string_view model = all_models()[static_cast<std::size_t>(material.model)].name;
  if (saved.name != material.name || saved.model != model) {
    throw Error(ErrorKind::files,
                fmt::format("the checkpoint cannot be used: its material \"{}\" with the model {} stands where the "
                            "scene has \"{}\" with {}",
                            saved.name, saved.model, material.name, model));
  }
  std::vector<std::string> there, wanted;
  for (const CheckpointColumn& column : saved.columns) there.push_back(shape_text(column.name, column.components));
  for_each_column(material.particles, [&](const std::string& name, std::size_t components, auto, const auto&) {
    wanted.push_back(shape_text(name, components));
  });
  wanted.insert(wanted.end(), {kBodyColumn, kVolumeColumn, kCellColumn});
  if (there == wanted) return;
  throw Error(ErrorKind::files,
              fmt::format("the checkpoint cannot be used: its particles of \"{}\" have the columns {}, and the scene "
                          "needs {}",
                          saved.name, fmt::join(there, ", "), fmt::join(wanted, ", ")));
}

template <class T>
const std::vector<T>& values_of(const CheckpointMaterial& saved, std::size_t c) {
  const CheckpointColumn& column = saved.columns[c];
  const auto* values = std::get_if<std::vector<T>>(&column.values);
  if (values != nullptr && values->size() == column.components * saved.particles) return *values;
  throw Error(ErrorKind::files, fmt::format("the checkpoint cannot be used: the column \"{}\" of \"{}\" holds numbers "
                                            "of another precision, or not one per particle",
                                            column.name, saved.name));
}

void require_bodies(const CheckpointMaterial& saved, const std::vector<std::uint16_t>& seeded_in, std::size_t bodies) {
  if (std::all_of(seeded_in.begin(), seeded_in.end(), [&](std::uint16_t body) { return body < bodies; })) return;
  throw Error(
      ErrorKind::files,
      fmt::format("the checkpoint cannot be used: the column \"{}\" of \"{}\" names a body that the scene has not",
                  kBodyColumn, saved.name));
}

template <int dim>
void require_cells(const CheckpointMaterial& saved, const std::vector<std::uint64_t>& cells) {
  constexpr int kBits = CellKey<dim>::kBitsPerAxis * dim;
  for (const std::uint64_t cell : cells) {
    if (cell >> kBits == 0) continue;
    throw Error(ErrorKind::files,
                fmt::format("the checkpoint cannot be used: a particle of \"{}\" is in no cell", saved.name));
  }
}

constexpr std::array<const char*, 3> kAxes = {"_x", "_y", "_z"};

void save_vector(const Vec3d& vector, const std::string& name, CheckpointState& state) {
  for (int i = 0; i < 3; ++i) state.numbers[name + kAxes[static_cast<std::size_t>(i)]] = vector[i];
}

Vec3d vector_of(const CheckpointState& state, const std::string& name) {
  Vec3d vector;
  for (int i = 0; i < 3; ++i) vector[i] = number_of(state, name + kAxes[static_cast<std::size_t>(i)]);
  return vector;
}

/// Whether any number or counter has a name that begins so: one that was lost alone is missed, a group that was never
/// there is not.
bool has_any(const CheckpointState& state, const std::string& prefix) {
  const auto is_in = [&](const auto& entries) {
    const auto first = entries.lower_bound(prefix);
    return first != entries.end() && first->first.starts_with(prefix);
  };
  return is_in(state.numbers) || is_in(state.counters);
}

}  // namespace

template <class Real, int dim>
CheckpointMaterial save_material(const MaterialSet<Real, dim>& material, const Particles<Real, dim>& particles,
                                 const MaterialSpeeds& speeds) {
  CheckpointMaterial saved;
  saved.name = material.name;
  saved.model = all_models()[static_cast<std::size_t>(material.model)].name;
  saved.particles = particles.size();
  for (std::size_t i = 0; i < speeds.size(); ++i) saved.numbers[kSpeedNames[i]] = speeds[i];
  for_each_column(particles, [&]<class T>(const std::string& name, std::size_t components, T, const auto& column_of) {
    std::vector<T> values;
    values.reserve(components * particles.size());
    for (std::size_t c = 0; c < components; ++c) {
      const auto column = column_of(c);
      for (std::size_t p = 0; p < particles.size(); ++p) values.push_back(column[p]);
    }
    saved.columns.push_back({name, components, std::move(values)});
  });
  const auto save = [&](const char* name, const auto& value_of) {
    std::vector<decltype(value_of(0))> values;
    values.reserve(particles.size());
    for (std::size_t p = 0; p < particles.size(); ++p) values.push_back(value_of(p));
    saved.columns.push_back({name, 1, std::move(values)});
  };
  save(kBodyColumn, [&](std::size_t p) { return particles.body(p); });
  save(kVolumeColumn, [&](std::size_t p) { return particles.rest_volume(p); });
  save(kCellColumn, [&](std::size_t p) { return particles.cell(p); });
  return saved;
}

template <class Real, int dim>
Particles<Real, dim> load_particles(const CheckpointMaterial& saved, const MaterialSet<Real, dim>& material,
                                    bool keeps_velocity, std::size_t bodies) {
  require_same_columns(saved, material);
  const Particles<Real, dim>& like = material.particles;
  typename Particles<Real, dim>::Options options;
  options.keeps_velocity = keeps_velocity;
  options.density = like.density();
  options.separate_grad_v = like.has(Field::grad_v);
  options.acceleration = like.has(Field::acceleration);
  for (int h = 0; h < like.history_count(); ++h) options.history.push_back(like.history_spec(h));
  Particles<Real, dim> particles(options);
  if (saved.particles == 0) return particles;
  const std::size_t shared = saved.columns.size() - 3;
  const std::vector<std::uint16_t>& seeded_in = values_of<std::uint16_t>(saved, shared);
  const std::vector<Real>& rest_volumes = values_of<Real>(saved, shared + 1);
  const std::vector<std::uint64_t>& cells = values_of<std::uint64_t>(saved, shared + 2);
  require_bodies(saved, seeded_in, bodies);
  require_cells<dim>(saved, cells);
  // At any place: the columns say where they are.
  particles.append(std::vector<Vec<double, dim>>(saved.particles), 1, Kernel::linear, {}, rest_volumes[0], 0,
                   seeded_in[0]);
  std::size_t at = 0;
  for_each_column(particles, [&]<class T>(const std::string&, std::size_t components, T, const auto& column_of) {
    const std::vector<T>& values = values_of<T>(saved, at++);
    for (std::size_t c = 0; c < components; ++c) {
      const auto column = column_of(c);
      for (std::size_t p = 0; p < saved.particles; ++p) column[p] = values[c * saved.particles + p];
    }
  });
  for (std::size_t p = 0; p < saved.particles; ++p) {
    particles.set_origin(p, seeded_in[p], rest_volumes[p]);
    particles.set_cell(p, cells[p]);
  }
  particles.sort_by_block();
  return particles;
}

MaterialSpeeds load_speeds(const CheckpointMaterial& saved) {
  MaterialSpeeds speeds;
  for (std::size_t i = 0; i < speeds.size(); ++i) speeds[i] = entry(saved.numbers, kSpeedNames[i]);
  return speeds;
}

void save_report(const FrameReport& report, const Scene& scene, CheckpointState& state) {
  state.counters["report.frame"] = report.frame;
  state.counters["report.steps"] = report.steps;
  state.counters["report.particles"] = report.particles;
  state.counters["report.parked"] = report.parked;
  state.counters["report.retries"] = report.retries;
  state.numbers["report.time"] = report.time;
  state.numbers["report.dt"] = report.dt;
  state.numbers["report.wall_seconds"] = report.wall_seconds;
  state.texts["report.limit"] = report.limit;
  // Only the end of a frame has them.
  for (std::size_t k = 0; k < report.colliders.size(); ++k) {
    const ColliderReport& collider = report.colliders[k];
    const std::string name = fmt::format("report.collider.{}.", scene.colliders[k].name);
    save_vector(collider.force, name + "force", state);
    save_vector(collider.torque, name + "torque", state);
    state.numbers[name + "depth"] = collider.inside.depth;
    state.counters[name + "inside"] = collider.inside.particles;
    state.counters[name + "caught"] = collider.caught;
  }
}

FrameReport load_report(const CheckpointState& state, const Scene& scene) {
  FrameReport report;
  report.frame = counter_of(state, "report.frame");
  report.steps = counter_of(state, "report.steps");
  report.particles = counter_of(state, "report.particles");
  report.parked = counter_of(state, "report.parked");
  report.retries = static_cast<int>(counter_of(state, "report.retries"));
  report.time = number_of(state, "report.time");
  report.dt = number_of(state, "report.dt");
  report.wall_seconds = number_of(state, "report.wall_seconds");
  report.limit = text_of(state, "report.limit");
  if (!has_any(state, "report.collider.")) return report;
  for (const ColliderSettings& settings : scene.colliders) {
    const std::string name = fmt::format("report.collider.{}.", settings.name);
    ColliderReport& collider = report.colliders.emplace_back();
    if (!has_any(state, name)) continue;
    collider.force = vector_of(state, name + "force");
    collider.torque = vector_of(state, name + "torque");
    collider.inside = {counter_of(state, name + "inside"), number_of(state, name + "depth")};
    collider.caught = counter_of(state, name + "caught");
  }
  return report;
}

void save_loads(const std::vector<ColliderLoad>& loads, const Scene& scene, CheckpointState& state) {
  for (std::size_t k = 0; k < scene.colliders.size(); ++k) {
    const ColliderLoad load = k < loads.size() ? loads[k] : ColliderLoad{};
    const std::string name = fmt::format("collider.{}.", scene.colliders[k].name);
    save_vector(load.impulse, name + "impulse", state);
    save_vector(load.angular_impulse, name + "angular_impulse", state);
    state.counters[name + "caught"] = load.caught;
  }
}

std::vector<ColliderLoad> load_loads(const CheckpointState& state, const Scene& scene) {
  std::vector<ColliderLoad> loads;
  for (const ColliderSettings& settings : scene.colliders) {
    const std::string name = fmt::format("collider.{}.", settings.name);
    ColliderLoad& load = loads.emplace_back();
    if (!has_any(state, name)) continue;
    load.impulse = vector_of(state, name + "impulse");
    load.angular_impulse = vector_of(state, name + "angular_impulse");
    load.caught = counter_of(state, name + "caught");
  }
  return loads;
}

template <class Object>
void save_counts(const std::vector<SourceCount>& counts, const std::vector<Object>& objects, std::string_view kind,
                 CheckpointState& state) {
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const std::string name = fmt::format("{}.{}.", kind, objects[i].name);
    state.counters[name + "particles"] = counts[i].particles;
    state.numbers[name + "mass"] = counts[i].mass;
  }
}

template <class Object>
std::vector<SourceCount> load_counts(const CheckpointState& state, const std::vector<Object>& objects,
                                     std::string_view kind) {
  std::vector<SourceCount> counts;
  for (const Object& object : objects) {
    const std::string name = fmt::format("{}.{}.", kind, object.name);
    counts.push_back({counter_of(state, name + "particles"), number_of(state, name + "mass")});
    if (counts.back().particles >= 0) continue;
    throw Error(ErrorKind::files,
                fmt::format("the checkpoint cannot be used: \"{}particles\" is {}", name, counts.back().particles));
  }
  return counts;
}

template void save_counts<EmitterSettings>(const std::vector<SourceCount>&, const std::vector<EmitterSettings>&,
                                           std::string_view, CheckpointState&);
template void save_counts<SinkSettings>(const std::vector<SourceCount>&, const std::vector<SinkSettings>&,
                                        std::string_view, CheckpointState&);
template std::vector<SourceCount> load_counts<EmitterSettings>(const CheckpointState&,
                                                               const std::vector<EmitterSettings>&, std::string_view);
template std::vector<SourceCount> load_counts<SinkSettings>(const CheckpointState&, const std::vector<SinkSettings>&,
                                                            std::string_view);

double number_of(const CheckpointState& state, std::string_view name) { return entry(state.numbers, name); }
std::int64_t counter_of(const CheckpointState& state, std::string_view name) { return entry(state.counters, name); }
const std::string& text_of(const CheckpointState& state, std::string_view name) { return entry(state.texts, name); }

template <class Real, int dim>
std::string layout_text(const World<Real, dim>& world) {
  // All digits: cells that differ in the last bit put particles elsewhere.
  return fmt::format("{}D, {} precision, {} kernel, cells of {} m, {} cells to a period", dim,
                     sizeof(Real) == 4 ? "single" : "double", name(world.transfer.kernel), world.grid.dx(),
                     fmt::join(world.grid.period(), " x "));
}

#define FIRN_INSTANTIATE(Real, dim)                                                                                 \
  template CheckpointMaterial save_material<Real, dim>(const MaterialSet<Real, dim>&, const Particles<Real, dim>&,  \
                                                       const MaterialSpeeds&);                                      \
  template Particles<Real, dim> load_particles<Real, dim>(const CheckpointMaterial&, const MaterialSet<Real, dim>&, \
                                                          bool, std::size_t);                                       \
  template std::string layout_text<Real, dim>(const World<Real, dim>&);
FIRN_INSTANTIATE(float, 2)
FIRN_INSTANTIATE(float, 3)
FIRN_INSTANTIATE(double, 2)
FIRN_INSTANTIATE(double, 3)
#undef FIRN_INSTANTIATE

}  // namespace firn
