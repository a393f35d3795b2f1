#pragma once

#include <firn/core/linear_algebra.h>

#include <vector>

namespace firn {

/// How densely spheres lie around a point, on a grid twice as coarse as their spacing: what turns a heap of balls into
/// a body with one surface. Quadratic B-spline weights: value and gradient are continuous.
class DensityField {
 public:
  struct Sample {
    float density = 0;    ///< 1 where particles fill space at their spacing, 0 where there are none
    Vec3f gradient = {};  ///< of density, 1/m; points into the body
  };

  /// centers in m. Particles far from the bulk are left out where the grid would grow without bound: they count as
  /// loose.
  DensityField(const std::vector<Vec3f>& centers, float spacing);

  Sample sample(const Vec3f& x) const;

 private:
  struct Stencil {
    int base[3];
    float weight[3][3];
    float slope[3][3];
  };
  bool locate(const Vec3f& x, Stencil* stencil) const;
  void choose_box(const std::vector<Vec3f>& centers);
  std::size_t index(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(size_[1]) + static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(size_[0]) +
           static_cast<std::size_t>(i);
  }

  float step_;
  Vec3f origin_ = {};
  int size_[3] = {0, 0, 0};
  std::vector<float> nodes_;
};

}  // namespace firn
