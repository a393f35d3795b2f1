#include <firn/core/error.h>
#include <firn/scene/document.h>
#include <firn/scene/value_text.h>

#include <fmt/format.h>
// The only file that sees the TOML library: its headers cost seconds of compilation.
#include <toml++/toml.h>

#include <algorithm>
#include <cctype>

namespace firn {
namespace {

Location location_of(const toml::source_region& source) { return {source.begin.line, source.begin.column, -1}; }

Node convert(const toml::node& node);

Node::Table convert_table(const toml::table& table) {
  Node::Table entries;
  for (auto&& [key, node] : table) {
    entries.push_back({std::string(key.str()), location_of(key.source()), convert(node)});
  }
  std::ranges::stable_sort(entries, {},
                           [](const Node::Entry& e) { return std::pair(e.location.line, e.location.column); });
  return entries;
}

Node convert(const toml::node& node) {
  Node result{location_of(node.source()), Node::Other{"a date or time"}};
  if (const auto* table = node.as_table()) {
    result.value = convert_table(*table);
  } else if (const auto* array = node.as_array()) {
    Node::Array values;
    for (const toml::node& element : *array) values.push_back(convert(element));
    result.value = std::move(values);
  } else if (const auto* text = node.as_string()) {
    result.value = text->get();
  } else if (const auto* integer = node.as_integer()) {
    result.value = integer->get();
  } else if (const auto* number = node.as_floating_point()) {
    result.value = number->get();
  } else if (const auto* boolean = node.as_boolean()) {
    result.value = boolean->get();
  }
  return result;
}

std::string_view line_of(std::string_view text, std::size_t line) {
  for (std::size_t i = 1; i < line; ++i) text.remove_prefix(std::min(text.size(), text.find('\n') + 1));
  return text.substr(0, text.find('\n'));
}

std::string_view trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t\r");
  if (begin == text.npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

/// The parts of `a."b".c`; empty if the text is not a key.
std::vector<std::string> key_parts(std::string_view key) {
  std::vector<std::string> parts;
  try {
    check_bare_letters("", std::string(key));
    const toml::table parsed = toml::parse(std::string(key) + " = 0", std::string());
    for (const toml::table* at = &parsed; at && at->size() == 1; at = at->begin()->second.as_table()) {
      parts.emplace_back(at->begin()->first.str());
    }
  } catch (const toml::parse_error&) {
    parts.clear();
  } catch (const Error&) {
    parts.clear();
  }
  return parts;
}

/// Header of the table that `line` (from 1) lies in, itself included if it is one.
std::string_view header_at(std::string_view text, std::size_t line) {
  for (; line > 0; --line) {
    std::string_view candidate = trimmed(line_of(text, line));
    if (candidate.empty() || candidate.front() != '[' || candidate.find('=') != candidate.npos) continue;
    candidate.remove_prefix(candidate.find_first_not_of('['));
    return candidate.substr(0, candidate.find(']'));
  }
  return {};
}

/// Line on which the key that is repeated on `line` was written first; 0 if that cannot be told.
std::size_t first_line_of(std::string_view text, std::size_t line) {
  const std::string_view repeated = trimmed(line_of(text, line));
  std::vector<std::string> path = key_parts(header_at(text, line));
  if (!repeated.starts_with('[')) {
    const std::vector<std::string> key = key_parts(repeated.substr(0, repeated.find('=')));
    if (key.empty()) return 0;
    path.insert(path.end(), key.begin(), key.end());
  }
  try {
    const std::size_t end = static_cast<std::size_t>(line_of(text, line).data() - text.data());
    const toml::table before = toml::parse(std::string(text.substr(0, end)), std::string());
    const toml::node* node = &before;
    std::size_t found = 0;
    for (const std::string& part : path) {
      if (const auto* array = node->as_array(); array && !array->empty()) node = &array->back();
      const toml::table* table = node->as_table();
      if (!table || !table->contains(part)) return 0;
      found = table->find(part)->first.source().begin.line;
      node = table->get(part);
    }
    return found;
  } catch (const toml::parse_error&) {
    return 0;
  }
}

/// The parser's words, and what a person can do about them.
std::string explained(const toml::parse_error& error, std::string_view text) {
  std::string description(error.description());
  const auto line = error.source().begin.line;
  if (const auto at = description.find("cannot redefine existing"); at != description.npos) {
    const auto open = description.find('\''), close = description.rfind('\'');
    const std::string key = description.substr(open + 1, close - open - 1);
    const std::size_t first = first_line_of(text, line);
    return first > 0 ? fmt::format("\"{}\" is given twice; first on line {}", key, first)
                     : fmt::format("\"{}\" is given twice", key);
  }
  constexpr std::string_view kPrefix = "Error while parsing ";
  if (description.starts_with(kPrefix)) description.erase(0, kPrefix.size());
  description = "not TOML: " + description;
  const std::string_view source = line_of(text, line);
  const std::size_t comma = error.source().begin.column - 1;
  const auto digit = [&](std::size_t i) {
    return i < source.size() && std::isdigit(static_cast<unsigned char>(source[i]));
  };
  if (comma > 0 && comma < source.size() && source[comma] == ',' && digit(comma - 1) && digit(comma + 1)) {
    description += "; a decimal number is written with a point, such as 1.5";
  } else if (description.find("could not determine value type") != description.npos) {
    description += "; text needs quotes";
  }
  return description;
}

}  // namespace

Node parse_toml(const std::string& name, const std::string& text) {
  check_bare_letters(name, text);
  try {
    return convert(toml::parse(text, name));
  } catch (const toml::parse_error& error) {
    const auto& begin = error.source().begin;
    throw Error(ErrorKind::usage,
                fmt::format("{}:{}:{}: {}", name, begin.line, begin.column, one_line(explained(error, text))));
  }
}

}  // namespace firn
