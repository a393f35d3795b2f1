#pragma once

#include <firn/integrators/world.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "support/random.h"

namespace firn::test {

/// Points spread evenly at random over the box [low, high).
template <int dim>
std::vector<Vec<double, dim>> random_points(Random& random, std::size_t count, const Vec<double, dim>& low,
                                            const Vec<double, dim>& high) {
  std::vector<Vec<double, dim>> points(count);
  for (auto& x : points) {
    for (int d = 0; d < dim; ++d) x[d] = random.uniform(low[d], high[d]);
  }
  return points;
}

template <class Real, int dim>
Vec<double, dim> get_vector(const Particles<Real, dim>& particles, Field field, std::size_t p) {
  Vec<double, dim> v;
  for (int i = 0; i < dim; ++i) v[i] = particles.real(field, i)[p];
  return v;
}

template <class Real, int dim>
void set_vector(Particles<Real, dim>& particles, Field field, std::size_t p, const Vec<double, dim>& v) {
  for (int i = 0; i < dim; ++i) particles.real(field, i)[p] = static_cast<Real>(v[i]);
}

template <class Real, int dim>
Mat<double, dim> get_matrix(const Particles<Real, dim>& particles, Field field, std::size_t p) {
  Mat<double, dim> m;
  for (int e = 0; e < dim * dim; ++e) m.e[e] = particles.real(field, e)[p];
  return m;
}

template <class Real, int dim>
void set_matrix(Particles<Real, dim>& particles, Field field, std::size_t p, const Mat<double, dim>& m) {
  for (int e = 0; e < dim * dim; ++e) particles.real(field, e)[p] = static_cast<Real>(m.e[e]);
}

/// f(particles, p, world position of p) for all particles, in their present order.
template <class Real, int dim, class F>
void for_each_particle(World<Real, dim>& world, const F& f) {
  for (auto& material : world.materials) {
    for (std::size_t p = 0; p < material.particles.size(); ++p) {
      f(material.particles, p, material.particles.position(p, world.grid.dx(), world.grid.kernel()));
    }
  }
}

/// Present place of each particle of a material, by id. Ids run from 0.
template <class Real, int dim>
std::vector<std::size_t> places_by_id(const Particles<Real, dim>& particles) {
  std::vector<std::size_t> places(particles.size());
  for (std::size_t p = 0; p < particles.size(); ++p) places[particles.id()[p]] = p;
  return places;
}

template <int dim>
double largest_entry(const Mat<double, dim>& m) {
  double largest = 0;
  for (const double entry : m.e) largest = std::max(largest, std::abs(entry));
  return largest;
}

/// a - b on an axis of the given period (0: none), the shortest way round.
inline double periodic_difference(double a, double b, double period) {
  const double difference = a - b;
  return period > 0 ? difference - period * std::round(difference / period) : difference;
}

}  // namespace firn::test
