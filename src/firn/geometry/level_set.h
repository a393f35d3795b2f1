#pragma once

#include <firn/geometry/shape.h>
#include <firn/geometry/triangle_mesh.h>

#include <cstdint>
#include <vector>

namespace firn {

/// A solid sampled on a grid: exact signed distances at the nodes of 8-cell blocks that the surface may touch, and one
/// distance for each other block. Trilinear next to the surface, so that edges are rounded by about a cell and parts
/// thinner than a cell may vanish; elsewhere a bound on the distance with the right sign.
///
/// A grid and not the mesh itself, because colliders are asked for every node and particle near them at every step: a
/// look-up costs some 20 ns whatever the number of triangles.
class LevelSet final : public Shape<3> {
 public:
  /// All that a level set consists of, for keeping it in a file.
  struct Data {
    Vec3d lower = {};  ///< corner of the first block, m
    double cell = 0;   ///< m
    Vec3d mesh_lower = {}, mesh_upper = {};
    std::int32_t blocks[3] = {};     ///< number along each axis
    std::vector<float> center;       ///< signed distance at the centre of every block, m
    std::vector<std::int32_t> fine;  ///< which run of node values each block has; -1 without
    std::vector<float> nodes;        ///< 9^3 for each block with node values, z fastest, m
  };

  /// Expects a mesh from prepare_mesh(); what is inside is MeshInside's answer. Throws Error (usage) if that many cells
  /// do not fit into memory (more than 2^18 blocks at the surface).
  LevelSet(const TriangleMesh& mesh, double cell);
  explicit LevelSet(Data data);

  double distance(const Vec3d& x) const override;
  Vec3d normal(const Vec3d& x) const override;
  Bounds<3> bounds() const override { return {data_.mesh_lower, data_.mesh_upper}; }

  const Data& data() const { return data_; }
  /// Whether sizes and indices fit together, so that no look-up can leave the arrays.
  static bool is_consistent(const Data& data);

 private:
  struct Place {
    std::size_t block;
    Vec3d in_block;  ///< cells from the block's corner
  };

  Place place_of(const Vec3d& x) const;
  std::size_t flat(const std::int32_t (&b)[3]) const;
  double coarse_distance(const Place& place) const;
  Vec3d coarse_normal(const Vec3d& x, std::size_t block) const;

  Data data_;
};

}  // namespace firn
