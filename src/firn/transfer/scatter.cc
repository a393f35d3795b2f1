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

/// What the second layer of a tile gets: there is none; the same momentum at all nodes, because C_p is left out; or one
/// that changes from node to node.
enum class Before { none, constant, affine };

/// What one batch of particles brings to the grid, computed in lanes and read particle by particle.
template <Kernel kernel, Form form, Before second, class Real, int dim>
struct ScatterBatch {
  using Group = NodeGroup<Real, second == Before::none ? 1 : 2>;

  static constexpr std::size_t kCount = Lanes<Real>::kCount;
  static constexpr int kSupport = support(kernel);
  static constexpr int kRows = power(kSupport, dim - 1);  // rows of nodes run along the last axis
  static constexpr bool kGradient = form == Form::gradient;

  static constexpr int kGroupNodes = Group::kNodes;
  static constexpr int kGroups = NodeRow<kernel, Group>::kGroups;
  static constexpr int kSlots = NodeRow<kernel, Group>::kSlots;

  HWY_ALIGN Real row_weight[kRows][kCount];
  HWY_ALIGN Real row_gradient[kGradient ? dim - 1 : 1][kRows][kCount];  // with the derivative on one of the axes
  HWY_ALIGN Real weight[kSlots][kCount] = {};                           // on the last axis, by slot
  HWY_ALIGN Real dweight[kGradient ? kSlots : 1][kCount] = {};
  HWY_ALIGN Real first_node[kCount * kNodeWidth];  // momentum and mass per weight at the cell's first node
  HWY_ALIGN Real step[dim][kCount * kNodeWidth];   // how that changes from node to node on each axis
  HWY_ALIGN Real before[kCount * kNodeWidth];      // the same of the second layer
  HWY_ALIGN Real before_step[second == Before::affine ? dim : 1][kCount * kNodeWidth];
  HWY_ALIGN Real impulse[dim][kCount * kNodeWidth];  // gradient form: -dt V0 tau / dx, by columns

  // The nodes of a group are all the same in these.
  HWY_INLINE Group first_nodes(std::size_t at) const { return Group::repeat(first_node + at, before + at); }
  HWY_INLINE Group steps(int d, std::size_t at) const {
    return Group::repeat(step[d] + at, second == Before::affine ? before_step[d] + at : nullptr);
  }
  HWY_INLINE Group impulses(int d, std::size_t at) const { return Group::repeat(impulse[d] + at, nullptr); }
};

template <Kernel kernel, Form form, Before second, class Real, int dim>
HWY_INLINE void fill_weights(const ParticleColumns<Real, dim>& particles, std::uint32_t p,
                             ScatterBatch<kernel, form, second, Real, dim>& batch) {
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

template <Kernel kernel, Form form, Before second, class Real, int dim>
HWY_INLINE void fill_batch(const ParticleColumns<Real, dim>& particles, std::uint32_t p, std::uint32_t lanes, Real dx,
                           Real dt, Real affine, ScatterBatch<kernel, form, second, Real, dim>& batch) {
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
  Vec<L, dim> q, q_before;
  Mat<L, dim> A, A_before;
  const L spin = L(affine * dx) * mass;
  const L stiffness = L(-dt * static_cast<Real>(apic_inverse_D(kernel)) / dx) * volume;
  for (int i = 0; i < dim; ++i) {
    L v = load_lanes(particles.velocity[i] + p);
    q_before[i] = mass * v;
    if (particles.acceleration) v = mul_add(L(dt), load_lanes(particles.acceleration[i] + p), v);
    q[i] = mass * v;
    for (int j = 0; j < dim; ++j) {
      A_before(i, j) = second == Before::constant ? L(Real(0)) : spin * load_lanes(particles.affine[i * dim + j] + p);
      A(i, j) = A_before(i, j);
      if constexpr (form == Form::mls) A(i, j) = mul_add(stiffness, tau(i, j), A(i, j));
    }
  }
  for (int d = 0; d < dim; ++d) {
    const L to_first_node = L(-static_cast<Real>(cell_offset(kernel))) - load_lanes(particles.offset[d] + p);
    for (int i = 0; i < dim; ++i) {
      q[i] = mul_add(A(i, d), to_first_node, q[i]);
      if constexpr (second == Before::affine) q_before[i] = mul_add(A_before(i, d), to_first_node, q_before[i]);
    }
  }

  const L zero = L(Real(0));
  store_as_nodes<Real, dim>(q, mass, batch.first_node);
  if constexpr (second != Before::none) store_as_nodes<Real, dim>(q_before, mass, batch.before);
  const L force = L(-dt / dx) * volume;
  const auto column = [](const Mat<L, dim>& M, int d) HWY_ATTR {
    Vec<L, dim> c;
    for (int i = 0; i < dim; ++i) c[i] = M(i, d);
    return c;
  };
  for (int d = 0; d < dim; ++d) {
    store_as_nodes<Real, dim>(column(A, d), zero, batch.step[d]);
    if constexpr (second == Before::affine) store_as_nodes<Real, dim>(column(A_before, d), zero, batch.before_step[d]);
    if constexpr (form == Form::gradient) store_as_nodes<Real, dim>(force * column(tau, d), zero, batch.impulse[d]);
  }
}

/// value + step; what is the same at all nodes stays as it is, where it has vectors of its own.
template <Before second, class Group>
HWY_INLINE Group next_nodes(const Group& value, const Group& step) {
  Group r;
  for (int k = 0; k < Group::kVectors; ++k) {
    const bool stays = second == Before::constant && k * Group::kPerVector >= kNodeWidth;
    r.part[k] = stays ? value.part[k] : hn::Add(value.part[k], step.part[k]);
  }
  return r;
}

/// Adds one particle to its nodes: w_a w_b (w_c (q + a A_x + b A_y + c A_z)), with what does not change from row to row
/// in registers.
template <Kernel kernel, Form form, Before second, class Real, int dim>
HWY_INLINE void scatter_particle(const ScatterBatch<kernel, form, second, Real, dim>& batch, std::size_t lane,
                                 Real* HWY_RESTRICT first, int shift) {
  using Batch = ScatterBatch<kernel, form, second, Real, dim>;
  using G = typename Batch::Group;
  constexpr int kGroups = Batch::kGroups, kLast = dim - 1;
  constexpr bool kGradient = form == Form::gradient;
  const std::size_t at = lane * kNodeWidth;
  const G q = batch.first_nodes(at);
  G step[dim], impulse[dim];
  for (int d = 0; d < dim; ++d) {
    step[d] = batch.steps(d, at);
    if constexpr (kGradient) impulse[d] = batch.impulses(d, at);
  }
  G value[kGroups], to_next[kLast][kGroups], force[kLast][kGroups];
  for (int g = 0; g < kGroups; ++g) {
    const int node = g * Batch::kGroupNodes - shift;
    const G w = G::spread(batch.weight[1 + node] + lane, Batch::kCount);
    value[g] = w * mul_add(G::node_numbers(node), step[kLast], q);
    if constexpr (kGradient) {
      value[g] = mul_add(G::spread(batch.dweight[1 + node] + lane, Batch::kCount), impulse[kLast], value[g]);
    }
    for (int d = 0; d < kLast; ++d) {
      to_next[d][g] = w * step[d];
      if constexpr (kGradient) force[d][g] = w * impulse[d];
    }
  }
  const auto add_row = [&](int row, const G(&row_value)[kGroups]) HWY_ATTR {
    Real* HWY_RESTRICT nodes = first + row_place<dim>(kernel, row) * G::kLayers;
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
        for (int g = 0; g < kGroups; ++g) row_value[g] = next_nodes<second>(row_value[g], to_next[1 % kLast][g]);
      }
    }
    for (int g = 0; g < kGroups; ++g) value[g] = next_nodes<second>(value[g], to_next[0][g]);
  }
}

template <Kernel kernel, Form form, Before second, class Real, int dim>
void scatter_particles(const ParticleColumns<Real, dim>& particles, std::uint32_t count, double dx, double dt,
                       const TransferSettings& settings, Real* tile) {
  using Batch = ScatterBatch<kernel, form, second, Real, dim>;
  static constexpr auto kTileOffsets = tile_offsets<dim>(kernel);
  Batch batch;
  for (std::uint32_t p = 0; p < count; p += Batch::kCount) {
    const std::uint32_t lanes = count - p < Batch::kCount ? count - p : Batch::kCount;
    fill_batch<kernel, form, second, Real, dim>(particles, p, lanes, static_cast<Real>(dx), static_cast<Real>(dt),
                                                static_cast<Real>(settings.affine), batch);
    for (std::uint32_t lane = 0; lane < lanes; ++lane) {
      const std::uint8_t cell = particles.cell[p + lane];
      if (cell == kNoCell) continue;
      const int shift = cell % Batch::kGroupNodes;
      scatter_particle(batch, lane, tile + (kTileOffsets[cell] - shift * kNodeWidth) * Batch::Group::kLayers, shift);
    }
  }
}

template <Kernel kernel, Form form, class Real, int dim>
void scatter_block(const ParticleColumns<Real, dim>& particles, std::uint32_t count, double dx, double dt,
                   const TransferSettings& settings, Real* tile) {
  if (!(settings.flip > 0)) {
    scatter_particles<kernel, form, Before::none, Real, dim>(particles, count, dx, dt, settings, tile);
  } else if (settings.affine == 0) {
    scatter_particles<kernel, form, Before::constant, Real, dim>(particles, count, dx, dt, settings, tile);
  } else {
    scatter_particles<kernel, form, Before::affine, Real, dim>(particles, count, dx, dt, settings, tile);
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
