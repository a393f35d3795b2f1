#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "firn/transfer/scatter.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <firn/core/linear_algebra-inl.h>
#include <firn/transfer/nodes-inl.h>
#include <firn/transfer/scatter.h>
#include <firn/transfer/tile.h>
#include <firn/transfer/weights-inl.h>

HWY_BEFORE_NAMESPACE();
namespace firn {
namespace HWY_NAMESPACE {

/// Position of component (i, j) in the stored stress.
template <int dim>
constexpr int stress_index(int i, int j) {
  if (i == j) return i;
  return dim == 3 ? 2 + i + j : 3;  // xy 3, xz 4, yz 5; xy 3 in 2D
}

/// What one batch of particles brings to the grid, computed in lanes and read particle by particle.
template <Kernel kernel, Form form, bool flip, class Real, int dim>
struct ScatterBatch {
  static constexpr std::size_t kCount = Lanes<Real>::kCount;
  static constexpr int kSupport = support(kernel);
  static constexpr int kRows = power(kSupport, dim - 1);  // rows of nodes run along the last axis
  static constexpr bool kGradient = form == Form::gradient;

  static constexpr int kGroupNodes = NodeGroup<Real>::kNodes;
  static constexpr int kGroups = NodeRow<kernel, NodeGroup<Real>>::kGroups;
  static constexpr int kSlots = NodeRow<kernel, NodeGroup<Real>>::kSlots;

  HWY_ALIGN Real row_weight[kRows][kCount];
  HWY_ALIGN Real row_gradient[kGradient ? dim - 1 : 1][kRows][kCount];  // with the derivative on one of the axes
  HWY_ALIGN Real weight[kSlots][kCount] = {};                           // on the last axis, by slot
  HWY_ALIGN Real dweight[kGradient ? kSlots : 1][kCount] = {};
  HWY_ALIGN Real first_node[kCount * kNodeWidth];    // momentum and mass per weight at the cell's first node
  HWY_ALIGN Real step[dim][kCount * kNodeWidth];     // how that changes from node to node on each axis
  HWY_ALIGN Real before[kCount * kNodeWidth];        // FLIP: momentum before the forces, and mass
  HWY_ALIGN Real impulse[dim][kCount * kNodeWidth];  // gradient form: -dt V0 tau / dx, by columns
};

template <Kernel kernel, Form form, bool flip, class Real, int dim>
HWY_INLINE void fill_weights(const ParticleColumns<Real, dim>& particles, std::uint32_t p,
                             ScatterBatch<kernel, form, flip, Real, dim>& batch) {
  using L = Lanes<Real>;
  using Axis = AxisWeights<kernel, L>;
  constexpr int kSupport = support(kernel);
  const Axis last(load_lanes(particles.offset[dim - 1] + p));
  for (int a = 0; a < kSupport; ++a) {
    store_lanes(last.w[a], batch.weight[1 + a], L::kCount);
    if constexpr (form == Form::gradient) store_lanes(last.dw[a], batch.dweight[1 + a], L::kCount);
  }
  const Axis x(load_lanes(particles.offset[0] + p));
  if constexpr (dim == 2) {
    for (int a = 0; a < kSupport; ++a) {
      store_lanes(x.w[a], batch.row_weight[a], L::kCount);
      if constexpr (form == Form::gradient) store_lanes(x.dw[a], batch.row_gradient[0][a], L::kCount);
    }
  } else {
    const Axis y(load_lanes(particles.offset[1] + p));
    for (int a = 0; a < kSupport; ++a) {
      for (int b = 0; b < kSupport; ++b) {
        const int row = a * kSupport + b;
        store_lanes(x.w[a] * y.w[b], batch.row_weight[row], L::kCount);
        if constexpr (form == Form::gradient) {
          store_lanes(x.dw[a] * y.w[b], batch.row_gradient[0][row], L::kCount);
          store_lanes(x.w[a] * y.dw[b], batch.row_gradient[1][row], L::kCount);
        }
      }
    }
  }
}

/// V_p^0 of the particles p to p + lanes; 0 in the lanes behind, where there may be no number of an origin to look up.
template <class Real, int dim>
HWY_INLINE Lanes<Real> load_rest_volumes(const ParticleColumns<Real, dim>& particles, std::uint32_t p,
                                         std::uint32_t lanes) {
  // One body alone is the usual case.
  if (particles.volume_of_origin.size() == 1) return Lanes<Real>(particles.volume_of_origin[0]);
  HWY_ALIGN Real volume[Lanes<Real>::kCount] = {};
  for (std::uint32_t lane = 0; lane < lanes; ++lane) volume[lane] = particles.rest_volume(p + lane);
  return load_lanes(volume);
}

template <Kernel kernel, Form form, bool flip, class Real, int dim>
HWY_INLINE void fill_batch(const ParticleColumns<Real, dim>& particles, std::uint32_t p, std::uint32_t lanes, Real dx,
                           Real dt, Real affine, ScatterBatch<kernel, form, flip, Real, dim>& batch) {
  using L = Lanes<Real>;
  fill_weights(particles, p, batch);
  const L volume = load_rest_volumes(particles, p, lanes);
  const L mass = L(particles.density) * volume;
  Mat<L, dim> tau;
  for (int i = 0; i < dim; ++i) {
    for (int j = 0; j <= i; ++j) {
      tau(i, j) = load_lanes(particles.stress[stress_index<dim>(i, j)] + p);
      tau(j, i) = tau(i, j);
    }
  }
  // mv(x_i) / w = q + A (x_i - x_p), here per cell instead of per metre.
  Vec<L, dim> q, before;
  Mat<L, dim> A;
  const L spin = L(affine * dx) * mass;
  const L stiffness = L(-dt * static_cast<Real>(apic_inverse_D(kernel)) / dx) * volume;
  for (int i = 0; i < dim; ++i) {
    L v = load_lanes(particles.velocity[i] + p);
    before[i] = mass * v;
    if (particles.acceleration) v = mul_add(L(dt), load_lanes(particles.acceleration[i] + p), v);
    q[i] = mass * v;
    for (int j = 0; j < dim; ++j) {
      A(i, j) = spin * load_lanes(particles.affine[i * dim + j] + p);
      if constexpr (form == Form::mls) A(i, j) = mul_add(stiffness, tau(i, j), A(i, j));
    }
  }
  for (int d = 0; d < dim; ++d) {
    const L to_first_node = L(-static_cast<Real>(cell_offset(kernel))) - load_lanes(particles.offset[d] + p);
    for (int i = 0; i < dim; ++i) q[i] = mul_add(A(i, d), to_first_node, q[i]);
  }

  const L zero = L(Real(0));
  store_as_nodes<Real, dim>(q, mass, batch.first_node);
  if constexpr (flip) store_as_nodes<Real, dim>(before, mass, batch.before);
  const L force = L(-dt / dx) * volume;
  for (int d = 0; d < dim; ++d) {
    Vec<L, dim> column;
    for (int i = 0; i < dim; ++i) column[i] = A(i, d);
    store_as_nodes<Real, dim>(column, zero, batch.step[d]);
    if constexpr (form == Form::gradient) {
      for (int i = 0; i < dim; ++i) column[i] = force * tau(i, d);
      store_as_nodes<Real, dim>(column, zero, batch.impulse[d]);
    }
  }
}

/// Number of each node of a group, from the node that the group begins at.
template <class Real>
HWY_INLINE NodeGroup<Real> node_numbers(int first) {
  HWY_ALIGN static constexpr Real kNumbers[] = {-1, -1, -1, -1, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2,
                                                3,  3,  3,  3,  4, 4, 4, 4, 5, 5, 5, 5, 6, 6, 6, 6};
  NodeGroup<Real> r;
  for (int k = 0; k < NodeGroup<Real>::kVectors; ++k) {
    r.part[k] =
        hn::LoadU(typename NodeGroup<Real>::D(), kNumbers + (first + 1) * kNodeWidth + k * NodeGroup<Real>::kPerVector);
  }
  return r;
}

/// Adds one particle to its nodes: w_a w_b (w_c (q + a A_x + b A_y + c A_z)), with what does not change from row to row
/// in registers.
template <Kernel kernel, Form form, bool flip, class Real, int dim>
HWY_INLINE void scatter_particle(const ScatterBatch<kernel, form, flip, Real, dim>& batch, std::size_t lane,
                                 Real* HWY_RESTRICT first, Real* HWY_RESTRICT first_before, int shift) {
  using G = NodeGroup<Real>;
  using Batch = ScatterBatch<kernel, form, flip, Real, dim>;
  constexpr int kGroups = Batch::kGroups, kLast = dim - 1;
  constexpr bool kGradient = form == Form::gradient;
  const std::size_t at = lane * kNodeWidth;
  const G q = G::repeat(batch.first_node + at);
  G step[dim], impulse[dim];
  for (int d = 0; d < dim; ++d) {
    step[d] = G::repeat(batch.step[d] + at);
    if constexpr (kGradient) impulse[d] = G::repeat(batch.impulse[d] + at);
  }
  G value[kGroups], before[kGroups], to_next[kLast][kGroups], force[kLast][kGroups];
  for (int g = 0; g < kGroups; ++g) {
    const int node = g * Batch::kGroupNodes - shift;
    const G w = G::spread(batch.weight[1 + node] + lane, Batch::kCount);
    value[g] = w * mul_add(node_numbers<Real>(node), step[kLast], q);
    if constexpr (flip) before[g] = w * G::repeat(batch.before + at);
    if constexpr (kGradient) {
      value[g] = mul_add(G::spread(batch.dweight[1 + node] + lane, Batch::kCount), impulse[kLast], value[g]);
    }
    for (int d = 0; d < kLast; ++d) {
      to_next[d][g] = w * step[d];
      if constexpr (kGradient) force[d][g] = w * impulse[d];
    }
  }
  const auto add_row = [&](int row, const G(&row_value)[kGroups]) HWY_ATTR {
    const int place = row_place<dim>(kernel, row);
    Real* HWY_RESTRICT nodes = first + place;
    const G w = G::broadcast(batch.row_weight[row][lane]);
    for (int g = 0; g < kGroups; ++g) {
      const G node = G::load(nodes + g * G::kNumbers);
      if constexpr (kGradient) {
        // Added up before they meet the node: particles of one cell wait for each other's sums.
        G addend = w * row_value[g];
        for (int d = 0; d < kLast; ++d) {
          addend = mul_add(G::broadcast(batch.row_gradient[d][row][lane]), force[d][g], addend);
        }
        (node + addend).store(nodes + g * G::kNumbers);
      } else {
        mul_add(w, row_value[g], node).store(nodes + g * G::kNumbers);
      }
      if constexpr (flip) {
        Real* HWY_RESTRICT nodes_before = first_before + place + g * G::kNumbers;
        mul_add(w, before[g], G::load(nodes_before)).store(nodes_before);
      }
    }
  };
  for (int a = 0; a < Batch::kSupport; ++a) {
    if constexpr (dim == 2) {
      add_row(a, value);
    } else {
      G row_value[kGroups];
      for (int g = 0; g < kGroups; ++g) row_value[g] = value[g];
      for (int b = 0; b < Batch::kSupport; ++b) {
        add_row(a * Batch::kSupport + b, row_value);
        for (int g = 0; g < kGroups; ++g) row_value[g] = row_value[g] + to_next[1 % kLast][g];
      }
    }
    for (int g = 0; g < kGroups; ++g) value[g] = value[g] + to_next[0][g];
  }
}

template <Kernel kernel, Form form, bool flip, class Real, int dim>
void scatter_particles(const ParticleColumns<Real, dim>& particles, std::uint32_t count, double dx, double dt,
                       const TransferSettings& settings, Real* tile, Real* before) {
  using Batch = ScatterBatch<kernel, form, flip, Real, dim>;
  static constexpr auto kTileOffsets = tile_offsets<dim>(kernel);
  Batch batch;
  for (std::uint32_t p = 0; p < count; p += Batch::kCount) {
    const std::uint32_t lanes = count - p < Batch::kCount ? count - p : Batch::kCount;
    fill_batch<kernel, form, flip, Real, dim>(particles, p, lanes, static_cast<Real>(dx), static_cast<Real>(dt),
                                              static_cast<Real>(settings.affine), batch);
    for (std::uint32_t lane = 0; lane < lanes; ++lane) {
      const std::uint8_t cell = particles.cell[p + lane];
      if (cell == kNoCell) continue;
      const int shift = cell % Batch::kGroupNodes;
      const int place = kTileOffsets[cell] - shift * kNodeWidth;
      scatter_particle(batch, lane, tile + place, flip ? before + place : nullptr, shift);
    }
  }
}

template <Kernel kernel, Form form, class Real, int dim>
void scatter_block(const ParticleColumns<Real, dim>& particles, std::uint32_t count, double dx, double dt,
                   const TransferSettings& settings, Real* tile, Real* before) {
  if (before != nullptr && settings.affine == 0) {
    scatter_particles<kernel, form, true, Real, dim>(particles, count, dx, dt, settings, tile, before);
    return;
  }
  scatter_particles<kernel, form, false, Real, dim>(particles, count, dx, dt, settings, tile, nullptr);
  if (before == nullptr) return;
  scatter_particles<kernel, form, false, Real, dim>(particles, count, dx, 0, settings, before, nullptr);
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
