#include "scene/scene_text.h"

#include <firn/materials/model_info.h>
#include <firn/scene/schema.h>
#include <firn/scene/value_text.h>

#include <cstdlib>
#include <set>

namespace firn::test {
namespace {

/// Converts to anything: for counting how many initialisers an aggregate takes.
struct Anything {
  template <class T>
  operator T() const;
};

/// Number of fields of a plain struct. Structs here have no array members, which would count element by element.
template <class T, class... Fields>
constexpr std::size_t field_count() {
  if constexpr (requires { T{Fields{}..., Anything{}}; }) {
    return field_count<T, Fields..., Anything>();
  } else {
    return sizeof...(Fields);
  }
}

std::size_t key_count(std::string_view section) { return find_section(section)->keys.size(); }

TEST(Schema, EveryFieldOfTheSettingsHasAKey) {
  EXPECT_EQ(key_count("resolution"), field_count<ResolutionSettings>());
  EXPECT_EQ(key_count("method"), field_count<MethodSettings>());
  EXPECT_EQ(key_count("limits"), field_count<LimitSettings>());
  EXPECT_EQ(key_count("body"), field_count<BodySettings>());
  // What they share counts as one field, their base.
  EXPECT_EQ(key_count("part"), field_count<PartSettings>() - 1 + field_count<ShapeSettings>());
  EXPECT_EQ(key_count("collider"), field_count<ColliderSettings>() - 1 + field_count<ShapeSettings>());
  EXPECT_EQ(key_count("camera"), field_count<CameraSettings>());
  EXPECT_EQ(key_count("render"), field_count<RenderSettings>());
  EXPECT_EQ(key_count("output"), field_count<OutputSettings>());
  EXPECT_EQ(key_count("checkpoint"), field_count<CheckpointSettings>());
  // The root also holds one field per other section, and the path of the file.
  EXPECT_EQ(key_count("") + schema().size() - 1 + 1, field_count<Scene>());
}

TEST(Schema, KeysWriteDifferentFields) {
  // Each key is set to a value unlike the default; then exactly that key must read differently.
  for (const Section& section : schema()) {
    if (section.kind == SectionKind::named) continue;
    for (const Key& key : section.keys) {
      Scene scene;
      void* object = section.add(scene);
      std::vector<std::optional<Value>> before;
      for (const Key& other : section.keys) before.push_back(other.get(object));
      switch (key.type) {
        case ValueType::boolean:
          key.set(object, !std::get<bool>(key.get(object).value_or(false)));
          break;
        case ValueType::integer:
          key.set(object, std::int64_t(17));
          break;
        case ValueType::number:
          key.set(object, 0.123);
          break;
        case ValueType::text:
          key.set(object, std::string("other"));
          break;
        case ValueType::choice:
          key.set(object, std::string(key.choices.back()));
          break;
        case ValueType::formula:
          key.set(object, std::vector<NumberOrFormula>{{0, "x"}});
          break;
        case ValueType::formulas:
          key.set(object, std::vector<NumberOrFormula>{{9}, {0, "x"}, {7}});
          break;
        case ValueType::files:
        case ValueType::texts:
          key.set(object, std::vector<std::string>{"other", "another"});
          break;
        case ValueType::keyframes:
          key.set(object, std::vector<KeyframeSettings>{{0, Vec3d{{1, 2, 3}}, {}, 2}, {1, {}, Vec3d{{4, 5, 6}}, {}}});
          break;
        default:
          key.set(object, std::vector<double>{9, 8, 7, 6, 5, 4});
          break;
      }
      for (std::size_t i = 0; i < section.keys.size(); ++i) {
        const bool changed = section.keys[i].get(object) != before[i];
        const bool expected = &section.keys[i] == &key;
        // The last choice may be the default.
        if (expected && key.type == ValueType::choice) continue;
        EXPECT_EQ(changed, expected) << key_path(section, key) << " and " << section.keys[i].info.name;
      }
    }
  }
}

TEST(Schema, EveryKeyIsDescribed) {
  for (const Section& section : schema()) {
    EXPECT_FALSE(section.help.empty()) << section.name;
    std::set<std::string_view> names;
    for (const Key& key : section.keys) {
      const std::string path = key_path(section, key);
      EXPECT_TRUE(names.insert(key.info.name).second) << path << " twice";
      EXPECT_GE(key.info.help.size(), 7u) << path;
      EXPECT_TRUE(key.info.help.ends_with('.') || key.info.help.ends_with('?')) << path;
      EXPECT_EQ(key.type == ValueType::choice, !key.choices.empty()) << path;
      if (!key.condition_key.empty()) {
        EXPECT_NE(section.find(key.condition_key), nullptr) << path;
      }
    }
  }
}

TEST(Schema, EveryDimensionalKeyHasAUnit) {
  const std::set<std::string> pure = {"resolution.particles_per_cell",
                                      "method.flip_blend",
                                      "limits.particle_cfl",
                                      "limits.elastic_cfl",
                                      "body.scale",
                                      "body.color",
                                      "part.normal",
                                      "part.axis",
                                      "part.scale",
                                      "collider.normal",
                                      "collider.axis",
                                      "collider.scale",
                                      "collider.friction",
                                      "collider.color",
                                      "emitter.scale",
                                      "emitter.color",
                                      "sink.scale",
                                      "field.axis",
                                      "pin.normal",
                                      "pin.axis",
                                      "pin.scale",
                                      "traction.scale",
                                      "traction.normal",
                                      "camera.up",
                                      "render.range"};
  for (const Section& section : schema()) {
    if (section.kind == SectionKind::named) continue;  // the models' own tests check theirs
    for (const Key& key : section.keys) {
      const bool countable = key.type == ValueType::integer || key.type == ValueType::boolean ||
                             key.type == ValueType::text || key.type == ValueType::texts ||
                             key.type == ValueType::files || key.type == ValueType::choice ||
                             key.type == ValueType::keyframes;
      if (countable) continue;
      EXPECT_EQ(key.info.unit.empty(), pure.count(key_path(section, key)) == 1) << key_path(section, key);
    }
  }
}

TEST(Schema, DefaultsAreInRange) {
  for (const Section& section : schema()) {
    for (const Key& key : section.keys) {
      const std::optional<Value> value = default_value(section, key);
      if (!value) continue;
      if (const auto* number = std::get_if<double>(&*value)) {
        EXPECT_TRUE(in_range(key.info, *number)) << key_path(section, key);
      }
      if (const auto* whole = std::get_if<std::int64_t>(&*value)) {
        EXPECT_TRUE(in_range(key.info, static_cast<double>(*whole))) << key_path(section, key);
      }
    }
  }
}

TEST(Schema, EveryParameterOfEveryModelIsAKey) {
  const Section& section = *find_section("material");
  for (const ModelInfo& model : all_models()) {
    MaterialSettings material;
    material.model = model.name;
    for (const Parameter& parameter : model.parameters) {
      const Key* key = section.find(parameter.name);
      ASSERT_NE(key, nullptr) << model.name << " " << parameter.name;
      EXPECT_TRUE(applies(section, *key, &material)) << model.name << " " << parameter.name;
      // One key serves all models, so they must mean the same by it.
      EXPECT_EQ(key->info.unit, parameter.unit) << parameter.name;
      EXPECT_EQ(key->info.minimum, parameter.minimum) << parameter.name;
      EXPECT_EQ(key->info.maximum, parameter.maximum) << parameter.name;
    }
  }
}

TEST(Schema, EveryPresetGivesAValidMaterial) {
  for (const Preset& preset : all_presets()) {
    const std::string error = error_of(kMinimal, {"material.snow.preset=" + std::string(preset.name)});
    EXPECT_EQ(error, "") << preset.name;
  }
}

TEST(ValueText, NumbersAreShortAndExact) {
  EXPECT_EQ(number_text(0.1), "0.1");
  EXPECT_EQ(number_text(140000), "140000");
  EXPECT_EQ(number_text(1e13), "1e13");
  EXPECT_EQ(number_text(-2e5), "-2e5");
  EXPECT_EQ(number_text(0), "0");
  for (const double value : {1.0 / 3, 1e300, 5e-324, 123456789.0, 9007199254740993.0, 1e5, -1e22}) {
    EXPECT_EQ(std::strtod(number_text(value).c_str(), nullptr), value);
  }
}

}  // namespace
}  // namespace firn::test
