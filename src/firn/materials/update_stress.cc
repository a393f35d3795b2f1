#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "firn/materials/update_stress.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <firn/materials/models-inl.h>
#include <firn/materials/update_stress.h>

#include <array>
#include <bit>

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

/// A model of which lane i is that of particle i of [begin, begin + count), the rest as the last one. Built from models
/// of single numbers, so that constants may be computed with functions that vectors lack, and with the same bits.
template <template <class> class Model, class Real, int dim>
HWY_NOINLINE Model<Lanes<Real>> model_in_lanes(ParametersOfOne& parameters, std::size_t varied,
                                               const MaterialColumns<Real, dim>& columns, std::size_t begin,
                                               std::size_t count) {
  using L = Lanes<Real>;
  constexpr std::size_t kMembers = sizeof(Model<Real>) / sizeof(Real);
  static_assert(sizeof(Model<L>) == kMembers * sizeof(L), "a model's members are all of its number type");
  using Members = std::array<Real, kMembers>;
  std::array<std::array<Real, L::kCount>, kMembers> lanes;
  for (std::size_t lane = 0; lane < L::kCount; ++lane) {
    const std::size_t p = begin + (lane < count ? lane : count - 1);
    Real own[kMaxVariedParameters];
    for (std::size_t k = 0; k < varied; ++k) own[k] = columns.history[history_count<Model<L>, dim>() + k][p];
    const auto members = std::bit_cast<Members>(Model<Real>(parameters.with(own)));
    for (std::size_t m = 0; m < kMembers; ++m) lanes[m][lane] = members[m];
  }
  return std::bit_cast<Model<L>>(lanes);
}

/// Particles [begin, end) with `own`, which may differ between lanes, or without it with the model of the parameters.
/// Compiled once for both: the model is in registers before the loop begins, wherever it comes from.
template <template <class> class Model, class Real, int dim>
HWY_NOINLINE StressReport update_range(const ModelParameters& parameters, const Model<Lanes<Real>>* own,
                                       const MaterialColumns<Real, dim>& columns, std::size_t begin, std::size_t end,
                                       Real dt) {
  using L = Lanes<Real>;
  const Model<L> model = own == nullptr ? Model<L>(parameters) : *own;
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
      report.failed = p + static_cast<std::size_t>(std::countr_zero(bits_of(used && !sound)));
    }
    wave_modulus = max(select(used && sound, response.wave_modulus, L(Real(0))), wave_modulus);
    if constexpr (is_viscous<Model<L>>()) {
      viscosity = max(select(used && sound, response.viscosity, L(Real(0))), viscosity);
    }
  }
  report.wave_speed = std::sqrt(static_cast<double>(largest_lane(wave_modulus)) / parameters.density);
  if constexpr (is_viscous<Model<L>>()) {
    report.kinematic_viscosity = static_cast<double>(largest_lane(viscosity)) / parameters.density;
  }
  return report;
}

/// Vector by vector, each with a model of its own.
template <template <class> class Model, class Real, int dim>
HWY_NOINLINE StressReport update_varied(const ModelParameters& parameters, const MaterialColumns<Real, dim>& columns,
                                        std::size_t begin, std::size_t end, Real dt) {
  using L = Lanes<Real>;
  ParametersOfOne own(parameters);
  StressReport report;
  for (std::size_t p = begin; p < end; p += L::kCount) {
    const std::size_t count = end - p < L::kCount ? end - p : L::kCount;
    const Model<L> model = model_in_lanes<Model, Real, dim>(own, parameters.varied.size(), columns, p, count);
    const StressReport part = update_range<Model, Real, dim>(parameters, &model, columns, p, p + count, dt);
    if (report.failed == StressReport::kNone) report.failed = part.failed;
    report.wave_speed = part.wave_speed > report.wave_speed ? part.wave_speed : report.wave_speed;
    report.kinematic_viscosity =
        part.kinematic_viscosity > report.kinematic_viscosity ? part.kinematic_viscosity : report.kinematic_viscosity;
  }
  return report;
}

template <template <class> class Model, class Real, int dim>
StressReport update_particles(const ModelParameters& parameters, const MaterialColumns<Real, dim>& columns,
                              std::size_t begin, std::size_t end, Real dt) {
  if (!parameters.varied.empty()) return update_varied<Model, Real, dim>(parameters, columns, begin, end, dt);
  return update_range<Model, Real, dim>(parameters, nullptr, columns, begin, end, dt);
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
