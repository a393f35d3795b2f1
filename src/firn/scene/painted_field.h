#pragma once

#include <firn/geometry/triangle_bvh.h>
#include <firn/io/painted_mesh.h>
#include <firn/scene/settings.h>

#include <string>
#include <vector>

namespace firn {

/// Numbers painted on the vertices of a body's mesh file, for every point of space: that of the nearest point of the
/// surface, between vertices in proportion to the areas of the triangle.
class PaintedField {
 public:
  /// Error(usage) if the body is not a PLY mesh or has no such property of its vertices; Error(files) if it cannot be
  /// read.
  PaintedField(const Scene& scene, const BodySettings& body, const std::string& attribute);

  /// @param x in world coordinates, m
  double at(const Vec3d& x) const;

 private:
  explicit PaintedField(PaintedMesh painted);

  TriangleMesh mesh_;
  std::vector<double> values_;
  TriangleBvh tree_;
};

}  // namespace firn
