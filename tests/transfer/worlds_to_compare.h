#pragma once

#include <firn/materials/model_info.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "support/worlds.h"

namespace firn::test {

/// Where the particles of a test world lie in their cells.
enum class Layout {
  cloud,   ///< anywhere
  faces,   ///< a third of them on cell faces and the numbers next to those
  counts,  ///< cells that hold 0, 1, 7, 8, 9, 64 and 1000 particles
};

inline constexpr double kCell = 0.125;  // a power of two: cell faces are numbers

/// Positions in cells, relative to the first node of cell 0.
template <int dim>
std::vector<Vec<double, dim>> cell_positions(Layout layout, Random& random) {
  std::vector<Vec<double, dim>> points;
  const auto add = [&](int count, const Vec<double, dim>& low, double width) {
    for (int n = 0; n < count; ++n) {
      Vec<double, dim> x;
      for (int d = 0; d < dim; ++d) x[d] = low[d] + random.uniform(0, width);
      points.push_back(x);
    }
  };
  // Across the origin, where coordinates change sign, and across the border of a block.
  const Vec<double, dim> low = constant_vector<double, dim>(-2.0);
  if (layout != Layout::counts) add(400, low, kBlockSide<dim> + 1);
  if (layout == Layout::counts) {
    constexpr int kCounts[] = {1, 0, 7, 8, 9, 64, 1000};
    for (std::size_t c = 0; c < std::size(kCounts); ++c) {
      Vec<double, dim> corner = low;
      corner[0] += static_cast<double>(c);
      corner[dim - 1] += static_cast<double>(c % 2);
      add(kCounts[c], corner, 1);
    }
  }
  return points;
}

/// Moves some particles to faces, edges, corners and centres of their cells, and to the numbers beside them. Only
/// inside the cloud: at its border, the gradients of the linear kernel would be those of a node with next to no mass.
template <class Real, int dim>
void move_to_faces(Particles<Real, dim>& particles, Random& random) {
  const Real zero = 0, one = 1;
  // Exactly one is what rounding makes of a particle that just entered the cell from above.
  const Real kPlaces[] = {
      zero, one, std::nextafter(zero, one), std::nextafter(one, zero), Real(0.5), Real(1e-30), Real(1e-8), Real(0.3)};
  for (std::size_t p = 0; p < particles.size(); p += 3) {
    bool inside = true;
    for (const std::int64_t c : cell_of_key<dim>(particles.cell(p))) inside = inside && c >= -1 && c <= 1;
    for (int d = 0; d < dim && inside; ++d) {
      particles.real(Field::offset, d)[p] = kPlaces[random.next() % std::size(kPlaces)];
    }
  }
}

template <class Real, int dim>
void set_random_state(Particles<Real, dim>& particles, std::string_view model, Random& random) {
  // Snow yields and has to be tested on both sides.
  const double strain = model == "snow" ? 0.1 : 0.2;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    for (int i = 0; i < dim; ++i) particles.real(Field::velocity, i)[p] = static_cast<Real>(random.uniform(-1, 1));
    for (int e = 0; e < dim * dim; ++e) {
      particles.real(Field::affine, e)[p] = static_cast<Real>(random.uniform(-1, 1) / kCell);
      particles.real(Field::strain, e)[p] += static_cast<Real>(random.uniform(-strain, strain));
    }
    for (int h = 0; h < particles.history_count(); ++h) {
      particles.history(h)[p] = static_cast<Real>(random.uniform(0.9, 1.1));
    }
  }
}

template <int dim>
Vec<double, dim> gravity() {
  Vec<double, dim> g = {};
  g[0] = 0.3;
  g[1] = -9.81;
  return g;
}

/// One material of every model, all in the same cells and in random motion. Same bits on every call.
template <class Real, int dim>
World<Real, dim> comparison_world(Layout layout, const TransferSettings& settings, bool with_body_force = false,
                                  const Period<dim>& period = {}) {
  World<Real, dim> world(kCell, settings, period);
  world.gravity = gravity<dim>();
  if (with_body_force) {
    world.body_force = [](const Vec<double, dim>& x, const Vec<double, dim>& v, std::uint32_t id, double t) {
      Vec<double, dim> a = -3.0 * v;
      a[0] += 20 * std::sin(5 * x[1] + t);
      a[1] += id % 2 == 0 ? 10.0 : -10.0;
      return a;
    };
  }
  Random random(7);
  for (std::size_t m = 0; m < all_models().size(); ++m) {
    const ModelInfo& info = all_models()[m];
    ModelParameters parameters;
    for (const Parameter& p : info.parameters) parameters.values.push_back(p.default_value);
    parameters.values[0] = 1e4;  // Young's modulus: waves cross a quarter of a cell in kTimeStep
    parameters.density = 1000;
    if (info.name == "snow") {
      // Stress is as exact as the strain that it comes from, and snow's strain is small: rounding of F by eps changes
      // the stress by eps / theta_c. With theta_c = 0.025 that alone would be a third of the tolerance.
      parameters.values[2] = 0.1;
      parameters.values[3] = 0.05;
    }
    world.add_material(std::string(info.name), static_cast<int>(m), parameters);
    auto points = cell_positions<dim>(layout, random);
    for (auto& x : points) {
      for (int d = 0; d < dim; ++d) x[d] = kCell * (x[d] + cell_offset(settings.kernel));
    }
    add_particles<Real, dim>(world, m, points, std::pow(kCell, dim) / 8);
    auto& particles = world.materials[m].particles;
    // Of several volumes, except for the first material, which takes the short way for one.
    for (std::size_t p = 0; m > 0 && p < particles.size(); ++p) {
      particles.set_origin(p, static_cast<std::uint16_t>(p % 3),
                           particles.rest_volume(p) * static_cast<Real>(0.75 + 0.125 * static_cast<double>(p % 5)));
    }
    set_random_state(particles, info.name, random);
    if (layout == Layout::faces) move_to_faces(particles, random);
  }
  prepare(world);
  return world;
}

inline constexpr double kTimeStep = 0.008;  // s; the fastest particles move a tenth of a cell

/// f(name, component count, column(particles, component)) for every column of real numbers.
template <class Real, int dim, class F>
void for_each_real_column(const Particles<Real, dim>& particles, const F& f) {
  for (const Field field : {Field::offset, Field::strain, Field::velocity, Field::affine, Field::stress, Field::grad_v,
                            Field::acceleration}) {
    if (!particles.has(field)) continue;
    f(std::string(kFields[static_cast<std::size_t>(field)].name), particles.component_count(field),
      [field](auto& p, int c) { return p.real(field, c); });
  }
  for (int h = 0; h < particles.history_count(); ++h) {
    f(particles.history_spec(h).name, 1, [h](auto& p, int) { return p.history(h); });
  }
}

/// Makes the real columns of `to` those of `from`, whose particles lie in the same order: what prepare computes differs
/// in the last bits between targets.
template <class Real, int dim>
void copy_columns(const World<Real, dim>& from, World<Real, dim>& to) {
  for (std::size_t m = 0; m < from.materials.size(); ++m) {
    const auto& source = from.materials[m].particles;
    auto& target = to.materials[m].particles;
    for_each_real_column(source, [&](const std::string&, int components, const auto& column) {
      for (int c = 0; c < components; ++c) {
        for (std::size_t p = 0; p < source.size(); ++p) column(target, c)[p] = column(source, c)[p];
      }
    });
  }
}

/// Largest difference of every column of real numbers between two worlds, over the column's largest magnitude;
/// particles are matched by id. "position" stands for the columns cell and offset.
template <class Real, int dim>
std::map<std::string, double> column_differences(const World<Real, dim>& a, const World<Real, dim>& b) {
  std::map<std::string, double> result;
  const double nan = std::nan("");
  for (std::size_t m = 0; m < a.materials.size(); ++m) {
    const auto &p = a.materials[m].particles, &q = b.materials[m].particles;
    std::map<std::uint32_t, std::size_t> place;
    for (std::size_t i = 0; i < q.size(); ++i) place[q.id()[i]] = i;
    const auto compare = [&](const std::string& name, int components, const auto& of_a, const auto& of_b) {
      double difference = 0, magnitude = 0;
      for (std::size_t i = 0; i < p.size(); ++i) {
        const std::size_t j = place.at(p.id()[i]);
        for (int c = 0; c < components; ++c) {
          const double x = of_a(i, c), y = of_b(j, c);
          difference = std::isfinite(x) && std::isfinite(y) ? std::max(difference, std::fabs(x - y)) : nan;
          magnitude = std::max(magnitude, std::fabs(y));
        }
      }
      const double relative = magnitude > 0 ? difference / magnitude : difference;
      double& worst = result[name];
      // NaN must not be lost in the maximum.
      worst = std::isnan(worst) || std::isnan(relative) ? nan : std::max(worst, relative);
    };
    const double dx = a.grid.dx();
    const Kernel kernel = a.grid.kernel();
    compare(
        "position", dim, [&](std::size_t i, int c) { return p.position(i, dx, kernel)[c]; },
        [&](std::size_t j, int c) {
          const auto x = q.position(j, dx, kernel);
          return x[c];
        });
    for_each_real_column(p, [&](const std::string& name, int components, const auto& column) {
      if (name == "offset") return;
      compare(
          name, components, [&](std::size_t i, int c) { return static_cast<double>(column(p, c)[i]); },
          [&](std::size_t j, int c) { return static_cast<double>(column(q, c)[j]); });
    });
  }
  return result;
}

}  // namespace firn::test
