#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "firn/transfer/gather.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <firn/core/linear_algebra-inl.h>
#include <firn/transfer/gather.h>
#include <firn/transfer/quad-inl.h>
#include <firn/transfer/weights-inl.h>

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

template <Kernel kernel, Form form, class Real, int dim>
struct GatherBatch {
  static constexpr int kSupport = support(kernel);
  static constexpr int kAgainst = Against<kernel, form>::kCount;
  static constexpr std::size_t kCount = Lanes<Real>::kCount;

  HWY_ALIGN Real weight[dim][kSupport][kCount];
  HWY_ALIGN Real other[kAgainst][dim][kSupport][kCount];
  HWY_ALIGN Real velocity[kCount * kNodeWidth];
  HWY_ALIGN Real change[kCount * kNodeWidth];
  HWY_ALIGN Real sums[kAgainst][dim][kCount * kNodeWidth];
};

template <Kernel kernel, Form form, class Real, int dim>
HWY_INLINE void fill_weights(const ParticleColumns<Real, dim>& particles, std::uint32_t p,
                             GatherBatch<kernel, form, Real, dim>& batch) {
  using L = Lanes<Real>;
  using A = Against<kernel, form>;
  for (int d = 0; d < dim; ++d) {
    const AxisWeights<kernel, L> axis(load_lanes(particles.offset[d] + p));
    for (int a = 0; a < support(kernel); ++a) {
      store_lanes(axis.w[a], batch.weight[d][a], L::kCount);
      if constexpr (A::kMoment) store_lanes(axis.w[a] * axis.distance[a], batch.other[0][d][a], L::kCount);
      if constexpr (A::kGradient) store_lanes(axis.dw[a], batch.other[A::kGradientIndex][d][a], L::kCount);
    }
  }
}

/// sum over the nodes of a row of w_a v_a and of the other weights times v_a.
template <Kernel kernel, Form form, class Real, int dim>
HWY_INLINE void gather_row(const Real* HWY_RESTRICT row, const GatherBatch<kernel, form, Real, dim>& batch,
                           std::size_t lane, Quad<Real>& sum, Quad<Real> (&against)[Against<kernel, form>::kCount]) {
  using Q = Quad<Real>;
  constexpr int kLast = dim - 1;
  for (int a = 0; a < support(kernel); ++a) {
    const Q v = Q::load(row + a * kNodeWidth);
    const Q w = Q::broadcast(batch.weight[kLast][a][lane]);
    sum = a == 0 ? w * v : mul_add(w, v, sum);
    for (int k = 0; k < Against<kernel, form>::kCount; ++k) {
      const Q other = Q::broadcast(batch.other[k][kLast][a][lane]);
      against[k] = a == 0 ? other * v : mul_add(other, v, against[k]);
    }
  }
}

/// Sum factorisation: along a row first, then over rows, then over planes.
template <Kernel kernel, Form form, class Real, int dim>
HWY_INLINE void gather_particle(const Real* HWY_RESTRICT first, GatherBatch<kernel, form, Real, dim>& batch,
                                std::size_t lane) {
  using Q = Quad<Real>;
  constexpr int kAgainst = Against<kernel, form>::kCount;
  Q v = Q::zero(), sums[kAgainst][dim];
  for (auto& axes : sums) {
    for (Q& sum : axes) sum = Q::zero();
  }
  for (int a = 0; a < support(kernel); ++a) {
    const Real* HWY_RESTRICT plane = first + a * tile_stride<dim>(kernel, 0);
    Q plane_v, plane_sums[kAgainst][dim];  // [k][d]: other weight k on axis d, for d > 0
    if constexpr (dim == 2) {
      Q against[kAgainst];
      gather_row(plane, batch, lane, plane_v, against);
      for (int k = 0; k < kAgainst; ++k) plane_sums[k][1] = against[k];
    } else {
      plane_v = Q::zero();
      for (int k = 0; k < kAgainst; ++k) plane_sums[k][1] = plane_sums[k][2] = Q::zero();
      for (int b = 0; b < support(kernel); ++b) {
        Q row_v, against[kAgainst];
        gather_row(plane + b * tile_stride<dim>(kernel, 1), batch, lane, row_v, against);
        const Q w_b = Q::broadcast(batch.weight[1][b][lane]);
        plane_v = mul_add(w_b, row_v, plane_v);
        for (int k = 0; k < kAgainst; ++k) {
          plane_sums[k][1] = mul_add(Q::broadcast(batch.other[k][1][b][lane]), row_v, plane_sums[k][1]);
          plane_sums[k][2] = mul_add(w_b, against[k], plane_sums[k][2]);
        }
      }
    }
    const Q w_a = Q::broadcast(batch.weight[0][a][lane]);
    v = mul_add(w_a, plane_v, v);
    for (int k = 0; k < kAgainst; ++k) {
      sums[k][0] = mul_add(Q::broadcast(batch.other[k][0][a][lane]), plane_v, sums[k][0]);
      for (int d = 1; d < dim; ++d) sums[k][d] = mul_add(w_a, plane_sums[k][d], sums[k][d]);
    }
  }
  v.store(batch.velocity + lane * kNodeWidth);
  for (int k = 0; k < kAgainst; ++k) {
    for (int d = 0; d < dim; ++d) sums[k][d].store(batch.sums[k][d] + lane * kNodeWidth);
  }
}

/// sum w_ip of the FLIP velocity change.
template <Kernel kernel, Form form, class Real, int dim>
HWY_INLINE void gather_change(const Real* HWY_RESTRICT first, GatherBatch<kernel, form, Real, dim>& batch,
                              std::size_t lane) {
  using Q = Quad<Real>;
  Q sum = Q::zero();
  for (int a = 0; a < support(kernel); ++a) {
    for (int b = 0; b < (dim == 3 ? support(kernel) : 1); ++b) {
      const Real* HWY_RESTRICT row =
          first + a * tile_stride<dim>(kernel, 0) + (dim == 3 ? b * tile_stride<dim>(kernel, 1) : 0);
      const Real w = dim == 3 ? batch.weight[0][a][lane] * batch.weight[1][b][lane] : batch.weight[0][a][lane];
      for (int c = 0; c < support(kernel); ++c) {
        sum = mul_add(Q::broadcast(w * batch.weight[dim - 1][c][lane]), Q::load(row + c * kNodeWidth), sum);
      }
    }
  }
  sum.store(batch.change + lane * kNodeWidth);
}

/// Writes C_p, and grad v where it has a column of its own.
template <Kernel kernel, Form form, class Real, int dim>
HWY_INLINE void store_gradients(const ParticleColumns<Real, dim>& particles, std::uint32_t p, std::uint32_t count,
                                Real inv_dx, const GatherBatch<kernel, form, Real, dim>& batch) {
  using L = Lanes<Real>;
  using A = Against<kernel, form>;
  const L inverse_D = L(static_cast<Real>(apic_inverse_D(kernel)) * inv_dx);
  for (int j = 0; j < dim; ++j) {
    if constexpr (A::kMoment) {
      const Vec<L, dim> column = load_from_quads<dim>(batch.sums[0][j]);
      for (int i = 0; i < dim; ++i) store_lanes(inverse_D * column[i], particles.affine[i * dim + j] + p, count);
    }
    if constexpr (A::kGradient) {
      const Vec<L, dim> column = load_from_quads<dim>(batch.sums[A::kGradientIndex][j]);
      for (int i = 0; i < dim; ++i) {
        Real* target = A::kMoment ? particles.grad_v[i * dim + j] : particles.affine[i * dim + j];
        store_lanes(L(inv_dx) * column[i], target + p, count);
      }
    }
  }
}

/// Gives particle p, which has moved by `shift` cells, its new key. False if that is not possible.
template <class Real, int dim>
bool change_cell(const ParticleColumns<Real, dim>& particles, std::uint32_t p, const Real (&shift)[dim],
                 const Period<dim>& period) {
  Index<dim> cell = cell_of_key<dim>(particles.cell[p]);
  for (int d = 0; d < dim; ++d) {
    if (!(std::fabs(shift[d]) <= static_cast<Real>(CellKey<dim>::kCellLimit))) return false;
    std::int64_t& c = cell[static_cast<std::size_t>(d)];
    c += static_cast<std::int64_t>(shift[d]);
    if (const std::int64_t length = period[static_cast<std::size_t>(d)]; length > 0)
      c = ((c % length) + length) % length;
  }
  if (!fits_key<dim>(cell)) return false;
  particles.cell[p] = cell_key<dim>(cell);
  return true;
}

/// x_p += dt u_p for one batch.
template <class Real, int dim>
HWY_INLINE void advect(const ParticleColumns<Real, dim>& particles, std::uint32_t p, std::uint32_t count,
                       const Vec<Lanes<Real>, dim>& u, const GatherTask<Real, dim>& task, GatherReport& report,
                       std::vector<std::uint32_t>& movers) {
  using L = Lanes<Real>;
  const L cells_per_speed = L(static_cast<Real>(task.dt / task.dx));
  Vec<L, dim> shift;
  auto moved = first_lanes<Real>(0);
  for (int d = 0; d < dim; ++d) {
    const L offset = mul_add(cells_per_speed, u[d], load_lanes(particles.offset[d] + p));
    shift[d] = floor(offset);
    // Rounding can make offset - floor(offset) exactly 1, which the weights accept.
    store_lanes(offset - shift[d], particles.offset[d] + p, count);
    moved = moved || !(shift[d] == L(Real(0)));
  }
  if (HWY_LIKELY(!any(moved && first_lanes<Real>(count)))) return;
  HWY_ALIGN Real shifts[dim][L::kCount];
  for (int d = 0; d < dim; ++d) store_lanes(shift[d], shifts[d], L::kCount);
  for (std::uint32_t lane = 0; lane < count; ++lane) {
    Real cells[dim];
    bool stays = true;
    for (int d = 0; d < dim; ++d) {
      cells[d] = shifts[d][lane];
      stays = stays && cells[d] == Real(0);
    }
    if (stays) continue;
    if (change_cell<Real, dim>(particles, p + lane, cells, task.period)) {
      movers.push_back(p + lane);
    } else if (report.failed == GatherReport::kNone) {
      report.failed = p + lane;
    }
  }
}

template <Kernel kernel, Form form, class Real, int dim>
GatherReport gather_block(const ParticleColumns<Real, dim>& particles, std::uint32_t begin, std::uint32_t end,
                          const GatherTask<Real, dim>& task, std::vector<std::uint32_t>& movers) {
  using L = Lanes<Real>;
  static constexpr auto kTileOffsets = tile_offsets<dim>(kernel);
  constexpr std::uint32_t kCount = L::kCount;
  const Real flip = static_cast<Real>(task.settings.flip);
  GatherReport report;
  L largest = L(Real(0));
  GatherBatch<kernel, form, Real, dim> batch;
  for (std::uint32_t p = begin; p < end; p += kCount) {
    const std::uint32_t count = end - p < kCount ? end - p : kCount;
    fill_weights(particles, p, batch);
    for (std::uint32_t lane = 0; lane < count; ++lane) {
      const std::int32_t first = kTileOffsets[particles.cell[p + lane] & CellKey<dim>::kCellMask];
      gather_particle(task.velocity + first, batch, lane);
      if (flip > Real(0)) gather_change(task.velocity_change + first, batch, lane);
    }
    store_gradients<kernel, form, Real, dim>(particles, p, count, static_cast<Real>(1 / task.dx), batch);

    Vec<L, dim> u = load_from_quads<dim>(batch.velocity), v = u;
    if (flip > Real(0)) {
      const Vec<L, dim> change = load_from_quads<dim>(batch.change);
      for (int i = 0; i < dim; ++i) {
        const L flip_v = load_lanes(particles.velocity[i] + p) + change[i];
        v[i] = mul_add(L(flip), flip_v - u[i], u[i]);
      }
    }
    if (task.constraint != nullptr) {
      HWY_ALIGN Real v_lanes[dim][kCount], u_lanes[dim][kCount];
      Real *v_pointers[dim], *u_pointers[dim];
      for (int i = 0; i < dim; ++i) {
        store_lanes(v[i], v_pointers[i] = v_lanes[i], kCount);
        store_lanes(u[i], u_pointers[i] = u_lanes[i], kCount);
      }
      task.constraint->apply(p, count, v_pointers, u_pointers);
      for (int i = 0; i < dim; ++i) {
        v[i] = load_lanes(v_lanes[i]);
        u[i] = load_lanes(u_lanes[i]);
      }
    }
    L speed_squared = v[0] * v[0];
    for (int i = 1; i < dim; ++i) speed_squared = mul_add(v[i], v[i], speed_squared);
    largest = max(select(first_lanes<Real>(count), speed_squared, L(Real(0))), largest);
    for (int i = 0; i < dim; ++i) store_lanes(v[i], particles.velocity[i] + p, count);
    advect<Real, dim>(particles, p, count, u, task, report, movers);
  }
  HWY_ALIGN Real squares[kCount];
  store_lanes(largest, squares, kCount);
  for (const Real square : squares) {
    const double speed = std::sqrt(static_cast<double>(square));
    if (speed > report.max_speed) report.max_speed = speed;
  }
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
