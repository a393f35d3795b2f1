#include <firn/core/error.h>
#include <firn/seeding/emission.h>
#include <firn/seeding/surface_lines.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

namespace firn {
namespace {

/// Candidates that measure the section.
constexpr std::int64_t kMeasured = 1 << 15;
/// Draws after which a section is taken for empty.
constexpr std::int64_t kMostTries = 1 << 22;

/// Steps of the Kronecker sequence along each direction of the section: powers of 1/g, with g the root > 1 of
/// g^dim = g + 1.
template <int dim>
constexpr double kronecker_step(int direction) {
  constexpr double g = dim == 2 ? 1.618033988749894848 : 1.324717957244746026;
  return direction == 0 ? 1 / g : 1 / (g * g);
}

}  // namespace

template <int dim>
SectionStream<dim>::SectionStream(std::shared_ptr<const Region<dim>> region, const Vec<double, dim>& velocity,
                                  double rate, const std::string& name)
    : region_(std::move(region)), velocity_(velocity), rate_(rate) {
  const Bounds<dim> bounds = region_->bounds();
  centre_ = bounds.center();
  const Vec<double, dim> half = 0.5 * bounds.size();
  double rectangle = 1;
  for (const Vec<double, dim>& direction : directions_across(velocity)) {
    double reach = 0;
    for (int i = 0; i < dim; ++i) reach += std::abs(direction[i]) * half[i];
    across_.push_back(reach * direction);
    rectangle *= 2 * reach;
  }
  std::int64_t inside = 0;
  for (std::int64_t j = 0; j < kMeasured; ++j) inside += region_->contains(candidate(j)) ? 1 : 0;
  if (inside == 0) {
    throw Error(ErrorKind::usage,
                fmt::format("{}: its section across the velocity, through the middle of its bounds, is empty; turn the "
                            "velocity or use another shape",
                            name));
  }
  area_ = rectangle * static_cast<double>(inside) / kMeasured;
}

template <int dim>
Vec<double, dim> SectionStream<dim>::candidate(std::int64_t j) const {
  Vec<double, dim> x = centre_;
  for (std::size_t i = 0; i < across_.size(); ++i) {
    const double turns = 0.5 + static_cast<double>(j) * kronecker_step<dim>(static_cast<int>(i));
    x += (2 * (turns - std::floor(turns)) - 1) * across_[i];
  }
  return x;
}

template <int dim>
Vec<double, dim> SectionStream<dim>::place(std::int64_t k) {
  if (k < count_) count_ = candidate_ = 0;
  for (std::int64_t last = candidate_ + kMostTries; candidate_ < last;) {
    const Vec<double, dim> x = candidate(candidate_++);
    if (!region_->contains(x)) continue;
    if (count_++ == k) return x;
    last = candidate_ + kMostTries;
  }
  throw Error(ErrorKind::usage, "emitter: no place for a particle in its section; use another shape");
}

template <int dim>
std::int64_t SectionStream<dim>::count_at(double time) const {
  return time > 0 ? static_cast<std::int64_t>(std::floor(time * rate_ + 0.5)) : 0;
}

template <int dim>
std::vector<Emitted<dim>> SectionStream<dim>::between(std::int64_t from, std::int64_t to, double time,
                                                      const Vec<double, dim>& gravity, const PoseAt<dim>& frame) {
  std::vector<Emitted<dim>> emitted;
  for (std::int64_t k = from; k < to; ++k) {
    const double began = (static_cast<double>(k) + 0.5) / rate_, age = time - began;
    Vec<double, dim> x = place(k), v = velocity_;
    if (frame) {
      const Pose<dim> pose = frame(began);
      x = to_world<dim>(pose, x);
      v = pose.rotation * v + pose.velocity_at(x);
    }
    emitted.push_back({x + age * v + (0.5 * age * age) * gravity, v + age * gravity});
  }
  return emitted;
}

template <int dim>
double lattice_spacing(double volume) {
  return dim == 2 ? std::sqrt(volume) : std::cbrt(volume);
}

template <int dim>
std::vector<Vec<double, dim>> moving_lattice(const Region<dim>& region, double spacing,
                                             const Vec<double, dim>& velocity, double time) {
  const Bounds<dim> bounds = region.bounds();
  const Vec<double, dim> origin = bounds.center() + time * velocity;
  Vec<std::int64_t, dim> first, last;
  for (int d = 0; d < dim; ++d) {
    first[d] = static_cast<std::int64_t>(std::ceil((bounds.lower[d] - origin[d]) / spacing - 0.5));
    last[d] = static_cast<std::int64_t>(std::floor((bounds.upper[d] - origin[d]) / spacing - 0.5));
    if (last[d] < first[d]) return {};
  }
  std::vector<Vec<double, dim>> points;
  for (Vec<std::int64_t, dim> i = first;;) {
    Vec<double, dim> x;
    for (int d = 0; d < dim; ++d) x[d] = origin[d] + (static_cast<double>(i[d]) + 0.5) * spacing;
    if (region.contains(x)) points.push_back(x);
    int d = dim - 1;
    while (d >= 0 && ++i[d] > last[d]) {
      i[d] = first[d];
      --d;
    }
    if (d < 0) return points;
  }
}

template <int dim>
std::vector<Vec<double, dim>> with_room(std::span<const Vec<double, dim>> points,
                                        std::span<const Vec<double, dim>> occupied, double distance) {
  using Cell = std::array<std::int64_t, dim>;
  const auto cell_of = [&](const Vec<double, dim>& x) {
    Cell cell;
    for (int d = 0; d < dim; ++d) cell[static_cast<std::size_t>(d)] = std::llround(std::floor(x[d] / distance));
    return cell;
  };
  std::vector<std::pair<Cell, std::size_t>> places;
  for (std::size_t i = 0; i < occupied.size(); ++i) places.emplace_back(cell_of(occupied[i]), i);
  std::sort(places.begin(), places.end());
  const auto is_free = [&](const Vec<double, dim>& x) {
    const Cell own = cell_of(x);
    for (int n = 0; n < (dim == 2 ? 3 : 9); ++n) {
      // Cells that differ in the last axis only are neighbours in the list.
      Cell low = own;
      low[0] += n % 3 - 1;
      if (dim == 3) low[1] += n / 3 - 1;
      low[dim - 1] -= 1;
      Cell high = low;
      high[dim - 1] += 2;
      auto place = std::lower_bound(places.begin(), places.end(), std::pair(low, std::size_t(0)));
      for (; place != places.end() && place->first <= high; ++place) {
        if (norm(occupied[place->second] - x) < distance) return false;
      }
    }
    return true;
  };
  std::vector<Vec<double, dim>> free;
  std::copy_if(points.begin(), points.end(), std::back_inserter(free), is_free);
  return free;
}

#define FIRN_INSTANTIATE(dim)                                                                                     \
  template class SectionStream<dim>;                                                                              \
  template double lattice_spacing<dim>(double);                                                                   \
  template std::vector<Vec<double, dim>> moving_lattice<dim>(const Region<dim>&, double, const Vec<double, dim>&, \
                                                             double);                                             \
  template std::vector<Vec<double, dim>> with_room<dim>(std::span<const Vec<double, dim>>,                        \
                                                        std::span<const Vec<double, dim>>, double);
FIRN_INSTANTIATE(2)
FIRN_INSTANTIATE(3)
#undef FIRN_INSTANTIATE

}  // namespace firn
