#pragma once

#include <firn/state/grid.h>
#include <firn/state/particle_columns.h>
#include <firn/transfer/transfer_settings.h>

#include <array>
#include <cstddef>
#include <cstdint>

/// P2G and G2P of one particle, node by node and in double precision: for particles that do not see all of their nodes.
/// Equations as in scatter.h and gather.h.
namespace firn {

/// The nodes that a particle touches, the last axis running fastest.
template <int dim>
struct ParticleNodes {
  static constexpr int kMost = power(support(Kernel::cubic), dim);

  int count = 0;
  double w[kMost];                 ///< w_ip
  Vec<double, dim> grad_w[kMost];  ///< 1/m; the gradient form and the linear kernel only
  Vec<double, dim> r[kMost];       ///< x_i - x_p, m
  std::int32_t place[kMost];       ///< number of the node in the tile of the particle's block
};

/// Place on axis d of a particle's node n.
template <int dim>
int node_on_axis(Kernel kernel, int n, int d) {
  // A table, because divisions by a number that the compiler does not know would take longer than all else.
  static constexpr auto kPlaces = [] {
    std::array<std::array<std::array<std::int8_t, dim>, ParticleNodes<dim>::kMost>, 3> places = {};
    for (int k = 0; k < 3; ++k) {
      const int side = support(static_cast<Kernel>(k));
      for (int m = 0; m < power(side, dim); ++m) {
        for (int e = dim - 1, rest = m; e >= 0; --e, rest /= side) {
          places[static_cast<std::size_t>(k)][static_cast<std::size_t>(m)][static_cast<std::size_t>(e)] =
              static_cast<std::int8_t>(rest % side);
        }
      }
    }
    return places;
  }();
  return kPlaces[static_cast<std::size_t>(kernel)][static_cast<std::size_t>(n)][static_cast<std::size_t>(d)];
}

/// Nodes of particle p, which has a cell in its block.
template <class Real, int dim>
void find_nodes(const ParticleColumns<Real, dim>& particles, std::uint32_t p, double dx,
                const TransferSettings& settings, ParticleNodes<dim>& nodes);

/// What a particle brings to each of its nodes.
template <int dim>
class ParticleLoad {
 public:
  /// @param dt length of the step, s
  template <class Real>
  ParticleLoad(const ParticleColumns<Real, dim>& particles, std::uint32_t p, double dx, double dt,
               const TransferSettings& settings);

  double mass(double w) const { return w * mass_; }
  /// Momentum without the step's impulses, kg m/s.
  Vec<double, dim> before(double w, const Vec<double, dim>& r) const { return (w * mass_) * (velocity_ + affine_ * r); }
  /// Impulse of the step's forces, N s.
  Vec<double, dim> impulse(double w, const Vec<double, dim>& grad_w, const Vec<double, dim>& r) const {
    const Vec<double, dim> force = form_ == Form::mls ? w * (stress_ * r) : stress_ * grad_w;
    return (w * mass_) * pushed_ + force;
  }

 private:
  Form form_;
  double mass_;
  Vec<double, dim> velocity_, pushed_ = {};  ///< v_p; dt b_p
  Mat<double, dim> affine_, stress_;         ///< stress times what it is multiplied with
};

/// Sums over a particle's nodes.
template <int dim>
class ParticleSums {
 public:
  void add(double w, const Vec<double, dim>& grad_w, const Vec<double, dim>& r, const Vec<double, dim>& v,
           const Vec<double, dim>& change) {
    velocity_ += w * v;
    change_ += w * change;
    moment_ = moment_ + outer(w * v, r);
    gradient_ = gradient_ + outer(v, grad_w);
  }

  /// sum w_ip v_i
  const Vec<double, dim>& velocity() const { return velocity_; }
  /// v_p^{n+1}, while the columns still hold v_p^n.
  template <class Real>
  Vec<double, dim> new_velocity(const ParticleColumns<Real, dim>& particles, std::uint32_t p, double flip) const;
  /// Writes C_p, and grad v where it has a column of its own.
  template <class Real>
  void store_gradients(const ParticleColumns<Real, dim>& particles, std::uint32_t p, double dx,
                       const TransferSettings& settings) const;

 private:
  Vec<double, dim> velocity_ = {}, change_ = {};
  Mat<double, dim> moment_ = {}, gradient_ = {};
};

}  // namespace firn
