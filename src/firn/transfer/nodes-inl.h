// Node values in SIMD vectors: neighbouring nodes of one row for scatter, the nodes of many particles for gather.

#if defined(FIRN_TRANSFER_NODES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FIRN_TRANSFER_NODES_INL_H_
#undef FIRN_TRANSFER_NODES_INL_H_
#else
#define FIRN_TRANSFER_NODES_INL_H_
#endif

#include <firn/core/linear_algebra-inl.h>
#include <firn/state/grid.h>
#include <firn/transfer/tile.h>

#include <array>
#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace firn {
namespace HWY_NAMESPACE {

/// The numbers of kNodes neighbouring nodes in a tile of one or two layers: two nodes where a vector holds two,
/// otherwise one.
template <class Real, int layers>
struct NodeGroup {
  static constexpr int kLayers = layers, kWidth = layers * kNodeWidth;
  static constexpr int kNodes = static_cast<int>(HWY_LANES(Real)) >= 2 * kWidth ? 2 : 1;
  static constexpr int kNumbers = kNodes * kWidth;
  using D = hn::CappedTag<Real, kNumbers>;
  static constexpr int kPerVector = static_cast<int>(HWY_LANES(Real)) < kNumbers ? HWY_LANES(Real) : kNumbers;
  static constexpr int kVectors = kNumbers / kPerVector;

  hn::Vec<D> part[kVectors];

  static HWY_INLINE NodeGroup broadcast(Real value) {
    NodeGroup r;
    for (int k = 0; k < kVectors; ++k) r.part[k] = hn::Set(D(), value);
    return r;
  }
  /// Node n is `values[n * stride]` in all of its numbers.
  static HWY_INLINE NodeGroup spread(const Real* HWY_RESTRICT values, std::size_t stride) {
    if constexpr (kNodes == 1) {
      return broadcast(values[0]);
    } else {
      const hn::Half<D> half;
      return {hn::Combine(D(), hn::Set(half, values[stride]), hn::Set(half, values[0]))};
    }
  }
  /// Every node is the one at `from`, and the one at `second` in its second layer: zero where that is null.
  static HWY_INLINE NodeGroup repeat(const Real* HWY_RESTRICT from, const Real* HWY_RESTRICT second) {
    NodeGroup r;
    if constexpr (kVectors > 1) {
      for (int k = 0; k < kVectors; ++k) {
        const int at = k * kPerVector % kNodeWidth;
        const bool is_first = k * kPerVector < kNodeWidth;
        r.part[k] = is_first            ? hn::Load(D(), from + at)
                    : second == nullptr ? hn::Zero(D())
                                        : hn::Load(D(), second + at);
      }
    } else if constexpr (kNumbers == kNodeWidth) {
      r.part[0] = hn::Load(D(), from);
    } else {
      const hn::CappedTag<Real, kWidth> whole;
      auto node = repeat_layers(whole, from, second);
      if constexpr (kNodes == 1) {
        r.part[0] = node;
      } else {
        r.part[0] = hn::Combine(D(), node, node);
      }
    }
    return r;
  }
  /// Node n is first + n in all of its numbers.
  static HWY_INLINE NodeGroup node_numbers(int first) {
    static constexpr auto kTable = [] {
      std::array<Real, kTableSize> table = {};
      for (std::size_t k = 0; k < table.size(); ++k) table[k] = static_cast<Real>(static_cast<int>(k / kWidth) - 1);
      return table;
    }();
    NodeGroup r;
    for (int k = 0; k < kVectors; ++k) {
      r.part[k] = hn::LoadU(D(), kTable.data() + (first + 1) * kWidth + k * kPerVector);
    }
    return r;
  }
  static HWY_INLINE NodeGroup load(const Real* HWY_RESTRICT from) {
    NodeGroup r;
    for (int k = 0; k < kVectors; ++k) r.part[k] = hn::Load(D(), from + k * kPerVector);
    return r;
  }
  HWY_INLINE void store(Real* HWY_RESTRICT to) const {
    for (int k = 0; k < kVectors; ++k) hn::Store(part[k], D(), to + k * kPerVector);
  }

  friend HWY_INLINE NodeGroup operator+(const NodeGroup& a, const NodeGroup& b) {
    NodeGroup r;
    for (int k = 0; k < kVectors; ++k) r.part[k] = hn::Add(a.part[k], b.part[k]);
    return r;
  }
  friend HWY_INLINE NodeGroup operator*(const NodeGroup& a, const NodeGroup& b) {
    NodeGroup r;
    for (int k = 0; k < kVectors; ++k) r.part[k] = hn::Mul(a.part[k], b.part[k]);
    return r;
  }
  /// a b + c.
  friend HWY_INLINE NodeGroup mul_add(const NodeGroup& a, const NodeGroup& b, const NodeGroup& c) {
    NodeGroup r;
    for (int k = 0; k < kVectors; ++k) r.part[k] = hn::MulAdd(a.part[k], b.part[k], c.part[k]);
    return r;
  }

 private:
  static constexpr int kLargestNumber = 6;  // of the last node of a cubic kernel's last group
  static constexpr std::size_t kTableSize = (kLargestNumber + 2) * kWidth;

  template <class E>
  static HWY_INLINE hn::Vec<E> repeat_layers(E e, const Real* HWY_RESTRICT from, const Real* HWY_RESTRICT second) {
    if constexpr (layers == 1) {
      return hn::Load(e, from);
    } else {
      const hn::Half<E> half;
      if (second == nullptr) return hn::ZeroExtendVector(e, hn::Load(half, from));
      return hn::Combine(e, hn::Load(half, second), hn::Load(half, from));
    }
  }
};

/// The nodes of a particle along the last axis, in groups that begin at multiples of a group: they may begin and end
/// with nodes of weight zero.
template <Kernel kernel, class Group>
struct NodeRow {
  static constexpr int kGroups = (support(kernel) + 2 * (Group::kNodes - 1)) / Group::kNodes;
  /// Weights by place: slot 1 + a belongs to node a, the others are zero.
  static constexpr int kSlots = 1 + kGroups * Group::kNodes;
};

/// Distance in a tile, in numbers, from a particle's first row of nodes to its row r.
template <int dim>
constexpr int row_place(Kernel kernel, int r) {
  if constexpr (dim == 2) return r * tile_stride<dim>(kernel, 0);
  return r / support(kernel) * tile_stride<dim>(kernel, 0) + r % support(kernel) * tile_stride<dim>(kernel, 1);
}

/// Writes lane l of a vector, and of `last` as the fourth number, as the l-th node at `to`.
template <class Real, int dim>
HWY_INLINE void store_as_nodes(const Vec<Lanes<Real>, dim>& v, const Lanes<Real>& last, Real* HWY_RESTRICT to) {
  const Lanes<Real> z = dim == 3 ? v[dim - 1] : Lanes<Real>(Real(0));
  hn::StoreInterleaved4(v[0].v, v[1].v, z.v, last.v, typename Lanes<Real>::D(), to);
}

/// Vector whose 128-bit block j is at base + first[step j].
template <class D, class Real = hn::TFromD<D>>
HWY_INLINE hn::Vec<D> load_blocks(D d, const Real* HWY_RESTRICT base, const std::int32_t* HWY_RESTRICT first,
                                  int step) {
  constexpr int kBlocks = static_cast<int>(hn::MaxLanes(D()) * sizeof(Real) / 16);
  if constexpr (kBlocks <= 1) {
    return hn::Load(d, base + first[0]);
  } else {
    const hn::Half<D> half;
    return hn::Combine(d, load_blocks(half, base, first + kBlocks / 2 * step, step),
                       load_blocks(half, base, first, step));
  }
}

/// SIMD registers of the target.
inline constexpr int kRegisters = HWY_TARGET <= HWY_AVX3 ? 32 : 16;

/// Vector whose 256-bit half j is at base + first[step j].
template <class D, class Real = hn::TFromD<D>>
HWY_INLINE hn::Vec<D> load_halves(D d, const Real* HWY_RESTRICT base, const std::int32_t* HWY_RESTRICT first,
                                  int step) {
  if constexpr (hn::MaxLanes(D()) * sizeof(Real) <= 32) {
    return hn::LoadU(d, base + first[0]);
  } else {
    const hn::Half<D> half;
    return hn::Combine(d, hn::LoadU(half, base + first[step]), hn::LoadU(half, base + first[0]));
  }
}

/// The even 128-bit blocks of two vectors by turns, and the odd ones.
template <class V>
HWY_INLINE V even_blocks(V a, V b) {
  return hn::OddEvenBlocks(hn::SwapAdjacentBlocks(b), a);
}
template <class V>
HWY_INLINE V odd_blocks(V a, V b) {
  return hn::OddEvenBlocks(b, hn::SwapAdjacentBlocks(a));
}

/// Transposes 4 x 4 numbers inside each 128-bit block: the first dim of them, of nodes n[0] to n[3].
template <int dim, class V>
HWY_INLINE Vec<Lanes<float>, dim> transpose_blocks(const V (&n)[4]) {
  const Lanes<float>::D d;
  const hn::Repartition<std::uint64_t, Lanes<float>::D> pairs;
  const auto xy01 = hn::BitCast(pairs, hn::InterleaveLower(d, n[0], n[1]));
  const auto xy23 = hn::BitCast(pairs, hn::InterleaveLower(d, n[2], n[3]));
  Vec<Lanes<float>, dim> r;
  r[0] = {hn::BitCast(d, hn::InterleaveLower(pairs, xy01, xy23))};
  r[1] = {hn::BitCast(d, hn::InterleaveUpper(pairs, xy01, xy23))};
  if constexpr (dim == 3) {
    const auto zm01 = hn::BitCast(pairs, hn::InterleaveUpper(d, n[0], n[1]));
    const auto zm23 = hn::BitCast(pairs, hn::InterleaveUpper(d, n[2], n[3]));
    r[2] = {hn::BitCast(d, hn::InterleaveLower(pairs, zm01, zm23))};
  }
  return r;
}

/// Lane l: the first dim numbers of the node at base + first[l].
template <int dim>
HWY_INLINE Vec<Lanes<float>, dim> load_nodes(const float* HWY_RESTRICT base, const std::int32_t* HWY_RESTRICT first) {
  const Lanes<float>::D d;
  const hn::Vec<Lanes<float>::D> n[4] = {load_blocks(d, base, first, 4), load_blocks(d, base, first + 1, 4),
                                         load_blocks(d, base, first + 2, 4), load_blocks(d, base, first + 3, 4)};
  return transpose_blocks<dim>(n);
}
template <int dim>
HWY_INLINE Vec<Lanes<double>, dim> load_nodes(const double* HWY_RESTRICT base, const std::int32_t* HWY_RESTRICT first) {
  const Lanes<double>::D d;
  Vec<Lanes<double>, dim> r;
  if constexpr (Lanes<double>::kCount == 2 || dim == 2) {
    const auto xy0 = load_blocks(d, base, first, 2), xy1 = load_blocks(d, base, first + 1, 2);
    r[0] = {hn::InterleaveLower(d, xy0, xy1)};
    r[1] = {hn::InterleaveUpper(d, xy0, xy1)};
    if constexpr (dim == 3) {
      r[2] = {hn::InterleaveLower(d, load_blocks(d, base + 2, first, 2), load_blocks(d, base + 2, first + 1, 2))};
    }
  } else {
    // Whole nodes, in half as many loads.
    const auto n0 = load_halves(d, base, first, 4), n1 = load_halves(d, base, first + 1, 4),
               n2 = load_halves(d, base, first + 2, 4), n3 = load_halves(d, base, first + 3, 4);
    const auto xz01 = hn::InterleaveLower(d, n0, n1), xz23 = hn::InterleaveLower(d, n2, n3);
    r[0] = {even_blocks(xz01, xz23)};
    r[1] = {even_blocks(hn::InterleaveUpper(d, n0, n1), hn::InterleaveUpper(d, n2, n3))};
    r[2] = {odd_blocks(xz01, xz23)};
  }
  return r;
}

/// The node at base + first[l] and the one behind it, both at once, in half as many loads.
template <int dim>
HWY_INLINE void load_adjacent(const float* HWY_RESTRICT base, const std::int32_t* HWY_RESTRICT first,
                              Vec<Lanes<float>, dim> (&nodes)[2]) {
  if constexpr (Lanes<float>::kCount == 4) {
    for (int c = 0; c < 2; ++c) nodes[c] = load_nodes<dim>(base + c * kNodeWidth, first);
  } else {
    const Lanes<float>::D d;
    Vec<Lanes<float>, dim> blocks[2];
    for (int h = 0; h < 2; ++h) {
      const std::int32_t* HWY_RESTRICT from = first + 4 * h;
      const hn::Vec<Lanes<float>::D> n[4] = {load_halves(d, base, from, 8), load_halves(d, base, from + 1, 8),
                                             load_halves(d, base, from + 2, 8), load_halves(d, base, from + 3, 8)};
      blocks[h] = transpose_blocks<dim>(n);
    }
    for (int i = 0; i < dim; ++i) {
      nodes[0][i] = {even_blocks(blocks[0][i].v, blocks[1][i].v)};
      nodes[1][i] = {odd_blocks(blocks[0][i].v, blocks[1][i].v)};
    }
  }
}
template <int dim>
HWY_INLINE void load_adjacent(const double* HWY_RESTRICT base, const std::int32_t* HWY_RESTRICT first,
                              Vec<Lanes<double>, dim> (&nodes)[2]) {
  for (int c = 0; c < 2; ++c) nodes[c] = load_nodes<dim>(base + c * kNodeWidth, first);
}

/// Two neighbouring nodes of one layer.
template <int dim, class Real>
HWY_INLINE void load_node_pair(const Real* HWY_RESTRICT base, const std::int32_t* HWY_RESTRICT first,
                               Vec<Lanes<Real>, dim> (&nodes)[2]) {
  if constexpr (kRegisters < 32) {
    for (int c = 0; c < 2; ++c) nodes[c] = load_nodes<dim>(base + c * kNodeWidth, first);
  } else {
    load_adjacent<dim>(base, first, nodes);
  }
}
/// One node in both layers.
template <int dim, class Real>
HWY_INLINE void load_layers(const Real* HWY_RESTRICT base, const std::int32_t* HWY_RESTRICT first,
                            Vec<Lanes<Real>, dim> (&layers)[2]) {
  load_adjacent<dim>(base, first, layers);
}

}  // namespace HWY_NAMESPACE
}  // namespace firn
HWY_AFTER_NAMESPACE();

#endif  // FIRN_TRANSFER_NODES_INL_H_
