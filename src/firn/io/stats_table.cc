#include <firn/core/error.h>
#include <firn/io/stats_table.h>
#include <fmt/format.h>

#include <utility>

namespace firn {

namespace {

using Value = StatsColumn::Value;

constexpr StatsColumn kColumns[] = {
    {"frame", "", "Number of the frame; frame 1 is t = 0.", [](const StatsRow& r) -> Value { return r.frame; }},
    {"time", "s", "Simulated time.", [](const StatsRow& r) -> Value { return r.time; }},
    {"steps", "", "Steps since the frame before.", [](const StatsRow& r) -> Value { return r.steps; }},
    {"dt", "s", "Smallest time step since the frame before.", [](const StatsRow& r) -> Value { return r.dt; }},
    {"limit", "", "What limited that time step.", [](const StatsRow& r) -> Value { return std::string_view(r.limit); }},
    {"particles", "", "Number of particles.", [](const StatsRow& r) -> Value { return r.particles; }},
    {"mass", "kg", "Total mass.", [](const StatsRow& r) -> Value { return r.mass; }},
    {"momentum_x", "kg m/s", "Linear momentum.", [](const StatsRow& r) -> Value { return r.momentum[0]; }},
    {"momentum_y", "kg m/s", "Linear momentum.", [](const StatsRow& r) -> Value { return r.momentum[1]; }},
    {"momentum_z", "kg m/s", "Linear momentum.", [](const StatsRow& r) -> Value { return r.momentum[2]; }},
    {"angular_momentum_x", "kg m^2/s", "Angular momentum about the origin, with the affine part.",
     [](const StatsRow& r) -> Value { return r.angular_momentum[0]; }},
    {"angular_momentum_y", "kg m^2/s", "Angular momentum about the origin, with the affine part.",
     [](const StatsRow& r) -> Value { return r.angular_momentum[1]; }},
    {"angular_momentum_z", "kg m^2/s", "Angular momentum about the origin, with the affine part.",
     [](const StatsRow& r) -> Value { return r.angular_momentum[2]; }},
    {"kinetic_energy", "J", "Kinetic energy.", [](const StatsRow& r) -> Value { return r.kinetic_energy; }},
    {"elastic_energy", "J", "Stored elastic energy.", [](const StatsRow& r) -> Value { return r.elastic_energy; }},
    {"gravitational_energy", "J", "-m g.x summed; zero at the origin.",
     [](const StatsRow& r) -> Value { return r.gravitational_energy; }},
    {"max_speed", "m/s", "Largest speed of a particle.", [](const StatsRow& r) -> Value { return r.max_speed; }},
    {"volume", "m^3", "Volume of all particles, J times undeformed volume summed; m^2 in 2D.",
     [](const StatsRow& r) -> Value { return r.volume; }},
    {"volume_drift", "", "Present over undeformed volume, less 1.",
     [](const StatsRow& r) -> Value { return r.volume_drift; }},
    {"min_J", "", "Smallest volume ratio det F.", [](const StatsRow& r) -> Value { return r.min_J; }},
    {"max_J", "", "Largest volume ratio det F.", [](const StatsRow& r) -> Value { return r.max_J; }},
    {"wall_seconds", "s", "Wall-clock time since the start of the run.",
     [](const StatsRow& r) -> Value { return r.wall_seconds; }},
};

/// Quoted where RFC 4180 asks for it.
std::string csv_text(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted.push_back('"');
    quoted.push_back(c);
  }
  quoted.push_back('"');
  return quoted;
}

std::string csv_field(const Value& value) {
  if (const auto* text = std::get_if<std::string_view>(&value)) return csv_text(*text);
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return fmt::format("{}", *integer);
  return fmt::format("{}", std::get<double>(value));  // shortest text that reads back to the same double
}

std::string header(const std::vector<std::string>& further_columns) {
  std::vector<std::string> names;
  for (const StatsColumn& column : kColumns) names.emplace_back(column.name);
  for (const std::string& name : further_columns) names.push_back(csv_text(name));
  return fmt::format("{}\n", fmt::join(names, ","));
}

}  // namespace

std::span<const StatsColumn> stats_columns() { return kColumns; }

StatsTable::StatsTable(const std::filesystem::path& path, std::vector<std::string> further_columns)
    : path_(path), further_columns_(further_columns.size()), rows_(path, header(further_columns)) {}

StatsTable::StatsTable(const std::filesystem::path& path, std::size_t further_columns, FrameRows rows)
    : path_(path), further_columns_(further_columns), rows_(std::move(rows)) {}

StatsTable StatsTable::resume(const std::filesystem::path& path, const std::vector<std::string>& further_columns,
                              std::int64_t frame, bool keep_later) {
  return {path, further_columns.size(), FrameRows::resume(path, header(further_columns), frame, keep_later)};
}

void StatsTable::append(const StatsRow& row) {
  if (row.further.size() != further_columns_) {
    throw Error(ErrorKind::usage, fmt::format("{}: the row has {} further values, the table {} further columns",
                                              path_.string(), row.further.size(), further_columns_));
  }
  std::vector<std::string> fields;
  for (const StatsColumn& column : kColumns) fields.push_back(csv_field(column.value(row)));
  for (const double number : row.further) fields.push_back(csv_field(number));
  rows_.append(row.frame, fmt::format("{}\n", fmt::join(fields, ",")));
}

}  // namespace firn
