#include <firn/core/parallel.h>
#include <firn/measure/penetration.h>

#include <algorithm>
#include <cstddef>

namespace firn {
namespace {

constexpr std::size_t kGrain = 1 << 12;

}  // namespace

Penetration& Penetration::operator+=(const Penetration& other) {
  particles += other.particles;
  depth = std::max(depth, other.depth);
  return *this;
}

template <class Real, int dim>
std::vector<Penetration> measure_penetration(const Particles<Real, dim>& particles, double dx, Kernel kernel,
                                             std::span<const Collider<dim>> colliders, double t) {
  std::vector<PosedCollider<dim>> posed;
  for (const Collider<dim>& collider : colliders) posed.emplace_back(collider, t);
  using Parts = std::vector<Penetration>;
  std::vector<Parts> parts((particles.size() + kGrain - 1) / kGrain, Parts(colliders.size()));
  parallel_chunks(particles.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    Parts& part = parts[begin / kGrain];
    for (std::size_t p = begin; p < end; ++p) {
      const Vec<double, dim> x = particles.position(p, dx, kernel);
      for (std::size_t k = 0; k < posed.size(); ++k) {
        const double distance = posed[k].distance(x);
        if (distance < 0) part[k] += {1, -distance};
      }
    }
  });
  Parts sums(colliders.size());
  for (const Parts& part : parts) {
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += part[k];
  }
  return sums;
}

#define FIRN_INSTANTIATE(Real, dim)                                                                             \
  template std::vector<Penetration> measure_penetration<Real, dim>(const Particles<Real, dim>&, double, Kernel, \
                                                                   std::span<const Collider<dim>>, double);
FIRN_INSTANTIATE(float, 2)
FIRN_INSTANTIATE(float, 3)
FIRN_INSTANTIATE(double, 2)
FIRN_INSTANTIATE(double, 3)
#undef FIRN_INSTANTIATE

}  // namespace firn
