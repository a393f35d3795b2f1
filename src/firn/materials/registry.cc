#include <firn/materials/model_info.h>
#include <firn/materials/models-inl.h>
#include <firn/materials/update_stress.h>

#include <array>

namespace firn {

const Parameter kDensity = {
    .name = "density",
    .unit = "kg/m^3",
    .default_value = 1000,
    .minimum = 0,
    .maximum = 1e6,
    .minimum_allowed = false,
    .help = "Mass per volume of the undeformed material.",
    .hint = "fresh snow is near 100, packed snow 400, water 1000, steel 7850",
};

namespace {

using namespace HWY_NAMESPACE;

/// Columns that only plane strain needs come last, so that those of three dimensions are a leading part.
template <class Model>
constexpr bool plane_strain_columns_last() {
  bool plane_strain = false;
  for (const HistoryColumn& column : Model::kHistory) {
    if (plane_strain && !column.plane_strain_only) return false;
    plane_strain = column.plane_strain_only;
  }
  return true;
}

template <class Model>
constexpr auto refusal_of() {
  std::string (*function)(const ModelParameters&) = nullptr;
  if constexpr (requires { &Model::refusal; }) function = &Model::refusal;
  return function;
}

template <template <class> class... Models>
constexpr auto infos_of(ModelList<Models...>) {
  static_assert(((Models<double>::kHistory.size() <= kMaxHistoryColumns) && ...));
  static_assert(((Models<double>::kParameters.size() <= kMaxVariedParameters) && ...));
  static_assert((plane_strain_columns_last<Models<double>>() && ...));
  return std::array{ModelInfo{
      .name = Models<double>::kName,
      .summary = Models<double>::kSummary,
      .source = Models<double>::kSource,
      .formula = Models<double>::kFormula,
      .parameters = Models<double>::kParameters,
      .history = Models<double>::kHistory,
      .strain = strain_kind<Models<double>>(),
      .minimum_J = Models<double>::kMinimumJ,
      .viscous = is_viscous<Models<double>>(),
      .refusal = refusal_of<Models<double>>(),
  }...};
}

constexpr auto kInfos = infos_of(AllModels());

template <int dim, template <class> class Model>
double energy_of(const ModelParameters& parameters, const double* F, const double* history) {
  HWY_NAMESPACE::Mat<double, dim> matrix;
  for (int e = 0; e < dim * dim; ++e) matrix.e[e] = F[e];
  return Model<double>(parameters).energy(matrix, history);
}

template <int dim, template <class> class... Models>
double energy_of(int model, ModelList<Models...>, const ModelParameters& parameters, const double* F,
                 const double* history) {
  using Function = double (*)(const ModelParameters&, const double*, const double*);
  static constexpr std::array<Function, sizeof...(Models)> kFunctions = {&energy_of<dim, Models>...};
  return kFunctions[static_cast<std::size_t>(model)](parameters, F, history);
}

template <template <class> class Model>
void volume_ratios_of(const ModelParameters& parameters, std::size_t count, const double* history, double* J) {
  const Model<double> model(parameters);
  for (std::size_t p = 0; p < count; ++p) J[p] = model.volume_ratio(J[p], history + p * kMaxHistoryColumns);
}

template <template <class> class... Models>
void volume_ratios_of(int model, ModelList<Models...>, const ModelParameters& parameters, std::size_t count,
                      const double* history, double* J) {
  using Function = void (*)(const ModelParameters&, std::size_t, const double*, double*);
  static constexpr std::array<Function, sizeof...(Models)> kFunctions = {&volume_ratios_of<Models>...};
  kFunctions[static_cast<std::size_t>(model)](parameters, count, history, J);
}

}  // namespace

std::span<const ModelInfo> all_models() { return kInfos; }

const ModelInfo* find_model(std::string_view name) {
  for (const ModelInfo& info : kInfos) {
    if (info.name == name) return &info;
  }
  return nullptr;
}

std::span<const HistoryColumn> history_columns(const ModelInfo& model, int dim) {
  std::size_t count = model.history.size();
  while (dim == 3 && count > 0 && model.history[count - 1].plane_strain_only) --count;
  return model.history.first(count);
}

int model_number(std::string_view name) {
  const ModelInfo* info = find_model(name);
  return info == nullptr ? -1 : static_cast<int>(info - kInfos.data());
}

template <int dim>
double energy_density(int model, const ModelParameters& parameters, const double* F, const double* history) {
  return energy_of<dim>(model, AllModels(), parameters, F, history);
}
double volume_ratio(int model, const ModelParameters& parameters, double J, const double* history) {
  volume_ratios(model, parameters, 1, history, &J);
  return J;
}
void volume_ratios(int model, const ModelParameters& parameters, std::size_t count, const double* history, double* J) {
  volume_ratios_of(model, AllModels(), parameters, count, history, J);
}
template double energy_density<2>(int, const ModelParameters&, const double*, const double*);
template double energy_density<3>(int, const ModelParameters&, const double*, const double*);

}  // namespace firn
