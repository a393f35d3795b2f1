#include <firn/core/error.h>
#include <firn/seeding/poisson_disk.h>
#include <firn/seeding/random.h>
#include <firn/seeding/sample_grid.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace firn {
namespace {

/// Bridson's k. 100 would pack 8 % more, at three times the cost.
constexpr int kCandidates = 30;
/// In radii. No point of a filled region is farther from its nearest sample (measured: 1.16), so farther ones are in a
/// part that the front has not reached.
constexpr double kUnreached = 1.25;
/// Cells of a row that are skipped at once where the region is far.
constexpr std::int32_t kRun = 16;

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
    const typename SampleGrid<dim>::Index count = grid_.count();
    typename SampleGrid<dim>::Index row = {};
    while (true) {
      for (row[0] = 0; row[0] < count[0]; row[0] += kRun) start_in_cells(row, std::min(row[0] + kRun, count[0]));
      int d = 1;
      while (d < dim && ++row[d] == count[d]) row[d++] = 0;
      if (d == dim) return std::move(samples_);
    }
  }

 private:
  /// Lets fronts start in the cells of a row from `first` to before `end`.
  void start_in_cells(const typename SampleGrid<dim>::Index& first, std::int32_t end) {
    typename SampleGrid<dim>::Index i = first;
    i[0] = end - 1;
    if (!region_.may_overlap({grid_.cell_bounds(first).lower, grid_.cell_bounds(i).upper})) return;
    for (i[0] = first[0]; i[0] < end; ++i[0]) start_in_cell(i);
  }

  /// Lets a front start in this cell if no sample is near.
  void start_in_cell(const typename SampleGrid<dim>::Index& i) {
    if (grid_.is_occupied(i)) return;
    const Bounds<dim> cell = grid_.cell_bounds(i);
    if (grid_.find_neighbour(cell.center(), kUnreached * radius_, samples_) >= 0 || !region_.may_overlap(cell)) return;
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
      forget_far_blockers(center);
      bool found = false;
      for (int k = 0; k < kCandidates && !found; ++k) found = accept(center + shell_vector());
      if (!found) active_.pop_back();
    }
  }

  /// Uniform by volume in the shell between one and two radii. By rejection from the cube: sines and cube roots would
  /// make the bits depend on the mathematics library.
  Vec<double, dim> shell_vector() {
    while (true) {
      // Steps of 2 millionths of the radius, so that one draw is enough for all components.
      std::uint64_t bits = random_.bits();
      Vec<double, dim> v;
      for (int d = 0; d < dim; ++d, bits >>= 21) v[d] = (static_cast<double>(bits & 0x1fffff) + 0.5) * 0x1p-19 - 2;
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

  /// Candidates around one sample fall to the same few neighbours, so those that were found before are tried before the
  /// grid is searched, the successful ones first.
  bool is_blocked(const Vec<double, dim>& x) {
    for (std::size_t i = 0; i < blockers_.size(); ++i) {
      const Vec<double, dim> offset = x - blockers_[i];
      if (dot(offset, offset) >= radius_ * radius_) continue;
      std::swap(blockers_[i], blockers_[i / 2]);
      return true;
    }
    return false;
  }

  void forget_far_blockers(const Vec<double, dim>& center) {
    std::erase_if(blockers_, [&](const Vec<double, dim>& blocker) {
      const Vec<double, dim> offset = blocker - center;
      return dot(offset, offset) >= 9 * radius_ * radius_;
    });
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
