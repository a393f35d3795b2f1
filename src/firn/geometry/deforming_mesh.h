#pragma once

#include <firn/geometry/deforming_shape.h>
#include <firn/geometry/mesh_neighbours.h>
#include <firn/geometry/sequence_clock.h>
#include <firn/geometry/triangle_bvh.h>

#include <mutex>
#include <string>
#include <vector>

namespace firn {

/// Meshes with the same triangles, each at its time.
struct MeshSequence {
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<std::vector<Vec3d>> positions;  ///< of the vertices, m; one list for each entry of the clock
  SequenceClock clock;

  TriangleMesh mesh_at(double t) const;
};

/// The solid inside a sequence of meshes: vertices move as the sequence's clock interpolates them, and the surface
/// between them with them, so that its velocity is the exact time derivative of a material point, along the surface
/// too. A belt that slides in its own plane moves without changing its form.
///
/// A tree of triangles is refitted once for each instant. Distances are exact, but for points further from the box
/// around the mesh than a twentieth of its longest side: there they are a bound. What is inside follows from the
/// pseudonormal at the nearest point, or, where the surface is open or not a manifold or pieces of it overlap in one of
/// the meshes, from the winding number, as for meshes that do not move.
///
/// Not a LevelSet for each instant, because making one costs a thousand times as much as a refit, and most of its nodes
/// would never be asked.
class DeformingMesh final : public DeformingShape<3> {
 public:
  /// @param inverted the solid is what lies outside. Throws Error (usage) if the numbers do not fit together.
  explicit DeformingMesh(MeshSequence sequence, bool inverted = false);

  std::shared_ptr<const ShapeInMotion<3>> at(double t) const override;
  const std::vector<double>& times() const override { return sequence_.clock.times(); }

  const MeshSequence& sequence() const { return sequence_; }
  bool uses_winding_number() const { return uses_winding_number_; }

 private:
  friend class MeshInstant;

  MeshSequence sequence_;
  bool inverted_;
  MeshNeighbours neighbours_;
  TriangleBvh tree_;
  bool uses_winding_number_;

  /// The last instants that were asked for.
  struct Cached {
    double t = 0;
    std::shared_ptr<const ShapeInMotion<3>> shape;
  };
  mutable std::mutex mutex_;
  mutable std::array<Cached, 4> cached_;
  mutable std::size_t next_slot_ = 0;
};

/// How far the surface of the last mesh is from that of the first one at most, m: 0 for a cycle that closes. Measured
/// at the vertices.
double gap_of_cycle(const MeshSequence& sequence);

}  // namespace firn
