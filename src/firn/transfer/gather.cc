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

/// sum w_ip v_i, and for each other weight k and axis d the sum with that weight in place of w on that axis.
template <Kernel kernel, Form form, class Real, int dim>
struct GatherSums {
  Vec<Lanes<Real>, dim> v;
  Vec<Lanes<Real>, dim> against[Against<kernel, form>::kCount][dim];
};

template <int dim, class L>
HWY_INLINE void add_product(L w, const Vec<L, dim>& v, bool begin, Vec<L, dim>& sum) {
  for (int i = 0; i < dim; ++i) sum[i] = begin ? w * v[i] : mul_add(w, v[i], sum[i]);
}

/// Sum factorisation: along a row first, then over rows, then over planes. All lanes at once, wherever their particles
/// lie in the tile: `nodes` is its begin and `first` the place of each particle's first node.
template <Kernel kernel, Form form, class Real, int dim>
HWY_INLINE void gather_nodes(const Real* HWY_RESTRICT nodes, const std::int32_t* HWY_RESTRICT first,
                             const GatherWeights<kernel, form, Real, dim>& weights,
                             GatherSums<kernel, form, Real, dim>& sums) {
  using V = Vec<Lanes<Real>, dim>;
  constexpr int kAgainst = Against<kernel, form>::kCount, kSupport = support(kernel), kLast = dim - 1;
#pragma GCC unroll 4
  for (int a = 0; a < kSupport; ++a) {
    V plane_v, plane_against[kAgainst][dim];  // [k][d] for d > 0
#pragma GCC unroll 4
    for (int b = 0; b < (dim == 3 ? kSupport : 1); ++b) {
      const Real* HWY_RESTRICT row =
          nodes + a * tile_stride<dim>(kernel, 0) + (dim == 3 ? b * tile_stride<dim>(kernel, 1) : 0);
      V row_v, row_against[kAgainst], pair[2];
#pragma GCC unroll 4
      for (int c = 0; c < kSupport; ++c) {
        const bool is_last = c + 1 == kSupport, is_alone = is_last && c % 2 == 0;
        if (c % 2 == 0 && !is_last) load_node_pair<dim>(row + c * kNodeWidth, first, pair);
        const V v = is_alone ? load_nodes<dim>(row + c * kNodeWidth, first) : pair[c % 2];
        add_product(weights.weight[kLast][c], v, c == 0, row_v);
        for (int k = 0; k < kAgainst; ++k) add_product(weights.other[k][kLast][c], v, c == 0, row_against[k]);
      }
      if constexpr (dim == 2) {
        plane_v = row_v;
        for (int k = 0; k < kAgainst; ++k) plane_against[k][1] = row_against[k];
      } else {
        add_product(weights.weight[1][b], row_v, b == 0, plane_v);
        for (int k = 0; k < kAgainst; ++k) {
          add_product(weights.other[k][1][b], row_v, b == 0, plane_against[k][1]);
          add_product(weights.weight[1][b], row_against[k], b == 0, plane_against[k][kLast]);
        }
      }
    }
    add_product(weights.weight[0][a], plane_v, a == 0, sums.v);
    for (int k = 0; k < kAgainst; ++k) {
      add_product(weights.other[k][0][a], plane_v, a == 0, sums.against[k][0]);
      for (int d = 1; d < dim; ++d) {
        add_product(weights.weight[0][a], plane_against[k][d], a == 0, sums.against[k][d]);
      }
    }
  }
}

/// sum w_ip of the FLIP velocity change. Particle by particle: a single sum needs its numbers in lanes only at the end,
/// so rows of neighbouring nodes can be read as they lie.
template <Kernel kernel, Form form, class Real, int dim>
HWY_INLINE Vec<Lanes<Real>, dim> gather_change(const Real* HWY_RESTRICT nodes, const std::int32_t* HWY_RESTRICT first,
                                               const GatherWeights<kernel, form, Real, dim>& weights) {
  using L = Lanes<Real>;
  using G = SummedNodes<Real>;
  using R = NodeRow<kernel, G>;
  constexpr int kSupport = support(kernel), kLast = dim - 1;
  HWY_ALIGN Real weight[kLast][kSupport][L::kCount], last_weight[R::kSlots][L::kCount] = {};
  for (int a = 0; a < kSupport; ++a) {
    for (int d = 0; d < kLast; ++d) store_lanes(weights.weight[d][a], weight[d][a], L::kCount);
    store_lanes(weights.weight[kLast][a], last_weight[1 + a], L::kCount);
  }
  HWY_ALIGN Real change[L::kCount * kNodeWidth];
  HWY_ALIGN std::int32_t place[L::kCount];
  for (std::size_t lane = 0; lane < L::kCount; ++lane) {
    place[lane] = static_cast<std::int32_t>(lane) * kNodeWidth;
    const int shift = first[lane] / kNodeWidth % G::kNodes;
    const Real* HWY_RESTRICT begin = nodes + first[lane] - shift * kNodeWidth;
    // Over rows, then over planes: in short chains of sums, none of which waits for all others.
    const auto add_to = [&](G(&sum)[R::kGroups], bool is_first, Real w, const auto& addend) HWY_ATTR {
      const G weight_of_all = G::broadcast(w);
      for (int g = 0; g < R::kGroups; ++g) {
        sum[g] = is_first ? weight_of_all * addend(g) : mul_add(weight_of_all, addend(g), sum[g]);
      }
    };
    G sum[R::kGroups];
#pragma GCC unroll 4
    for (int a = 0; a < kSupport; ++a) {
      if constexpr (dim == 2) {
        const Real* HWY_RESTRICT row = begin + row_place<dim>(kernel, a);
        add_to(sum, a == 0, weight[0][a][lane], [&](int g) HWY_ATTR { return G::load(row + g * G::kNumbers); });
      } else {
        G plane[R::kGroups];
#pragma GCC unroll 4
        for (int b = 0; b < kSupport; ++b) {
          const Real* HWY_RESTRICT row = begin + row_place<dim>(kernel, a * kSupport + b);
          add_to(plane, b == 0, weight[1][b][lane], [&](int g) HWY_ATTR { return G::load(row + g * G::kNumbers); });
        }
        add_to(sum, a == 0, weight[0][a][lane], [&](int g) HWY_ATTR { return plane[g]; });
      }
    }
    G total;
    for (int g = 0; g < R::kGroups; ++g) {
      const G w = G::spread(last_weight[1 + g * G::kNodes - shift] + lane, L::kCount);
      total = g == 0 ? w * sum[g] : mul_add(w, sum[g], total);
    }
    total.store_sum(change + place[lane]);
  }
  return load_nodes<dim>(change, place);
}

/// Writes C_p, and grad v where it has a column of its own.
template <Kernel kernel, Form form, class Real, int dim>
HWY_INLINE void store_gradients(const ParticleColumns<Real, dim>& particles, std::uint32_t p, std::uint32_t count,
                                Real inv_dx, const GatherSums<kernel, form, Real, dim>& sums) {
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

template <Kernel kernel, Form form, class Real, int dim>
GatherReport gather_block(const ParticleColumns<Real, dim>& particles, std::uint32_t particle_count,
                          const GatherTask<Real, dim>& task, std::vector<Leaver>& leavers) {
  using L = Lanes<Real>;
  static constexpr auto kTileOffsets = tile_offsets<dim>(kernel);
  constexpr std::uint32_t kCount = L::kCount;
  const Real flip = static_cast<Real>(task.settings.flip), inv_dx = static_cast<Real>(1 / task.dx);
  GatherReport report;
  L largest = L(Real(0));
  for (std::uint32_t p = 0; p < particle_count; p += kCount) {
    const std::uint32_t count = particle_count - p < kCount ? particle_count - p : kCount;
    const GatherWeights<kernel, form, Real, dim> weights(particles, p);
    HWY_ALIGN std::int32_t first[kCount];
    for (std::uint32_t lane = 0; lane < kCount; ++lane) {
      // Lanes behind the last particle have some code, of which the tile needs to know nothing.
      first[lane] = kTileOffsets[particles.cell[p + lane] % kTileOffsets.size()];
    }
    GatherSums<kernel, form, Real, dim> sums;
    gather_nodes(task.velocity, first, weights, sums);
    store_gradients(particles, p, count, inv_dx, sums);

    Vec<L, dim> u = sums.v, v = u;
    if (flip > Real(0)) {
      const Vec<L, dim> change = gather_change(task.velocity_change, first, weights);
      for (int i = 0; i < dim; ++i) {
        const L flip_v = load_lanes(particles.velocity[i] + p) + change[i];
        v[i] = mul_add(L(flip), flip_v - u[i], u[i]);
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
