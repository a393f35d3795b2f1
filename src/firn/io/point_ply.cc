#include <firn/io/atomic_file.h>
#include <firn/io/point_files.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

namespace firn {
namespace {

static_assert(std::endian::native == std::endian::little, "files of points are written as they lie in memory");

enum class PlyType { uchar, int_, float_, double_ };

constexpr const char* kNames[] = {"uchar", "int", "float", "double"};
constexpr std::size_t kSizes[] = {1, 4, 4, 8};

bool fits_int(const std::vector<std::int64_t>& values) {
  return std::ranges::all_of(values, [](std::int64_t v) {
    return v >= std::numeric_limits<std::int32_t>::min() && v <= std::numeric_limits<std::int32_t>::max();
  });
}

PlyType type_of(const SnapshotColumn& column) {
  if (column.name == kColorColumn && column.components == 3) return PlyType::uchar;
  if (std::holds_alternative<std::vector<std::int32_t>>(column.values)) return PlyType::int_;
  if (const auto* wide = std::get_if<std::vector<std::int64_t>>(&column.values)) {
    return fits_int(*wide) ? PlyType::int_ : PlyType::double_;
  }
  return PlyType::float_;
}

template <class T>
void put(char* to, T value) {
  std::memcpy(to, &value, sizeof value);
}

void put(char* to, PlyType type, double value) {
  switch (type) {
    case PlyType::uchar:
      return put(to, static_cast<std::uint8_t>(value));
    case PlyType::int_:
      return put(to, static_cast<std::int32_t>(value));
    case PlyType::float_:
      return put(to, static_cast<float>(value));
    case PlyType::double_:
      return put(to, value);
  }
}

}  // namespace

void write_ply(const std::filesystem::path& path, const Snapshot& snapshot) {
  const std::size_t count = snapshot.size();
  std::string bytes = fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", count);
  std::size_t row = 0;
  for (const SnapshotColumn& column : snapshot.columns) {
    const auto type = static_cast<std::size_t>(type_of(column));
    for (const std::string& name : component_names(column)) {
      bytes += fmt::format("property {} {}\n", kNames[type], name);
      row += kSizes[type];
    }
  }
  bytes += "end_header\n";
  std::size_t offset = bytes.size();
  bytes.resize(offset + row * count);
  for (const SnapshotColumn& column : snapshot.columns) {
    const PlyType type = type_of(column);
    const std::size_t size = kSizes[static_cast<std::size_t>(type)];
    for (std::size_t p = 0; p < count; ++p) {
      char* to = bytes.data() + offset + p * row;
      for (int c = 0; c < column.components; ++c, to += size) put(to, type, value(column, p, c));
    }
    offset += size * static_cast<std::size_t>(column.components);
  }
  write_file_atomically(path, bytes);
}

}  // namespace firn
