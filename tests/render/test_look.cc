#include <firn/materials/model_info.h>
#include <firn/render/look.h>
#include <gtest/gtest.h>

#include <string>

namespace firn {
namespace {

const Look& look_of(std::string_view preset, std::string_view model) {
  return find_look({.name = "stuff", .model = std::string(model), .preset = std::string(preset)});
}

TEST(Look, EveryPresetHasItsOwn) {
  for (const Preset& preset : all_presets()) {
    EXPECT_EQ(look_of(preset.name, preset.model).name, preset.name);
  }
}

TEST(Look, EveryModelHasOneForMaterialsWithoutPreset) {
  for (const ModelInfo& model : all_models()) EXPECT_EQ(look_of("", model.name).name, model.name);
}

TEST(Look, WhatNobodyKnowsIsNeutral) {
  EXPECT_EQ(look_of("", "").name, "");
  EXPECT_EQ(look_of("porridge", "no_such_model").name, "");
}

TEST(Look, PresetsAreToldApart) {
  for (const Preset& a : all_presets()) {
    for (const Preset& b : all_presets()) {
      if (a.name == b.name) continue;
      const Look &x = look_of(a.name, a.model), &y = look_of(b.name, b.model);
      EXPECT_TRUE(norm(x.color - y.color) > 0.01F || x.gloss != y.gloss || x.smooth != y.smooth)
          << a.name << " and " << b.name;
    }
  }
}

TEST(Look, NothingReflectsMoreLightThanItGets) {
  for (const Preset& preset : all_presets()) {
    const Look& look = look_of(preset.name, preset.model);
    for (int c = 0; c < 3; ++c) {
      EXPECT_GT(look.color[c], 0) << preset.name;
      EXPECT_LE(look.color[c] * (1 + look.jitter), 1) << preset.name;
    }
    for (const float share : {look.wrap, look.smooth, look.gloss}) {
      EXPECT_GE(share, 0) << preset.name;
      EXPECT_LE(share, 1) << preset.name;
    }
  }
}

}  // namespace
}  // namespace firn
