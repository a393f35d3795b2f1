#if defined(FIRN_MATERIALS_CAM_CLAY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FIRN_MATERIALS_CAM_CLAY_INL_H_
#undef FIRN_MATERIALS_CAM_CLAY_INL_H_
#else
#define FIRN_MATERIALS_CAM_CLAY_INL_H_
#endif

#include <firn/materials/friction_angle.h>
#include <firn/materials/hencky_strain-inl.h>

HWY_BEFORE_NAMESPACE();
namespace firn {
namespace HWY_NAMESPACE {

/// Soil and snow pack: non-associated Cam-Clay (NACC, Wolper et al. 2019), on Hencky instead of neo-Hookean
/// elasticity, so that the return map is exact in strains. With p = -tr(tau)/3, positive in compression, and
/// q = sqrt(3/2) |dev tau|, yield is on the ellipse
///
///   q^2 (1 + 2 beta) + M^2 (p + beta p0) (p - p0) = 0,   p0 = K sinh(xi max(-alpha, 0)),   M as for sand
///
/// p0 is the preconsolidation pressure, beta p0 the tension that cohesion bears, alpha the packing: below 0 packed,
/// above 0 loose. Let c = (1 - beta) p0 / 2 be the middle of the ellipse. The return map has three cases:
///
///   p > p0          to the tip; alpha takes the volume that is packed. Solved for the new p0, by Newton steps from the
///                   side on which every iterate is admissible, as p0 grows faster than exponentially
///   p < -beta p0    to the other tip, of the p0 that is left when alpha has taken the volume that opens
///   else            q alone is scaled back (no dilatancy). Hardening is borrowed from where the line from (c, 0) meets
///                   the ellipse: alpha softens for p < c and hardens for p > c, as if volume had changed
///
/// Wolper et al. scale q on the ellipse of the old alpha; here alpha is moved first, so that every returned state is
/// admissible and the map idempotent. log_Jp keeps the real change of volume, which alpha is not. The stored strain is
/// Fe. Valid for J > 0.
template <class T>
struct CamClay {
  static constexpr std::string_view kName = "cam_clay";
  static constexpr std::string_view kSummary =
      "Soil and snow pack: packs under pressure, and breaks by shear and tension.";
  static constexpr std::string_view kSource = "Wolper et al. 2019";
  static constexpr std::string_view kFormula =
      "tau of hencky; q^2 (1 + 2 beta) + M^2 (p + beta p0) (p - p0) <= 0, p0 = K sinh(xi max(-alpha, 0))";
  static constexpr std::array kParameters = {
      kYoungsModulus,
      kPoissonRatio,
      kFrictionAngle,
      Parameter{.name = "preconsolidation_pressure",
                .unit = "Pa",
                .default_value = 1e3,
                .minimum = 0,
                .maximum = 1e12,
                .help = "p0: pressure beyond which the undeformed material packs for good."},
      Parameter{.name = "cohesion_ratio",
                .unit = "",
                .default_value = 0.3,
                .minimum = 0,
                .maximum = 10,
                .help = "beta: tension that the material bears, as a share of the pressure at which it packs."},
      Parameter{.name = "packing_hardening",
                .unit = "",
                .default_value = 1,
                .minimum = 1e-2,
                .maximum = 1000,
                .help = "xi: how fast packing hardens and opening softens. Larger is more brittle."},
      kDilationLimit,
  };
  static constexpr std::array<HistoryColumn, 3> kHistory = {
      {{"packing", "", "Change of Cam-Clay's alpha: below 0 packed and harder, above 0 softer.", 0},
       kLogJp,
       kElasticStrainZz}};
  static constexpr double kMinimumJ = 0;

  T mu, lambda;           // Pa
  T cohesion, hardening;  // -: beta, xi
  T initial_packing;      // -: alpha of undeformed material is minus this
  T stretch_of_q;         // -: (q / M) sqrt(1 + 2 beta) / K per |dev strain|, which makes the ellipse a circle
  T loosest;              // -: largest change of alpha

  HWY_INLINE explicit CamClay(const ModelParameters& parameters)
      : CamClay(parameters, bulk_modulus(parameters.values[0], parameters.values[1])) {}

  HWY_INLINE T volume_ratio(T J, const T* history) const { return J * exp(history[1] + history[2]); }

  template <int dim>
  HWY_INLINE T energy(const Mat<T, dim>& Fe, const T* history) const {
    return hencky_energy(mu, lambda, hencky_strain(Fe, dim == 2 ? history[2] : T(0)).strain);
  }

  /// p0 / K for a change of alpha.
  HWY_INLINE T strength(T packing) const { return sinh_of(hardening * max(T(0), initial_packing - packing)); }

  template <int dim>
  HWY_INLINE Response<T, dim> update(Mat<T, dim>& Fe, T* history, const Mat<T, dim>& grad_v, T dt) const {
    Fe = deformed(Fe, grad_v, dt);
    HenckyStrain<T, dim> h = hencky_strain(Fe, dim == 2 ? history[2] : T(0));
    const StrainParts<T> trial = split(h.strain);
    // In units of K: pressure x, and y for which the ellipse is a circle of middle c and radius r.
    const T packing = history[0], x = -trial.trace, y = stretch_of_q * trial.norm;
    const T x0 = strength(packing);
    const T distance = sqrt(mul_add(x - middle(x0), x - middle(x0), y * y));
    const auto yielded = !(distance <= radius(x0));
    const auto crushed = x > x0;
    const auto torn = x < -(cohesion * x0);

    const T sheared = packing - (x - middle(x0)) * (T(1) - radius(x0) / distance);
    const T opened = packing - x - cohesion * x0;
    const T x_crushed = crushed_strength(packing - x, x0);
    const T moved = select(crushed, packing - x + x_crushed, select(torn, opened, sheared));
    const T new_packing = min(moved, loosest);

    const T x1 = select(crushed, x_crushed, strength(new_packing));
    const T lowest_x = -(cohesion * x1);
    const T new_x = min(max(x, lowest_x), x1);
    // radius^2 - (new_x - middle)^2, in a form that is exactly zero at the tips.
    const T height = (x1 - new_x) * (new_x - lowest_x);
    const T factor = min(sqrt(max(height, T(0))) / y, T(1));
    const T shape = select(crushed || torn || !(y > T(0)), T(0), factor);
    return_to(join(-new_x, shape, trial.deviator), yielded, h, Fe, history + 2);
    history[0] = select(yielded, new_packing, packing);
    history[1] = select(yielded, history[1] + (new_x - x), history[1]);
    // A memory that is not a number has to show, whatever was clamped.
    const T memory = packing + history[1];
    h.J = select(memory == memory, h.J, memory);
    return hencky_response(mu, lambda, h);
  }

 private:
  HWY_INLINE CamClay(const ModelParameters& parameters, double K)
      : mu(constant<T>(lame_mu(parameters.values[0], parameters.values[1]))),
        lambda(constant<T>(lame_lambda(parameters.values[0], parameters.values[1]))),
        cohesion(constant<T>(parameters.values[4])),
        hardening(constant<T>(parameters.values[5])),
        initial_packing(constant<T>(std::asinh(parameters.values[3] / K) / parameters.values[5])),
        stretch_of_q(constant<T>(std::sqrt(6 * (1 + 2 * parameters.values[4])) *
                                 lame_mu(parameters.values[0], parameters.values[1]) /
                                 (friction_slope(parameters.values[2]) * K))),
        loosest(constant<T>(std::asinh(parameters.values[3] / K) / parameters.values[5] + parameters.values[6])) {}

  HWY_INLINE T middle(T x0) const { return T(0.5) * (T(1) - cohesion) * x0; }
  HWY_INLINE T radius(T x0) const { return T(0.5) * (T(1) + cohesion) * x0; }

  /// sinh(a) for a >= 0, without the cancellation of e^a - e^-a near 0; the argument is cut off at 20, where p0 is 2e8
  /// K.
  static HWY_INLINE T sinh_of(T a) {
    const T e = exp(min(T(20), a)), square = a * a;
    const T series = a * mul_add(square,
                                 mul_add(square, mul_add(square, constant<T>(1.0 / 5040), constant<T>(1.0 / 120)),
                                         constant<T>(1.0 / 6)),
                                 T(1));
    return select(a < constant<T>(0.25), series, T(0.5) * (e - T(1) / e));
  }

  /// The x = p0/K for which strength(packing_without + x) = x: material that is packed until it bears what it is given.
  /// The left side falls and is convex, so that Newton's steps from below stay below, and each of them is admissible.
  HWY_INLINE T crushed_strength(T packing_without, T x0) const {
    T x = x0;
    for (int step = 0; step < 6; ++step) {
      const T s = strength(packing_without + x);
      // d sinh = cosh, zero where the argument of sinh is cut off below.
      const T slope = hardening * sqrt(mul_add(s, s, T(1)));
      x = x + max((s - x) / (T(1) + slope), T(0));
    }
    return x;
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace firn
HWY_AFTER_NAMESPACE();

#endif  // FIRN_MATERIALS_CAM_CLAY_INL_H_
