#include <firn/core/parallel.h>
#include <firn/measure/particle_state.h>
#include <firn/measure/probe.h>
#include <firn/measure/stress_invariants.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace firn {
namespace {

/// Quadratic B-spline of a distance in cells.
double spline(double s) {
  s = std::abs(s);
  if (s < 0.5) return 0.75 - s * s;
  return s < 1.5 ? 0.5 * (1.5 - s) * (1.5 - s) : 0;
}

constexpr double kReachInCells = 1.5;

/// The material's particles, found by block.
template <class Real, int dim>
class Neighbourhood {
 public:
  Neighbourhood(const Particles<Real, dim>& particles, double dx, Kernel kernel, const Period<dim>& period)
      : particles_(particles), dx_(dx), kernel_(kernel), period_(period) {}

  /// visit(p, weight) for the particles around x, block after block.
  template <class Visit>
  void for_each(const Vec<double, dim>& x, const Visit& visit) const {
    Index<dim> low, high;
    for (int d = 0; d < dim; ++d) {
      const double cell = x[d] / dx_ - cell_offset(kernel_);
      if (!(std::abs(cell) < 1e9)) return;
      low[d] = floor_block(cell - kReachInCells);
      high[d] = floor_block(cell + kReachInCells);
    }
    for (Index<dim> block = low;;) {
      visit_block(block, x, visit);
      int d = dim - 1;
      while (d >= 0 && ++block[static_cast<std::size_t>(d)] > high[static_cast<std::size_t>(d)]) {
        block[static_cast<std::size_t>(d)] = low[static_cast<std::size_t>(d)];
        --d;
      }
      if (d < 0) return;
    }
  }

 private:
  static std::int64_t floor_block(double cell) { return static_cast<std::int64_t>(std::floor(cell / kBlockSide<dim>)); }

  template <class Visit>
  void visit_block(const Index<dim>& block, const Vec<double, dim>& x, const Visit& visit) const {
    Index<dim> cell;
    Vec<double, dim> shift;  // from the block's own place to the one that was asked for, across periodic axes
    for (int d = 0; d < dim; ++d) {
      const auto i = static_cast<std::size_t>(d);
      const std::int64_t wanted = block[i] * kBlockSide<dim>, length = period_[i];
      cell[i] = length > 0 ? ((wanted % length) + length) % length : wanted;
      shift[d] = dx_ * static_cast<double>(wanted - cell[i]);
    }
    if (!fits_key<dim>(cell)) return;
    const std::uint64_t key = block_of_cell<dim>(cell_key<dim>(cell));
    std::size_t b = 0, end = particles_.block_count();
    while (b < end) {
      const std::size_t middle = (b + end) / 2;
      if (particles_.block_key(middle) < key) {
        b = middle + 1;
      } else {
        end = middle;
      }
    }
    if (b == particles_.block_count() || particles_.block_key(b) != key) return;
    for (std::size_t p = particles_.first_of_block(b); p < particles_.first_of_block(b) + particles_.block_size(b);
         ++p) {
      const Vec<double, dim> distance = particles_.position(p, dx_, kernel_) + shift - x;
      double weight = 1;
      for (int d = 0; d < dim; ++d) weight *= spline(distance[d] / dx_);
      if (weight > 0) visit(p, weight);
    }
  }

  const Particles<Real, dim>& particles_;
  double dx_;
  Kernel kernel_;
  Period<dim> period_;
};

}  // namespace

template <class Real, int dim>
void add_to_probes(std::span<const Vec<double, dim>> points, const Particles<Real, dim>& particles, int model,
                   const ModelParameters& parameters, double dx, Kernel kernel, const Period<dim>& period,
                   std::span<ProbeSums> sums) {
  const Neighbourhood<Real, dim> neighbourhood(particles, dx, kernel, period);
  parallel_each(points.size(), [&](std::size_t i) {
    ProbeSums& sum = sums[i];
    ParametersOfOne own(parameters);
    neighbourhood.for_each(points[i], [&](std::size_t p, double weight) {
      const double mass = weight * particles.mass(p);
      sum.mass += mass;
      for (int d = 0; d < dim; ++d) sum.momentum[d] += mass * particles.real(Field::velocity, d)[p];
      const double rest_volume = weight * particles.rest_volume(p);
      const ParticleState<dim> state = particle_state(particles, p, parameters);
      sum.volume += rest_volume * volume_ratio(state, model, own.with(state.varied));
      // V p = V_0 J (tau / J).
      sum.work += rest_volume * pressure(kirchhoff_stress(particles, p));
    });
  });
}

ProbeValue probe_value(const ProbeSums& sums, double dx, int dim) {
  constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
  if (!(sums.mass > 0)) return {0, {{kNothing, kNothing, kNothing}}, kNothing};
  return {sums.mass / std::pow(dx, dim), (1 / sums.mass) * sums.momentum, sums.work / sums.volume};
}

#define FIRN_INSTANTIATE(Real, dim)                                                                           \
  template void add_to_probes<Real, dim>(std::span<const Vec<double, dim>>, const Particles<Real, dim>&, int, \
                                         const ModelParameters&, double, Kernel, const Period<dim>&,          \
                                         std::span<ProbeSums>);
FIRN_INSTANTIATE(float, 2)
FIRN_INSTANTIATE(float, 3)
FIRN_INSTANTIATE(double, 2)
FIRN_INSTANTIATE(double, 3)
#undef FIRN_INSTANTIATE

}  // namespace firn
