#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "firn/materials/update_stress.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <firn/materials/models-inl.h>
#include <firn/materials/update_stress.h>

#include <array>

HWY_BEFORE_NAMESPACE();
namespace firn {
namespace HWY_NAMESPACE {

/// Position of component (i, j) in the stored stress.
template <int dim>
constexpr int stress_index(int i, int j) {
  if (i == j) return i;
  return dim == 3 ? 2 + i + j : 3;  // xy 3, xz 4, yz 5; xy 3 in 2D
}

/// History columns of the model in dim dimensions.
template <class Model, int dim>
constexpr int history_count() {
  int count = 0;
  for (const HistoryColumn& column : Model::kHistory) count += dim == 2 || !column.plane_strain_only ? 1 : 0;
  return count;
}

/// Largest of the lanes and of zero.
template <class Real>
double largest_of(Lanes<Real> lanes) {
  HWY_ALIGN Real values[Lanes<Real>::kCount];
  store_lanes(lanes, values, Lanes<Real>::kCount);
  Real largest = 0;
  for (const Real value : values) largest = value > largest ? value : largest;
  return static_cast<double>(largest);
}

/// First lane of the mask.
template <class Real>
std::size_t first_of(LaneMask<Real> mask) {
  HWY_ALIGN Real flags[Lanes<Real>::kCount];
  store_lanes(select(mask, Lanes<Real>(Real(1)), Lanes<Real>(Real(0))), flags, Lanes<Real>::kCount);
  std::size_t lane = 0;
  while (lane + 1 < Lanes<Real>::kCount && flags[lane] == Real(0)) ++lane;
  return lane;
}

template <template <class> class Model, class Real, int dim>
StressReport update_particles(const ModelParameters& parameters, const MaterialColumns<Real, dim>& columns,
                              std::size_t begin, std::size_t end, Real dt) {
  using L = Lanes<Real>;
  const Model<L> model(parameters);
  constexpr int kHistoryCount = history_count<Model<L>, dim>();
  constexpr std::span<const StrainEntry> kEntries = strain_entries(strain_kind<Model<L>>(), dim);
  constexpr Real kLargest = std::numeric_limits<Real>::max();
  const L minimum_J = L(static_cast<Real>(Model<L>::kMinimumJ < -kLargest ? -kLargest : Model<L>::kMinimumJ));
  L wave_modulus = L(Real(0)), viscosity = L(Real(0));
  StressReport report;
  for (std::size_t p = begin; p < end; p += L::kCount) {
    const std::size_t count = end - p < L::kCount ? end - p : L::kCount;
    Mat<L, dim> grad_v, F = identity<L, dim>();
    for (int e = 0; e < dim * dim; ++e) grad_v.e[e] = load_lanes(columns.grad_v[e] + p);
    for (const StrainEntry& e : kEntries) F.e[e.entry] = load_lanes(columns.strain[e.entry] + p);
    L history[kHistoryCount + 1];
    for (int h = 0; h < kHistoryCount; ++h) history[h] = load_lanes(columns.history[h] + p);

    const Response<L, dim> response = model.update(F, history, grad_v, L(dt));

    for (const StrainEntry& e : kEntries) store_lanes(F.e[e.entry], columns.strain[e.entry] + p, count);
    for (int h = 0; h < kHistoryCount; ++h) store_lanes(history[h], columns.history[h] + p, count);
    L magnitude = L(Real(0));
    for (int i = 0; i < dim; ++i) {
      for (int j = i; j < dim; ++j) {
        store_lanes(response.tau(i, j), columns.stress[stress_index<dim>(i, j)] + p, count);
        magnitude = magnitude + abs(response.tau(i, j));
      }
    }
    if constexpr (dim == 2) store_lanes(response.tau_zz, columns.stress[2] + p, count);

    // Comparisons with NaN are false, so this also catches states that are not numbers.
    const auto sound = response.J > minimum_J && magnitude <= L(kLargest);
    const auto used = first_lanes<Real>(count);
    if (HWY_UNLIKELY(any(used && !sound)) && report.failed == StressReport::kNone) {
      report.failed = p + first_of(used && !sound);
    }
    wave_modulus = max(select(used && sound, response.wave_modulus, L(Real(0))), wave_modulus);
    if constexpr (is_viscous<Model<L>>()) {
      viscosity = max(select(used && sound, response.viscosity, L(Real(0))), viscosity);
    }
  }
  report.wave_speed = std::sqrt(largest_of(wave_modulus) / parameters.density);
  report.kinematic_viscosity = largest_of(viscosity) / parameters.density;
  return report;
}

template <class Real, int dim, template <class> class... Models>
UpdateStress<Real, dim> function_of(int model, ModelList<Models...>) {
  static constexpr std::array<UpdateStress<Real, dim>, sizeof...(Models)> kFunctions = {
      &update_particles<Models, Real, dim>...};
  return kFunctions[static_cast<std::size_t>(model)];
}

UpdateStress<float, 2> update_float_2(int model) { return function_of<float, 2>(model, AllModels()); }
UpdateStress<float, 3> update_float_3(int model) { return function_of<float, 3>(model, AllModels()); }
UpdateStress<double, 2> update_double_2(int model) { return function_of<double, 2>(model, AllModels()); }
UpdateStress<double, 3> update_double_3(int model) { return function_of<double, 3>(model, AllModels()); }

}  // namespace HWY_NAMESPACE
}  // namespace firn
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <firn/core/simd.h>

namespace firn {

HWY_EXPORT(update_float_2);
HWY_EXPORT(update_float_3);
HWY_EXPORT(update_double_2);
HWY_EXPORT(update_double_3);

template <>
UpdateStress<float, 2> update_stress_function<float, 2>(int model) {
  return FIRN_DISPATCH(update_float_2)(model);
}
template <>
UpdateStress<float, 3> update_stress_function<float, 3>(int model) {
  return FIRN_DISPATCH(update_float_3)(model);
}
template <>
UpdateStress<double, 2> update_stress_function<double, 2>(int model) {
  return FIRN_DISPATCH(update_double_2)(model);
}
template <>
UpdateStress<double, 3> update_stress_function<double, 3>(int model) {
  return FIRN_DISPATCH(update_double_3)(model);
}

}  // namespace firn
#endif  // HWY_ONCE
