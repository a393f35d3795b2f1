#include <fcntl.h>
#include <firn/core/error.h>
#include <firn/core/log.h>
#include <firn/io/atomic_file.h>
#include <firn/io/stats_table.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <iterator>
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

[[noreturn]] void fail(const std::filesystem::path& path, int reason) {
  throw Error(ErrorKind::files, fmt::format("{}: cannot add a row: {}{}", path.string(), std::strerror(reason),
                                            reason == ENOSPC ? "; free some disk space" : ""));
}

/// Adds text, by one write if the system takes it whole, and takes a part of it back.
void append_text(const std::filesystem::path& path, std::string_view text) {
  const int file = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (file < 0) fail(path, errno);
  struct stat before = {};
  ::fstat(file, &before);
  int reason = 0;
  while (!text.empty() && reason == 0) {
    const ssize_t written = ::write(file, text.data(), text.size());
    if (written >= 0) {
      text.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno != EINTR) {
      reason = errno;
    }
  }
  if (reason != 0 && S_ISREG(before.st_mode) && ::ftruncate(file, before.st_size) != 0) reason = errno;
  if (::close(file) != 0 && reason == 0) reason = errno;
  if (reason != 0) fail(path, reason);
}

}  // namespace

std::span<const StatsColumn> stats_columns() { return kColumns; }

StatsTable::StatsTable(const std::filesystem::path& path, std::vector<std::string> further_columns)
    : path_(path), further_columns_(further_columns.size()) {
  write_file_atomically(path_, header(further_columns));
}

StatsTable StatsTable::resume(const std::filesystem::path& path, std::vector<std::string> further_columns,
                              std::int64_t frame, bool keep_later) {
  std::ifstream stream(path, std::ios::binary);
  const int reason = errno;
  if (std::error_code error; !stream && std::filesystem::exists(path, error)) {
    throw Error(ErrorKind::files, fmt::format("{}: cannot read the rows: {}", path.string(), std::strerror(reason)));
  }
  const std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  const std::string first = header(further_columns);
  if (!text.starts_with(first)) {
    log_warning(fmt::format("{}: the rows up to frame {} are lost: the file is missing or has other columns",
                            path.string(), frame));
    return StatsTable(path, std::move(further_columns));
  }
  StatsTable table;
  table.path_ = path;
  table.further_columns_ = further_columns.size();
  table.before_ = first;
  std::size_t begin = first.size();
  for (std::size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    const std::string line = text.substr(begin, end + 1 - begin);
    std::int64_t number = 0;
    std::from_chars(line.data(), line.data() + line.size(), number);
    if (number <= frame) {
      table.before_ += line;
    } else if (keep_later) {
      table.later_[number] = line;
    }
  }
  table.write_all();
  return table;
}

void StatsTable::write_all() const {
  std::string text = before_;
  for (const auto& [frame, line] : later_) text += line;
  write_file_atomically(path_, text, Durability::synced);
}

void StatsTable::sync() const {
  const int file = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC);
  const bool synced = file >= 0 && (::fsync(file) == 0 || errno == EINVAL);
  const int reason = errno;
  if (file >= 0) ::close(file);
  if (!synced) {
    throw Error(ErrorKind::files,
                fmt::format("{}: cannot flush to the disk: {}", path_.string(), std::strerror(reason)));
  }
}

void StatsTable::append(const StatsRow& row) {
  if (row.further.size() != further_columns_) {
    throw Error(ErrorKind::usage, fmt::format("{}: the row has {} further values, the table {} further columns",
                                              path_.string(), row.further.size(), further_columns_));
  }
  std::vector<std::string> fields;
  for (const StatsColumn& column : kColumns) fields.push_back(csv_field(column.value(row)));
  for (const double number : row.further) fields.push_back(csv_field(number));
  const std::string line = fmt::format("{}\n", fmt::join(fields, ","));
  if (later_.empty()) return append_text(path_, line);
  before_ += line;
  later_.erase(later_.begin(), later_.upper_bound(row.frame));
  write_all();
}

}  // namespace firn
