// What every return map promises: the state that it gives lies on the yield surface or inside, a second call changes
// nothing, and plastic flow takes work and never gives any. Snow, which clamps stretches, has its own test.

#include <gtest/gtest.h>

#include <algorithm>

#include "materials/plastic_states.h"

namespace firn {
namespace {

using namespace test;

constexpr int kStates = 100000;

template <template <class> class M, int d>
struct Case {
  using Model = M<double>;
  static constexpr int kDim = d;
};
using Cases = testing::Types<Case<hw::VonMises, 2>, Case<hw::VonMises, 3>, Case<hw::DruckerPrager, 2>,
                             Case<hw::DruckerPrager, 3>, Case<hw::CamClay, 2>, Case<hw::CamClay, 3>>;
struct CaseNames {
  template <class T>
  static std::string GetName(int) {
    return std::string(T::Model::kName) + "_" + std::to_string(T::kDim) + "d";
  }
};

template <class T>
class ReturnMap : public testing::Test {
 protected:
  using Tested = typename T::Model;
  static constexpr int kDim = T::kDim;
  using State = Element<Tested, kDim>;

  /// Principal elastic strains, and their directions, with the out-of-plane one in 2D.
  hw::HenckyStrain<double, kDim> strain(const State& state) const {
    return hw::hencky_strain(state.strain, kDim == 2 ? state.history[Tested::kHistory.size() - 1] : 0);
  }

  ModelParameters parameters = plastic_parameters<Tested>();
  Tested model = Tested(parameters);
  double modulus =
      lame_lambda(parameters.values[0], parameters.values[1]) + 2 * lame_mu(parameters.values[0], parameters.values[1]);
};
TYPED_TEST_SUITE(ReturnMap, Cases, CaseNames);

TYPED_TEST(ReturnMap, EndsOnTheYieldSurfaceOrInsideAndStaysThere) {
  using Model = typename TypeParam::Model;
  constexpr int dim = TypeParam::kDim;
  Random random(1);
  int yielded = 0, inside = 0;
  for (int n = 0; n < kStates / 5; ++n) {
    auto state = plastic_state<Model, dim>(random);
    const auto trial = state;
    const auto first = state.update(this->model, {}, 0);
    const double outside = excess<Model>(this->parameters, invariants<dim>(first), state.history);
    ASSERT_LE(outside, 1e-10 * this->modulus) << n;
    if (distance(trial.strain, state.strain) > 1e-9) {
      ++yielded;
    } else {
      ++inside;
    }
    const auto before = state;
    const auto second = state.update(this->model, {}, 0);
    ASSERT_LE(distance(second.tau, first.tau), 1e-9 * this->modulus) << n;
    ASSERT_LE(distance(state.strain, before.strain), 1e-9) << n;
    for (std::size_t h = 0; h < Model::kHistory.size(); ++h) {
      ASSERT_NEAR(state.history[h], before.history[h], 1e-9) << Model::kHistory[h].name << " " << n;
    }
  }
  // Both kinds of state were met.
  EXPECT_GT(yielded, kStates / 50);
  EXPECT_GT(inside, 50);
}

TYPED_TEST(ReturnMap, LeavesElasticStatesAlone) {
  using Model = typename TypeParam::Model;
  constexpr int dim = TypeParam::kDim;
  Random random(2);
  int met = 0;
  for (int n = 0; n < 2000; ++n) {
    Element<Model, dim> state(random_deformation<dim>(random, 0.98, 0.99));
    const auto trial = state;
    const auto response = state.update(this->model, {}, 0);
    if (excess<Model>(this->parameters, invariants<dim>(response), state.history) > -10) continue;
    ++met;
    EXPECT_TRUE(std::equal(trial.strain.e, trial.strain.e + dim * dim, state.strain.e));
    EXPECT_TRUE(std::equal(trial.history, trial.history + kMaxHistoryColumns, state.history));
  }
  EXPECT_GT(met, 100);
}

TYPED_TEST(ReturnMap, PlasticFlowTakesWork) {
  using Model = typename TypeParam::Model;
  constexpr int dim = TypeParam::kDim;
  Random random(3);
  double total = 0;
  for (int n = 0; n < kStates; ++n) {
    auto state = plastic_state<Model, dim>(random);
    const auto trial = this->strain(state).strain;
    state.update(this->model, {}, 0);
    const auto elastic = this->strain(state);
    const double mu = this->model.mu, lambda = this->model.lambda;
    double work = 0;
    const double trace = elastic.strain[0] + elastic.strain[1] + elastic.strain[2];
    for (int i = 0; i < 3; ++i) {
      work += (2 * mu * elastic.strain[i] + lambda * trace) * (trial[i] - elastic.strain[i]);
    }
    ASSERT_GE(work, -1e-9 * this->modulus) << n;
    total += work;
  }
  EXPECT_GT(total / kStates, 1e-3 * this->modulus);
}

TYPED_TEST(ReturnMap, KeepsTheAxesOfStrainAndIsObjective) {
  using Model = typename TypeParam::Model;
  constexpr int dim = TypeParam::kDim;
  Random random(4);
  for (int n = 0; n < 2000; ++n) {
    auto state = plastic_state<Model, dim>(random), turned = state;
    const auto Q = random_rotation<dim>(random), R = random_rotation<dim>(random);
    turned.strain = Q * turned.strain * R;
    const auto response = state.update(this->model, {}, 0), of_turned = turned.update(this->model, {}, 0);
    EXPECT_LE(distance(of_turned.tau, Q * response.tau * hw::transpose(Q)), 1e-11 * this->modulus);
    EXPECT_LE(distance(turned.strain, Q * state.strain * R), 1e-11);
    EXPECT_NEAR(of_turned.tau_zz, response.tau_zz, dim == 2 ? 1e-11 * this->modulus : 1e300);
    for (std::size_t h = 0; h < Model::kHistory.size(); ++h) EXPECT_NEAR(turned.history[h], state.history[h], 1e-11);
  }
}

TYPED_TEST(ReturnMap, PlaneStrainIsASliceOfThreeDimensionsWhileItFlows) {
  using Model = typename TypeParam::Model;
  Random random(5);
  for (int walk = 0; walk < 20; ++walk) {
    Element<Model, 2> plane(hw::identity<double, 2>());
    Element<Model, 3> space(hw::identity<double, 3>());
    for (int step = 0; step < 100; ++step) {
      const auto g = random_matrix<2>(random, 3);
      const auto flat = plane.update(this->model, g, 0.01);
      const auto solid = space.update(this->model, Matrix<3>{{g.e[0], g.e[1], 0, g.e[2], g.e[3], 0, 0, 0, 0}}, 0.01);
      for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < 2; ++j) ASSERT_NEAR(flat.tau(i, j), solid.tau(i, j), 1e-8 * this->modulus) << step;
      }
      ASSERT_NEAR(flat.tau_zz, solid.tau(2, 2), 1e-8 * this->modulus);
      const double flat_ratio = this->model.volume_ratio(hw::determinant(plane.strain), plane.history);
      ASSERT_NEAR(flat_ratio, this->model.volume_ratio(hw::determinant(space.strain), space.history), 1e-8);
    }
  }
}

TYPED_TEST(ReturnMap, NoticesAYieldSurfaceThatIsOnePercentTooSmall) {
  using Model = typename TypeParam::Model;
  constexpr int dim = TypeParam::kDim;
  ModelParameters weaker = this->parameters;
  set_parameter<Model>(weaker, "yield_stress", 0.99 * 8e3);
  set_parameter<Model>(weaker, "friction_angle", 0.99 * 30);
  Random random(6);
  double worst = 0;
  for (int n = 0; n < 1000; ++n) {
    auto state = plastic_state<Model, dim>(random);
    const auto response = state.update(this->model, {}, 0);
    worst = std::max(worst, excess<Model>(weaker, invariants<dim>(response), state.history));
  }
  EXPECT_GT(worst, 1e-5 * this->modulus);
}

}  // namespace
}  // namespace firn
