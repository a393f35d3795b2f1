#pragma once

#include <firn/geometry/triangle_bvh.h>

namespace firn {

/// Solid angle of a triangle seen from x, positive if x looks at its back (is inside). Van Oosterom and Strackee 1983.
double solid_angle(const TriangleBvh::Triangle& triangle, const Vec3d& x);

/// Generalised winding number of a surface: 1 inside, 0 outside a closed one; a smooth transition across the holes of
/// an open one. Far groups of triangles count as one dipole and its gradient: Barill et al. 2018, "Fast winding numbers
/// for soups and clouds", the first two terms of equation 8; near ones are exact.
class WindingNumber {
 public:
  /// A group counts as far when it is `accuracy` times its own radius away. 3 keeps errors below 0.05, far from what
  /// could move an answer past 1/2; infinity is exact.
  explicit WindingNumber(const TriangleMesh& mesh, double accuracy = 3);

  double operator()(const Vec3d& x) const;

 private:
  struct Expansion {
    Vec3d center;        ///< of area
    Vec3d area_vector;   ///< sum of area times normal
    Mat3d moment;        ///< sum of area times normal times (centre of the triangle - center)^T
    double far_squared;  ///< beyond this squared distance the expansion stands for the group
  };

  static double far_field(const Expansion& expansion, const Vec3d& offset, double squared);

  TriangleBvh tree_;
  std::vector<Expansion> expansions_;
};

}  // namespace firn
