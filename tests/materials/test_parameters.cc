#include <firn/materials/model_info.h>
#include <firn/materials/update_stress.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace firn {
namespace {

TEST(Parameters, RangesContainTheirDefaultAndRefuseWhatLiesOutside) {
  std::vector<Parameter> all = {kDensity};
  for (const ModelInfo& info : all_models()) {
    all.insert(all.end(), info.parameters.begin(), info.parameters.end());
  }
  const double infinity = std::numeric_limits<double>::infinity();
  for (const Parameter& p : all) {
    SCOPED_TRACE(std::string(p.name));
    EXPECT_TRUE(in_range(p, p.default_value));
    EXPECT_EQ(in_range(p, p.minimum), p.minimum_allowed);
    EXPECT_EQ(in_range(p, p.maximum), p.maximum_allowed);
    EXPECT_FALSE(in_range(p, std::nextafter(p.minimum, -infinity)));
    EXPECT_FALSE(in_range(p, std::nextafter(p.maximum, infinity)));
    EXPECT_FALSE(in_range(p, std::nan("")));
    EXPECT_FALSE(in_range(p, infinity));
    EXPECT_FALSE(in_range(p, -infinity));
    EXPECT_FALSE(p.help.empty());
  }
}

TEST(Parameters, OfOneNameAreOneParameter) {
  // A scene key has one range, one default and one meaning, whichever model it belongs to.
  for (const ModelInfo& a : all_models()) {
    for (const ModelInfo& b : all_models()) {
      for (const Parameter& p : a.parameters) {
        for (const Parameter& q : b.parameters) {
          if (p.name != q.name) continue;
          EXPECT_EQ(p.unit, q.unit) << p.name;
          EXPECT_EQ(p.help, q.help) << p.name;
          EXPECT_EQ(p.default_value, q.default_value) << p.name;
          EXPECT_EQ(p.minimum, q.minimum) << p.name;
          EXPECT_EQ(p.maximum, q.maximum) << p.name;
        }
      }
    }
  }
}

TEST(Models, AreNamedOnceAndFoundByName) {
  std::set<std::string_view> names;
  for (const ModelInfo& info : all_models()) {
    EXPECT_TRUE(names.insert(info.name).second) << info.name;
    EXPECT_EQ(find_model(info.name), &info);
    EXPECT_EQ(&all_models()[static_cast<std::size_t>(model_number(info.name))], &info);
    EXPECT_FALSE(info.summary.empty());
    EXPECT_FALSE(info.source.empty());
    std::set<std::string_view> keys;
    for (const Parameter& p : info.parameters) EXPECT_TRUE(keys.insert(p.name).second) << p.name;
  }
  EXPECT_EQ(find_model("no such model"), nullptr);
  EXPECT_EQ(model_number("no such model"), -1);
}

TEST(Presets, GiveEveryParameterOfTheirModelAValueInRange) {
  for (const Preset& preset : all_presets()) {
    SCOPED_TRACE(std::string(preset.name));
    EXPECT_EQ(find_preset(preset.name), &preset);
    const ModelInfo* info = find_model(preset.model);
    ASSERT_NE(info, nullptr);
    EXPECT_TRUE(in_range(kDensity, preset.density));
    std::set<std::string_view> given;
    for (const Preset::Value& value : preset.values) {
      EXPECT_TRUE(given.insert(value.parameter).second) << value.parameter;
      const auto parameter = std::find_if(info->parameters.begin(), info->parameters.end(),
                                          [&](const Parameter& p) { return p.name == value.parameter; });
      ASSERT_NE(parameter, info->parameters.end()) << value.parameter;
      EXPECT_TRUE(in_range(*parameter, value.value)) << value.parameter;
    }
    EXPECT_EQ(given.size(), info->parameters.size());
  }
  EXPECT_EQ(find_preset("no such preset"), nullptr);
}

TEST(Parameters, LameParametersAreThoseOfHookesLaw) {
  // Uniaxial tension: with stress E e along x and strain -nu e across, the stress across vanishes.
  const double E = 3e5, nu = 0.35, mu = lame_mu(E, nu), lambda = lame_lambda(E, nu);
  EXPECT_NEAR((lambda + 2 * mu) * 1 - 2 * lambda * nu, E, 1e-9);
  EXPECT_NEAR(lambda * (1 - nu) - (lambda + 2 * mu) * nu, 0, 1e-9);
}

TEST(Energy, IsThatOfTheModelByNumber) {
  // Shear F = I + g e_x e_y of a neo-Hookean solid: mu/2 g^2.
  const double F[] = {1, 0.3, 0, 1};
  const ModelParameters parameters = {{1e5, 0.25}, 1000};
  EXPECT_NEAR(energy_density<2>(model_number("neo_hookean"), parameters, F, nullptr), 0.5 * 4e4 * 0.09, 1e-9);
  EXPECT_EQ(volume_ratio(model_number("neo_hookean"), parameters, 0.7, nullptr), 0.7);
  const double Jp = 0.5;
  const ModelParameters snow = {{1.4e5, 0.2, 2.5e-2, 7.5e-3, 10, 8}, 400};
  EXPECT_EQ(volume_ratio(model_number("snow"), snow, 0.98, &Jp), 0.49);
}

}  // namespace
}  // namespace firn
