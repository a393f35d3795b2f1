#pragma once

#include <firn/geometry/bounds.h>
#include <firn/geometry/motion.h>

#include <algorithm>
#include <cmath>

/// What a pose does to points and boxes of its frame.
namespace firn {

/// The place in the world of a point of the frame, m.
template <int dim>
Vec<double, dim> to_world(const Pose<dim>& pose, const Vec<double, dim>& x) {
  return pose.origin + pose.rotation * (pose.scale * x);
}

/// The place in the frame of a point of the world, m.
template <int dim>
Vec<double, dim> to_frame(const Pose<dim>& pose, const Vec<double, dim>& x) {
  return (1 / pose.scale) * (transpose(pose.rotation) * (x - pose.origin));
}

/// A box in the world that holds what lies in `box` of the frame.
template <int dim>
Bounds<dim> bounds_in_world(const Pose<dim>& pose, const Bounds<dim>& box) {
  const Vec<double, dim> centre = to_world<dim>(pose, box.center()), half = (0.5 * pose.scale) * box.size();
  Vec<double, dim> reach = {};
  for (int i = 0; i < dim; ++i) {
    for (int j = 0; j < dim; ++j) reach[i] += std::abs(pose.rotation(i, j)) * half[j];
  }
  return {centre - reach, centre + reach};
}

/// The largest speed in the world of a point of `box` of the frame, m/s: that of one of its corners.
template <int dim>
double fastest_in(const Pose<dim>& pose, const Bounds<dim>& box) {
  double fastest = 0;
  for (int corner = 0; corner < 1 << dim; ++corner) {
    Vec<double, dim> x;
    for (int i = 0; i < dim; ++i) x[i] = (corner >> i & 1) != 0 ? box.upper[i] : box.lower[i];
    fastest = std::max(fastest, norm(pose.velocity_at(to_world<dim>(pose, x))));
  }
  return fastest;
}

}  // namespace firn
