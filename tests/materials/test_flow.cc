// Materials that flow: Herschel-Bulkley pastes, viscoelastic and Newtonian liquids, driven through single points.

#include <firn/materials/model_info.h>
#include <gtest/gtest.h>

#include <array>

#include "materials/plastic_states.h"

namespace firn {
namespace {

using namespace test;

/// Stress after shearing at a rate (1/s) for a time (s).
template <class Model, int dim>
hw::Response<double, dim> sheared(const Model& model, Element<Model, dim>& element, double rate, double time,
                                  int steps) {
  Matrix<dim> grad_v = {};
  grad_v(0, 1) = rate;
  hw::Response<double, dim> response;
  for (int step = 0; step < steps; ++step) response = element.update(model, grad_v, time / steps);
  return response;
}

using Paste = hw::HerschelBulkley<double>;

TEST(HerschelBulkley, SteadyShearFollowsTheFlowCurve) {
  for (const auto& [yield, consistency, index] :
       {std::array{100.0, 20.0, 1.0}, {100.0, 20.0, 0.3}, {50.0, 5.0, 0.6}, {0.0, 10.0, 1.5}, {1.0, 0.7, 0.6}}) {
    const Paste paste({{1e6, 0.3, yield, consistency, index}, 1000});
    for (const double rate : {0.01, 1.0, 30.0}) {
      const double expected = yield + consistency * std::pow(rate, index);
      Element<Paste, 3> solid(hw::identity<double, 3>());
      Element<Paste, 2> plane(hw::identity<double, 2>());
      // Long against the time in which the elastic stress builds up.
      const double time = 2 + 20 * expected / (4e5 * rate);
      const int steps = 4000;
      EXPECT_NEAR(sheared(paste, solid, rate, time, steps).tau(0, 1) / expected, 1, 5e-3) << index << " " << rate;
      EXPECT_NEAR(sheared(paste, plane, rate, time, steps).tau(0, 1) / expected, 1, 5e-3) << index << " " << rate;
    }
  }
}

TEST(HerschelBulkley, DoesNotFlowBelowYield) {
  const Paste paste({{1e4, 0.3, 100, 10, 0.5}, 1000});
  Element<Paste, 3> element(hw::identity<double, 3>());
  const double below = 0.99 * 100 / lame_mu(1e4, 0.3);
  const double tau = sheared(paste, element, 1.0, below, 100).tau(0, 1);
  EXPECT_NEAR(tau, 99, 0.02);
  const auto before = element.strain;
  for (int step = 0; step < 1000; ++step) element.update(paste, {}, 1.0);
  EXPECT_TRUE(std::equal(before.e, before.e + 9, element.strain.e));
  // Beyond yield the same wait brings it back to the yield stress.
  sheared(paste, element, 1.0, 1, 1000);
  const auto rested = element.update(paste, {}, 1e6);
  EXPECT_NEAR(invariants<3>(rested).q / std::numbers::sqrt3, 100, 1e-2);
}

TEST(HerschelBulkley, SolvesTheImplicitStep) {
  Random random(1);
  const double mu = lame_mu(1e5, 0.3);
  double worst = 0;
  for (int n = 0; n < 20000; ++n) {
    const double consistency = std::pow(10, random.uniform(-3, 5)), index = random.uniform(0.1, 3);
    const double excess_stress = std::pow(10, random.uniform(-4, 6)), dt = std::pow(10, random.uniform(-9, 0));
    const Paste paste({{1e5, 0.3, 0, consistency, index}, 1000});
    const double y = paste.overstress(excess_stress, dt);
    const double residual = y + mu * dt * std::pow(y / consistency, 1 / index) - excess_stress;
    // The slope of the equation in ln y is at least excess / max(1, n).
    worst = std::max(worst, std::fabs(residual) / excess_stress);
    EXPECT_LE(y, excess_stress * (1 + 1e-12));
  }
  EXPECT_LE(worst, 1e-9);
}

TEST(HerschelBulkley, FlowTakesWorkAndKeepsVolume) {
  const Paste paste({{1e5, 0.3, 2e3, 100, 0.5}, 1000});
  Random random(2);
  for (int n = 0; n < 20000; ++n) {
    const auto F = random_deformation<3>(random, 0.6, 1.5);
    Element<Paste, 3> element(F);
    const auto trial = hw::hencky_strain(F, 0.0).strain;
    element.update(paste, {}, 1e-3);
    const auto elastic = hw::hencky_strain(element.strain, 0.0).strain;
    double work = 0;
    const double trace = elastic[0] + elastic[1] + elastic[2];
    for (int i = 0; i < 3; ++i) work += (2 * paste.mu * elastic[i] + paste.lambda * trace) * (trial[i] - elastic[i]);
    ASSERT_GE(work, -1e-6);
    ASSERT_NEAR(hw::determinant(element.strain) / hw::determinant(F), 1, 1e-11);
  }
}

using Slime = hw::OldroydB<double>;

Slime slime(double shear_modulus, double relaxation_time, double viscosity = 0) {
  return Slime({{1e6, 7, viscosity, shear_modulus, relaxation_time}, 1000});
}

TEST(OldroydB, StartOfShearFollowsTheTheory) {
  // relaxation_time 0.5, rate 2, viscosity 3, t = 1: 5.18798830 and 7.12792980.
  const double lambda = 0.5, rate = 2, eta = 3, t = 1;
  const double shear = eta * rate * (1 - std::exp(-t / lambda));
  const double normal = 2 * eta * lambda * rate * rate * (1 - std::exp(-t / lambda) * (1 + t / lambda));
  EXPECT_NEAR(shear, 5.18798830, 1e-8);
  EXPECT_NEAR(normal, 7.12792980, 1e-8);
  const auto run = [&](int steps, double viscosity) {
    Element<Slime, 3> element(hw::identity<double, 3>());
    const auto response = sheared(slime(eta / lambda, lambda, viscosity), element, rate, t, steps);
    return std::array{response.tau(0, 1), response.tau(0, 0) - response.tau(1, 1)};
  };
  const auto coarse = run(1000, 0), fine = run(2000, 0);
  EXPECT_NEAR(coarse[0] / shear, 1, 5e-3);
  EXPECT_NEAR(coarse[1] / normal, 1, 5e-3);
  EXPECT_NEAR((coarse[0] - shear) / (fine[0] - shear), 2, 0.05) << "first order in dt";
  EXPECT_NEAR(run(1000, 0.25)[0] - coarse[0], 0.25 * rate, 1e-12) << "the solvent adds its viscosity";
}

TEST(OldroydB, StressRelaxesExponentially) {
  const Slime model = slime(1e3, 0.2);
  Matrix<3> step = hw::identity<double, 3>();
  step(0, 1) = 0.7;
  Element<Slime, 3> element(step);
  EXPECT_NEAR(element.update(model, {}, 0).tau(0, 1), 700, 1e-9);
  for (int n = 0; n < 30; ++n) element.update(model, {}, 0.01);
  EXPECT_NEAR(element.update(model, {}, 0.1).tau(0, 1), 700 * std::exp(-0.4 / 0.2), 1e-9);
}

TEST(OldroydB, ConformationStaysPositiveDefinite) {
  const Slime model = slime(1e3, 0.1);
  Random random(3);
  for (int walk = 0; walk < 50; ++walk) {
    Element<Slime, 3> element(hw::identity<double, 3>());
    for (int n = 0; n < 500; ++n) {
      element.update(model, random_matrix<3>(random, 20), 0.02);
      const auto& b = element.strain;
      ASSERT_GT(b(0, 0), 0);
      ASSERT_GT(b(0, 0) * b(1, 1) - b(0, 1) * b(0, 1), 0);
      ASSERT_GT(hw::determinant(b), 0);
    }
  }
}

TEST(OldroydB, RelaxationTakesEnergy) {
  const Slime model = slime(1e3, 0.1);
  Random random(4);
  for (int n = 0; n < 2000; ++n) {
    Element<Slime, 3> element(random_deformation<3>(random, 0.3, 3));
    const double before = model.energy(element.strain, element.history);
    element.update(model, {}, 0.01);
    EXPECT_LT(model.energy(element.strain, element.history), before);
  }
}

using Liquid = hw::NewtonianFluid<double>;

TEST(NewtonianFluid, TaitPressureOfAColumnIsTheOneOfTheory) {
  // p(depth) of the law p = B ((rho/rho0)^gamma - 1): B = 1e5, gamma = 7, 1 m of water: 9877.1936 Pa.
  const double B = 1e5, gamma = 7, rho = 1000, g = 9.81;
  const Liquid water({{B * gamma, gamma, 0, 1e12}, rho});
  // dp/dz = rho0 g / J, integrated with the model's own pressure, by the midpoint in the mass above.
  double J = 1, depth = 0;
  const int steps = 20000;
  const double mass = 9877.1936 / g;  // kg/m^2 above the floor
  for (int n = 0; n < steps; ++n) {
    const double target = (n + 0.5) * mass / steps * g;
    for (int k = 0; k < 3; ++k) J -= (water.liquid.pressure(J) - target) / (-water.liquid.wave_modulus(J) / (J * J));
    depth += mass / steps / rho * J;
  }
  EXPECT_NEAR(depth, 1, 1e-6);
  EXPECT_NEAR(water.liquid.pressure(0.99), B * (std::pow(0.99, -7) - 1), 1e-8);
}

TEST(NewtonianFluid, ShearStressIsViscosityTimesRate) {
  const Liquid honey({{1e6, 7, 8, 1e12}, 1400});
  Element<Liquid, 3> element(hw::identity<double, 3>());
  const auto response = sheared(honey, element, 3.0, 1, 10);
  EXPECT_NEAR(response.tau(0, 1), 24, 1e-12);
  EXPECT_NEAR(response.tau(1, 0), 24, 1e-12);
  EXPECT_EQ(response.tau(0, 0), 0);
  EXPECT_EQ(response.viscosity, 8);
  // Expansion alone has no viscous stress: what is left is pressure.
  const auto swollen = element.update(honey, 0.1 * hw::identity<double, 3>(), 0.01);
  EXPECT_NEAR(swollen.tau(0, 0), -element.strain(0, 0) * honey.liquid.pressure(element.strain(0, 0)), 1e-9);
}

TEST(NewtonianFluid, DissipatesInEveryMotion) {
  const Liquid honey({{1e6, 7, 8, 1e12}, 1400});
  Random random(5);
  for (int n = 0; n < 1000; ++n) {
    Element<Liquid, 2> element(hw::identity<double, 2>());
    const auto grad_v = random_matrix<2>(random, 5);
    const auto response = element.update(honey, grad_v, 1e-9);
    const double pressure = element.strain(0, 0) * honey.liquid.pressure(element.strain(0, 0));
    double power = pressure * hw::trace(grad_v);
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) power += response.tau(i, j) * grad_v(i, j);
    }
    EXPECT_GE(power, -1e-9);
  }
}

TEST(NewtonianFluid, OpensAtItsTensileStrengthAndForgetsTheVoid) {
  const Liquid water({{1e6, 7, 0, 2e3}, 1000});
  Element<Liquid, 3> element(hw::identity<double, 3>());
  const auto torn = element.update(water, 0.1 * hw::identity<double, 3>(), 1);
  EXPECT_NEAR(torn.tau(0, 0) / torn.J, 2e3, 1e-6);
  EXPECT_NEAR(element.update(water, -0.01 * hw::identity<double, 3>(), 1).J, torn.J * 0.97, 1e-12);
  const Liquid strong({{1e6, 7, 0, 1e12}, 1000});
  Element<Liquid, 3> held(hw::identity<double, 3>());
  EXPECT_NEAR(held.update(strong, 0.1 * hw::identity<double, 3>(), 1).J, 1.3, 1e-12);
}

TEST(Columns, AreThoseThatAModelDeclares) {
  const auto count = [](const char* model, int dim) { return strain_entries(find_model(model)->strain, dim).size(); };
  EXPECT_EQ(count("neo_hookean", 2), 4u);
  EXPECT_EQ(count("neo_hookean", 3), 9u);
  EXPECT_EQ(count("newtonian_fluid", 3), 1u);
  EXPECT_EQ(count("oldroyd_b", 2), 3u);
  EXPECT_EQ(count("oldroyd_b", 3), 6u);
  for (const ModelInfo& info : all_models()) {
    for (const int dim : {2, 3}) {
      for (const StrainEntry& e : strain_entries(info.strain, dim)) {
        EXPECT_LT(e.entry, dim * dim);
        EXPECT_EQ(e.initial_value, e.entry % (dim + 1) == 0 ? 1 : 0);
      }
    }
  }
  const ModelInfo& metal = *find_model("von_mises");
  EXPECT_EQ(history_columns(metal, 2).size(), 2u);
  EXPECT_EQ(history_columns(metal, 3).size(), 1u);
  EXPECT_EQ(history_columns(*find_model("snow"), 3).size(), 1u);
}

}  // namespace
}  // namespace firn
