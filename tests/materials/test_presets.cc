// What "chosen" numbers of presets have to bring about, each with a neighbour that must not.

#include <firn/materials/friction_angle.h>
#include <firn/materials/model_info.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include "support/preset_points.h"

namespace firn {
namespace {

constexpr double kGravity = 9.81;  // m/s^2

using test::drive;
using test::number;

/// Largest tension or compression (by sign) of a bar pulled or squeezed to a strain, Pa.
double strength(std::string_view preset, double strain) {
  double largest = 0;
  for (const PointState& s : drive(preset, PointPath::uniaxial, strain)) {
    largest = std::max(largest, std::copysign(1.0, strain) * s.stress[0]);
  }
  return largest;
}

TEST(Presets, AreTheTwentyOfTheList) {
  for (const char* name : {"snow",       "wet_snow", "powder_snow", "jelly",    "rubber", "yogurt",   "whipped_cream",
                           "toothpaste", "honey",    "water",       "mud",      "sand",   "wet_sand", "clay",
                           "plasticine", "steel",    "copper",      "concrete", "foam",   "lava"}) {
    EXPECT_NE(find_preset(name), nullptr) << name;
  }
}

TEST(Presets, SayWhereEachNumberComesFrom) {
  for (const Preset& preset : all_presets()) {
    EXPECT_FALSE(preset.density_source.empty()) << preset.name;
    const ModelInfo* model = find_model(preset.model);
    EXPECT_EQ(preset.values.size(), model->parameters.size()) << preset.name;
    for (const Preset::Value& value : preset.values) {
      EXPECT_GE(value.source.size(), 10u) << preset.name << " " << value.parameter;
      EXPECT_EQ(value.source.find('\n'), std::string_view::npos);
    }
  }
}

/// Height of a cone of paste that carries itself, m. The pressure of its weight on the base is density g h / 3, and a
/// bar yields at sqrt(3) times the shear yield stress.
double cone_height(std::string_view preset) {
  return 3 * std::numbers::sqrt3 * number(preset, "shear_yield_stress", 0) / (number(preset, "density") * kGravity);
}

TEST(Presets, PastesKeepPeaksAndWaterDoesNot) {
  EXPECT_GT(cone_height("yogurt"), 0.02);
  EXPECT_LT(cone_height("yogurt"), 0.05);
  EXPECT_EQ(cone_height("water"), 0);
  EXPECT_GT(cone_height("whipped_cream"), 0.08);
  EXPECT_GT(cone_height("foam"), 0.15);
  // A strand of 1 cm carries itself as a column of its diameter, yogurt's does not by far.
  const auto column_height = [](std::string_view name) { return cone_height(name) / 3; };
  EXPECT_GT(column_height("toothpaste"), 0.01);
  EXPECT_LT(column_height("yogurt"), 0.012);
  // The yield that the heights are computed from is the one that the model has.
  EXPECT_NEAR(drive("yogurt", PointPath::shear, 0.5, 0, 1e-5).back().stress[3], 60, 0.2);
}

TEST(Presets, PastesFlowWhenStirredAndAreThinnerThanHoney) {
  const auto apparent_viscosity = [](const char* name) {
    const auto states = drive(name, PointPath::shear, 20, 0, 20);
    return states.back().stress[3] / 20;
  };
  EXPECT_NEAR(apparent_viscosity("honey"), 10, 1e-6);
  for (const char* name : {"yogurt", "whipped_cream", "foam"}) {
    EXPECT_LT(apparent_viscosity(name), 10) << name;
    EXPECT_GT(apparent_viscosity(name), 1) << name;
  }
  EXPECT_LT(drive("toothpaste", PointPath::shear, 20, 0, 10).back().stress[3], 500);
  EXPECT_NEAR(drive("mud", PointPath::shear, 2).back().stress[3], 120, 1);
  // Stokes: 2/9 of the difference in density, g and radius^2 over the viscosity.
  EXPECT_NEAR(2.0 / 9 * number("honey", "density") * kGravity * 0.01 * 0.01 / number("honey", "viscosity"), 0.03, 2e-3);
  EXPECT_NEAR(apparent_viscosity("water"), 1.002e-3, 1e-9);
  EXPECT_GT(drive("lava", PointPath::shear, 5).back().stress[3], 100 * apparent_viscosity("honey"));
}

TEST(Presets, YieldComesAtAFewPerCentOfElasticStrain) {
  for (const char* name : {"yogurt", "whipped_cream", "toothpaste", "foam", "mud", "lava"}) {
    const double mu = lame_mu(number(name, "youngs_modulus"), number(name, "poisson_ratio"));
    const double strain = number(name, "shear_yield_stress") / mu;
    EXPECT_GT(strain, 0.01) << name;
    EXPECT_LT(strain, 0.1) << name;
  }
}

TEST(Presets, PastesHoldTheirVolumeUnderTheirOwnWeight) {
  const auto squeezed = [](const char* name) {
    return number(name, "density") * kGravity * 0.1 /
           bulk_modulus(number(name, "youngs_modulus"), number(name, "poisson_ratio"));
  };
  for (const char* name : {"yogurt", "whipped_cream", "toothpaste", "foam", "mud", "lava"}) {
    EXPECT_LT(squeezed(name), 0.02) << name;
  }
  EXPECT_GT(squeezed("jelly"), 0.02) << "shows that it is soft";
}

TEST(Presets, LayersOnASlopeAreAsThickAsTheirYieldSays) {
  const auto thickness = [](const char* name) {
    return number(name, "shear_yield_stress") /
           (number(name, "density") * kGravity * std::sin(10 * std::numbers::pi / 180));
  };
  EXPECT_GT(thickness("mud"), 0.03);
  EXPECT_LT(thickness("mud"), 0.05);
  EXPECT_NEAR(thickness("lava"), 0.5, 0.1);
}

TEST(Presets, SandRestsAtItsSlopeAndMudDoesNot) {
  const PointState sand = drive("sand", PointPath::shear, 0.5, 1000).back();
  EXPECT_NEAR(std::atan(sand.stress[3] / sand.pressure) * 180 / std::numbers::pi, 34.7, 1);
  const PointState mud = drive("mud", PointPath::shear, 0.5, 1000).back();
  EXPECT_LT(std::atan(mud.stress[3] / mud.pressure) * 180 / std::numbers::pi, 20);
  // A vertical cut stands to 4 c / (density g) tan(45 + phi/2).
  const auto cut = [](const char* name) {
    return 4 * number(name, "cohesion") / (number(name, "density") * kGravity) *
           std::tan((45 + number(name, "friction_angle") / 2) * std::numbers::pi / 180);
  };
  EXPECT_EQ(cut("sand"), 0);
  EXPECT_GT(cut("wet_sand"), 0.3);
  EXPECT_LT(cut("wet_sand"), 0.5);
}

TEST(Presets, JellyWobblesAndRubberRings) {
  // First shear mode of a block of height h on a table: sqrt(mu / density) / (4 h).
  const auto frequency = [](const char* name) {
    const double mu = lame_mu(number(name, "youngs_modulus"), number(name, "poisson_ratio"));
    return std::sqrt(mu / number(name, "density")) / (4 * 0.1);
  };
  EXPECT_GT(frequency("jelly"), 5);
  EXPECT_LT(frequency("jelly"), 10);
  EXPECT_GT(frequency("rubber"), 5 * frequency("jelly"));
}

TEST(Presets, SnowIsStickyWetAndLooseDry) {
  const double snow = strength("snow", 0.1), wet = strength("wet_snow", 0.1), powder = strength("powder_snow", 0.1);
  EXPECT_GT(wet, 1.7 * snow);
  EXPECT_LT(powder, 0.1 * snow);
  const auto packing = [](const char* name) { return strength(name, -0.03); };
  EXPECT_GT(strength("wet_snow", -0.06), 1.7 * packing("snow"));
  EXPECT_LT(packing("powder_snow"), 0.4 * packing("snow"));
  EXPECT_NEAR(std::exp(number("powder_snow", "hardening") * 0.2), 4, 0.1);
  EXPECT_NEAR(std::exp(number("snow", "hardening") * 0.2), 7.4, 0.1);
  // Squeezed to two thirds, it stays packed.
  EXPECT_LT(drive("snow", PointPath::uniaxial, -0.4).back().history[0], 0.9);
}

TEST(Presets, MetalsKeepTheirBendAndRubberDoesNot) {
  for (const char* name : {"steel", "copper", "plasticine"}) {
    const auto states = drive(name, PointPath::uniaxial, 0.2);
    const PointState& end = states.back();
    const double elastic = end.stress[0] * end.volume_ratio / number(name, "youngs_modulus");
    EXPECT_LT(elastic, 0.1 * end.strain) << name;
    EXPECT_NEAR(end.history[0] + elastic, end.strain, 1e-6) << name;
  }
  const PointState rubber = drive("rubber", PointPath::uniaxial, 0.2).back();
  EXPECT_NEAR(rubber.energy / rubber.work, 1, 1e-3);
  EXPECT_NEAR(strength("steel", 0.01), 2.35e8, 0.1 * 2.35e8);
  EXPECT_NEAR(number("plasticine", "yield_stress") / number("plasticine", "youngs_modulus"), 0.01, 1e-12);
  EXPECT_GT(strength("plasticine", -0.1), 2 * number("plasticine", "density") * kGravity);
}

TEST(Presets, ConcreteHasItsStrengthInTensionAndCracksOfItsWidth) {
  double strongest = 0;
  double open_at = 0;
  for (const PointState& s : drive("concrete", PointPath::uniaxial, 0.01)) {
    strongest = std::max(strongest, s.stress[0]);
    if (s.stress[0] > 1e-3 * 2.6e6) open_at = s.strain;
  }
  EXPECT_NEAR(strongest, 2.6e6, 0.1e6);
  // In cells of 1 cm.
  EXPECT_NEAR(open_at * 0.01, 77e-6, 1e-6);
  EXPECT_GT(strength("concrete", -0.004), 25e6) << "not crushed";
}

TEST(Presets, ClayStandsAndPacks) {
  const double weight = number("clay", "density") * kGravity;  // Pa per metre
  EXPECT_GT(strength("clay", -0.05), weight);
  EXPECT_LT(strength("clay", -0.05), 10 * weight);
  EXPECT_LT(number("clay", "preconsolidation_pressure"),
            0.01 * bulk_modulus(number("clay", "youngs_modulus"), number("clay", "poisson_ratio")));
  const auto pressed = drive("clay", PointPath::triaxial, 0.01, 1e5);
  EXPECT_LT(pressed.front().history[0], -1e-3) << "packed by 1e5 Pa";
  double strongest = 0;
  const auto sheared = drive("clay", PointPath::shear, 0.1);
  for (const PointState& s : sheared) strongest = std::max(strongest, s.von_mises);
  EXPECT_GT(sheared.back().von_mises, 0.75 * strongest);
  EXPECT_LT(strength("sand", -0.05), 0.01 * weight) << "dry sand has no strength of its own";
}

TEST(Presets, LiquidsKeepTheirDensityUnderTwoMetres) {
  for (const char* name : {"water", "honey"}) {
    EXPECT_LT(2 * number(name, "density") * kGravity, 0.01 * number(name, "bulk_modulus")) << name;
    const double sound = std::sqrt(number(name, "bulk_modulus") / number(name, "density"));
    EXPECT_NEAR(sound, 45, 2) << name;
  }
}

}  // namespace
}  // namespace firn
