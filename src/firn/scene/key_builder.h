#pragma once

#include <firn/scene/schema.h>

#include <type_traits>
#include <utility>

/// Turns a pointer to a field of settings.h into a Key: type, reading and writing follow from the field's C++ type.
namespace firn {

/// The scene's words for the values of an enum, in the enum's order. Specialised beside the schema table.
template <class Enum>
struct ChoiceNames;

/// How one C++ type is stored in a Value.
template <class T>
struct FieldTraits {
  static_assert(std::is_enum_v<T>);
  static constexpr ValueType type = ValueType::choice;
  static Value to_value(T field) { return std::string(ChoiceNames<T>::list[static_cast<std::size_t>(field)]); }
  static T from_value(const Value& value) {
    std::size_t i = 0;
    while (i + 1 < std::size(ChoiceNames<T>::list) && ChoiceNames<T>::list[i] != std::get<std::string>(value)) ++i;
    return static_cast<T>(i);
  }
};

template <>
struct FieldTraits<bool> {
  static constexpr ValueType type = ValueType::boolean;
  static Value to_value(bool field) { return field; }
  static bool from_value(const Value& value) { return std::get<bool>(value); }
};

template <class T>
requires std::is_integral_v<T>
struct FieldTraits<T> {
  static constexpr ValueType type = ValueType::integer;
  static Value to_value(T field) { return static_cast<std::int64_t>(field); }
  static T from_value(const Value& value) { return static_cast<T>(std::get<std::int64_t>(value)); }
};

template <>
struct FieldTraits<double> {
  static constexpr ValueType type = ValueType::number;
  static Value to_value(double field) { return field; }
  static double from_value(const Value& value) { return std::get<double>(value); }
};

template <>
struct FieldTraits<std::string> {
  static constexpr ValueType type = ValueType::text;
  static Value to_value(const std::string& field) { return field; }
  static std::string from_value(const Value& value) { return std::get<std::string>(value); }
};

template <>
struct FieldTraits<Vec3d> {
  static constexpr ValueType type = ValueType::vector;
  static Value to_value(const Vec3d& field) { return std::vector<double>{field[0], field[1], field[2]}; }
  static Vec3d from_value(const Value& value) {
    const auto& numbers = std::get<std::vector<double>>(value);
    return {{numbers[0], numbers[1], numbers[2]}};
  }
};

template <>
struct FieldTraits<NumberOrFormula> {
  static constexpr ValueType type = ValueType::formula;
  static Value to_value(const NumberOrFormula& field) { return std::vector<NumberOrFormula>{field}; }
  static NumberOrFormula from_value(const Value& value) { return std::get<std::vector<NumberOrFormula>>(value)[0]; }
};

template <>
struct FieldTraits<std::array<NumberOrFormula, 3>> {
  using Field = std::array<NumberOrFormula, 3>;
  static constexpr ValueType type = ValueType::formulas;
  static Value to_value(const Field& field) { return std::vector<NumberOrFormula>(field.begin(), field.end()); }
  static Field from_value(const Value& value) {
    const auto& given = std::get<std::vector<NumberOrFormula>>(value);
    return {given[0], given[1], given[2]};
  }
};

template <>
struct FieldTraits<std::array<double, 2>> {
  static constexpr ValueType type = ValueType::interval;
  static Value to_value(const std::array<double, 2>& field) { return std::vector<double>{field[0], field[1]}; }
  static std::array<double, 2> from_value(const Value& value) {
    const auto& numbers = std::get<std::vector<double>>(value);
    return {numbers[0], numbers[1]};
  }
};

template <>
struct FieldTraits<std::vector<double>> {
  static constexpr ValueType type = ValueType::numbers;
  static Value to_value(const std::vector<double>& field) { return field; }
  static std::vector<double> from_value(const Value& value) { return std::get<std::vector<double>>(value); }
};

template <>
struct FieldTraits<std::vector<std::string>> {
  static constexpr ValueType type = ValueType::texts;
  static Value to_value(const std::vector<std::string>& field) { return field; }
  static std::vector<std::string> from_value(const Value& value) { return std::get<std::vector<std::string>>(value); }
};

template <>
struct FieldTraits<std::vector<KeyframeSettings>> {
  static constexpr ValueType type = ValueType::keyframes;
  static Value to_value(const std::vector<KeyframeSettings>& field) { return field; }
  static std::vector<KeyframeSettings> from_value(const Value& value) {
    return std::get<std::vector<KeyframeSettings>>(value);
  }
};

template <>
struct FieldTraits<LimitSettings::Box> {
  static constexpr ValueType type = ValueType::box;
  static Value to_value(const LimitSettings::Box& box) {
    return std::vector<double>{box.lower[0], box.lower[1], box.lower[2], box.upper[0], box.upper[1], box.upper[2]};
  }
  static LimitSettings::Box from_value(const Value& value) {
    const auto& n = std::get<std::vector<double>>(value);
    return {{{n[0], n[1], n[2]}}, {{n[3], n[4], n[5]}}};
  }
};

template <class T>
struct Unwrapped {
  using Type = T;
};
template <class T>
struct Unwrapped<std::optional<T>> {
  using Type = T;
};

/// Fluent description of a key, so that the schema table reads as a table.
class KeyBuilder {
 public:
  template <class Object, class Field>
  KeyBuilder(std::string_view name, Field Object::*member) {
    using T = typename Unwrapped<Field>::Type;
    key_.info.name = name;
    key_.type = FieldTraits<T>::type;
    if constexpr (std::is_enum_v<T>) {
      key_.choices.assign(std::begin(ChoiceNames<T>::list), std::end(ChoiceNames<T>::list));
    }
    key_.set = [member](void* object, const Value& value) {
      static_cast<Object*>(object)->*member = FieldTraits<T>::from_value(value);
    };
    key_.get = [member](const void* object) -> std::optional<Value> {
      const Field& field = static_cast<const Object*>(object)->*member;
      if constexpr (requires { field.empty(); }) {
        return field.empty() ? std::nullopt : std::optional<Value>(FieldTraits<T>::to_value(field));
      } else if constexpr (std::is_same_v<Field, T>) {
        return FieldTraits<T>::to_value(field);
      } else {
        return field ? std::optional<Value>(FieldTraits<T>::to_value(*field)) : std::nullopt;
      }
    };
  }

  KeyBuilder& type(ValueType value) { return key_.type = value, *this; }
  KeyBuilder& unit(std::string_view text) { return key_.info.unit = text, *this; }
  KeyBuilder& at_least(double minimum) { return key_.info.minimum = minimum, *this; }
  KeyBuilder& at_most(double maximum) { return key_.info.maximum = maximum, *this; }
  KeyBuilder& above(double minimum) { return key_.info.minimum_allowed = false, at_least(minimum); }
  KeyBuilder& below(double maximum) { return key_.info.maximum_allowed = false, at_most(maximum); }
  KeyBuilder& help(std::string_view text) { return key_.info.help = text, *this; }
  KeyBuilder& hint(std::string_view text) { return key_.info.hint = text, *this; }
  KeyBuilder& choices(std::vector<std::string_view> names) {
    key_.type = ValueType::choice;
    return key_.choices = std::move(names), *this;
  }
  KeyBuilder& default_text(std::string_view text) { return key_.default_text = text, *this; }
  KeyBuilder& required() { return key_.required = true, *this; }
  /// The particles do not depend on the value.
  KeyBuilder& presentation() { return key_.decides_result = false, *this; }
  KeyBuilder& path() { return key_.is_path = true, *this; }
  KeyBuilder& only_with(std::string_view key, std::vector<std::string_view> values) {
    key_.condition_key = key;
    return key_.condition_values = std::move(values), *this;
  }

  operator Key() const { return key_; }

 private:
  Key key_;
};

}  // namespace firn
