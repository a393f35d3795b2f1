#include <firn/core/parallel.h>
#include <firn/seeding/surface_lines.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace firn {
namespace {

constexpr int kBisections = 40;

template <int dim>
double reach(const Vec<double, dim>& half, const Vec<double, dim>& direction) {
  double sum = 0;
  for (int i = 0; i < dim; ++i) sum += std::abs(direction[i]) * half[i];
  return sum;
}

/// Even pieces of a length, of at most this size.
std::size_t pieces(double length, double size) {
  return static_cast<std::size_t>(std::max(1.0, std::ceil(length / size * (1 - 1e-9))));
}

}  // namespace

std::vector<Vec2d> directions_across(const Vec2d& direction) {
  const Vec2d d = (1 / norm(direction)) * direction;
  return {{{-d[1], d[0]}}};
}

std::vector<Vec3d> directions_across(const Vec3d& direction) {
  const Vec3d d = (1 / norm(direction)) * direction;
  int least = 0;
  for (int i = 1; i < 3; ++i) least = std::abs(d[i]) < std::abs(d[least]) ? i : least;
  Vec3d helper = {};
  helper[least] = 1;
  const Vec3d first = normalized(cross(d, helper));
  return {first, cross(d, first)};
}

template <int dim>
std::vector<SurfaceSample<dim>> surface_along(const Region<dim>& body, const Region<dim>& part,
                                              const Vec<double, dim>& direction, double spacing) {
  Bounds<dim> box = body.bounds();
  const Bounds<dim> other = part.bounds();
  for (int i = 0; i < dim; ++i) {
    box.lower[i] = std::max(box.lower[i], other.lower[i]);
    box.upper[i] = std::min(box.upper[i], other.upper[i]);
    if (!(box.lower[i] <= box.upper[i])) return {};
  }
  const Vec<double, dim> half = 0.5 * box.size();
  const auto across = directions_across(direction);
  std::vector<std::size_t> counts;
  std::size_t lines = 1;
  double area = 1;
  for (const auto& side : across) {
    const double width = 2 * reach<dim>(half, side);
    counts.push_back(pieces(width, spacing));
    lines *= counts.back();
    area *= width / static_cast<double>(counts.back());
  }
  // A step more at both ends, so that a surface on the border is crossed.
  const double depth = reach<dim>(half, direction) + 2 * spacing;
  const std::size_t steps = pieces(2 * depth, 2 * spacing);
  const double step = 2 * depth / static_cast<double>(steps);

  std::vector<std::vector<SurfaceSample<dim>>> found(lines);
  parallel_each(lines, [&](std::size_t line) {
    Vec<double, dim> middle = box.center();
    std::size_t rest = line;
    for (std::size_t s = 0; s < across.size(); ++s) {
      const double share = (static_cast<double>(rest % counts[s]) + 0.5) / static_cast<double>(counts[s]);
      middle += ((2 * share - 1) * reach<dim>(half, across[s])) * across[s];
      rest /= counts[s];
    }
    const auto at = [&](double s) { return middle + s * direction; };
    bool inside = body.contains(at(-depth));
    for (std::size_t k = 1; k <= steps; ++k) {
      const double end = -depth + static_cast<double>(k) * step;
      const bool was_inside = inside;
      inside = body.contains(at(end));
      if (!was_inside || inside) continue;
      double in = end - step, out = end;
      for (int i = 0; i < kBisections; ++i) {
        const double half_way = 0.5 * (in + out);
        (body.contains(at(half_way)) ? in : out) = half_way;
      }
      if (part.contains(at(in))) found[line].push_back({at(in), area});
    }
  });
  std::vector<SurfaceSample<dim>> samples;
  for (const auto& of_line : found) samples.insert(samples.end(), of_line.begin(), of_line.end());
  return samples;
}

template std::vector<SurfaceSample<2>> surface_along<2>(const Region<2>&, const Region<2>&, const Vec2d&, double);
template std::vector<SurfaceSample<3>> surface_along<3>(const Region<3>&, const Region<3>&, const Vec3d&, double);

}  // namespace firn
