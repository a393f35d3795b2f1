// Parameters that differ between particles: in lanes they must do what they do for each particle alone.

#include <firn/core/simd.h>
#include <firn/materials/model_info.h>
#include <firn/materials/update_stress.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/random.h"

namespace firn {
namespace {

using test::Random;

constexpr std::size_t kCount = 53, kRoom = kCount + 16;
constexpr double kTimeStep = 0.01;

/// Columns of particles in random states.
template <class Real, int dim>
struct Columns {
  using Column = std::vector<Real>;
  std::vector<Column> grad_v, strain, history, stress;

  Columns(const ModelInfo& info, const ModelParameters& parameters) {
    grad_v.assign(dim * dim, Column(kRoom)), strain = grad_v;
    history.assign(history_columns(info, dim).size() + parameters.varied.size(), Column(kRoom));
    stress.assign(kStressComponents<dim>, Column(kRoom));
    Random random(7);
    for (std::size_t p = 0; p < kCount; ++p) {
      for (std::size_t e = 0; e < dim * dim; ++e) {
        grad_v[e][p] = static_cast<Real>(random.uniform(-3, 3));
        strain[e][p] = static_cast<Real>((e % (dim + 1) == 0 ? 1 : 0) + random.uniform(-0.05, 0.05));
      }
      for (std::size_t h = 0; h < history_columns(info, dim).size(); ++h) {
        history[h][p] = static_cast<Real>(info.history[h].initial_value + random.uniform(0, 0.05));
      }
    }
  }

  StressReport update(int model, const ModelParameters& parameters, std::size_t begin, std::size_t end) {
    MaterialColumns<Real, dim> columns = {};
    const StrainKind kind = all_models()[static_cast<std::size_t>(model)].strain;
    for (std::size_t e = 0; e < dim * dim; ++e) columns.grad_v[e] = grad_v[e].data();
    for (const StrainEntry& entry : strain_entries(kind, dim)) {
      columns.strain[entry.entry] = strain[static_cast<std::size_t>(entry.entry)].data();
    }
    for (std::size_t h = 0; h < history.size(); ++h) columns.history[h] = history[h].data();
    for (std::size_t s = 0; s < stress.size(); ++s) columns.stress[s] = stress[s].data();
    return update_stress_function<Real, dim>(model)(parameters, columns, begin, end, static_cast<Real>(kTimeStep));
  }
};

/// Two sets of values that Real can hold: the defaults, and others that are allowed too.
template <class Real>
std::vector<double> values_of(const ModelInfo& info, double factor) {
  std::vector<double> values;
  for (const Parameter& p : info.parameters) {
    const double wanted = p.default_value == 0 ? (factor == 1 ? 0 : 0.1) : p.default_value * factor;
    const double value = static_cast<double>(static_cast<Real>(wanted));
    values.push_back(in_range(p, value) ? value : static_cast<double>(static_cast<Real>(p.default_value)));
  }
  return values;
}

class VariedParameters : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { select_simd_target(GetParam()); }
  void TearDown() override { select_simd_target(available_simd_targets().back()); }

  /// The first `border` particles have one set of values, the others another one.
  template <class Real, int dim>
  void expect_halves_to_be_two_materials(std::size_t border) {
    for (int model = 0; model < static_cast<int>(all_models().size()); ++model) {
      const ModelInfo& info = all_models()[static_cast<std::size_t>(model)];
      SCOPED_TRACE(std::string(info.name));
      const ModelParameters one = {.values = values_of<Real>(info, 1)}, other = {.values = values_of<Real>(info, 1.1)};
      ASSERT_NE(one.values, other.values);
      ModelParameters both = one;
      for (int k = 0; k < static_cast<int>(info.parameters.size()); ++k) both.varied.push_back(k);

      Columns<Real, dim> apart(info, one), together(info, both);
      const std::size_t own = apart.history.size();
      for (std::size_t k = 0; k < info.parameters.size(); ++k) {
        for (std::size_t p = 0; p < kCount; ++p) {
          together.history[own + k][p] = static_cast<Real>((p < border ? one : other).values[k]);
        }
      }
      const auto varied_before = std::vector(together.history.begin() + static_cast<long>(own), together.history.end());
      const StressReport left = apart.update(model, one, 0, border), right = apart.update(model, other, border, kCount);
      const StressReport report = together.update(model, both, 0, kCount);
      EXPECT_TRUE(apart.stress == together.stress);
      EXPECT_TRUE(apart.strain == together.strain);
      EXPECT_TRUE(std::equal(apart.history.begin(), apart.history.end(), together.history.begin()));
      EXPECT_TRUE(
          std::equal(varied_before.begin(), varied_before.end(), together.history.begin() + static_cast<long>(own)))
          << "values are kept";
      EXPECT_EQ(report.wave_speed, std::max(left.wave_speed, right.wave_speed));
      EXPECT_EQ(report.kinematic_viscosity, std::max(left.kinematic_viscosity, right.kinematic_viscosity));
      EXPECT_GT(report.wave_speed, 0);
      EXPECT_EQ(report.failed, StressReport::kNone);
    }
  }
};

TEST_P(VariedParameters, HalvesWithTheirOwnValuesAreTwoMaterialsToTheBit) {
  // Borders between vectors and inside of them.
  for (const std::size_t border : {std::size_t(16), std::size_t(21), std::size_t(1)}) {
    expect_halves_to_be_two_materials<float, 2>(border);
    expect_halves_to_be_two_materials<float, 3>(border);
    expect_halves_to_be_two_materials<double, 2>(border);
    expect_halves_to_be_two_materials<double, 3>(border);
  }
}

TEST_P(VariedParameters, OneOfThemMayVaryAndTheRestBeShared) {
  const ModelInfo& info = *find_model("von_mises");
  const int model = model_number("von_mises");
  ModelParameters shared = {.values = values_of<double>(info, 1)}, varied = shared, stronger = shared;
  varied.varied = {2};
  stronger.values[2] = 5e3;
  Columns<double, 3> columns(info, varied), weak(info, shared), strong(info, shared);
  for (std::size_t p = 0; p < kCount; ++p) columns.history[1][p] = p % 2 == 0 ? shared.values[2] : 5e3;
  // In three dimensions the model has one column, and the varied one is next.
  ASSERT_EQ(columns.history.size(), 2u);
  columns.update(model, varied, 0, kCount);
  weak.update(model, shared, 0, kCount);
  strong.update(model, stronger, 0, kCount);
  int different = 0;
  for (std::size_t p = 0; p < kCount; ++p) {
    EXPECT_EQ(columns.stress[0][p], (p % 2 == 0 ? weak : strong).stress[0][p]);
    different += weak.stress[0][p] != strong.stress[0][p] ? 1 : 0;
  }
  EXPECT_GT(different, 40);
}

TEST_P(VariedParameters, AFailureIsReportedByItsFirstIndex) {
  const ModelInfo& info = *find_model("neo_hookean");
  ModelParameters parameters = {.values = values_of<float>(info, 1), .varied = {0}};
  Columns<float, 3> columns(info, parameters);
  for (std::size_t p = 0; p < kCount; ++p) columns.history[0][p] = 1e5f;
  columns.strain[0][30] = columns.strain[0][41] = std::nanf("");
  EXPECT_EQ(columns.update(model_number("neo_hookean"), parameters, 0, kCount).failed, 30u);
}

INSTANTIATE_TEST_SUITE_P(Targets, VariedParameters, testing::ValuesIn(available_simd_targets()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace firn
