#if defined(FIRN_MATERIALS_SNOW_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FIRN_MATERIALS_SNOW_INL_H_
#undef FIRN_MATERIALS_SNOW_INL_H_
#else
#define FIRN_MATERIALS_SNOW_INL_H_
#endif

#include <firn/materials/fixed_corotated-inl.h>

HWY_BEFORE_NAMESPACE();
namespace firn {
namespace HWY_NAMESPACE {

/// Snow (Stomakhin et al. 2013, sections 5 and 7): fixed corotated elasticity of the elastic part Fe of F = Fe Fp.
/// Stretches of Fe beyond [1 - theta_c, 1 + theta_s] become plastic: they are clamped, and what was clamped away is
/// multiplied onto Jp = det Fp. Packed snow (Jp < 1) hardens and torn snow (Jp > 1) softens:
///
///   mu = h mu_0,  lambda = h lambda_0,  h = min(exp(xi (1 - Jp)), cap)
///
/// The stored strain is Fe; the history is Jp. The cap is ours: without it a few strongly packed particles set the time
/// step of the whole scene (exp(10 * 0.5) = 148 times the stiffness).
template <class T>
struct Snow {
  static constexpr std::string_view kName = "snow";
  static constexpr std::string_view kSummary = "Snow that packs, hardens, tears and crumbles.";
  static constexpr std::string_view kSource = "Stomakhin et al. 2013, sections 5 and 7";
  static constexpr std::string_view kFormula =
      "tau of fixed_corotated with h mu and h lambda, h = min(exp(xi (1 - Jp)), cap); stretches of Fe stay in [1 - "
      "theta_c, 1 + theta_s]";
  static constexpr std::array kParameters = {
      kYoungsModulus,
      kPoissonRatio,
      Parameter{.name = "critical_compression",
                .unit = "",
                .default_value = 2.5e-2,
                .minimum = 0,
                .maximum = 0.5,
                .help = "theta_c: elastic compression beyond which snow packs. Larger is chunkier."},
      Parameter{.name = "critical_stretch",
                .unit = "",
                .default_value = 7.5e-3,
                .minimum = 0,
                .maximum = 0.5,
                .help = "theta_s: elastic stretch beyond which snow tears. Larger is stickier, smaller is powdery."},
      Parameter{.name = "hardening",
                .unit = "",
                .default_value = 10,
                .minimum = 0,
                .maximum = 50,
                .help = "xi: how fast packed snow stiffens. Larger is icier."},
      Parameter{
          .name = "hardening_cap",
          .unit = "",
          .default_value = 8,
          .minimum = 1,
          .maximum = 1000,
          .help = "Largest factor by which packing may stiffen snow; the time step shrinks with its square root."},
  };
  static constexpr std::array<HistoryColumn, 1> kHistory = {
      {{"Jp", "", "Plastic volume ratio det Fp: below 1 packed, above 1 torn.", 1.0}}};
  static constexpr double kMinimumJ = 0;

  T mu0, lambda0;              // Pa
  T lowest, highest;           // 1 - theta_c, 1 + theta_s
  T hardening, hardening_cap;  // -

  HWY_INLINE explicit Snow(const ModelParameters& parameters)
      : mu0(Scalar<T>(lame_mu(parameters.values[0], parameters.values[1]))),
        lambda0(Scalar<T>(lame_lambda(parameters.values[0], parameters.values[1]))),
        lowest(Scalar<T>(1 - parameters.values[2])),
        highest(Scalar<T>(1 + parameters.values[3])),
        hardening(Scalar<T>(parameters.values[4])),
        hardening_cap(Scalar<T>(parameters.values[5])) {}

  HWY_INLINE T hardening_factor(T Jp) const { return min(exp(hardening * (T(1) - Jp)), hardening_cap); }

  HWY_INLINE T volume_ratio(T J, const T* history) const { return J * history[0]; }

  template <int dim>
  HWY_INLINE T energy(const Mat<T, dim>& Fe, const T* history) const {
    const T h = hardening_factor(history[0]);
    return fixed_corotated_energy(h * mu0, h * lambda0, svd(Fe).sigma);
  }

  template <int dim>
  HWY_INLINE Response<T, dim> update(Mat<T, dim>& Fe, T* history, const Mat<T, dim>& grad_v, T dt) const {
    const Mat<T, dim> trial = deformed(Fe, grad_v, dt);
    const Svd<T, dim> s = svd(trial);
    const auto yielded = s.sigma[0] > highest || s.sigma[dim - 1] < lowest;
    Vec<T, dim> sigma;
    for (int i = 0; i < dim; ++i) sigma[i] = min(max(s.sigma[i], lowest), highest);
    // The quotient of products: one division instead of one per stretch.
    T trial_J = s.sigma[0], J = sigma[0];
    for (int i = 1; i < dim; ++i) trial_J = trial_J * s.sigma[i], J = J * sigma[i];
    const T clamped_away = trial_J / J;
    // An elastic step keeps the bits of its trial state instead of a recomposed one.
    const Mat<T, dim> returned = compose(s.U, sigma, s.V);
    for (int i = 0; i < dim * dim; ++i) Fe.e[i] = select(yielded, returned.e[i], trial.e[i]);
    history[0] = select(yielded, history[0] * clamped_away, history[0]);
    // Times h at the end: the exponential takes as long as the rotations, and neither waits for the other.
    const T h = hardening_factor(history[0]);
    Response<T, dim> response = fixed_corotated_response(mu0, lambda0, s.U, sigma);
    for (T& tau : response.tau.e) tau = h * tau;
    response.tau_zz = h * response.tau_zz;
    response.wave_modulus = h * response.wave_modulus;
    // The return map makes det Fe positive whatever came in; material turned inside out, or NaN, shows in Jp.
    response.J = select(history[0] > T(0), response.J, -response.J);
    return response;
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace firn
HWY_AFTER_NAMESPACE();

#endif  // FIRN_MATERIALS_SNOW_INL_H_
