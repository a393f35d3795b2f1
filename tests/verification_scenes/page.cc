#include "verification_scenes/page.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace firn::test {
namespace {

std::string row_text(const std::vector<std::string>& cells) { return fmt::format("| {} |\n", fmt::join(cells, " | ")); }

std::string range_text(const Gate& gate) {
  if (std::isinf(gate.high)) return fmt::format(">= {:.4g}", gate.low);
  if (gate.low == -gate.high) return fmt::format("+-{:.3g}", gate.high);
  return fmt::format("{:.4g} to {:.4g}", gate.low, gate.high);
}

std::string table_text(const Table& table) {
  std::string text = row_text(table.header) + "|";
  for (std::size_t i = 0; i < table.header.size(); ++i) text += "---|";
  text += "\n";
  for (const auto& row : table.rows) text += row_text(row);
  return text;
}

}  // namespace

std::string page_path() { return std::string(FIRN_SOURCE_DIR) + "/docs/verification-scenes.md"; }

std::string block_of(const Check& check, const Outcome& outcome, const Outcome& control) {
  Table gates = {{"gate", "allowed", "measured", "control: " + check.control}, {}};
  for (const Gate& gate : outcome.gates) {
    const auto broken = std::ranges::find(control.gates, gate.name, &Gate::name);
    const bool must_fail = std::ranges::find(check.caught_by, gate.name) != check.caught_by.end();
    gates.rows.push_back(
        {gate.name, range_text(gate), fmt::format("{:.4g}", gate.measured),
         must_fail && broken != control.gates.end() ? fmt::format("{:.4g}, refused", broken->measured) : ""});
  }
  return table_text(outcome.table) + "\n" + table_text(gates);
}

std::string with_block(const std::string& page, const std::string& name, const std::string& block) {
  const std::string begin = "<!-- begin " + name + " -->\n", end = "<!-- end " + name + " -->";
  const auto from = page.find(begin);
  const auto to = from == std::string::npos ? from : page.find(end, from);
  if (to == std::string::npos) throw std::runtime_error("no markers of " + name + " in " + page_path());
  return page.substr(0, from) + begin + block + page.substr(to);
}

}  // namespace firn::test
