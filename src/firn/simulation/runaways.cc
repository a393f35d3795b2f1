#include <firn/core/log.h>
#include <firn/integrators/verbs.h>
#include <firn/simulation/runaways.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace firn {

template <class Real, int dim>
void RunawayGuard<Real, dim>::park_fast(World<Real, dim>& world) {
  if (!may_park(world)) return;
  double fastest = 0;
  for (auto& material : world.materials) {
    if (!(material.max_speed > *limits_.speed)) {
      fastest = std::max(fastest, material.max_speed);
      continue;
    }
    const auto& particles = material.particles;
    std::vector<std::uint32_t> places;
    double fastest_left = 0;
    for (std::uint32_t p = 0; p < particles.size(); ++p) {
      double square = 0;
      for (int i = 0; i < dim; ++i) {
        const double v = particles.real(Field::velocity, i)[p];
        square += v * v;
      }
      if (square > *limits_.speed * *limits_.speed) {
        places.push_back(p);
      } else {
        fastest_left = std::max(fastest_left, square);
      }
    }
    material.max_speed = std::sqrt(fastest_left);
    fastest = std::max(fastest, material.max_speed);
    remove(world, material, places, fmt::format("faster than limits.speed = {:g} m/s", *limits_.speed));
  }
  world.max_speed = fastest;
}

template <class Real, int dim>
void RunawayGuard<Real, dim>::park_far(World<Real, dim>& world) {
  if (!limits_.box) return;
  for (auto& material : world.materials) {
    std::vector<std::uint32_t> places;
    for (std::uint32_t p = 0; p < material.particles.size(); ++p) {
      const auto x = material.particles.position(p, world.grid.dx(), world.grid.kernel());
      bool inside = true;
      for (int d = 0; d < dim; ++d) inside = inside && x[d] >= limits_.box->lower[d] && x[d] <= limits_.box->upper[d];
      if (!inside) places.push_back(p);
    }
    remove(world, material, places, "outside limits.box");
  }
}

template <class Real, int dim>
void RunawayGuard<Real, dim>::remove(World<Real, dim>& world, MaterialSet<Real, dim>& material,
                                     const std::vector<std::uint32_t>& places, const std::string& reason) {
  if (places.empty()) return;
  const auto first = material.particles.position(places.front(), world.grid.dx(), world.grid.kernel());
  log_warning(fmt::format(
      "parked {} particle(s) of \"{}\" at t = {:.6g} s, {}: the first is id {} at x = {:.4g} m, y = {:.4g} m",
      places.size(), material.name, world.t, reason, material.particles.id()[places.front()], first[0], first[1]));
  parked_ += static_cast<std::int64_t>(places.size());
  material.particles.remove(places);
  activate_blocks(world);
}

template class RunawayGuard<float, 2>;
template class RunawayGuard<float, 3>;
template class RunawayGuard<double, 2>;
template class RunawayGuard<double, 3>;

}  // namespace firn
