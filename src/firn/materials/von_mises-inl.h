#if defined(FIRN_MATERIALS_VON_MISES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FIRN_MATERIALS_VON_MISES_INL_H_
#undef FIRN_MATERIALS_VON_MISES_INL_H_
#else
#define FIRN_MATERIALS_VON_MISES_INL_H_
#endif

#include <firn/materials/hencky_strain-inl.h>

HWY_BEFORE_NAMESPACE();
namespace firn {
namespace HWY_NAMESPACE {

/// Metal and plasticine: Hencky elasticity, von Mises yield and linear isotropic hardening (Simo and Hughes 1998,
/// chapter 3, in logarithmic strains as in Simo 1992).
///
///   q = sqrt(3/2) |dev tau| = sqrt(6) mu |dev strain|  <=  yield_stress + H alpha      Pa
///
/// q is the tension at which a bar yields; in shear the limit is yield_stress / sqrt(3). Beyond it the deviator is
/// scaled back along itself, exactly, with 3 mu d_alpha = q_trial - q:
///
///   d_alpha = (q_trial - yield_stress - H alpha) / (3 mu + H)
///
/// alpha is the equivalent plastic strain. Volume stays elastic, so that det Fp = 1; pressure has no influence on
/// yield. The stored strain is Fe. Valid for J > 0; H = 0 is perfect plasticity, softening is not offered because its
/// bands would be as wide as a cell.
template <class T>
struct VonMises {
  static constexpr std::string_view kName = "von_mises";
  static constexpr std::string_view kSummary =
      "Metal or modelling clay: elastic up to a yield stress, then bends for good.";
  static constexpr std::string_view kSource = "Simo 1992; Simo and Hughes 1998, chapter 3";
  static constexpr std::string_view kFormula = "tau of hencky; sqrt(3/2) |dev tau| <= yield_stress + H alpha";
  static constexpr std::array kParameters = {
      kYoungsModulus,
      kPoissonRatio,
      Parameter{.name = "yield_stress",
                .unit = "Pa",
                .default_value = 1e3,
                .minimum = 0,
                .maximum = 1e12,
                .minimum_allowed = false,
                .help = "Tension at which a bar begins to flow (von Mises); shear yields at 0.577 of it.",
                .hint = "modelling clay is near 5e4, copper 7e7, mild steel 2.5e8"},
      Parameter{.name = "hardening_modulus",
                .unit = "Pa",
                .default_value = 0,
                .minimum = 0,
                .maximum = 1e12,
                .help = "Growth of the yield stress per plastic strain."},
  };
  static constexpr std::array<HistoryColumn, 2> kHistory = {
      {{"plastic_strain", "", "Equivalent plastic strain: how much the material has flowed.", 0}, kElasticStrainZz}};
  static constexpr double kMinimumJ = 0;

  T mu, lambda;                       // Pa
  T yield_stress, hardening_modulus;  // Pa
  T q_per_strain;                     // Pa, q / |dev strain|
  T flow_per_excess;                  // 1/Pa, d_alpha / (q_trial - limit)

  HWY_INLINE explicit VonMises(const ModelParameters& parameters)
      : mu(constant<T>(lame_mu(parameters.values[0], parameters.values[1]))),
        lambda(constant<T>(lame_lambda(parameters.values[0], parameters.values[1]))),
        yield_stress(constant<T>(parameters.values[2])),
        hardening_modulus(constant<T>(parameters.values[3])),
        q_per_strain(constant<T>(std::sqrt(6.0) * lame_mu(parameters.values[0], parameters.values[1]))),
        flow_per_excess(
            constant<T>(1 / (3 * lame_mu(parameters.values[0], parameters.values[1]) + parameters.values[3]))) {}

  HWY_INLINE T volume_ratio(T J, const T* history) const { return J * exp(history[1]); }

  template <int dim>
  HWY_INLINE T energy(const Mat<T, dim>& Fe, const T* history) const {
    return hencky_energy(mu, lambda, hencky_strain(Fe, dim == 2 ? history[1] : T(0)).strain);
  }

  template <int dim>
  HWY_INLINE Response<T, dim> update(Mat<T, dim>& Fe, T* history, const Mat<T, dim>& grad_v, T dt) const {
    Fe = deformed(Fe, grad_v, dt);
    HenckyStrain<T, dim> h = hencky_strain(Fe, dim == 2 ? history[1] : T(0));
    const StrainParts<T> trial = split(h.strain);
    const T q_trial = q_per_strain * trial.norm;
    const T limit = mul_add(hardening_modulus, history[0], yield_stress);
    // Written so that a limit that is not a number yields, and shows in the stress.
    const auto yielded = !(q_trial <= limit);
    const T d_alpha = (q_trial - limit) * flow_per_excess;
    const T q = mul_add(hardening_modulus, d_alpha, limit);
    return_to(join(trial.trace, q / q_trial, trial.deviator), yielded, h, Fe, history + 1);
    history[0] = select(yielded, history[0] + d_alpha, history[0]);
    return hencky_response(mu, lambda, h);
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace firn
HWY_AFTER_NAMESPACE();

#endif  // FIRN_MATERIALS_VON_MISES_INL_H_
