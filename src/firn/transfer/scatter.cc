#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "firn/transfer/scatter.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <firn/core/linear_algebra-inl.h>
#include <firn/transfer/quad-inl.h>
#include <firn/transfer/scatter.h>
#include <firn/transfer/weights-inl.h>

#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace firn {
namespace HWY_NAMESPACE {

/// What one batch of particles brings to the grid, computed in lanes and stored particle by particle.
template <Kernel kernel, class Real, int dim>
struct ScatterBatch {
  static constexpr int kSupport = support(kernel);
  static constexpr std::size_t kCount = Lanes<Real>::kCount;

  HWY_ALIGN Real weight[dim][kSupport][kCount];
  HWY_ALIGN Real dweight[dim][kSupport][kCount];     // gradient form only
  HWY_ALIGN Real first_node[kCount * kNodeWidth];    // momentum and mass per weight at the cell's first node
  HWY_ALIGN Real step[dim][kCount * kNodeWidth];     // how that changes from node to node on each axis
  HWY_ALIGN Real impulse[dim][kCount * kNodeWidth];  // gradient form: -dt V0 tau / dx, by columns
};

template <Kernel kernel, Form form, class Real, int dim>
HWY_INLINE void fill_batch(const ParticleColumns<Real, dim>& particles, std::uint32_t p, Real dx, Real dt, Real affine,
                           ScatterBatch<kernel, Real, dim>& batch) {
  using L = Lanes<Real>;
  const L mass = load_lanes(particles.mass + p);
  const L volume = load_lanes(particles.rest_volume + p);

  Mat<L, dim> tau;
  for (int i = 0; i < dim; ++i) {
    for (int j = 0; j < dim; ++j) tau(i, j) = load_lanes(particles.stress[i][j] + p);
  }
  // mv(x_i) / w = q + A (x_i - x_p), here per cell instead of per metre.
  Vec<L, dim> q;
  Mat<L, dim> A;
  const L spin = L(affine * dx) * mass;
  const L stiffness = L(-dt * static_cast<Real>(apic_inverse_D(kernel)) / dx) * volume;
  for (int i = 0; i < dim; ++i) {
    L v = load_lanes(particles.velocity[i] + p);
    if (particles.acceleration[i] != nullptr) v = mul_add(L(dt), load_lanes(particles.acceleration[i] + p), v);
    q[i] = mass * v;
    for (int j = 0; j < dim; ++j) {
      A(i, j) = spin * load_lanes(particles.affine[i * dim + j] + p);
      if constexpr (form == Form::mls) A(i, j) = mul_add(stiffness, tau(i, j), A(i, j));
    }
  }

  for (int d = 0; d < dim; ++d) {
    const AxisWeights<kernel, L> axis(load_lanes(particles.offset[d] + p));
    for (int a = 0; a < support(kernel); ++a) {
      store_lanes(axis.w[a], batch.weight[d][a], L::kCount);
      if constexpr (form == Form::gradient) store_lanes(axis.dw[a], batch.dweight[d][a], L::kCount);
    }
    for (int i = 0; i < dim; ++i) q[i] = mul_add(A(i, d), axis.distance[0], q[i]);
  }

  const L zero = L(Real(0));
  store_vector_as_quads<Real, dim>(q, mass, batch.first_node);
  const L force = L(-dt / dx) * volume;
  for (int d = 0; d < dim; ++d) {
    Vec<L, dim> column;
    for (int i = 0; i < dim; ++i) column[i] = A(i, d);
    store_vector_as_quads<Real, dim>(column, zero, batch.step[d]);
    if constexpr (form == Form::gradient) {
      for (int i = 0; i < dim; ++i) column[i] = force * tau(i, d);
      store_vector_as_quads<Real, dim>(column, zero, batch.impulse[d]);
    }
  }
}

/// Adds one particle to one row of nodes, which runs along the last axis.
///
/// @param w weight of the row; value what its first node gets per weight; step the change of value from node to node
/// @param impulse_row in the gradient form, what the gradients on the other axes give the row, per weight on this axis
/// @param impulse in the gradient form, -dt V0 tau e_last / dx
template <Kernel kernel, Form form, class Real, int dim>
HWY_INLINE void scatter_row(Real* HWY_RESTRICT row, Real w, Quad<Real> value, const Quad<Real>& step,
                            const Quad<Real>& impulse_row, const Quad<Real>& impulse,
                            const ScatterBatch<kernel, Real, dim>& batch, std::size_t lane) {
  for (int a = 0; a < support(kernel); ++a) {
    const Real w_a = batch.weight[dim - 1][a][lane];
    Quad<Real> node = mul_add(Quad<Real>::broadcast(w * w_a), value, Quad<Real>::load(row + a * kNodeWidth));
    if constexpr (form == Form::gradient) {
      node = mul_add(Quad<Real>::broadcast(w_a), impulse_row, node);
      node = mul_add(Quad<Real>::broadcast(w * batch.dweight[dim - 1][a][lane]), impulse, node);
    }
    node.store(row + a * kNodeWidth);
    value = value + step;
  }
}

template <Kernel kernel, Form form, class Real, int dim>
HWY_INLINE void scatter_particle(const ScatterBatch<kernel, Real, dim>& batch, std::size_t lane,
                                 Real* HWY_RESTRICT first) {
  using Q = Quad<Real>;
  const std::size_t at = lane * kNodeWidth;
  Q step[dim], impulse[dim];
  for (int d = 0; d < dim; ++d) {
    step[d] = Q::load(batch.step[d] + at);
    impulse[d] = form == Form::gradient ? Q::load(batch.impulse[d] + at) : Q::zero();
  }
  Q value = Q::load(batch.first_node + at);
  for (int a = 0; a < support(kernel); ++a) {
    Real* HWY_RESTRICT row = first + a * tile_stride<dim>(kernel, 0);
    const Real w_a = batch.weight[0][a][lane];
    const Real dw_a = form == Form::gradient ? batch.dweight[0][a][lane] : Real(0);
    if constexpr (dim == 2) {
      const Q impulse_row = Q::broadcast(dw_a) * impulse[0];
      scatter_row<kernel, form, Real, dim>(row, w_a, value, step[1], impulse_row, impulse[1], batch, lane);
    } else {
      Q row_value = value;
      for (int b = 0; b < support(kernel); ++b) {
        const Real w_b = batch.weight[1][b][lane];
        Q impulse_row = Q::zero();
        if constexpr (form == Form::gradient) {
          impulse_row =
              mul_add(Q::broadcast(w_a * batch.dweight[1][b][lane]), impulse[1], Q::broadcast(dw_a * w_b) * impulse[0]);
        }
        scatter_row<kernel, form, Real, dim>(row, w_a * w_b, row_value, step[2], impulse_row, impulse[2], batch, lane);
        row += tile_stride<dim>(kernel, 1);
        row_value = row_value + step[1];
      }
    }
    value = value + step[0];
  }
}

template <Kernel kernel, Form form, class Real, int dim>
void scatter_block(const ParticleColumns<Real, dim>& particles, std::uint32_t begin, std::uint32_t end, double dx,
                   double dt, const TransferSettings& settings, Real* tile) {
  static constexpr auto kTileOffsets = tile_offsets<dim>(kernel);
  constexpr std::uint32_t kCount = Lanes<Real>::kCount;
  ScatterBatch<kernel, Real, dim> batch;
  for (std::uint32_t p = begin; p < end; p += kCount) {
    fill_batch<kernel, form, Real, dim>(particles, p, static_cast<Real>(dx), static_cast<Real>(dt),
                                        static_cast<Real>(settings.affine), batch);
    const std::uint32_t count = end - p < kCount ? end - p : kCount;
    for (std::uint32_t lane = 0; lane < count; ++lane) {
      const std::int32_t first = kTileOffsets[particles.cell[p + lane] & CellKey<dim>::kCellMask];
      scatter_particle<kernel, form, Real, dim>(batch, lane, tile + first);
    }
  }
}

template <class Real, int dim>
ScatterBlock<Real, dim> select_scatter(Kernel kernel, Form form) {
  if (form == Form::mls) {
    return kernel == Kernel::cubic ? &scatter_block<Kernel::cubic, Form::mls, Real, dim>
                                   : &scatter_block<Kernel::quadratic, Form::mls, Real, dim>;
  }
  switch (kernel) {
    case Kernel::linear:
      return &scatter_block<Kernel::linear, Form::gradient, Real, dim>;
    case Kernel::quadratic:
      return &scatter_block<Kernel::quadratic, Form::gradient, Real, dim>;
    case Kernel::cubic:
      break;
  }
  return &scatter_block<Kernel::cubic, Form::gradient, Real, dim>;
}

ScatterBlock<float, 2> scatter_float_2(Kernel kernel, Form form) { return select_scatter<float, 2>(kernel, form); }
ScatterBlock<float, 3> scatter_float_3(Kernel kernel, Form form) { return select_scatter<float, 3>(kernel, form); }
ScatterBlock<double, 2> scatter_double_2(Kernel kernel, Form form) { return select_scatter<double, 2>(kernel, form); }
ScatterBlock<double, 3> scatter_double_3(Kernel kernel, Form form) { return select_scatter<double, 3>(kernel, form); }

}  // namespace HWY_NAMESPACE
}  // namespace firn
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <firn/core/simd.h>

namespace firn {

HWY_EXPORT(scatter_float_2);
HWY_EXPORT(scatter_float_3);
HWY_EXPORT(scatter_double_2);
HWY_EXPORT(scatter_double_3);

template <>
ScatterBlock<float, 2> scatter_function<float, 2>(const TransferSettings& s) {
  return FIRN_DISPATCH(scatter_float_2)(s.kernel, s.form);
}
template <>
ScatterBlock<float, 3> scatter_function<float, 3>(const TransferSettings& s) {
  return FIRN_DISPATCH(scatter_float_3)(s.kernel, s.form);
}
template <>
ScatterBlock<double, 2> scatter_function<double, 2>(const TransferSettings& s) {
  return FIRN_DISPATCH(scatter_double_2)(s.kernel, s.form);
}
template <>
ScatterBlock<double, 3> scatter_function<double, 3>(const TransferSettings& s) {
  return FIRN_DISPATCH(scatter_double_3)(s.kernel, s.form);
}

}  // namespace firn
#endif  // HWY_ONCE
