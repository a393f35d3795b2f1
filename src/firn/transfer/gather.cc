#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "firn/transfer/gather.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <firn/core/linear_algebra-inl.h>
#include <firn/transfer/gather.h>
#include <firn/transfer/nodes-inl.h>
#include <firn/transfer/tile.h>
#include <firn/transfer/weights-inl.h>

#include <bit>
#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace firn {
namespace HWY_NAMESPACE {

/// Sums over a particle's nodes: the field itself, and the field against up to two other weights per axis, in place of
/// w_a on that axis: w_a (x_a - x_p) / dx for C_p and dx dw_a/dx for the velocity gradient.
template <Kernel kernel, Form form>
struct Against {
  static constexpr bool kMoment = kernel != Kernel::linear;
  static constexpr bool kGradient = form == Form::gradient;
  static constexpr int kCount = (kMoment ? 1 : 0) + (kGradient ? 1 : 0);
  static constexpr int kGradientIndex = kMoment ? 1 : 0;
};

/// Weights of a batch of particles.
template <Kernel kernel, Form form, class Real, int dim>
struct GatherWeights {
  using L = Lanes<Real>;
  using A = Against<kernel, form>;

  L weight[dim][support(kernel)];
  L other[A::kCount][dim][support(kernel)];

  HWY_INLINE GatherWeights(const ParticleColumns<Real, dim>& particles, std::uint32_t p) {
    for (int d = 0; d < dim; ++d) {
      const AxisWeights<kernel, L> axis(load_lanes(particles.offset[d] + p));
      for (int a = 0; a < support(kernel); ++a) {
        weight[d][a] = axis.w[a];
        if constexpr (A::kMoment) other[0][d][a] = axis.w[a] * axis.distance[a];
        if constexpr (A::kGradient) other[A::kGradientIndex][d][a] = axis.dw[a];
      }
    }
  }
};

template <int dim, class L>
HWY_INLINE void add_product(L w, const Vec<L, dim>& v, bool begin, Vec<L, dim>& sum) {
  for (int i = 0; i < dim; ++i) sum[i] = begin ? w * v[i] : mul_add(w, v[i], sum[i]);
}

/// body(0), body(1), ... body(count - 1), written out or as a loop.
template <bool unrolled, int count, class Body>
HWY_INLINE void repeat(const Body& body) {
  if constexpr (unrolled) {
#pragma GCC unroll 8
    for (int n = 0; n < count; ++n) body(n);
  } else {
#pragma GCC unroll 1
    for (int n = 0; n < count; ++n) body(n);
  }
}

/// Sums over the nodes that lie on the axes from `axis` on: a row, a plane, or all.
template <Kernel kernel, Form form, bool flip, class Real, int dim, int axis>
struct NodeSums {
  static constexpr int kAgainst = Against<kernel, form>::kCount;
  using V = Vec<Lanes<Real>, dim>;
  using Weights = GatherWeights<kernel, form, Real, dim>;

  V v, change, against[kAgainst][dim];  // [k][d] for d >= axis

  /// To be called before the first add().
  HWY_INLINE void clear() {
    for (int i = 0; i < dim; ++i) {
      v[i] = change[i] = Lanes<Real>(Real(0));
      for (int k = 0; k < kAgainst; ++k) {
        for (int d = axis; d < dim; ++d) against[k][d][i] = Lanes<Real>(Real(0));
      }
    }
  }
  /// Adds node a of a row, or begins with it.
  HWY_INLINE void add_node(const Weights& weights, int a, bool begin, const V& node_v, const V& node_change) {
    add_product(weights.weight[axis][a], node_v, begin, v);
    if constexpr (flip) add_product(weights.weight[axis][a], node_change, begin, change);
    for (int k = 0; k < kAgainst; ++k) add_product(weights.other[k][axis][a], node_v, begin, against[k][axis]);
  }
  /// Adds the row of a plane, or the plane, that lies at a.
  HWY_INLINE void add(const Weights& weights, int a, const NodeSums<kernel, form, flip, Real, dim, axis + 1>& part) {
    add_node(weights, a, false, part.v, part.change);
    for (int k = 0; k < kAgainst; ++k) {
      for (int d = axis + 1; d < dim; ++d)
        add_product(weights.weight[axis][a], part.against[k][d], false, against[k][d]);
    }
  }
};

/// Sum factorisation: along a row first, then over rows, then over planes. All lanes at once, wherever their particles
/// lie in the tile: `nodes` is where it, its plane or its row begins, and `first` the place of each particle's first
/// node.
///
/// Only rows are written out, and planes where vectors are short: all 27 nodes would be 11 KB of instructions, which
/// are faster by themselves, but do not stay decoded while stress and scatter take their turns.
template <Kernel kernel, Form form, bool flip, class Real, int dim, int axis = 0>
HWY_INLINE void gather_nodes(const Real* HWY_RESTRICT nodes, const std::int32_t* HWY_RESTRICT first,
                             const GatherWeights<kernel, form, Real, dim>& weights,
                             NodeSums<kernel, form, flip, Real, dim, axis>& sums) {
  using V = Vec<Lanes<Real>, dim>;
  constexpr int kSupport = support(kernel), kStride = tile_stride<dim>(kernel, axis) * (flip ? 2 : 1);
  if constexpr (axis < dim - 1) {
    constexpr bool kUnrolled = axis == dim - 2 && kRegisters < 32;
    sums.clear();
    repeat<kUnrolled, kSupport>([&](int a) HWY_ATTR {
      NodeSums<kernel, form, flip, Real, dim, axis + 1> part;
      gather_nodes<kernel, form, flip, Real, dim, axis + 1>(nodes + a * kStride, first, weights, part);
      sums.add(weights, a, part);
    });
  } else if constexpr (flip) {
    repeat<true, kSupport>([&](int a) HWY_ATTR {
      V layers[2];
      load_layers<dim>(nodes + a * kStride, first, layers);
      sums.add_node(weights, a, a == 0, layers[0], layers[1]);
    });
  } else {
    repeat<true, kSupport / 2>([&](int half) HWY_ATTR {
      V pair[2];
      load_node_pair<dim>(nodes + 2 * half * kStride, first, pair);
      for (int c = 0; c < 2; ++c) sums.add_node(weights, 2 * half + c, half + c == 0, pair[c], pair[c]);
    });
    if constexpr (kSupport % 2 == 1) {
      const V last = load_nodes<dim>(nodes + (kSupport - 1) * kStride, first);
      sums.add_node(weights, kSupport - 1, false, last, last);
    }
  }
}

/// Writes C_p, and grad v where it has a column of its own.
template <Kernel kernel, Form form, bool flip, class Real, int dim>
HWY_INLINE void store_gradients(const ParticleColumns<Real, dim>& particles, std::uint32_t p, std::uint32_t count,
                                Real inv_dx, const NodeSums<kernel, form, flip, Real, dim, 0>& sums) {
  using L = Lanes<Real>;
  using A = Against<kernel, form>;
  const L inverse_D = L(static_cast<Real>(apic_inverse_D(kernel)) * inv_dx);
  for (int j = 0; j < dim; ++j) {
    for (int i = 0; i < dim; ++i) {
      if constexpr (A::kMoment) {
        store_lanes(inverse_D * sums.against[0][j][i], particles.affine[i * dim + j] + p, count);
      }
      if constexpr (A::kGradient) {
        Real* target = A::kMoment ? particles.grad_v[i * dim + j] : particles.affine[i * dim + j];
        store_lanes(L(inv_dx) * sums.against[A::kGradientIndex][j][i], target + p, count);
      }
    }
  }
}

/// Gives particle p, which has moved by `shift` cells, its new cell, or notes that it leaves the block. False if the
/// cell is out of reach.
template <class Real, int dim>
bool change_cell(const ParticleColumns<Real, dim>& particles, std::uint32_t p, const Real (&shift)[dim],
                 const GatherTask<Real, dim>& task, std::vector<Leaver>& leavers) {
  constexpr int kSide = kBlockSide<dim>;
  std::int64_t place[dim];  // in the block
  int code = 0;
  bool stays = true;
  for (int d = dim - 1, rest = particles.cell[p]; d >= 0; --d, rest /= kSide) {
    if (!(std::fabs(shift[d]) <= static_cast<Real>(CellKey<dim>::kCellLimit))) return false;
    place[d] = rest % kSide + static_cast<std::int64_t>(shift[d]);
    stays = stays && place[d] >= 0 && place[d] < kSide;
  }
  if (stays) {
    for (int d = 0; d < dim; ++d) code = code * kSide + static_cast<int>(place[d]);
    particles.cell[p] = static_cast<std::uint8_t>(code);
    return true;
  }
  Index<dim> cell = task.origin;
  for (int d = 0; d < dim; ++d) {
    const auto axis = static_cast<std::size_t>(d);
    cell[axis] += place[d];
    if (const std::int64_t length = task.period[axis]; length > 0) cell[axis] = (cell[axis] % length + length) % length;
  }
  if (!fits_key<dim>(cell)) return false;
  particles.cell[p] = kNoCell;
  leavers.push_back({task.first_place + p, cell_key<dim>(cell)});
  return true;
}

/// x_p += dt u_p for one batch.
template <class Real, int dim>
HWY_INLINE void advect(const ParticleColumns<Real, dim>& particles, std::uint32_t p, std::uint32_t count,
                       const Vec<Lanes<Real>, dim>& u, const GatherTask<Real, dim>& task, GatherReport& report,
                       std::vector<Leaver>& leavers) {
  using L = Lanes<Real>;
  const L cells_per_speed = L(static_cast<Real>(task.dt / task.dx));
  Vec<L, dim> shift;
  auto moved = !first_lanes<Real>(L::kCount);
  for (int d = 0; d < dim; ++d) {
    const L offset = mul_add(cells_per_speed, u[d], load_lanes(particles.offset[d] + p));
    shift[d] = floor(offset);
    // Rounding can make offset - floor(offset) exactly 1, which the weights accept.
    store_lanes(offset - shift[d], particles.offset[d] + p, count);
    moved = moved || !(shift[d] == L(Real(0)));
  }
  moved = moved && first_lanes<Real>(count);
  if (!any(moved)) return;
  HWY_ALIGN Real shifts[dim][L::kCount];
  for (int d = 0; d < dim; ++d) store_lanes(shift[d], shifts[d], L::kCount);
  for (std::uint64_t left = bits_of(moved); left != 0; left &= left - 1) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(left));
    Real cells[dim];
    for (int d = 0; d < dim; ++d) cells[d] = shifts[d][lane];
    if (!change_cell<Real, dim>(particles, p + lane, cells, task, leavers) && report.failed == GatherReport::kNone) {
      report.failed = task.first_place + p + lane;
    }
  }
}

/// Colliders act on v and u.
template <class Real, int dim>
HWY_INLINE void constrain(const ParticleColumns<Real, dim>& particles, std::uint32_t p, std::uint32_t count,
                          const ParticleConstraint<Real, dim>& constraint, Vec<Lanes<Real>, dim>& v,
                          Vec<Lanes<Real>, dim>& u) {
  constexpr std::size_t kCount = Lanes<Real>::kCount;
  HWY_ALIGN Real v_lanes[dim][kCount], u_lanes[dim][kCount];
  Real *v_pointers[dim], *u_pointers[dim];
  for (int i = 0; i < dim; ++i) {
    store_lanes(v[i], v_pointers[i] = v_lanes[i], kCount);
    store_lanes(u[i], u_pointers[i] = u_lanes[i], kCount);
  }
  constraint.apply(particles, p, count, v_pointers, u_pointers);
  for (int i = 0; i < dim; ++i) {
    v[i] = load_lanes(v_lanes[i]);
    u[i] = load_lanes(u_lanes[i]);
  }
}

template <Kernel kernel, Form form, bool flip, class Real, int dim>
GatherReport gather_particles(const ParticleColumns<Real, dim>& particles, std::uint32_t particle_count,
                              const GatherTask<Real, dim>& task, std::vector<Leaver>& leavers) {
  using L = Lanes<Real>;
  static constexpr auto kTileOffsets = tile_offsets<dim>(kernel);
  constexpr std::uint32_t kCount = L::kCount;
  const Real inv_dx = static_cast<Real>(1 / task.dx);
  GatherReport report;
  L largest = L(Real(0));
  for (std::uint32_t p = 0; p < particle_count; p += kCount) {
    const std::uint32_t count = particle_count - p < kCount ? particle_count - p : kCount;
    const GatherWeights<kernel, form, Real, dim> weights(particles, p);
    HWY_ALIGN std::int32_t first[kCount];
    for (std::uint32_t lane = 0; lane < kCount; ++lane) {
      // Lanes behind the last particle have some code, of which the tile needs to know nothing.
      first[lane] = kTileOffsets[particles.cell[p + lane] % kTileOffsets.size()] * (flip ? 2 : 1);
    }
    NodeSums<kernel, form, flip, Real, dim, 0> sums;
    gather_nodes<kernel, form, flip>(task.velocity, first, weights, sums);
    store_gradients(particles, p, count, inv_dx, sums);

    Vec<L, dim> u = sums.v, v = u;
    if constexpr (flip) {
      for (int i = 0; i < dim; ++i) {
        const L flip_v = load_lanes(particles.velocity[i] + p) + sums.change[i];
        v[i] = mul_add(L(static_cast<Real>(task.settings.flip)), flip_v - u[i], u[i]);
      }
    }
    if (task.constraint != nullptr) constrain(particles, p, count, *task.constraint, v, u);
    L speed_squared = v[0] * v[0];
    for (int i = 1; i < dim; ++i) speed_squared = mul_add(v[i], v[i], speed_squared);
    largest = max(select(first_lanes<Real>(count), speed_squared, L(Real(0))), largest);
    for (int i = 0; i < dim; ++i) store_lanes(v[i], particles.velocity[i] + p, count);
    advect<Real, dim>(particles, p, count, u, task, report, leavers);
  }
  report.max_speed = std::sqrt(static_cast<double>(largest_lane(largest)));
  return report;
}

template <Kernel kernel, Form form, class Real, int dim>
GatherReport gather_block(const ParticleColumns<Real, dim>& particles, std::uint32_t count,
                          const GatherTask<Real, dim>& task, std::vector<Leaver>& leavers) {
  return task.settings.flip > 0 ? gather_particles<kernel, form, true>(particles, count, task, leavers)
                                : gather_particles<kernel, form, false>(particles, count, task, leavers);
}

template <class Real, int dim>
GatherBlock<Real, dim> select_gather(Kernel kernel, Form form) {
  if (form == Form::mls) {
    return kernel == Kernel::cubic ? &gather_block<Kernel::cubic, Form::mls, Real, dim>
                                   : &gather_block<Kernel::quadratic, Form::mls, Real, dim>;
  }
  switch (kernel) {
    case Kernel::linear:
      return &gather_block<Kernel::linear, Form::gradient, Real, dim>;
    case Kernel::quadratic:
      return &gather_block<Kernel::quadratic, Form::gradient, Real, dim>;
    case Kernel::cubic:
      break;
  }
  return &gather_block<Kernel::cubic, Form::gradient, Real, dim>;
}

GatherBlock<float, 2> gather_float_2(Kernel kernel, Form form) { return select_gather<float, 2>(kernel, form); }
GatherBlock<float, 3> gather_float_3(Kernel kernel, Form form) { return select_gather<float, 3>(kernel, form); }
GatherBlock<double, 2> gather_double_2(Kernel kernel, Form form) { return select_gather<double, 2>(kernel, form); }
GatherBlock<double, 3> gather_double_3(Kernel kernel, Form form) { return select_gather<double, 3>(kernel, form); }

}  // namespace HWY_NAMESPACE
}  // namespace firn
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <firn/core/simd.h>

namespace firn {

HWY_EXPORT(gather_float_2);
HWY_EXPORT(gather_float_3);
HWY_EXPORT(gather_double_2);
HWY_EXPORT(gather_double_3);

template <>
GatherBlock<float, 2> gather_function<float, 2>(const TransferSettings& s) {
  return FIRN_DISPATCH(gather_float_2)(s.kernel, s.form);
}
template <>
GatherBlock<float, 3> gather_function<float, 3>(const TransferSettings& s) {
  return FIRN_DISPATCH(gather_float_3)(s.kernel, s.form);
}
template <>
GatherBlock<double, 2> gather_function<double, 2>(const TransferSettings& s) {
  return FIRN_DISPATCH(gather_double_2)(s.kernel, s.form);
}
template <>
GatherBlock<double, 3> gather_function<double, 3>(const TransferSettings& s) {
  return FIRN_DISPATCH(gather_double_3)(s.kernel, s.form);
}

}  // namespace firn
#endif  // HWY_ONCE
