#if defined(FIRN_MATERIALS_FIXED_COROTATED_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FIRN_MATERIALS_FIXED_COROTATED_INL_H_
#undef FIRN_MATERIALS_FIXED_COROTATED_INL_H_
#else
#define FIRN_MATERIALS_FIXED_COROTATED_INL_H_
#endif

#include <firn/materials/model-inl.h>

#include <limits>

HWY_BEFORE_NAMESPACE();
namespace firn {
namespace HWY_NAMESPACE {

/// Fixed corotated energy in principal stretches sigma (Stomakhin et al. 2012; Jiang et al. 2016, section 6.3):
///
///   psi = mu sum (sigma_i - 1)^2 + lambda/2 (J - 1)^2                 J/m^3
template <class T, int dim>
HWY_INLINE T fixed_corotated_energy(T mu, T lambda, const Vec<T, dim>& sigma) {
  T J = sigma[0], stretch = (sigma[0] - T(1)) * (sigma[0] - T(1));
  for (int i = 1; i < dim; ++i) {
    J = J * sigma[i];
    stretch = stretch + (sigma[i] - T(1)) * (sigma[i] - T(1));
  }
  return mu * stretch + T(0.5) * lambda * (J - T(1)) * (J - T(1));
}

/// Along the longest principal stretch, sigma^2 d2 psi / d sigma^2 = 2 mu sigma^2 + lambda J^2; at rest lambda + 2 mu.
/// Pa.
template <class T>
HWY_INLINE T fixed_corotated_wave_modulus(T mu, T lambda, T J, T longest) {
  return mul_add(lambda, max(J * J, T(1)), (mu + mu) * max(longest * longest, T(1)));
}

/// Its Kirchhoff stress, tau = 2 mu (F - R) F^T + lambda (J - 1) J I, from U and sigma of F = U diag(sigma) V^T, Pa.
template <class T, int dim>
HWY_INLINE Response<T, dim> fixed_corotated_response(T mu, T lambda, const Mat<T, dim>& U, const Vec<T, dim>& sigma) {
  Response<T, dim> response;
  response.J = sigma[0];
  for (int i = 1; i < dim; ++i) response.J = response.J * sigma[i];
  const T pressure_term = lambda * (response.J - T(1)) * response.J;
  Vec<T, dim> principal;
  for (int i = 0; i < dim; ++i) principal[i] = mul_add((mu + mu) * (sigma[i] - T(1)), sigma[i], pressure_term);
  response.tau = rotated_diagonal(U, principal);
  response.tau_zz = pressure_term;
  response.wave_modulus = fixed_corotated_wave_modulus(mu, lambda, response.J, sigma[0]);
  return response;
}

/// Fixed corotated elastic solid.
///
///   psi = mu |F - R|^2 + lambda/2 (J - 1)^2        tau = 2 mu (F - R) F^T + lambda (J - 1) J I
///
/// R is the rotation of F's polar decomposition. Valid for every F: energy and stress stay finite as J -> 0 and an
/// inverted particle is pushed back to shape along its smallest stretch, the sign-carrying one.
template <class T>
struct FixedCorotated {
  static constexpr std::string_view kName = "fixed_corotated";
  static constexpr std::string_view kSummary =
      "Elastic solid that recovers even from inversion; jelly and soft bodies.";
  static constexpr std::string_view kSource = "Stomakhin et al. 2012; Jiang et al. 2016, section 6.3";
  static constexpr std::string_view kFormula =
      "psi = mu |F - R|^2 + lambda/2 (J - 1)^2; tau = 2 mu (F - R) F^T + lambda (J - 1) J I";
  static constexpr std::array kParameters = {kYoungsModulus, kPoissonRatio};
  static constexpr std::array<HistoryColumn, 0> kHistory = {};
  static constexpr double kMinimumJ = -std::numeric_limits<double>::infinity();

  T mu, lambda;  // Pa

  HWY_INLINE explicit FixedCorotated(const ModelParameters& parameters)
      : mu(Scalar<T>(lame_mu(parameters.values[0], parameters.values[1]))),
        lambda(Scalar<T>(lame_lambda(parameters.values[0], parameters.values[1]))) {}

  HWY_INLINE T volume_ratio(T J, const T* /*history*/) const { return J; }

  template <int dim>
  HWY_INLINE T energy(const Mat<T, dim>& F, const T* /*history*/) const {
    return fixed_corotated_energy(mu, lambda, svd(F).sigma);
  }

  template <int dim>
  HWY_INLINE Response<T, dim> update(Mat<T, dim>& F, T* /*history*/, const Mat<T, dim>& grad_v, T dt) const {
    F = deformed(F, grad_v, dt);
    const Rotation<T, dim> rotation = polar_rotation(F);
    Response<T, dim> response;
    response.J = determinant(F);
    response.tau_zz = lambda * (response.J - T(1)) * response.J;
    const Mat<T, dim> P = (mu + mu) * (F - rotation.R);  // without its volumetric part
    for (int i = 0; i < dim; ++i) {
      for (int j = i; j < dim; ++j) {
        T s = i == j ? response.tau_zz : T(0);
        for (int k = 0; k < dim; ++k) s = mul_add(P(i, k), F(j, k), s);
        response.tau(i, j) = response.tau(j, i) = s;
      }
    }
    response.wave_modulus = fixed_corotated_wave_modulus(mu, lambda, response.J, rotation.largest);
    return response;
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace firn
HWY_AFTER_NAMESPACE();

#endif  // FIRN_MATERIALS_FIXED_COROTATED_INL_H_
