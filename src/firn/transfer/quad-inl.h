// Quad<Real>: the four numbers of a grid node as a value, in as many SIMD vectors as the target needs.

#if defined(FIRN_TRANSFER_QUAD_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FIRN_TRANSFER_QUAD_INL_H_
#undef FIRN_TRANSFER_QUAD_INL_H_
#else
#define FIRN_TRANSFER_QUAD_INL_H_
#endif

#include <firn/core/linear_algebra-inl.h>
#include <firn/state/grid.h>

HWY_BEFORE_NAMESPACE();
namespace firn {
namespace HWY_NAMESPACE {

template <class Real>
struct Quad {
  using D = hn::CappedTag<Real, kNodeWidth>;
  static constexpr int kPerVector = static_cast<int>(HWY_LANES(Real)) < kNodeWidth ? HWY_LANES(Real) : kNodeWidth;
  static constexpr int kVectors = kNodeWidth / kPerVector;

  hn::Vec<D> part[kVectors];

  static HWY_INLINE Quad broadcast(Real value) {
    Quad r;
    for (int k = 0; k < kVectors; ++k) r.part[k] = hn::Set(D(), value);
    return r;
  }
  static HWY_INLINE Quad zero() { return broadcast(Real(0)); }
  static HWY_INLINE Quad load(const Real* HWY_RESTRICT from) {
    Quad r;
    for (int k = 0; k < kVectors; ++k) r.part[k] = hn::Load(D(), from + k * kPerVector);
    return r;
  }
  HWY_INLINE void store(Real* HWY_RESTRICT to) const {
    for (int k = 0; k < kVectors; ++k) hn::Store(part[k], D(), to + k * kPerVector);
  }

  friend HWY_INLINE Quad operator+(const Quad& a, const Quad& b) {
    Quad r;
    for (int k = 0; k < kVectors; ++k) r.part[k] = hn::Add(a.part[k], b.part[k]);
    return r;
  }
  friend HWY_INLINE Quad operator*(const Quad& a, const Quad& b) {
    Quad r;
    for (int k = 0; k < kVectors; ++k) r.part[k] = hn::Mul(a.part[k], b.part[k]);
    return r;
  }
  /// a b + c.
  friend HWY_INLINE Quad mul_add(const Quad& a, const Quad& b, const Quad& c) {
    Quad r;
    for (int k = 0; k < kVectors; ++k) r.part[k] = hn::MulAdd(a.part[k], b.part[k], c.part[k]);
    return r;
  }
};

/// Writes lane l of (x, y, z, w) as the l-th quad at `to`.
template <class Real>
HWY_INLINE void store_as_quads(const Lanes<Real>& x, const Lanes<Real>& y, const Lanes<Real>& z, const Lanes<Real>& w,
                               Real* HWY_RESTRICT to) {
  hn::StoreInterleaved4(x.v, y.v, z.v, w.v, typename Lanes<Real>::D(), to);
}

/// The inverse: components 0 to n - 1 of the quads at `from`, in lanes.
template <int n, class Real>
HWY_INLINE Vec<Lanes<Real>, n> load_from_quads(const Real* HWY_RESTRICT from) {
  hn::Vec<typename Lanes<Real>::D> parts[4];
  hn::LoadInterleaved4(typename Lanes<Real>::D(), from, parts[0], parts[1], parts[2], parts[3]);
  Vec<Lanes<Real>, n> r;
  for (int i = 0; i < n; ++i) r[i] = Lanes<Real>(parts[i]);
  return r;
}

/// Writes the lanes of a vector (and `mass`) as quads.
template <class Real, int dim>
HWY_INLINE void store_vector_as_quads(const Vec<Lanes<Real>, dim>& v, const Lanes<Real>& mass, Real* HWY_RESTRICT to) {
  if constexpr (dim == 3) {
    store_as_quads(v[0], v[1], v[2], mass, to);
  } else {
    store_as_quads(v[0], v[1], Lanes<Real>(Real(0)), mass, to);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace firn
HWY_AFTER_NAMESPACE();

#endif  // FIRN_TRANSFER_QUAD_INL_H_
