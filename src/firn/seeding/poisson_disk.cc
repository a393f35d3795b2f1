#include <firn/core/error.h>
#include <firn/seeding/poisson_disk.h>
#include <firn/seeding/random.h>
#include <firn/seeding/sample_grid.h>
#include <fmt/format.h>

#include <cmath>

namespace firn {
namespace {

/// Bridson's k. 100 would pack 8 % more, at three times the cost.
constexpr int kCandidates = 30;
/// In radii. No point of a filled region is farther from its nearest sample (measured: 1.16), so farther ones are in a
/// part that the front has not reached.
constexpr double kUnreached = 1.25;

template <int dim>
class Sampler {
 public:
  Sampler(const Region<dim>& region, double radius, std::uint64_t seed, std::int64_t budget)
      : region_(region),
        bounds_(region.bounds()),
        radius_(radius),
        budget_(budget),
        random_(seed),
        grid_(bounds_, radius) {}

  std::vector<Vec<double, dim>> run() {
    typename SampleGrid<dim>::Index i = {};
    while (true) {
      start_in_cell(i);
      int d = 0;
      while (d < dim && ++i[d] == grid_.count()[d]) i[d++] = 0;
      if (d == dim) return std::move(samples_);
    }
  }

 private:
  /// Lets a front start in this cell if no sample is near.
  void start_in_cell(const typename SampleGrid<dim>::Index& i) {
    if (grid_.is_occupied(i)) return;
    const Bounds<dim> cell = grid_.cell_bounds(i);
    if (grid_.find_neighbour(cell.center(), kUnreached * radius_, samples_) >= 0 || !region_.may_overlap(cell)) return;
    blockers_.clear();
    for (int k = 0; k < kCandidates; ++k) {
      Vec<double, dim> x;
      for (int d = 0; d < dim; ++d) x[d] = cell.lower[d] + random_.uniform() * (cell.upper[d] - cell.lower[d]);
      if (!accept(x)) continue;
      advance_front();
      return;
    }
  }

  /// Always goes on at the newest sample: its surroundings are in the cache, which a random choice would miss; the
  /// density is the same within 1 %.
  void advance_front() {
    while (!active_.empty()) {
      // A copy, because accept() may move the samples.
      const Vec<double, dim> center = samples_[static_cast<std::size_t>(active_.back())];
      blockers_.clear();
      bool found = false;
      for (int k = 0; k < kCandidates && !found; ++k) found = accept(center + shell_vector());
      if (!found) active_.pop_back();
    }
  }

  /// Uniform by volume in the shell between one and two radii. By rejection from the cube: sines and cube roots would
  /// make the bits depend on the mathematics library.
  Vec<double, dim> shell_vector() {
    while (true) {
      Vec<double, dim> v;
      for (int d = 0; d < dim; ++d) v[d] = 4 * random_.uniform() - 2;
      const double squared = dot(v, v);
      if (squared >= 1 && squared < 4) return radius_ * v;
    }
  }

  bool accept(const Vec<double, dim>& x) {
    for (int d = 0; d < dim; ++d) {
      if (!(x[d] >= bounds_.lower[d] && x[d] <= bounds_.upper[d])) return false;
    }
    // In order of cost: most candidates fall to one of the first tests.
    if (is_blocked(x) || !region_.may_contain(x) || has_neighbour(x) || !region_.contains(x)) return false;
    if (static_cast<std::int64_t>(samples_.size()) >= budget_) {
      throw Error(ErrorKind::resources,
                  fmt::format("seeding: more than the allowed {} samples at radius {:.4g} m; use a "
                              "larger radius or fewer particles per cell",
                              budget_, radius_));
    }
    const auto index = static_cast<std::int32_t>(samples_.size());
    samples_.push_back(x);
    grid_.insert(x, index);
    active_.push_back(index);
    return true;
  }

  /// Candidates around one sample fall to the same few neighbours, so those are tried before the grid is searched.
  bool is_blocked(const Vec<double, dim>& x) const {
    for (const Vec<double, dim>& blocker : blockers_) {
      const Vec<double, dim> offset = x - blocker;
      if (dot(offset, offset) < radius_ * radius_) return true;
    }
    return false;
  }

  bool has_neighbour(const Vec<double, dim>& x) {
    const std::int32_t neighbour = grid_.find_neighbour(x, radius_, samples_);
    if (neighbour < 0) return false;
    blockers_.push_back(samples_[static_cast<std::size_t>(neighbour)]);
    return true;
  }

  const Region<dim>& region_;
  Bounds<dim> bounds_;
  double radius_;
  std::int64_t budget_;
  Random random_;
  SampleGrid<dim> grid_;
  std::vector<Vec<double, dim>> samples_;
  std::vector<std::int32_t> active_;
  std::vector<Vec<double, dim>> blockers_;
};

}  // namespace

template <int dim>
double poisson_radius(double samples_per_cell, double cell_size) {
  const double per_cell = poisson_density<dim>() / samples_per_cell;
  return cell_size * (dim == 2 ? std::sqrt(per_cell) : std::cbrt(per_cell));
}

template <int dim>
std::vector<Vec<double, dim>> sample_poisson_disk(const Region<dim>& region, double radius, std::uint64_t seed,
                                                  std::int64_t budget) {
  return Sampler<dim>(region, radius, seed, budget).run();
}

template double poisson_radius<2>(double, double);
template double poisson_radius<3>(double, double);
template std::vector<Vec2d> sample_poisson_disk<2>(const Region<2>&, double, std::uint64_t, std::int64_t);
template std::vector<Vec3d> sample_poisson_disk<3>(const Region<3>&, double, std::uint64_t, std::int64_t);

}  // namespace firn
