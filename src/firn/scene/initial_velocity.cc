#include <firn/core/error.h>
#include <firn/core/expression.h>
#include <firn/core/parallel.h>
#include <firn/scene/initial_velocity.h>
#include <fmt/format.h>

#include <cmath>
#include <optional>

namespace firn {
namespace {

constexpr std::size_t kGrain = 1 << 10;

/// omega x, the velocity of rigid rotation, as a matrix: 1/s.
template <int dim>
Mat<double, dim> spin_matrix(const Vec3d& omega) {
  if constexpr (dim == 3) return {{0, -omega[2], omega[1], omega[2], 0, -omega[0], -omega[1], omega[0], 0}};
  if constexpr (dim == 2) return {{0, -omega[2], omega[2], 0}};
}

/// One component of a velocity: a constant or a formula.
class Component {
 public:
  explicit Component(const NumberOrFormula& given) : number_(given.number) {
    if (!given.formula.empty()) formula_.emplace(given.formula);
  }

  /// May be infinite or not a number.
  template <int dim>
  double at(const Vec<double, dim>& x) const {
    if (!formula_) return number_;
    double values[4] = {};
    for (int i = 0; i < dim; ++i) values[i] = x[i];
    return formula_->unchecked(values);
  }

  /// Difference along an axis over `width`, 1/s; one-sided at the edge of where the formula has values.
  template <int dim>
  double slope(const Vec<double, dim>& x, int axis, double width) const {
    if (!formula_) return 0;
    Vec<double, dim> low = x, high = x;
    low[axis] -= 0.5 * width;
    high[axis] += 0.5 * width;
    const double middle = at(x), below = at(low), above = at(high);
    if (!std::isfinite(below) && !std::isfinite(above)) return 0;
    if (!std::isfinite(below)) return (above - middle) / (0.5 * width);
    if (!std::isfinite(above)) return (middle - below) / (0.5 * width);
    return (above - below) / width;
  }

  /// Throws what is wrong with the value.
  void check(const Vec3d& x, const std::string& body) const {
    try {
      if (formula_) (*formula_)(x);
    } catch (const Error& error) {
      throw Error(ErrorKind::usage, fmt::format("body \"{}\": velocity: {}", body, error.what()));
    }
  }

 private:
  double number_;
  std::optional<Expression> formula_;
};

}  // namespace

template <class Real, int dim>
void set_initial_velocity(Particles<Real, dim>& particles, std::size_t first, const BodySettings& body,
                          const std::vector<Vec<double, dim>>& positions, double cell_size, bool affine) {
  const Mat<double, dim> spin = spin_matrix<dim>(body.angular_velocity);
  Vec<double, dim> centre = {};
  for (const auto& x : positions) centre += x;
  centre = (1.0 / static_cast<double>(positions.size())) * centre;
  std::vector<Component> components;
  for (const NumberOrFormula& given : body.velocity) components.emplace_back(given);

  parallel_chunks(positions.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec<double, dim> turning = spin * (positions[i] - centre);
      for (int d = 0; d < dim; ++d) {
        const Component& component = components[static_cast<std::size_t>(d)];
        particles.real(Field::velocity, d)[first + i] = static_cast<Real>(component.at(positions[i]) + turning[d]);
        for (int axis = 0; affine && axis < dim; ++axis) {
          particles.real(Field::affine, d * dim + axis)[first + i] =
              static_cast<Real>(spin(d, axis) + component.slope(positions[i], axis, cell_size));
        }
      }
    }
  });
  // One by one, so that the first particle is named whatever the number of threads.
  for (std::size_t i = 0; i < positions.size(); ++i) {
    for (int d = 0; d < dim; ++d) {
      if (std::isfinite(static_cast<double>(particles.real(Field::velocity, d)[first + i]))) continue;
      Vec3d x = {};
      for (int e = 0; e < dim; ++e) x[e] = positions[i][e];
      components[static_cast<std::size_t>(d)].check(x, body.name);
      throw Error(ErrorKind::usage, fmt::format("body \"{}\": velocity is beyond the range of the scene's precision at "
                                                "({:.6g}, {:.6g}, {:.6g}) m",
                                                body.name, x[0], x[1], x[2]));
    }
  }
}

#define FIRN_INSTANTIATE(Real, dim)                                                                      \
  template void set_initial_velocity<Real, dim>(Particles<Real, dim>&, std::size_t, const BodySettings&, \
                                                const std::vector<Vec<double, dim>>&, double, bool);
FIRN_INSTANTIATE(float, 2)
FIRN_INSTANTIATE(float, 3)
FIRN_INSTANTIATE(double, 2)
FIRN_INSTANTIATE(double, 3)
#undef FIRN_INSTANTIATE

}  // namespace firn
