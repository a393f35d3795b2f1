#include <firn/core/simd.h>
#include <firn/materials/model_info.h>
#include <firn/materials/update_stress.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "materials/states.h"

namespace firn {
namespace {

using namespace test;

constexpr std::size_t kLargestVector = 16;  // floats of AVX-512
constexpr double kTimeStep = 0.01;

/// Columns of `count` particles in random states, with recognisable values behind them.
template <class Real, int dim>
struct Columns {
  static constexpr Real kCanary = Real(12345);
  std::size_t count;
  StrainKind kind;
  std::vector<std::vector<Real>> grad_v, strain, history, stress;

  Columns(std::size_t particles, const ModelInfo& info, std::uint64_t seed) : count(particles), kind(info.strain) {
    const auto make = [&](std::size_t components) {
      return std::vector<std::vector<Real>>(components, std::vector<Real>(count + kLargestVector, kCanary));
    };
    grad_v = make(dim * dim), strain = make(dim * dim), history = make(history_columns(info, dim).size());
    stress = make(kStressComponents<dim>);
    Random random(seed);
    const double size = info.name == "snow" ? 0.15 : 0.3;
    for (std::size_t p = 0; p < count; ++p) {
      for (std::size_t e = 0; e < dim * dim; ++e) {
        grad_v[e][p] = static_cast<Real>(random.uniform(-5, 5));
        strain[e][p] = static_cast<Real>((e % (dim + 1) == 0 ? 1 : 0) + random.uniform(-size, size));
      }
      for (std::size_t h = 0; h < history.size(); ++h)
        history[h][p] = static_cast<Real>(info.history[h].initial_value + random.uniform(-0.1, 0.1));
      if (info.strain != StrainKind::deformation_gradient) make_definite(p);
    }
  }

  /// b = F F^T instead of F, as conformations are.
  void make_definite(std::size_t p) {
    Matrix<dim> F;
    for (std::size_t e = 0; e < dim * dim; ++e) F.e[e] = strain[e][p];
    const Matrix<dim> b = F * hw::transpose(F);
    for (std::size_t e = 0; e < dim * dim; ++e) strain[e][p] = static_cast<Real>(b.e[e]);
  }

  /// As a particle store gives them: columns that the model has no use for are null.
  MaterialColumns<Real, dim> pointers() {
    MaterialColumns<Real, dim> columns = {};
    for (std::size_t e = 0; e < dim * dim; ++e) columns.grad_v[e] = grad_v[e].data();
    for (const StrainEntry& entry : strain_entries(kind, dim)) {
      const auto e = static_cast<std::size_t>(entry.entry);
      columns.strain[e] = strain[e].data();
    }
    for (std::size_t h = 0; h < history.size(); ++h) columns.history[h] = history[h].data();
    for (std::size_t s = 0; s < stress.size(); ++s) columns.stress[s] = stress[s].data();
    return columns;
  }
};

ModelParameters parameters_of(const ModelInfo& info) {
  ModelParameters parameters;
  for (const Parameter& p : info.parameters) parameters.values.push_back(p.default_value);
  if (info.name == "snow") {
    // Room for rounding of the strain, eps / theta_c of the stress.
    parameters.values[2] = 0.1;
    parameters.values[3] = 0.05;
  }
  if (info.name == "rankine_damage") {
    // The same, eps over the strain at which it cracks.
    parameters.values[2] = 1e4;
    parameters.values[3] = 100;
  }
  return parameters;
}

/// The same update on plain numbers.
template <template <class> class Model, class Real, int dim>
StressReport update_numbers(const ModelParameters& parameters, Columns<Real, dim>& c) {
  const Model<double> model(parameters);
  double modulus = 0, viscosity = 0;
  for (std::size_t p = 0; p < c.count; ++p) {
    Matrix<dim> F, grad_v;
    for (std::size_t e = 0; e < dim * dim; ++e) F.e[e] = c.strain[e][p], grad_v.e[e] = c.grad_v[e][p];
    double memory[kMaxHistoryColumns] = {};
    for (std::size_t h = 0; h < c.history.size(); ++h) memory[h] = c.history[h][p];
    const auto response = model.update(F, memory, grad_v, static_cast<double>(Real(kTimeStep)));
    for (const StrainEntry& entry : strain_entries(c.kind, dim)) {
      const auto e = static_cast<std::size_t>(entry.entry);
      c.strain[e][p] = static_cast<Real>(F.e[e]);
    }
    for (std::size_t h = 0; h < c.history.size(); ++h) c.history[h][p] = static_cast<Real>(memory[h]);
    const auto& t = response.tau;
    const std::vector<double> stored =
        dim == 3 ? std::vector{t(0, 0), t(1, 1), t(2 % dim, 2 % dim), t(0, 1), t(0, 2 % dim), t(1, 2 % dim)}
                 : std::vector{t(0, 0), t(1, 1), response.tau_zz, t(0, 1)};
    for (std::size_t s = 0; s < stored.size(); ++s) c.stress[s][p] = static_cast<Real>(stored[s]);
    modulus = std::max(modulus, response.wave_modulus);
    if constexpr (hw::is_viscous<Model<double>>()) viscosity = std::max(viscosity, response.viscosity);
  }
  return {std::sqrt(modulus / parameters.density), StressReport::kNone, viscosity / parameters.density};
}

template <class Real, int dim, template <class> class... Models>
StressReport update_numbers(int model, hw::ModelList<Models...>, const ModelParameters& parameters,
                            Columns<Real, dim>& c) {
  using Function = StressReport (*)(const ModelParameters&, Columns<Real, dim>&);
  static constexpr std::array<Function, sizeof...(Models)> kFunctions = {&update_numbers<Models, Real, dim>...};
  return kFunctions[static_cast<std::size_t>(model)](parameters, c);
}

template <class Real>
double relative_difference(const std::vector<std::vector<Real>>& a, const std::vector<std::vector<Real>>& b,
                           std::size_t count) {
  double difference = 0, magnitude = 0;
  for (std::size_t c = 0; c < a.size(); ++c) {
    for (std::size_t p = 0; p < count; ++p) {
      difference = std::max(difference, std::fabs(static_cast<double>(a[c][p]) - static_cast<double>(b[c][p])));
      magnitude = std::max(magnitude, std::fabs(static_cast<double>(b[c][p])));
    }
  }
  return magnitude > 0 ? difference / magnitude : difference;
}

class UpdateStressOnTarget : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { select_simd_target(GetParam()); }
  void TearDown() override { select_simd_target(available_simd_targets().back()); }

  template <class Body>
  void for_each_model(const Body& body) {
    for (const ModelInfo& info : all_models()) {
      SCOPED_TRACE(std::string(info.name));
      body(info, model_number(info.name));
    }
  }

  template <class Real, int dim>
  void expect_numbers_and_unharmed_canaries() {
    const double tolerance = sizeof(Real) == 4 ? 1e-5 : 1e-13;
    for_each_model([&](const ModelInfo& info, int model) {
      const ModelParameters parameters = parameters_of(info);
      for (std::size_t count = 0; count <= 3 * kLargestVector; ++count) {
        Columns<Real, dim> lanes(count, info, count), numbers = lanes;
        const auto report = update_stress_function<Real, dim>(model)(parameters, lanes.pointers(), 0, count, kTimeStep);
        const auto expected = update_numbers<Real, dim>(model, hw::AllModels(), parameters, numbers);
        EXPECT_LE(relative_difference(lanes.strain, numbers.strain, count), tolerance) << count;
        EXPECT_LE(relative_difference(lanes.history, numbers.history, count), tolerance) << count;
        EXPECT_LE(relative_difference(lanes.stress, numbers.stress, count), tolerance) << count;
        EXPECT_NEAR(report.wave_speed, expected.wave_speed, tolerance * expected.wave_speed);
        EXPECT_NEAR(report.kinematic_viscosity, expected.kinematic_viscosity, tolerance * expected.kinematic_viscosity);
        EXPECT_EQ(report.kinematic_viscosity > 0, info.viscous && count > 0);
        EXPECT_EQ(report.failed, StressReport::kNone);
        for (const auto* columns : {&lanes.strain, &lanes.history, &lanes.stress}) {
          for (const auto& column : *columns) {
            EXPECT_TRUE(std::all_of(column.begin() + static_cast<std::ptrdiff_t>(count), column.end(), [](Real x) {
              return x == (Columns<Real, dim>::kCanary);
            })) << count;
          }
        }
      }
    });
  }

  /// Only particles [begin, end) change, wherever vectors begin, and they get the bits that the whole range gives them.
  template <class Real, int dim>
  void expect_ranges_to_be_independent() {
    for_each_model([&](const ModelInfo& info, int model) {
      constexpr std::size_t kCount = 40;
      const auto update = update_stress_function<Real, dim>(model);
      const ModelParameters parameters = parameters_of(info);
      Columns<Real, dim> whole(kCount, info, 1), parts = whole;
      update(parameters, whole.pointers(), 0, kCount, kTimeStep);
      for (const auto& [begin, end] : {std::pair{5, 18}, {0, 5}, {19, 40}, {18, 19}}) {
        update(parameters, parts.pointers(), static_cast<std::size_t>(begin), static_cast<std::size_t>(end), kTimeStep);
      }
      EXPECT_EQ(whole.strain, parts.strain);
      EXPECT_EQ(whole.history, parts.history);
      EXPECT_EQ(whole.stress, parts.stress);
    });
  }

  template <class Real, int dim>
  void expect_failures_to_be_reported() {
    const Real nan = std::numeric_limits<Real>::quiet_NaN(), infinity = std::numeric_limits<Real>::infinity();
    for_each_model([&](const ModelInfo& info, int model) {
      constexpr std::size_t kCount = 41;
      const auto update = update_stress_function<Real, dim>(model);
      const ModelParameters parameters = parameters_of(info);
      const auto failed_with = [&](const auto& spoil) {
        Columns<Real, dim> columns(kCount, info, 1);
        spoil(columns);
        const auto report = update(parameters, columns.pointers(), 0, kCount, kTimeStep);
        EXPECT_TRUE(std::isfinite(report.wave_speed));
        return report.failed;
      };
      for (const std::size_t p : {0u, 7u, 40u}) {
        for (const StrainEntry& entry : strain_entries(info.strain, dim)) {
          const auto e = static_cast<std::size_t>(entry.entry);
          EXPECT_EQ(failed_with([&](auto& c) { c.strain[e][p] = nan; }), p) << e;
          EXPECT_EQ(failed_with([&](auto& c) { c.strain[e][p] = infinity; }), p) << e;
        }
        for (std::size_t e = 0; e < dim * dim; ++e) {
          EXPECT_EQ(failed_with([&](auto& c) { c.grad_v[e][p] = nan; }), p) << e;
          EXPECT_EQ(failed_with([&](auto& c) { c.grad_v[e][p] = -infinity; }), p) << e;
        }
        for (std::size_t h = 0; h < history_columns(info, dim).size(); ++h) {
          EXPECT_EQ(failed_with([&](auto& c) { c.history[h][p] = nan; }), p) << info.history[h].name;
        }
        EXPECT_EQ(failed_with([&](auto& c) { c.strain[0][p] = c.strain[0][40] = nan; }), p) << "the first one";
        // Turned inside out, or flat.
        const bool bears_it = info.minimum_J < 0;
        for (const Real stretch : {Real(-0.9), Real(0)}) {
          const std::size_t failed = failed_with([&](auto& c) {
            for (std::size_t e = 0; e < dim * dim; ++e) {
              c.grad_v[e][p] = 0;
              c.strain[e][p] = e == 0 ? stretch : e % (dim + 1) == 0 ? Real(1) : Real(0);
            }
          });
          EXPECT_EQ(failed, bears_it ? StressReport::kNone : p) << stretch;
        }
      }
    });
  }
};

TEST_P(UpdateStressOnTarget, LanesAgreeWithNumbersForEveryCount) {
  expect_numbers_and_unharmed_canaries<float, 2>();
  expect_numbers_and_unharmed_canaries<float, 3>();
  expect_numbers_and_unharmed_canaries<double, 2>();
  expect_numbers_and_unharmed_canaries<double, 3>();
}

TEST_P(UpdateStressOnTarget, RangesAreIndependent) {
  expect_ranges_to_be_independent<float, 2>();
  expect_ranges_to_be_independent<float, 3>();
  expect_ranges_to_be_independent<double, 2>();
  expect_ranges_to_be_independent<double, 3>();
}

TEST_P(UpdateStressOnTarget, UnusableStatesAreReportedByTheirFirstIndex) {
  expect_failures_to_be_reported<float, 2>();
  expect_failures_to_be_reported<float, 3>();
  expect_failures_to_be_reported<double, 2>();
  expect_failures_to_be_reported<double, 3>();
}

/// Smooth motion of one set of particles: its columns after some steps.
template <class Real, int dim>
Columns<Real, dim> moved(Columns<Real, dim> columns, const ModelInfo& info, int steps) {
  const auto update = update_stress_function<Real, dim>(model_number(info.name));
  for (int step = 0; step < steps; ++step) {
    update(parameters_of(info), columns.pointers(), 0, columns.count, static_cast<Real>(1e-3));
  }
  return columns;
}

/// Undeformed particles, each with a velocity gradient of its own.
template <class Real, int dim>
Columns<Real, dim> at_rest(const ModelInfo& info) {
  Columns<Real, dim> columns(40, info, 1);
  Random random(9);
  for (std::size_t p = 0; p < columns.count; ++p) {
    for (std::size_t e = 0; e < dim * dim; ++e) {
      columns.grad_v[e][p] = static_cast<Real>(random.uniform(-1, 1));
      columns.strain[e][p] = e % (dim + 1) == 0 ? Real(1) : Real(0);
    }
    for (std::size_t h = 0; h < columns.history.size(); ++h) {
      columns.history[h][p] = static_cast<Real>(info.history[h].initial_value);
    }
  }
  return columns;
}

TEST_P(UpdateStressOnTarget, SinglePrecisionFollowsDouble) {
  for_each_model([&](const ModelInfo& info, int model) {
    const auto single = moved(at_rest<float, 3>(info), info, 100);
    auto exact = moved(at_rest<double, 3>(info), info, 100);
    const ModelParameters parameters = parameters_of(info);
    const auto report = update_stress_function<double, 3>(model)(parameters, exact.pointers(), 0, exact.count, 0.0);
    // A hundred roundings of the strain, times the stiffness.
    const double tolerance = 3e-5 * report.wave_speed * report.wave_speed * parameters.density;
    for (std::size_t s = 0; s < exact.stress.size(); ++s) {
      for (std::size_t p = 0; p < exact.count; ++p) {
        ASSERT_NEAR(single.stress[s][p], exact.stress[s][p], tolerance) << s << " " << p;
      }
    }
  });
}

TEST_P(UpdateStressOnTarget, ColumnsAreAllThatAParticleRemembers) {
  // Columns that are written and read back go on with the same bits.
  for_each_model([&](const ModelInfo& info, int) {
    const auto whole = moved(at_rest<float, 2>(info), info, 60);
    const auto half = moved(at_rest<float, 2>(info), info, 30);
    Columns<float, 2> restored(half.count, info, 5);
    restored.grad_v = half.grad_v, restored.strain = half.strain, restored.history = half.history;
    restored = moved(restored, info, 30);
    for (const StrainEntry& entry : strain_entries(info.strain, 2)) {
      const auto e = static_cast<std::size_t>(entry.entry);
      EXPECT_EQ(whole.strain[e], restored.strain[e]);
    }
    EXPECT_EQ(whole.history, restored.history);
    EXPECT_TRUE(std::equal(whole.stress[0].begin(), whole.stress[0].begin() + 40, restored.stress[0].begin()));
  });
}

INSTANTIATE_TEST_SUITE_P(Targets, UpdateStressOnTarget, testing::ValuesIn(available_simd_targets()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace firn
