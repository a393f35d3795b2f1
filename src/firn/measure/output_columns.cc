#include <firn/core/parallel.h>
#include <firn/materials/model_info.h>
#include <firn/measure/output_columns.h>
#include <firn/measure/particle_state.h>
#include <firn/measure/stress_invariants.h>

#include <algorithm>
#include <cmath>

namespace firn {
namespace {

constexpr std::size_t kGrain = 8192;

template <class T>
std::vector<T>& column(Snapshot& snapshot, const char* name, const char* unit, const char* help, int components) {
  for (SnapshotColumn& existing : snapshot.columns) {
    if (existing.name == name) return std::get<std::vector<T>>(existing.values);
  }
  snapshot.columns.push_back({name, unit, help, components, std::vector<T>()});
  return std::get<std::vector<T>>(snapshot.columns.back().values);
}

/// History columns of all models, so that every snapshot has the same ones whichever materials it holds.
std::vector<HistoryColumn> all_history() {
  std::vector<HistoryColumn> all;
  for (const ModelInfo& info : all_models()) {
    for (const HistoryColumn& h : info.history) {
      if (std::none_of(all.begin(), all.end(), [&](const HistoryColumn& other) { return other.name == h.name; })) {
        all.push_back(h);
      }
    }
  }
  return all;
}

/// What all particles of the model have in common; 0 if it has no such parameter.
double shared_value(std::string_view name, int model, const ModelParameters& parameters) {
  const auto list = all_models()[static_cast<std::size_t>(model)].parameters;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (list[i].name == name) return parameters.values[i];
  }
  return 0;
}

/// Which place each particle gets in the order of ids.
template <class Real, int dim>
std::vector<std::uint32_t> id_ranks(const Particles<Real, dim>& particles) {
  const std::size_t count = particles.size();
  std::vector<std::uint64_t> sorted(count);  // id, then place in memory
  parallel_chunks(count, kGrain, [&](std::size_t first, std::size_t last) {
    for (std::size_t p = first; p < last; ++p) sorted[p] = std::uint64_t(particles.id()[p]) << 32 | p;
  });
  tbb::parallel_sort(sorted.begin(), sorted.end());
  std::vector<std::uint32_t> ranks(count);
  parallel_chunks(count, kGrain, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) ranks[sorted[i] & 0xffffffff] = static_cast<std::uint32_t>(i);
  });
  return ranks;
}

template <class Real, int dim>
std::vector<double> volume_ratios(const Particles<Real, dim>& particles, int model, const ModelParameters& parameters) {
  std::vector<double> ratios(particles.size());
  parallel_chunks(ratios.size(), kGrain, [&](std::size_t first, std::size_t last) {
    for (std::size_t p = first; p < last; ++p) {
      ratios[p] = volume_ratio(particle_state(particles, p, parameters), model, parameters);
    }
  });
  return ratios;
}

}  // namespace

template <class Real, int dim>
void append_to_snapshot(Snapshot& snapshot, const Particles<Real, dim>& particles, int model,
                        const ModelParameters& parameters, const MaterialLabel& label, double dx, Kernel kernel) {
  const std::size_t begin = snapshot.size();
  const auto material = static_cast<std::int32_t>(snapshot.materials.size());
  snapshot.materials.push_back({label.name, label.model, label.preset, begin, begin + particles.size()});
  const std::vector<std::uint32_t> ranks = id_ranks(particles);

  // Looked up one by one because adding a column may move the others. fill(to, p) writes the numbers of a particle.
  // Particles are read in the order in which they lie in memory and written to their places: the other way round nearly
  // every number would be fetched from far away.
  const auto append = [&]<class T>(T, const char* name, const char* unit, const char* help, int components,
                                   const auto& fill) {
    std::vector<T>& values = column<T>(snapshot, name, unit, help, components);
    const std::size_t before = values.size(), width = static_cast<std::size_t>(components);
    values.resize(before + ranks.size() * width);
    parallel_chunks(ranks.size(), kGrain, [&](std::size_t first, std::size_t last) {
      for (std::size_t p = first; p < last; ++p) fill(values.data() + before + ranks[p] * width, p);
    });
  };
  append(Real(), "position", "m", "Position.", 3, [&](Real* to, std::size_t p) {
    const Vec<double, dim> x = particles.position(p, dx, kernel);
    for (int i = 0; i < 3; ++i) to[i] = i < dim ? static_cast<Real>(x[i < dim ? i : 0]) : Real(0);
  });
  append(Real(), "velocity", "m/s", "Velocity.", 3, [&](Real* to, std::size_t p) {
    for (int i = 0; i < 3; ++i) to[i] = i < dim ? particles.real(Field::velocity, i < dim ? i : 0)[p] : Real(0);
  });
  append(std::int64_t(), "id", "", "Number of the particle, stable over the whole run.", 1,
         [&](std::int64_t* to, std::size_t p) { *to = particles.id()[p]; });
  append(std::int32_t(), "body", "", "Index of the body that the particle was seeded in.", 1,
         [&](std::int32_t* to, std::size_t p) { *to = static_cast<std::int32_t>(particles.body()[p]); });
  append(std::int32_t(), "material", "", "Index of the particle's material.", 1,
         [&](std::int32_t* to, std::size_t) { *to = material; });
  const std::vector<double> ratios = volume_ratios(particles, model, parameters);
  append(Real(), "J", "", "Current volume over undeformed volume.", 1,
         [&](Real* to, std::size_t p) { *to = static_cast<Real>(ratios[p]); });
  append(
      Real(), "von_mises_stress", "Pa", "Von Mises equivalent of the Cauchy stress.", 1,
      [&](Real* to, std::size_t p) { *to = static_cast<Real>(von_mises(kirchhoff_stress(particles, p)) / ratios[p]); });
  append(
      Real(), "pressure", "Pa", "Minus the mean Cauchy stress: positive in compression.", 1,
      [&](Real* to, std::size_t p) { *to = static_cast<Real>(pressure(kirchhoff_stress(particles, p)) / ratios[p]); });
  const auto own_column = [&](std::string_view name) {
    int own = -1;
    for (int k = 0; k < particles.history_count(); ++k) own = particles.history_spec(k).name == name ? k : own;
    return own;
  };
  for (const HistoryColumn& h : all_history()) {
    const int own = own_column(h.name);
    append(Real(), std::string(h.name).c_str(), std::string(h.unit).c_str(), std::string(h.help).c_str(), 1,
           [&](Real* to, std::size_t p) {
             *to = own < 0 ? static_cast<Real>(h.initial_value) : particles.history(own)[p];
           });
  }
  for (const Parameter& parameter : label.varied) {
    const int own = own_column(parameter.name);
    const Real shared = static_cast<Real>(shared_value(parameter.name, model, parameters));
    append(Real(), std::string(parameter.name).c_str(), std::string(parameter.unit).c_str(),
           std::string(parameter.help).c_str(), 1,
           [&](Real* to, std::size_t p) { *to = own < 0 ? shared : particles.history(own)[p]; });
  }
}

#define FIRN_INSTANTIATE(Real, dim)                                                                                \
  template void append_to_snapshot<Real, dim>(Snapshot&, const Particles<Real, dim>&, int, const ModelParameters&, \
                                              const MaterialLabel&, double, Kernel);
FIRN_INSTANTIATE(float, 2)
FIRN_INSTANTIATE(float, 3)
FIRN_INSTANTIATE(double, 2)
FIRN_INSTANTIATE(double, 3)
#undef FIRN_INSTANTIATE

}  // namespace firn
