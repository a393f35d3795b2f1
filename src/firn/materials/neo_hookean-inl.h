#if defined(FIRN_MATERIALS_NEO_HOOKEAN_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FIRN_MATERIALS_NEO_HOOKEAN_INL_H_
#undef FIRN_MATERIALS_NEO_HOOKEAN_INL_H_
#else
#define FIRN_MATERIALS_NEO_HOOKEAN_INL_H_
#endif

#include <firn/materials/model-inl.h>

HWY_BEFORE_NAMESPACE();
namespace firn {
namespace HWY_NAMESPACE {

/// Compressible neo-Hookean solid (Jiang et al. 2016, section 6.1; Bonet and Wood 2008, eq. 6.27).
///
///   psi = mu/2 (tr(F F^T) - dim) - mu ln J + lambda/2 (ln J)^2        J/m^3
///   tau = mu (F F^T - I) + lambda ln J I                              Pa
///
/// Valid for J > 0; both the energy and the stress grow without bound as J -> 0, so elements resist inversion. Resists
/// compression with the logarithm, not with (J^2 - 1)/2, which stays finite as J -> 0.
template <class T>
struct NeoHookean {
  static constexpr std::string_view kName = "neo_hookean";
  static constexpr std::string_view kSummary = "Rubber-like elastic solid that resists being squeezed to nothing.";
  static constexpr std::string_view kSource = "Jiang et al. 2016, section 6.1";
  static constexpr std::string_view kFormula =
      "psi = mu/2 (tr(F F^T) - dim) - mu ln J + lambda/2 (ln J)^2; tau = mu (F F^T - I) + lambda ln J I";
  static constexpr std::array kParameters = {kYoungsModulus, kPoissonRatio};
  static constexpr std::array<HistoryColumn, 0> kHistory = {};
  static constexpr double kMinimumJ = 0;

  T mu, lambda;  // Pa

  HWY_INLINE explicit NeoHookean(const ModelParameters& parameters)
      : mu(Scalar<T>(lame_mu(parameters.values[0], parameters.values[1]))),
        lambda(Scalar<T>(lame_lambda(parameters.values[0], parameters.values[1]))) {}

  HWY_INLINE T volume_ratio(T J, const T* /*history*/) const { return J; }

  template <int dim>
  HWY_INLINE T energy(const Mat<T, dim>& F, const T* /*history*/) const {
    const T log_J = log(determinant(F));
    return T(0.5) * mu * (norm_squared(F) - T(dim)) - mu * log_J + T(0.5) * lambda * log_J * log_J;
  }

  template <int dim>
  HWY_INLINE Response<T, dim> update(Mat<T, dim>& F, T* /*history*/, const Mat<T, dim>& grad_v, T dt) const {
    F = deformed(F, grad_v, dt);
    Response<T, dim> response;
    response.J = determinant(F);
    const T log_J = log(response.J);
    const T pressure_term = lambda * log_J;
    response.tau = mu * (F * transpose(F));
    for (int i = 0; i < dim; ++i) response.tau(i, i) = response.tau(i, i) + (pressure_term - mu);
    response.tau_zz = pressure_term;
    // lambda + 2 mu at rest; stiffer where stretched (mu F^2) or squeezed (lambda (1 - ln J)).
    const T stretch = max(norm_squared(F) * T(Scalar<T>(1.0 / dim)), T(1));
    response.wave_modulus = mul_add(lambda, max(T(1) - log_J, T(1)), (mu + mu) * stretch);
    return response;
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace firn
HWY_AFTER_NAMESPACE();

#endif  // FIRN_MATERIALS_NEO_HOOKEAN_INL_H_
