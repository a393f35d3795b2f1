#include <firn/core/error.h>
#include <firn/seeding/random.h>
#include <firn/seeding/sampling.h>
#include <fmt/format.h>

#include <cmath>

namespace firn {
namespace {

template <int dim>
Vec<double, dim> jittered(const Vec<double, dim>& x, double reach, Random& random) {
  Vec<double, dim> moved = x;
  for (int d = 0; d < dim; ++d) moved[d] += reach * (2 * random.uniform() - 1);
  return moved;
}

}  // namespace

template <int dim>
Samples<dim> sample_lattice(const Region<dim>& region, double cell_size, int per_axis, const std::string& name,
                            double jitter, std::uint64_t seed) {
  if (!(cell_size > 0) || per_axis < 1) {
    throw Error(ErrorKind::usage,
                fmt::format("{}: a lattice needs a positive cell size and at least 1 sample per axis, "
                            "got {} m and {}",
                            name, cell_size, per_axis));
  }
  if (!(jitter >= 0 && jitter <= 1)) {
    throw Error(ErrorKind::usage, fmt::format("{}: jitter must be in [0, 1], got {}", name, jitter));
  }
  const double spacing = cell_size / per_axis;
  const Bounds<dim> bounds = region.bounds();
  Vec<std::int64_t, dim> first, last;
  double candidates = 1;
  for (int d = 0; d < dim; ++d) {
    first[d] = static_cast<std::int64_t>(std::floor(bounds.lower[d] / spacing));
    last[d] = static_cast<std::int64_t>(std::ceil(bounds.upper[d] / spacing));
    candidates *= static_cast<double>(last[d] - first[d] + 1);
  }
  if (candidates > 64.0 * std::numeric_limits<std::int32_t>::max()) {
    throw Error(ErrorKind::resources,
                fmt::format("{}: a lattice of {:.3g} points is too large; use larger cells", name, candidates));
  }
  Random random(seed);
  Samples<dim> samples;
  samples.radius = (1 - jitter) * spacing;
  for (Vec<std::int64_t, dim> i = first;;) {
    Vec<double, dim> x;
    for (int d = 0; d < dim; ++d) x[d] = (static_cast<double>(i[d]) + 0.5) * spacing;
    if (region.contains(x)) {
      const Vec<double, dim> moved = jittered(x, 0.5 * jitter * spacing, random);
      samples.positions.push_back(region.contains(moved) ? moved : x);
    }
    int d = 0;
    while (d < dim && ++i[d] > last[d]) {
      i[d] = first[d];
      ++d;
    }
    if (d == dim) break;
  }
  if (samples.positions.empty()) {
    throw Error(ErrorKind::usage,
                fmt::format("{}: no lattice point lies inside: it is {:.2g} m wide, the lattice has a "
                            "spacing of {:.2g} m; use smaller cells",
                            name, bounds.largest_side(), spacing));
  }
  samples.volume_per_sample = region.volume() / static_cast<double>(samples.positions.size());
  return samples;
}

template Samples<2> sample_lattice<2>(const Region<2>&, double, int, const std::string&, double, std::uint64_t);
template Samples<3> sample_lattice<3>(const Region<3>&, double, int, const std::string&, double, std::uint64_t);

}  // namespace firn
