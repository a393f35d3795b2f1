#if defined(FIRN_MATERIALS_HENCKY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FIRN_MATERIALS_HENCKY_INL_H_
#undef FIRN_MATERIALS_HENCKY_INL_H_
#else
#define FIRN_MATERIALS_HENCKY_INL_H_
#endif

#include <firn/materials/hencky_strain-inl.h>

HWY_BEFORE_NAMESPACE();
namespace firn {
namespace HWY_NAMESPACE {

/// St. Venant-Kirchhoff elasticity of the Hencky strain, the logarithm of the stretch, in principal stretches sigma
/// (Klar et al. 2016; Hencky 1928).
///
///   psi = mu sum (ln sigma_i)^2 + lambda/2 (ln J)^2                   J/m^3
///   tau_i = 2 mu ln sigma_i + lambda ln J                             Pa, along the columns of U
///
/// Valid for J > 0. The energy has no bound as J -> 0, but the stress grows just with the logarithm; stretched by more
/// than e = 2.7 it softens in force. tau is a linear function of the strain, which makes it the elasticity of the
/// plastic models here: stretching and squeezing to the inverse are opposite.
template <class T>
struct Hencky {
  static constexpr std::string_view kName = "hencky";
  static constexpr std::string_view kSummary = "Elastic solid, linear in logarithmic strain; stiff bodies, metals.";
  static constexpr std::string_view kSource = "Hencky 1928; Klar et al. 2016";
  static constexpr std::string_view kFormula =
      "psi = mu sum (ln sigma_i)^2 + lambda/2 (ln J)^2; tau_i = 2 mu ln sigma_i + lambda ln J";
  static constexpr std::array kParameters = {kYoungsModulus, kPoissonRatio};
  static constexpr std::array<HistoryColumn, 0> kHistory = {};
  static constexpr double kMinimumJ = 0;

  T mu, lambda;  // Pa

  HWY_INLINE explicit Hencky(const ModelParameters& parameters)
      : mu(constant<T>(lame_mu(parameters.values[0], parameters.values[1]))),
        lambda(constant<T>(lame_lambda(parameters.values[0], parameters.values[1]))) {}

  HWY_INLINE T volume_ratio(T J, const T* /*history*/) const { return J; }

  template <int dim>
  HWY_INLINE T energy(const Mat<T, dim>& F, const T* /*history*/) const {
    return hencky_energy(mu, lambda, hencky_strain(F, T(0)).strain);
  }

  template <int dim>
  HWY_INLINE Response<T, dim> update(Mat<T, dim>& F, T* /*history*/, const Mat<T, dim>& grad_v, T dt) const {
    F = deformed(F, grad_v, dt);
    return hencky_response(mu, lambda, hencky_strain(F, T(0)));
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace firn
HWY_AFTER_NAMESPACE();

#endif  // FIRN_MATERIALS_HENCKY_INL_H_
