#include <firn/core/log.h>
#include <firn/scene/size_hints.h>
#include <firn/scene/value_text.h>
#include <fmt/format.h>

namespace firn {
namespace {

/// Wider bodies than this, in cells, do not fit into the memory of most machines: a full cube has 8e9 particles.
constexpr double kWide = 1000;

bool is_from_file(const BodySettings& body) { return !body.mesh.empty() || !body.polygon.empty(); }

const char* unit_name(BodySettings::Units units) {
  switch (units) {
    case BodySettings::Units::m:
      return "m";
    case BodySettings::Units::cm:
      return "cm";
    case BodySettings::Units::mm:
      return "mm";
  }
  return "m";
}

}  // namespace

std::string too_small_hint(const BodySettings& body) {
  if (!is_from_file(body)) return "make it larger, or use smaller cells";
  if (body.units == BodySettings::Units::m)
    return "set its scale if the file is in a larger unit, or use smaller cells";
  return fmt::format("did you mean units = \"m\" instead of \"{}\"? Otherwise use smaller cells",
                     unit_name(body.units));
}

std::string too_large_hint(const BodySettings& body) {
  if (!is_from_file(body) || body.units == BodySettings::Units::mm) return "use larger cells";
  return "did you mean units = \"mm\"? Otherwise use larger cells";
}

void warn_of_size(const BodySettings& body, const WorldPlan::Body& plan, double cell_size) {
  const double width = plan.width_in_cells;
  const bool is_narrow = width < 1;
  const bool is_wide = width > kWide && is_from_file(body);
  if (!is_narrow && !is_wide) return;
  log_warning(fmt::format("body {}: it is {:.2g} cells wide ({:.3g} m, cells of {:.3g} m) and gets {} particle{}; {}",
                          in_quotes(body.name), width, width * cell_size, cell_size, plan.particles,
                          plan.particles == 1 ? "" : "s", is_narrow ? too_small_hint(body) : too_large_hint(body)));
}

}  // namespace firn
