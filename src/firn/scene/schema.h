#pragma once

#include <firn/core/parameter.h>
#include <firn/scene/settings.h>

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

/// The one table of all scene keys. Reading, validation, `firn explain`, the editors' JSON Schema, the reference page
/// and the resolved scene are loops over it.
namespace firn {

enum class ValueType {
  boolean,
  integer,
  number,
  varied,  ///< a number, or what makes it differ between the particles of a material
  text,
  choice,
  vector,    ///< one number per dimension
  formula,   ///< a number or a formula
  formulas,  ///< one number or formula per dimension
  vector3,   ///< three numbers, also in 2D
  rotation,  ///< one number in 2D, three in 3D
  interval,  ///< two numbers, the lower first
  box,       ///< two vectors: lowest and highest corner
  numbers,   ///< a list of any length
  texts,     ///< a list of names
  files,     ///< a text or a list of texts, each a path or a pattern of paths
  keyframes  ///< a list of tables with the keys of keyframe_keys()
};

/// A value of any ValueType. A formula is a list of one. Lists of numbers are stored for 3D (vector and formulas: 3,
/// interval: 2, box: 6 numbers); a rotation in 2D is the third of its three numbers.
using Value = std::variant<bool, std::int64_t, double, std::string, std::vector<double>, std::vector<NumberOrFormula>,
                           ParameterVariation, std::vector<std::string>, std::vector<KeyframeSettings>>;

/// One key. `info` holds name, unit, range (of each number), help and hint.
struct Key {
  Parameter info;
  ValueType type = ValueType::number;
  std::vector<std::string_view> choices;  ///< of ValueType::choice
  std::string_view default_text;          ///< instead of a value: how the default is found; "" if it is a value
  bool required = false;                  ///< whenever it applies
  bool decides_result = true;             ///< false: the particles are the same whatever the value
  bool is_path = false;                   ///< text that is a path from the scene file's folder
  std::string_view condition_key;         ///< applies only where this choice of the same section ...
  std::vector<std::string_view> condition_values;  ///< ... has one of these values; no condition if empty

  std::function<void(void* object, const Value& value)> set;
  /// Nothing for an optional field that is not set.
  std::function<std::optional<Value>(const void* object)> get;
};

/// Where the keys stand in the file.
enum class SectionKind {
  root,   ///< key = value
  table,  ///< [limits]
  named,  ///< [material.snow]
  list,   ///< [[body]]
};

/// A group of keys, all fields of one struct of settings.h.
struct Section {
  SectionKind kind = SectionKind::table;
  std::string_view name;  ///< "" for the root
  std::string_view help;
  std::vector<std::vector<std::string_view>> exactly_one_of;  ///< groups of keys that exclude each other
  std::vector<Key> keys;

  std::function<std::size_t(const Scene&)> count;
  std::function<void*(Scene&)> add;  ///< a new object of a named or list section; the one object of the others
  std::function<void*(Scene&, std::size_t)> at;

  const Key* find(std::string_view key) const;
  const void* object(const Scene& scene, std::size_t index) const;
};

/// In the order in which a scene is read and written.
std::span<const Section> schema();
/// Of one element of a list of keyframes; fields of KeyframeSettings.
std::span<const Key> keyframe_keys();
/// Null if there is none.
const Section* find_section(std::string_view name);

/// "material.<name>.density", "body.mass", "limits.speed".
std::string key_path(const Section& section, const Key& key);
/// The default, or nothing for a key that is required or whose default is told by default_text.
std::optional<Value> default_value(const Section& section, const Key& key);
/// True if the key may be given for this object (its condition holds).
bool applies(const Section& section, const Key& key, const void* object);
/// "> 0", "in (-1, 0.5)"; "" if any number is allowed.
std::string range_text(const Key& key);
/// "a number", "a list of 2 numbers"; with dimension 0, what holds for both: "a list of 3 numbers (2 in a 2D scene)".
std::string type_text(const Key& key, int dimension = 0);

}  // namespace firn
