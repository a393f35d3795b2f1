#if defined(FIRN_MATERIALS_HERSCHEL_BULKLEY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FIRN_MATERIALS_HERSCHEL_BULKLEY_INL_H_
#undef FIRN_MATERIALS_HERSCHEL_BULKLEY_INL_H_
#else
#define FIRN_MATERIALS_HERSCHEL_BULKLEY_INL_H_
#endif

#include <firn/materials/hencky_strain-inl.h>

#include <numbers>

HWY_BEFORE_NAMESPACE();
namespace firn {
namespace HWY_NAMESPACE {

/// Yogurt, foam, paste, lava: an elastic solid that flows by the Herschel-Bulkley law above a yield stress (Yue et al.
/// 2015; Nagasawa et al. 2019), here on Hencky elasticity. With the shear stress s = |dev tau| / sqrt(2) and the rate
/// of plastic shear g, so that in simple shear s is the stress and g the rate,
///
///   s = shear_yield_stress + consistency g^flow_index   where s exceeds the yield stress, else g = 0
///
/// The return map solves the implicit step s + mu dt g(s) = s_trial for the overstress, in logarithms: there the left
/// side is a convex function between two straight lines, and a fixed number of Newton steps from their lower envelope
/// reaches round-off for every index. The deviator is scaled to s; volume stays elastic (det Fp = 1).
///
/// The viscosity needs no limit of the time step of its own: the flow never takes more stress than the elastic step
/// gave. Flow is visible where mu is large against s; creep below yield does not occur. The stored strain is Fe. Valid
/// for J > 0.
template <class T>
struct HerschelBulkley {
  static constexpr std::string_view kName = "herschel_bulkley";
  static constexpr std::string_view kSummary = "Paste, cream, foam: a soft solid that flows above its yield stress.";
  static constexpr std::string_view kSource = "Yue et al. 2015; Nagasawa et al. 2019; Herschel and Bulkley 1926";
  static constexpr std::string_view kFormula =
      "tau of hencky; shear stress = shear_yield_stress + consistency (shear rate)^flow_index while it flows";
  static constexpr std::array kParameters = {
      kYoungsModulus,
      kPoissonRatio,
      Parameter{.name = "shear_yield_stress",
                .unit = "Pa",
                .default_value = 50,
                .minimum = 0,
                .maximum = 1e12,
                .help = "Shear stress below which the material does not flow; tension yields at 1.73 of it.",
                .hint = "yogurt is near 10 to 50, whipped cream 50, toothpaste 200"},
      Parameter{
          .name = "consistency",
          .unit = "Pa s^n",
          .default_value = 10,
          .minimum = 0,
          .maximum = 1e12,
          .minimum_allowed = false,
          .help = "Stress beyond yield at a shear rate of 1/s; with a flow index of 1 it is a viscosity in Pa s."},
      Parameter{
          .name = "flow_index",
          .unit = "",
          .default_value = 1,
          .minimum = 0.1,
          .maximum = 3,
          .help = "n: 1 flows in proportion to stress (Bingham), below 1 it thins when sheared, above 1 it thickens."},
  };
  static constexpr std::array<HistoryColumn, 1> kHistory = {{kElasticStrainZz}};
  static constexpr double kMinimumJ = 0;

  T mu, lambda;       // Pa
  T yield_stress;     // Pa, shear
  T index;            // -
  T inverse_index;    // -
  T log_consistency;  // logarithm of Pa s^n

  HWY_INLINE explicit HerschelBulkley(const ModelParameters& parameters)
      : mu(constant<T>(lame_mu(parameters.values[0], parameters.values[1]))),
        lambda(constant<T>(lame_lambda(parameters.values[0], parameters.values[1]))),
        yield_stress(constant<T>(parameters.values[2])),
        index(constant<T>(parameters.values[4])),
        inverse_index(constant<T>(1 / parameters.values[4])),
        log_consistency(constant<T>(std::log(parameters.values[3]))) {}

  HWY_INLINE T volume_ratio(T J, const T* history) const { return J * exp(history[0]); }

  template <int dim>
  HWY_INLINE T energy(const Mat<T, dim>& Fe, const T* history) const {
    return hencky_energy(mu, lambda, hencky_strain(Fe, dim == 2 ? history[0] : T(0)).strain);
  }

  template <int dim>
  HWY_INLINE Response<T, dim> update(Mat<T, dim>& Fe, T* history, const Mat<T, dim>& grad_v, T dt) const {
    Fe = deformed(Fe, grad_v, dt);
    HenckyStrain<T, dim> h = hencky_strain(Fe, dim == 2 ? history[0] : T(0));
    const StrainParts<T> trial = split(h.strain);
    const T s_trial = constant<T>(std::numbers::sqrt2) * mu * trial.norm;
    const auto yielded = s_trial > yield_stress;
    const T s = yield_stress + overstress(s_trial - yield_stress, dt);
    return_to(join(trial.trace, min(s / s_trial, T(1)), trial.deviator), yielded, h, Fe, history);
    return hencky_response(mu, lambda, h);
  }

  /// y > 0 with y + mu dt (y / consistency)^(1/n) = excess, for excess > 0; all in Pa.
  HWY_INLINE T overstress(T excess, T dt) const {
    constexpr Scalar<T> kTiny = Scalar<T>(1e-30);
    const T log_excess = log(max(excess, T(kTiny)));
    // z = ln(y / excess); the flow's share of the excess is exp(shift + z / n).
    const T shift = log(max(mu * dt, T(kTiny))) + inverse_index * (log_excess - log_consistency) - log_excess;
    T z = min(-(index * shift), T(0));
    for (int step = 0; step < 5; ++step) {
      const T stays = exp(z), flows = exp(mul_add(inverse_index, z, shift));
      const T sum = stays + flows;
      z = z - log(sum) * sum / mul_add(inverse_index, flows, stays);
    }
    return excess * exp(z);
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace firn
HWY_AFTER_NAMESPACE();

#endif  // FIRN_MATERIALS_HERSCHEL_BULKLEY_INL_H_
