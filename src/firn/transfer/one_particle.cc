#include <firn/transfer/one_particle.h>
#include <firn/transfer/tile.h>
#include <firn/transfer/weights-inl.h>

namespace firn {
namespace {

/// Weights on one axis.
struct Axis {
  double w[4], dw[4], distance[4];
};

template <Kernel kernel>
Axis axis_of(double offset) {
  const HWY_NAMESPACE::AxisWeights<kernel, double> weights(offset);
  Axis axis = {};
  for (int a = 0; a < support(kernel); ++a) {
    axis.w[a] = weights.w[a];
    axis.dw[a] = weights.dw[a];
    axis.distance[a] = weights.distance[a];
  }
  return axis;
}

Axis axis_of(Kernel kernel, double offset) {
  if (kernel == Kernel::linear) return axis_of<Kernel::linear>(offset);
  return kernel == Kernel::quadratic ? axis_of<Kernel::quadratic>(offset) : axis_of<Kernel::cubic>(offset);
}

/// Place of component (i, j) in the stored stress.
template <int dim>
int stress_place(int i, int j) {
  if (i == j) return i;
  return dim == 3 ? 2 + i + j : 3;
}

}  // namespace

template <class Real, int dim>
void find_nodes(const ParticleColumns<Real, dim>& particles, std::uint32_t p, double dx,
                const TransferSettings& settings, ParticleNodes<dim>& nodes) {
  const Kernel kernel = settings.kernel;
  const double inv_dx = 1 / dx;
  Axis axes[dim];
  std::int32_t first = 0;
  for (int d = dim - 1, rest = particles.cell[p]; d >= 0; --d, rest /= kBlockSide<dim>) {
    axes[d] = axis_of(kernel, static_cast<double>(particles.offset[d][p]));
    first += rest % kBlockSide<dim> * tile_stride<dim>(kernel, d) / kNodeWidth;
  }
  for (int d = 0; d < dim; ++d) {
    for (double& distance : axes[d].distance) distance *= dx;
  }
  nodes.count = power(support(kernel), dim);
  for (int n = 0; n < nodes.count; ++n) {
    nodes.w[n] = 1;
    nodes.place[n] = first + node_place<dim>(kernel, n);
    for (int d = 0; d < dim; ++d) {
      const int a = node_on_axis<dim>(kernel, n, d);
      nodes.w[n] *= axes[d].w[a];
      nodes.r[n][d] = axes[d].distance[a];
    }
  }
  nodes.has_gradients = settings.form == Form::gradient || kernel == Kernel::linear;
  if (!nodes.has_gradients) return;
  for (int n = 0; n < nodes.count; ++n) {
    nodes.grad_w[n] = constant_vector<double, dim>(inv_dx);
    for (int d = 0; d < dim; ++d) {
      const int a = node_on_axis<dim>(kernel, n, d);
      for (int e = 0; e < dim; ++e) nodes.grad_w[n][e] *= e == d ? axes[d].dw[a] : axes[d].w[a];
    }
  }
}

template <int dim>
template <class Real>
ParticleLoad<dim>::ParticleLoad(const ParticleColumns<Real, dim>& particles, std::uint32_t p, double dx, double dt,
                                const TransferSettings& settings)
    : form_(settings.form), mass_(static_cast<double>(particles.mass(p))) {
  const double inverse_D = apic_inverse_D(settings.kernel) / (dx * dx);
  const double scale = -dt * static_cast<double>(particles.rest_volume(p)) * (form_ == Form::mls ? inverse_D : 1);
  for (int i = 0; i < dim; ++i) {
    velocity_[i] = static_cast<double>(particles.velocity[i][p]);
    if (particles.acceleration) pushed_[i] = dt * static_cast<double>(particles.acceleration[i][p]);
    for (int j = 0; j < dim; ++j) {
      affine_(i, j) = settings.affine * static_cast<double>(particles.affine[i * dim + j][p]);
      stress_(i, j) = scale * static_cast<double>(particles.stress[stress_place<dim>(i, j)][p]);
    }
  }
}

template <int dim>
template <class Real>
Vec<double, dim> ParticleSums<dim>::new_velocity(const ParticleColumns<Real, dim>& particles, std::uint32_t p,
                                                 double flip) const {
  if (flip == 0) return velocity_;
  Vec<double, dim> v;
  for (int i = 0; i < dim; ++i) {
    const double own = static_cast<double>(particles.velocity[i][p]) + change_[i];
    v[i] = (1 - flip) * velocity_[i] + flip * own;
  }
  return v;
}

template <int dim>
template <class Real>
void ParticleSums<dim>::store_gradients(const ParticleColumns<Real, dim>& particles, std::uint32_t p, double dx,
                                        const TransferSettings& settings) const {
  const double inverse_D = apic_inverse_D(settings.kernel) / (dx * dx);
  const bool is_gradient = settings.kernel == Kernel::linear;
  for (int e = 0; e < dim * dim; ++e) {
    particles.affine[e][p] = static_cast<Real>(is_gradient ? gradient_.e[e] : inverse_D * moment_.e[e]);
    if (particles.grad_v) particles.grad_v[e][p] = static_cast<Real>(gradient_.e[e]);
  }
}

#define FIRN_INSTANTIATE(Real, dim)                                                                                   \
  template void find_nodes<Real, dim>(const ParticleColumns<Real, dim>&, std::uint32_t, double,                       \
                                      const TransferSettings&, ParticleNodes<dim>&);                                  \
  template ParticleLoad<dim>::ParticleLoad(const ParticleColumns<Real, dim>&, std::uint32_t, double, double,          \
                                           const TransferSettings&);                                                  \
  template Vec<double, dim> ParticleSums<dim>::new_velocity(const ParticleColumns<Real, dim>&, std::uint32_t, double) \
      const;                                                                                                          \
  template void ParticleSums<dim>::store_gradients(const ParticleColumns<Real, dim>&, std::uint32_t, double,          \
                                                   const TransferSettings&) const;
FIRN_INSTANTIATE(float, 2)
FIRN_INSTANTIATE(float, 3)
FIRN_INSTANTIATE(double, 2)
FIRN_INSTANTIATE(double, 3)
#undef FIRN_INSTANTIATE

}  // namespace firn
