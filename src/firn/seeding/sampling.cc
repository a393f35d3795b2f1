#include <firn/core/error.h>
#include <firn/core/log.h>
#include <firn/seeding/poisson_disk.h>
#include <firn/seeding/sampling.h>
#include <fmt/format.h>

#include <cmath>

namespace firn {
namespace {

/// Allowed distance from the count that was asked for.
constexpr double kCountTolerance = 0.02;
/// Samples at the surface cover less of the inside, so that a region gets this many more per radius^(dim - 1) of
/// surface (measured on boxes of 15 to 120 radii).
constexpr double kSurfaceExcess2 = 0.16, kSurfaceExcess3 = 0.1225;

template <int dim>
void check_budget(const Region<dim>& region, double radius, std::int64_t budget, const std::string& name) {
  const double expected = expected_count(region, radius);
  if (expected <= static_cast<double>(budget)) return;
  throw Error(ErrorKind::resources,
              fmt::format("{}: a radius of {:.4g} m would give about {:.4g} samples, more than the allowed {}; use a "
                          "larger radius or fewer particles per cell",
                          name, radius, expected, budget));
}

template <int dim>
void check_size(const Region<dim>& region, double radius, std::size_t count, const std::string& name) {
  const double width = region.bounds().largest_side() / radius;
  if (count == 0) {
    throw Error(
        ErrorKind::usage,
        fmt::format("{}: no sample fits: it is {:.2g} sampling radii wide ({:.3g} m at a radius of {:.3g} m); did "
                    "you mean millimetres? Set its scale, or use a smaller radius or cell size",
                    name, width, region.bounds().largest_side(), radius));
  }
  if (width < 2) {
    log_warning(fmt::format("{}: it is only {:.2g} sampling radii wide and gets {} samples; is its unit right?", name,
                            width, count));
  }
}

/// The radius at which expected_count() is `count`; it falls with the radius, so by bisection.
template <int dim>
double radius_for(const Region<dim>& region, double count) {
  double low = 0, high = 4 * region.bounds().largest_side();
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (expected_count(region, middle) > count ? low : high) = middle;
  }
  return high;
}

template <int dim>
Samples<dim> sample_at_radius(const Region<dim>& region, double radius, const SamplingRequest& request,
                              const std::string& name) {
  check_budget(region, radius, request.budget, name);
  Samples<dim> samples;
  samples.radius = radius;
  samples.positions = sample_poisson_disk(region, radius, request.seed, request.budget);
  return samples;
}

template <int dim>
Samples<dim> sample_to_count(const Region<dim>& region, const SamplingRequest& request, const std::string& name) {
  const auto wanted = static_cast<double>(*request.count);
  const int tries = wanted < 5000 ? 12 : 5;
  double radius = radius_for(region, wanted);
  Samples<dim> best;
  double best_error = std::numeric_limits<double>::infinity();
  for (int i = 0; i < tries && best_error > kCountTolerance * wanted; ++i) {
    Samples<dim> samples = sample_at_radius(region, radius, request, name);
    const auto count = static_cast<double>(samples.positions.size());
    radius *= std::pow(std::max(count, 0.5) / wanted, 1.0 / dim);
    if (std::abs(count - wanted) >= best_error) continue;
    best_error = std::abs(count - wanted);
    best = std::move(samples);
  }
  if (best_error > kCountTolerance * wanted) {
    log_warning(fmt::format("{}: asked for {} samples, got {}", name, *request.count, best.positions.size()));
  }
  return best;
}

}  // namespace

template <int dim>
double expected_count(const Region<dim>& region, double radius) {
  const double excess = dim == 2 ? kSurfaceExcess2 : kSurfaceExcess3;
  return (poisson_density<dim>() * region.volume() / radius + excess * region.surface()) / std::pow(radius, dim - 1);
}

template <int dim>
Samples<dim> sample_region(const Region<dim>& region, const SamplingRequest& request, const std::string& name) {
  if (!request.radius && !request.count) throw Error(ErrorKind::usage, name + ": give a radius or a count of samples");
  if (request.radius && (!(*request.radius > 0) || !std::isfinite(*request.radius))) {
    throw Error(ErrorKind::usage,
                fmt::format("{}: the sampling radius must be positive, got {}", name, *request.radius));
  }
  if (!request.radius && *request.count < 1) {
    throw Error(ErrorKind::usage,
                fmt::format("{}: the count of samples must be at least 1, got {}", name, *request.count));
  }
  if (!request.radius && *request.count > request.budget) {
    throw Error(ErrorKind::resources,
                fmt::format("{}: {} samples are more than the allowed {}", name, *request.count, request.budget));
  }
  Samples<dim> samples = request.radius ? sample_at_radius(region, *request.radius, request, name)
                                        : sample_to_count(region, request, name);
  check_size(region, samples.radius, samples.positions.size(), name);
  samples.volume_per_sample = region.volume() / static_cast<double>(samples.positions.size());
  return samples;
}

Samples<3> sample_mesh(const TriangleMesh& mesh, const SamplingRequest& request, const std::string& name) {
  const MeshRegion region(mesh);
  if (region.inside().has_overlaps()) {
    log_warning(name + ": pieces of the mesh overlap; they are filled once, and the volume is counted, not exact");
  }
  if (region.inside().has_inverted_parts()) {
    log_warning(name + ": a piece of the mesh is inside out and stays empty; flip its normals to fill it");
  }
  return sample_region<3>(region, request, name);
}

Samples<2> sample_polygon(const Polygon& polygon, const SamplingRequest& request, const std::string& name) {
  return sample_region<2>(PolygonRegion(polygon), request, name);
}

template double expected_count<2>(const Region<2>&, double);
template double expected_count<3>(const Region<3>&, double);
template Samples<2> sample_region<2>(const Region<2>&, const SamplingRequest&, const std::string&);
template Samples<3> sample_region<3>(const Region<3>&, const SamplingRequest&, const std::string&);

}  // namespace firn
