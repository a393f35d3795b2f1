#include <firn/core/error.h>
#include <firn/core/expression.h>
#include <firn/scene/nearest.h>
#include <firn/scene/read_value.h>
#include <firn/scene/read_variation.h>
#include <firn/scene/value_text.h>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace firn {
namespace {

constexpr std::string_view kPointHint = "a decimal number is written with a point, such as 1.5";

class ValueReader {
 public:
  ValueReader(const Key& key, const Node& node, int dimension) : key_(key), node_(node), dimension_(dimension) {}

  Value read() const {
    switch (key_.type) {
      case ValueType::boolean:
        return get<bool>();
      case ValueType::text:
        return get<std::string>();
      case ValueType::choice:
        return choice();
      case ValueType::number:
        return number(node_);
      case ValueType::varied:
        if (node_.table() || std::holds_alternative<std::string>(node_.value)) return read_variation(key_, node_);
        return number(node_);
      case ValueType::integer:
        return integer();
      case ValueType::vector:
        return padded(list(node_, static_cast<std::size_t>(dimension_)));
      case ValueType::formula:
        return std::vector<NumberOrFormula>{number_or_formula(node_)};
      case ValueType::formulas:
        return formulas();
      case ValueType::vector3:
        return list(node_, 3);
      case ValueType::interval:
        return list(node_, 2);
      case ValueType::rotation:
        return rotation();
      case ValueType::box:
        return box();
      case ValueType::numbers:
        return list(node_, node_.array() ? node_.array()->size() : 0);
      case ValueType::files:
        if (const auto* text = std::get_if<std::string>(&node_.value)) return std::vector<std::string>{*text};
        return texts();
      case ValueType::texts:
        return texts();
      case ValueType::keyframes:
        return keyframes();
    }
    wrong_type();
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorKind::usage, fmt::format("{} {}", key_.info.name, what));
  }

  [[noreturn]] void wrong_type(std::string_view hint = {}) const {
    if (hint.empty() && looks_like_decimal_comma()) hint = kPointHint;
    fail(fmt::format("must be {}, got {}{}{}", type_text(key_, dimension_), node_.describe(), hint.empty() ? "" : "; ",
                     hint));
  }

  [[noreturn]] void out_of_range(const std::string& given) const {
    const std::string range = range_text(key_);
    const std::string unit = key_.info.unit.empty() ? "" : fmt::format(" {}", key_.info.unit);
    fail(fmt::format("must be {}{}, got {}{}{}", range.empty() ? "a finite number" : range, range.empty() ? "" : unit,
                     given, key_.info.hint.empty() ? "" : "; ", key_.info.hint));
  }

  /// "1,5" as text, or [1,5, 2,5] with twice as many whole numbers as expected.
  bool looks_like_decimal_comma() const {
    if (const auto* text = std::get_if<std::string>(&node_.value)) {
      const auto comma = text->find(',');
      return comma != text->npos && comma > 0 && comma + 1 < text->size() && std::ranges::all_of(*text, [](char c) {
               return std::isdigit(static_cast<unsigned char>(c)) || c == ',' || c == '-';
             });
    }
    const Node::Array* array = node_.array();
    if (!array) return false;
    const std::size_t expected = key_.type == ValueType::vector ? static_cast<std::size_t>(dimension_) : 3;
    return array->size() == 2 * expected &&
           std::ranges::all_of(*array, [](const Node& n) { return std::holds_alternative<std::int64_t>(n.value); });
  }

  template <class T>
  T get() const {
    if (const T* value = std::get_if<T>(&node_.value)) return *value;
    wrong_type();
  }

  std::string choice() const {
    const auto* text = std::get_if<std::string>(&node_.value);
    if (!text) wrong_type();
    if (std::ranges::find(key_.choices, *text) != key_.choices.end()) return *text;
    const std::string nearest = nearest_name(*text, {key_.choices.begin(), key_.choices.end()});
    fail(fmt::format("must be {}, got {}{}", type_text(key_), in_quotes(*text),
                     nearest.empty() ? "" : fmt::format("; did you mean {}?", in_quotes(nearest))));
  }

  double number(const Node& node) const {
    const std::optional<double> given = node.number();
    if (!given) wrong_type();
    const double value = *given;
    if (!in_range(key_.info, value)) out_of_range(number_text(value));
    return value;
  }

  std::int64_t integer() const {
    const double value = number(node_);
    if (const auto* whole = std::get_if<std::int64_t>(&node_.value)) return *whole;
    // 1e6 is a real number in TOML, but people mean a count.
    if (value != std::floor(value) || std::abs(value) > 0x1p53) wrong_type();
    return static_cast<std::int64_t>(value);
  }

  std::vector<double> list(const Node& node, std::size_t count) const {
    const Node::Array* array = node.array();
    if (!array || array->size() != count) wrong_type();
    std::vector<double> numbers;
    for (const Node& element : *array) numbers.push_back(number(element));
    return numbers;
  }

  static std::vector<double> padded(std::vector<double> numbers) {
    numbers.resize(3, 0.0);
    return numbers;
  }

  std::vector<NumberOrFormula> formulas() const {
    const Node::Array* array = node_.array();
    if (!array || array->size() != static_cast<std::size_t>(dimension_)) wrong_type();
    std::vector<NumberOrFormula> values;
    for (const Node& element : *array) values.push_back(number_or_formula(element));
    values.resize(3);
    return values;
  }

  NumberOrFormula number_or_formula(const Node& node) const {
    const auto* text = std::get_if<std::string>(&node.value);
    if (!text) return {number(node)};
    check_formula(*text);
    return {0, *text};
  }

  void check_formula(const std::string& text) const {
    try {
      const Expression parsed(text);
    } catch (const Error& error) {
      fail(error.what());
    }
  }

  Value rotation() const {
    if (dimension_ == 2) return std::vector<double>{0, 0, number(node_)};
    return list(node_, 3);
  }

  Value box() const {
    const Node::Array* corners = node_.array();
    if (!corners || corners->size() != 2) wrong_type();
    std::vector<double> numbers = padded(list((*corners)[0], static_cast<std::size_t>(dimension_)));
    const std::vector<double> upper = padded(list((*corners)[1], static_cast<std::size_t>(dimension_)));
    numbers.insert(numbers.end(), upper.begin(), upper.end());
    return numbers;
  }

  Value texts() const {
    const Node::Array* array = node_.array();
    if (!array) wrong_type();
    std::vector<std::string> found;
    for (const Node& element : *array) {
      const auto* text = std::get_if<std::string>(&element.value);
      if (!text) fail(fmt::format("must be {}, got {} in it", type_text(key_), element.describe()));
      found.push_back(*text);
    }
    return found;
  }

  Value keyframes() const {
    const Node::Array* array = node_.array();
    if (!array) wrong_type();
    std::vector<KeyframeSettings> frames;
    for (const Node& element : *array) {
      const std::string label = fmt::format("entry {}", frames.size() + 1);
      if (!element.table()) fail(fmt::format("{} must be a table {{ time, ... }}, got {}", label, element.describe()));
      frames.push_back(keyframe(element, label));
    }
    return frames;
  }

  KeyframeSettings keyframe(const Node& node, const std::string& label) const {
    KeyframeSettings frame;
    std::vector<std::string> names;
    for (const Key& key : keyframe_keys()) names.emplace_back(key.info.name);
    for (const Node::Entry& entry : *node.table()) {
      if (std::ranges::find(names, entry.key) != names.end()) continue;
      fail(fmt::format("{}: unknown key {}{}", label, in_quotes(entry.key), suggestion(entry.key, names)));
    }
    for (const Key& key : keyframe_keys()) {
      const Node::Entry* entry = node.find(key.info.name);
      if (!entry && key.required) fail(fmt::format("{}: {} is required", label, key.info.name));
      if (!entry) continue;
      try {
        key.set(&frame, ValueReader(key, entry->node, dimension_).read());
      } catch (const Error& error) {
        fail(fmt::format("{}: {}", label, error.what()));
      }
    }
    return frame;
  }

  const Key& key_;
  const Node& node_;
  int dimension_;
};

}  // namespace

Value read_value(const Key& key, const Node& node, int dimension) { return ValueReader(key, node, dimension).read(); }

}  // namespace firn
