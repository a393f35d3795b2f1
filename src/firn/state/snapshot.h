#pragma once

#include <firn/core/linear_algebra.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace firn {

/// One named quantity of all particles, component-interleaved: value c of particle p is values[p * components + c].
/// Vectors have 3 components and matrices 9 (row-major) also in 2D, padded with zeros (the matrix with a unit zz entry
/// where it is a deformation), because that is what every client program expects.
struct SnapshotColumn {
  std::string name;  ///< for example "velocity"
  std::string unit;  ///< SI; "" for pure numbers and ids
  std::string help;  ///< one sentence, for file metadata and reference pages
  int components = 1;
  std::variant<std::vector<float>, std::vector<double>, std::vector<std::int32_t>, std::vector<std::int64_t>> values;
};

/// Particles [begin, end) belong to this material.
struct SnapshotMaterial {
  std::string name;    ///< as in the scene, for example "snow"
  std::string model;   ///< for example "snow"
  std::string preset;  ///< for example "snow"; "" without one
  std::size_t begin = 0, end = 0;
};

/// A copy of the particles at one instant, in world coordinates and in the order (material, id): what frames are
/// written from and pictures are drawn from, safe to read while the simulation goes on.
struct Snapshot {
  int dimension = 3;
  double time = 0;              ///< s
  double cell_size = 0;         ///< m
  double particle_spacing = 0;  ///< m, (volume per particle)^(1/dimension) of the smallest particle
  std::vector<SnapshotMaterial> materials;
  std::vector<std::string> bodies;      ///< names, indexed by the column "body"
  std::vector<SnapshotColumn> columns;  ///< "position" (m) first; then at least velocity, id, body, material

  std::size_t size() const { return materials.empty() ? 0 : materials.back().end; }
  /// Null if there is no such column.
  const SnapshotColumn* find(std::string_view name) const;
  /// Position of particle p, m.
  Vec3d position(std::size_t p) const;
};

/// Component c of particle p as a double, whatever the stored type.
double value(const SnapshotColumn& column, std::size_t p, int c = 0);

}  // namespace firn
