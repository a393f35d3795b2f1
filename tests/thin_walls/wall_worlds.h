#pragma once

#include <firn/geometry/shapes.h>
#include <firn/integrators/time_step.h>
#include <firn/materials/model_info.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <string_view>
#include <vector>

#include "support/worlds.h"

namespace firn::test {

inline constexpr double kDx = 0.0625;  // m

/// A plate, thin in its own y, with its centre at the origin of the frame.
template <int dim>
Collider<dim> plate(double thickness, double width, Contact contact = Contact::separate, double friction = 0) {
  Vec<double, dim> half = constant_vector<double, dim>(0.5 * width);
  half[1] = 0.5 * thickness;
  Collider<dim> collider = {"plate", std::make_shared<Box<dim>>(half), {}, contact, friction};
  collider.thickness = thickness;
  return collider;
}

/// The rotation by this angle in the plane of x and y.
template <int dim>
Mat<double, dim> turned(double degrees) {
  const double a = degrees * M_PI / 180;
  if constexpr (dim == 2) {
    return rotation_by(a);
  } else {
    return rotation_by(Vec3d{{0, 0, a}});
  }
}

inline ModelParameters jelly() { return elastic(1e5, 0.3, 1000); }

/// Lattice of 2 points per cell and axis that fills the box [low, high) of a turned and moved frame; metres.
template <int dim>
std::vector<Vec<double, dim>> block_of_points(const Vec<double, dim>& low, const Vec<double, dim>& high,
                                              const Mat<double, dim>& rotation, const Vec<double, dim>& origin) {
  const double step = 0.5 * kDx;
  std::vector<Vec<double, dim>> points;
  Index<dim> count;
  std::int64_t total = 1;
  for (int d = 0; d < dim; ++d) {
    total *= count[static_cast<std::size_t>(d)] = std::llround((high[d] - low[d]) / step);
  }
  for (std::int64_t n = 0; n < total; ++n) {
    Vec<double, dim> x;
    std::int64_t rest = n;
    for (int d = dim - 1; d >= 0; --d) {
      const std::int64_t c = count[static_cast<std::size_t>(d)];
      x[d] = low[d] + step * (static_cast<double>(rest % c) + 0.5);
      rest /= c;
    }
    points.push_back(origin + rotation * x);
  }
  return points;
}

/// Adds a body of a material of its own.
template <class Real, int dim>
void add_body(World<Real, dim>& world, std::string_view model, const ModelParameters& parameters,
              const std::vector<Vec<double, dim>>& points, const Vec<double, dim>& velocity) {
  world.add_material("body" + std::to_string(world.materials.size()), model_number(model), parameters);
  const std::size_t m = world.materials.size() - 1;
  add_particles(world, m, points, std::pow(0.5 * kDx, dim));
  auto& particles = world.materials[m].particles;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    for (int i = 0; i < dim; ++i) particles.real(Field::velocity, i)[p] = static_cast<Real>(velocity[i]);
  }
}

template <class Real, int dim>
Vec<double, dim> mean_velocity(const World<Real, dim>& world, std::size_t material) {
  const auto& particles = world.materials[material].particles;
  Vec<double, dim> sum = {};
  for (std::size_t p = 0; p < particles.size(); ++p) {
    for (int i = 0; i < dim; ++i) sum[i] += static_cast<double>(particles.real(Field::velocity, i)[p]);
  }
  return (1 / static_cast<double>(particles.size())) * sum;
}

/// Positions by id.
template <class Real, int dim>
std::vector<Vec<double, dim>> positions(const World<Real, dim>& world) {
  std::vector<Vec<double, dim>> x(world.particle_count());
  for (const auto& material : world.materials) {
    for (std::size_t p = 0; p < material.particles.size(); ++p) {
      x[material.particles.id()[p]] = material.particles.position(p, world.grid.dx(), world.grid.kernel());
    }
  }
  return x;
}

/// Runs to t_end; visit() after every step. The steps are those of a frame that ends there.
template <class Real, int dim, class Visit>
void run_until(World<Real, dim>& world, double t_end, const Visit& visit) {
  while (world.t < t_end * (1 - 1e-12)) {
    const double dt = choose_time_step(world, TimeStepLimits(), t_end - world.t).dt;
    const StepReport report = step_explicit(world, dt);
    ASSERT_FALSE(report.failure) << report.failure->cause << " at t = " << world.t;
    visit();
  }
}
template <class Real, int dim>
void run_until(World<Real, dim>& world, double t_end) {
  run_until(world, t_end, [] {});
}

/// The path that keeps sides apart, switched off.
template <class Real, int dim>
void forget_thickness(World<Real, dim>& world) {
  for (auto& collider : world.colliders) collider.thickness = std::numeric_limits<double>::infinity();
}

}  // namespace firn::test
