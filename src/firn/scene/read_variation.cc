#include <firn/core/error.h>
#include <firn/core/expression.h>
#include <firn/scene/nearest.h>
#include <firn/scene/read_variation.h>
#include <firn/scene/value_text.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace firn {
namespace {

using Kind = ParameterVariation::Kind;

/// What a table may hold, first the key that tells its kind.
struct Form {
  Kind kind;
  std::vector<std::string_view> required, optional;
};

const std::vector<Form>& forms() {
  static const std::vector<Form> all = {
      {Kind::spread, {"value", "spread"}, {"distribution", "seed"}},
      {Kind::range, {"from", "to"}, {"seed"}},
      {Kind::attribute, {"attribute"}, {"scale"}},
  };
  return all;
}

constexpr std::string_view kForms =
    "{ value = .., spread = .. }, { from = .., to = .. } or { attribute = \"..\" }, a number or a formula in quotes";

class VariationReader {
 public:
  VariationReader(const Key& key, const Node& node) : key_(key), node_(node) {}

  ParameterVariation read() {
    if (const auto* text = std::get_if<std::string>(&node_.value)) return formula(*text);
    check_keys();
    variation_.kind = form().kind;
    switch (variation_.kind) {
      case Kind::formula:
        break;
      case Kind::spread:
        read_spread();
        break;
      case Kind::range:
        variation_.from = in_range_of_key("from");
        variation_.to = in_range_of_key("to");
        if (!(variation_.from <= variation_.to)) {
          fail(fmt::format("from must not be above to, got {} and {}", number_text(variation_.from),
                           number_text(variation_.to)));
        }
        break;
      case Kind::attribute:
        variation_.text = text_of("attribute");
        if (has("scale")) variation_.scale = number("scale");
        break;
    }
    if (has("seed")) variation_.seed = seed();
    return variation_;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorKind::usage, fmt::format("{}: {}", key_.info.name, what));
  }

  ParameterVariation formula(const std::string& text) const {
    try {
      const Expression parsed(text);
    } catch (const Error& error) {
      throw Error(ErrorKind::usage, fmt::format("{} {}", key_.info.name, error.what()));
    }
    ParameterVariation variation;
    variation.text = text;
    return variation;
  }

  bool has(std::string_view name) const { return node_.find(name) != nullptr; }
  const Node& at(std::string_view name) const { return node_.find(name)->node; }

  /// The form of which the first key is given.
  const Form& form() const {
    for (const Form& form : forms()) {
      if (has(form.required[0])) return form;
    }
    fail(fmt::format("must be one of {}", kForms));
  }

  void check_keys() const {
    const Form& chosen = form();
    std::vector<std::string> known(chosen.required.begin(), chosen.required.end());
    known.insert(known.end(), chosen.optional.begin(), chosen.optional.end());
    for (const Node::Entry& entry : *node_.table()) {
      if (std::ranges::find(known, entry.key) != known.end()) continue;
      fail(fmt::format("unknown key {} beside {}{}", in_quotes(entry.key), chosen.required[0],
                       suggestion(entry.key, known)));
    }
    for (const std::string_view name : chosen.required) {
      if (!has(name)) fail(fmt::format("{} needs {} beside it", chosen.required[0], name));
    }
  }

  double number(std::string_view name) const {
    const Node& node = at(name);
    const std::optional<double> given = node.number();
    if (!given) fail(fmt::format("{} must be a number, got {}", name, node.describe()));
    const double value = *given;
    if (!std::isfinite(value)) fail(fmt::format("{} must be a finite number, got {}", name, number_text(value)));
    return value;
  }

  double in_range_of_key(std::string_view name) const {
    const double value = number(name);
    if (in_range(key_.info, value)) return value;
    const std::string unit = key_.info.unit.empty() ? "" : fmt::format(" {}", key_.info.unit);
    fail(fmt::format("{} must be {}{}, got {}", name, range_text(key_), unit, number_text(value)));
  }

  std::string text_of(std::string_view name) const {
    const auto* text = std::get_if<std::string>(&at(name).value);
    if (!text || text->empty()) fail(fmt::format("{} must be a text in quotes, got {}", name, at(name).describe()));
    return *text;
  }

  std::uint64_t seed() const {
    const auto* whole = std::get_if<std::int64_t>(&at("seed").value);
    if (!whole || *whole < 0) fail(fmt::format("seed must be a whole number >= 0, got {}", at("seed").describe()));
    return static_cast<std::uint64_t>(*whole);
  }

  void read_spread() {
    using Distribution = ParameterVariation::Distribution;
    variation_.value = in_range_of_key("value");
    variation_.spread = number("spread");
    if (!(variation_.spread >= 0 && variation_.spread <= 10)) {
      fail(fmt::format("spread, the standard deviation over the mean, must be in [0, 10], got {}",
                       number_text(variation_.spread)));
    }
    if (has("distribution")) {
      const std::string name = text_of("distribution");
      if (name != "normal" && name != "lognormal") {
        fail(fmt::format("distribution must be one of \"normal\", \"lognormal\", got {}", in_quotes(name)));
      }
      variation_.distribution = name == "normal" ? Distribution::normal : Distribution::lognormal;
    }
    if (variation_.distribution == Distribution::lognormal && !(variation_.value > 0)) {
      fail(fmt::format("a lognormal distribution needs a value > 0, got {}; give distribution = \"normal\"",
                       number_text(variation_.value)));
    }
  }

  const Key& key_;
  const Node& node_;
  ParameterVariation variation_;
};

}  // namespace

ParameterVariation read_variation(const Key& key, const Node& node) { return VariationReader(key, node).read(); }

std::string variation_text(const ParameterVariation& v) {
  const std::string seed = v.seed ? fmt::format(", seed = {}", *v.seed) : "";
  switch (v.kind) {
    case Kind::formula:
      return in_quotes(v.text);
    case Kind::spread:
      return fmt::format("{{ value = {}, spread = {}, distribution = \"{}\"{} }}", number_text(v.value),
                         number_text(v.spread),
                         v.distribution == ParameterVariation::Distribution::normal ? "normal" : "lognormal", seed);
    case Kind::range:
      return fmt::format("{{ from = {}, to = {}{} }}", number_text(v.from), number_text(v.to), seed);
    case Kind::attribute:
      return fmt::format("{{ attribute = {}, scale = {} }}", in_quotes(v.text), number_text(v.scale));
  }
  return "";
}

}  // namespace firn
