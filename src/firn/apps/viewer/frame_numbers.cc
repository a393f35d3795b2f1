#include <firn/apps/viewer/frame_numbers.h>

#include <charconv>
#include <fstream>
#include <limits>
#include <map>

namespace firn {
namespace {

/// The fields of a line of CSV; quotes are doubled inside quoted fields.
std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quoted && c == '"' && i + 1 < line.size() && line[i + 1] == '"') {
      fields.back() += line[++i];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      fields.emplace_back();
    } else if (c != '\r') {
      fields.back() += c;
    }
  }
  return fields;
}

double number(const std::string& text) {
  double value = std::numeric_limits<double>::quiet_NaN();
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

}  // namespace

const std::vector<PlottedNumber>& plotted_numbers() {
  using N = FrameNumbers;
  static const std::vector<PlottedNumber> all = {
      {"kinetic energy", "J", [](const N& n) { return n.kinetic_energy; }},
      {"elastic energy", "J", [](const N& n) { return n.elastic_energy; }},
      {"gravitational energy", "J", [](const N& n) { return n.gravitational_energy; }},
      {"total energy", "J", [](const N& n) { return n.total_energy(); }},
      {"momentum", "kg m/s", [](const N& n) { return norm(n.momentum); }},
      {"time step", "s", [](const N& n) { return n.dt; }},
      {"particles", "", [](const N& n) { return static_cast<double>(n.particles); }},
      {"largest speed", "m/s", [](const N& n) { return n.max_speed; }},
  };
  return all;
}

std::vector<FrameNumbers> read_frame_numbers(const std::filesystem::path& stats) {
  std::vector<FrameNumbers> rows;
  std::ifstream stream(stats);
  std::string line;
  if (!std::getline(stream, line)) return rows;
  const std::vector<std::string> names = split(line);
  std::map<std::string, std::size_t> place;
  for (std::size_t i = 0; i < names.size(); ++i) place[names[i]] = i;
  while (std::getline(stream, line)) {
    const std::vector<std::string> fields = split(line);
    // The last line of a run that is being written may be short.
    if (fields.size() != names.size()) continue;
    const auto at = [&](const char* name) {
      const auto found = place.find(name);
      return found == place.end() ? std::numeric_limits<double>::quiet_NaN() : number(fields[found->second]);
    };
    FrameNumbers row;
    const double frame = at("frame"), particles = at("particles");
    if (!(frame >= 1)) continue;
    row.frame = static_cast<std::int64_t>(frame);
    row.time = at("time");
    row.kinetic_energy = at("kinetic_energy");
    row.elastic_energy = at("elastic_energy");
    row.gravitational_energy = at("gravitational_energy");
    row.momentum = {{at("momentum_x"), at("momentum_y"), at("momentum_z")}};
    row.max_speed = at("max_speed");
    row.dt = at("dt");
    if (const auto limit = place.find("limit"); limit != place.end()) row.limit = fields[limit->second];
    row.particles = particles >= 0 ? static_cast<std::int64_t>(particles) : 0;
    rows.push_back(row);
  }
  return rows;
}

}  // namespace firn
