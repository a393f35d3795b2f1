#include <firn/state/snapshot.h>

namespace firn {

const SnapshotColumn* Snapshot::find(std::string_view name) const {
  for (const SnapshotColumn& column : columns) {
    if (column.name == name) return &column;
  }
  return nullptr;
}

Vec3d Snapshot::position(std::size_t p) const {
  const SnapshotColumn& position = columns.front();
  return {{value(position, p, 0), value(position, p, 1), value(position, p, 2)}};
}

double value(const SnapshotColumn& column, std::size_t p, int c) {
  return std::visit(
      [&](const auto& values) {
        return static_cast<double>(
            values[p * static_cast<std::size_t>(column.components) + static_cast<std::size_t>(c)]);
      },
      column.values);
}

}  // namespace firn
