#include <firn/materials/crack_band.h>
#include <firn/materials/model_info.h>
#include <firn/materials/point_driver.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "materials/states.h"

namespace firn {
namespace {

using namespace test;
using Model = hw::RankineDamage<double>;
using Strain = hw::Vec<double, 3>;

constexpr double kE = 3e10, kNu = 0.2, kStrength = 2.5e6, kFractureEnergy = 100;

ModelParameters concrete(double cell_size = 0.02, double nu = kNu) {
  return {.values = {kE, nu, kStrength, kFractureEnergy}, .cell_size = cell_size};
}

/// Work per area of a crack one cell wide, pulled without lateral stress until it is open and further.
double opening_work(double cell_size, double assumed_cell_size) {
  PointRequest request;
  request.model = model_number("rankine_damage");
  request.parameters = concrete(assumed_cell_size);
  request.path = PointPath::uniaxial;
  request.strain = 1.2 * opening_strain(kStrength, kFractureEnergy, assumed_cell_size);
  const auto states = drive_point(request);
  EXPECT_EQ(states.back().history[0], 1);
  EXPECT_NEAR(states.back().energy, 0, 1e-6 * states.back().work);
  EXPECT_NEAR(states.back().stress[0], 0, 1e-9 * kStrength);
  return states.back().work * cell_size;
}

TEST(RankineDamage, ACrackTakesItsFractureEnergyWhateverTheCellSize) {
  for (const double cell_size : {0.005, 0.02, 0.08}) {
    EXPECT_NEAR(opening_work(cell_size, cell_size), kFractureEnergy, 0.01 * kFractureEnergy) << cell_size;
  }
  // Without regard to the cell size, cells of twice the size take twice the energy.
  EXPECT_NEAR(opening_work(0.04, 0.02), 2 * kFractureEnergy, 0.02 * kFractureEnergy);
}

TEST(RankineDamage, StressFallsFromTheStrengthAlongALine) {
  PointRequest request;
  request.model = model_number("rankine_damage");
  request.parameters = concrete();
  request.path = PointPath::uniaxial;
  const double e0 = kStrength / kE, ef = opening_strain(kStrength, kFractureEnergy, 0.02);
  request.strain = 1.5 * ef;
  double last_damage = 0;
  for (const PointState& s : drive_point(request)) {
    const double line = s.strain < e0 ? kE * s.strain : std::max(kStrength * (ef - s.strain) / (ef - e0), 0.0);
    EXPECT_NEAR(s.stress[0] * s.volume_ratio, line, 2e-4 * kStrength) << s.strain;
    EXPECT_GE(s.history[0], last_damage);
    EXPECT_LE(s.history[0], 1);
    last_damage = s.history[0];
  }
}

/// Residual of the compliance for the stresses that the model answers with, over the size of the strain.
double compliance_error(const Strain& strain, double damage, double nu) {
  const Model model(concrete(0.02, nu));
  const auto answer = model.principal_stress(strain, 1 - damage);
  double worst = 0, size = 0;
  for (int i = 0; i < 3; ++i) {
    const double own = answer.tau[i], others = answer.tau[(i + 1) % 3] + answer.tau[(i + 2) % 3];
    size = std::max(size, std::fabs(strain[i]));
    // The strain of a crack is what the compliance leaves, positive; without stress if the crack is whole.
    const double crack = strain[i] - (own - nu * others);
    const double expected = own > 0 ? own * damage / (1 - damage) : 0;
    worst = std::max(worst, own == 0 && damage == 1 ? std::max(-crack, 0.0) : std::fabs(crack - expected));
  }
  return worst / size;
}

TEST(RankineDamage, StressSolvesTheCompliance) {
  Random random(1);
  for (const double nu : {-0.5, 0.0, 0.2, 0.45}) {
    for (const double damage : {0.0, 0.3, 0.9, 0.999, 1.0}) {
      for (int n = 0; n < 2000; ++n) {
        const Strain strain = {{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}};
        ASSERT_LE(compliance_error(strain, damage, nu), 2e-12) << nu << " " << damage;
      }
    }
  }
}

double energy_of(const Model& model, const Strain& strain, double damage) {
  const Matrix<3> F = {{std::exp(strain[0]), 0, 0, 0, std::exp(strain[1]), 0, 0, 0, std::exp(strain[2])}};
  return model.energy(F, &damage);
}

TEST(RankineDamage, StressOfCrackedMaterialIsTheGradientOfItsEnergy) {
  const Model model(concrete());
  Random random(2);
  for (int n = 0; n < 500; ++n) {
    const double damage = random.uniform(0, 1);
    const Strain strain = {{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}};
    for (int i = 0; i < 3; ++i) {
      constexpr double h = 1e-5;
      Strain above = strain, below = strain;
      above[i] += h, below[i] -= h;
      const double slope = (energy_of(model, above, damage) - energy_of(model, below, damage)) / (2 * h);
      EXPECT_NEAR(slope, kE * model.principal_stress(strain, 1 - damage).tau[i], 2e-5 * kE);
    }
  }
}

/// Work on a closed path through strains where different principal stresses are tensile.
template <class Stress>
double closed_work(const Stress& stress) {
  const Strain corners[] = {{{1, 0.2, 0}}, {{1, -1, 0.3}}, {{-0.4, -1, -0.5}}, {{-0.5, 1, 0.1}}, {{1, 0.2, 0}}};
  constexpr int kSteps = 2000;
  double work = 0;
  for (int c = 0; c < 4; ++c) {
    const Strain step = (1.0 / kSteps) * (corners[c + 1] - corners[c]);
    for (int n = 0; n < kSteps; ++n) work += hw::dot(stress(corners[c] + (n + 0.5) * step), step);
  }
  return work;
}

TEST(RankineDamage, ClosedPathsYieldNoEnergy) {
  const Model model(concrete());
  for (const double damage : {0.2, 0.7, 1.0}) {
    EXPECT_NEAR(closed_work([&](const Strain& e) { return model.principal_stress(e, 1 - damage).tau; }), 0, 1e-6);
    // The law that suggests itself, positive principal stresses of whole material times 1 - D, is an engine.
    const double engine = closed_work([&](const Strain& e) {
      Strain tau = model.principal_stress(e, 1).tau;
      for (int i = 0; i < 3; ++i) tau[i] *= tau[i] > 0 ? 1 - damage : 1;
      return tau;
    });
    EXPECT_GT(std::fabs(engine), 1e-2);
  }
}

TEST(RankineDamage, DamageGrowsAndTakesEnergyOnRandomPaths) {
  const Model model(concrete());
  Random random(3);
  int grown = 0;
  for (int path = 0; path < 50; ++path) {
    Matrix<3> F = hw::identity<double, 3>();
    double damage = 0;
    for (int n = 0; n < 200; ++n) {
      const double before = damage;
      model.update(F, &damage, random_matrix<3>(random, 1), 2e-4);
      ASSERT_GE(damage, before);
      ASSERT_LE(damage, 1);
      // The strain does its work at the damage before; what follows only takes.
      const double whole = model.energy(F, &before), left = model.energy(F, &damage);
      ASSERT_LE(left, whole * (1 + 1e-12));
      grown += damage > before ? 1 : 0;
      // The same strain again damages hardly any further, although a step is twice the strain at which it cracks.
      double again = damage;
      model.update(F, &again, Matrix<3>{}, 0);
      ASSERT_LE(again, damage + 5e-4);
    }
  }
  EXPECT_GT(grown, 300);
}

TEST(RankineDamage, ClosedCracksBearPressureAsIfWhole) {
  const Model model(concrete());
  const double broken = 1, whole = 0;
  Matrix<3> squeezed = hw::identity<double, 3>(), pulled = squeezed;
  squeezed(0, 0) = 0.999, pulled(0, 0) = 1.001;
  EXPECT_EQ(response(model, squeezed, &broken).tau(0, 0), response(model, squeezed, &whole).tau(0, 0));
  EXPECT_EQ(response(model, pulled, &broken).tau(0, 0), 0);
  EXPECT_GT(response(model, pulled, &whole).tau(0, 0), 0);
}

TEST(RankineDamage, CracksInPlaneStrainAreThoseOfThreeDimensions) {
  const Model model(concrete());
  Random random(4);
  for (int n = 0; n < 200; ++n) {
    const Matrix<2> F = hw::identity<double, 2>() + random_matrix<2>(random, 3e-4);
    Matrix<2> flat = F;
    Matrix<3> solid = {{F.e[0], F.e[1], 0, F.e[2], F.e[3], 0, 0, 0, 1}};
    double of_flat = 0.2, of_solid = 0.2;
    const auto plane = model.update(flat, &of_flat, Matrix<2>{}, 0);
    const auto space = model.update(solid, &of_solid, Matrix<3>{}, 0);
    EXPECT_NEAR(of_flat, of_solid, 1e-9);
    EXPECT_NEAR(plane.tau(0, 0), space.tau(0, 0), 1e-5 * kStrength);
    EXPECT_NEAR(plane.tau_zz, space.tau(2, 2), 1e-5 * kStrength);
  }
}

TEST(RankineDamage, CoarseCellsAreRefusedWithTheLargestThatWillDo) {
  const ModelInfo& model = *find_model("rankine_damage");
  EXPECT_EQ(model.refusal(concrete(0.9)), "");
  EXPECT_EQ(model.refusal(concrete(1)),
            "cells of 1 m are too coarse for a fracture_energy of 100 J/m^2: a cell would store more energy than its "
            "crack takes; use cells below 2 fracture_energy youngs_modulus / cracking_stress^2 = 0.96 m, more "
            "fracture_energy or less cracking_stress");
}

}  // namespace
}  // namespace firn
