#include <firn/scene/read_variation.h>
#include <firn/scene/value_text.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cstdint>

namespace firn {
namespace {

std::string list_text(const std::vector<double>& numbers, std::size_t begin, std::size_t count) {
  std::string text = "[";
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0) text += ", ";
    text += number_text(numbers[begin + i]);
  }
  return text + "]";
}

std::string numbers_text(ValueType type, const std::vector<double>& numbers, int dimension) {
  const auto n = static_cast<std::size_t>(dimension);
  switch (type) {
    case ValueType::vector:
      return list_text(numbers, 0, n);
    case ValueType::rotation:
      return dimension == 2 ? number_text(numbers[2]) : list_text(numbers, 0, 3);
    case ValueType::box:
      return fmt::format("[{}, {}]", list_text(numbers, 0, n), list_text(numbers, 3, n));
    default:
      return list_text(numbers, 0, numbers.size());
  }
}

std::string formula_text(const NumberOrFormula& value) {
  return value.formula.empty() ? number_text(value.number) : in_quotes(value.formula);
}

std::string formulas_text(const std::vector<NumberOrFormula>& formulas, int dimension) {
  std::string text = "[";
  for (std::size_t i = 0; i < static_cast<std::size_t>(dimension); ++i) {
    if (i > 0) text += ", ";
    text += formula_text(formulas[i]);
  }
  return text + "]";
}

template <class Names>
std::string join_quoted(const Names& names) {
  std::string text;
  for (const auto& name : names) {
    if (!text.empty()) text += ", ";
    text += in_quotes(name);
  }
  return text;
}

std::string keyframe_text(const KeyframeSettings& frame, int dimension) {
  std::string text;
  for (const Key& key : keyframe_keys()) {
    const std::optional<Value> value = key.get(&frame);
    if (!value) continue;
    text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", key.info.name, value_text(key, *value, dimension));
  }
  return fmt::format("{{ {} }}", text);
}

}  // namespace

std::string number_text(double value) {
  std::string text = fmt::format("{}", value);
  // 10000000000000 is hard to read; 1e13 is not.
  const std::size_t zeros = text.size() - 1 - text.find_last_not_of('0');
  if (zeros < 5 || zeros == text.size() || text.find_first_not_of("-0123456789") != text.npos) return text;
  text.resize(text.size() - zeros);
  return fmt::format("{}e{}", text, zeros);
}

std::string quoted_list(const std::vector<std::string_view>& names) { return join_quoted(names); }
std::string quoted_list(const std::vector<std::string>& names) { return join_quoted(names); }

std::string in_quotes(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (c == '\n') {
      out += "\\n";
    } else if (code < 0x20 || code == 0x7f) {
      out += fmt::format("\\u{:04X}", code);
    } else {
      out += c;
    }
  }
  return out + "\"";
}

bool is_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto first = static_cast<unsigned char>(text[i++]);
    if (first < 0x80) continue;
    const int following = first >= 0xF0 ? 3 : first >= 0xE0 ? 2 : 1;
    if (first < 0xC2 || first > 0xF4) return false;
    std::uint32_t code = first & (0x3F >> following);
    for (int k = 0; k < following; ++k) {
      if (i == text.size() || (static_cast<unsigned char>(text[i]) & 0xC0) != 0x80) return false;
      code = code << 6 | (static_cast<unsigned char>(text[i++]) & 0x3F);
    }
    constexpr std::uint32_t kLeast[] = {0, 0x80, 0x800, 0x10000};
    if (code < kLeast[following] || code > 0x10FFFF || (code >= 0xD800 && code < 0xE000)) return false;
  }
  return true;
}

std::string key_text(std::string_view key) {
  const bool bare = !key.empty() && std::ranges::all_of(key, [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-';
  });
  return bare ? std::string(key) : in_quotes(key);
}

std::string value_text(const Key& key, const Value& value, int dimension) {
  struct Visitor {
    ValueType type;
    int dimension;
    std::string operator()(bool b) const { return b ? "true" : "false"; }
    std::string operator()(std::int64_t i) const { return fmt::format("{}", i); }
    std::string operator()(double d) const { return number_text(d); }
    std::string operator()(const std::string& s) const { return in_quotes(s); }
    std::string operator()(const std::vector<double>& v) const { return numbers_text(type, v, dimension); }
    std::string operator()(const ParameterVariation& v) const { return variation_text(v); }
    std::string operator()(const std::vector<NumberOrFormula>& v) const {
      return type == ValueType::formula ? formula_text(v.front()) : formulas_text(v, dimension);
    }
    std::string operator()(const std::vector<std::string>& v) const { return fmt::format("[{}]", join_quoted(v)); }
    std::string operator()(const std::vector<KeyframeSettings>& v) const {
      std::string text;
      for (const KeyframeSettings& frame : v) text += (text.empty() ? "" : ", ") + keyframe_text(frame, dimension);
      return fmt::format("[{}]", text);
    }
  };
  return std::visit(Visitor{key.type, dimension}, value);
}

}  // namespace firn
