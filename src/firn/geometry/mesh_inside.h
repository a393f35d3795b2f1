#pragma once

#include <firn/geometry/inside_grid.h>
#include <firn/geometry/local_winding.h>
#include <firn/geometry/mesh_report.h>
#include <firn/geometry/winding_number.h>

namespace firn {

/// The solid that a mesh bounds: where its winding number exceeds 1/2. Pieces that overlap are one solid; a piece
/// inside another is a hollow if it faces the other way. Works for open meshes as far as the winding number makes sense
/// of them.
class MeshInside {
 public:
  /// Expects a mesh from prepare_mesh(). `cells`: of the look-up grid along the longest side (at most 48 are used for
  /// an open surface).
  explicit MeshInside(const TriangleMesh& mesh, int cells = 96);

  bool contains(const Vec3d& x) const;
  /// False without much work for most points outside; true says nothing.
  bool may_contain(const Vec3d& x) const {
    return local_.empty() ? grid_.at(x) != InsideGrid<3>::Kind::outside : contains(x);
  }
  /// False only if no point of the box is inside.
  bool may_overlap(const Bounds<3>& box) const { return grid_.may_overlap(box); }

  const Bounds<3>& bounds() const { return report_.bounds; }
  double area() const { return report_.area; }
  /// m^3: by the divergence theorem, or, where that does not hold (open meshes, overlapping or partly inverted pieces),
  /// by counting a grid of points.
  double volume() const { return volume_; }

  bool has_overlaps() const { return largest_winding_ > 1.5; }
  bool has_inverted_parts() const { return smallest_winding_ < -0.5; }

 private:
  void build_grid(const TriangleMesh& mesh);

  MeshReport report_;
  WindingNumber winding_;
  InsideGrid<3> grid_;
  LocalWinding local_;  ///< empty if the surface has no whole winding numbers
  double volume_ = 0;
  double largest_winding_ = 0, smallest_winding_ = 0;  ///< among the cells that the surface does not touch
};

/// Whether a triangle and a box have a common point: separating axes, Akenine-Moller 2001.
bool overlaps(const TriangleBvh::Triangle& triangle, const Bounds<3>& box);

}  // namespace firn
