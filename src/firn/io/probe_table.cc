#include <firn/io/probe_table.h>
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>

namespace firn {
namespace {

constexpr const char* kHeader = "frame,time,point,x,y,z,density,velocity_x,velocity_y,velocity_z,pressure\n";

/// The shortest text that reads back to the same double.
std::string field(double number) { return std::isnan(number) ? "" : fmt::format("{}", number); }

}  // namespace

ProbeTable::ProbeTable(const std::filesystem::path& path) : rows_(path, kHeader) {}

ProbeTable::ProbeTable(FrameRows rows) : rows_(std::move(rows)) {}

ProbeTable ProbeTable::resume(const std::filesystem::path& path, std::int64_t frame, bool keep_later) {
  return ProbeTable(FrameRows::resume(path, kHeader, frame, keep_later));
}

void ProbeTable::append(std::int64_t frame, double time, std::span<const ProbeRow> rows) {
  std::string text;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const ProbeRow& row = rows[i];
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", frame, time, i, row.position[0], row.position[1],
                        row.position[2], row.density, field(row.velocity[0]), field(row.velocity[1]),
                        field(row.velocity[2]), field(row.pressure));
  }
  rows_.append(frame, text);
}

}  // namespace firn
