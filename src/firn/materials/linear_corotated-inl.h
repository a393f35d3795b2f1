#if defined(FIRN_MATERIALS_LINEAR_COROTATED_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FIRN_MATERIALS_LINEAR_COROTATED_INL_H_
#undef FIRN_MATERIALS_LINEAR_COROTATED_INL_H_
#else
#define FIRN_MATERIALS_LINEAR_COROTATED_INL_H_
#endif

#include <firn/materials/model-inl.h>

#include <limits>

HWY_BEFORE_NAMESPACE();
namespace firn {
namespace HWY_NAMESPACE {

/// Linear corotated elastic solid: Hooke's law for the strain S - I that is left when the rotation R of F = R S is
/// taken away (Mueller and Gross 2004; Stomakhin et al. 2012).
///
///   psi = mu |S - I|^2 + lambda/2 (tr(S - I))^2                       J/m^3
///   tau_i = sigma_i (2 mu (sigma_i - 1) + lambda sum (sigma_k - 1))   Pa, along the columns of U
///
/// Valid for every F; as with the fixed corotated model energy and stress stay finite as J -> 0. The volume term is the
/// linear one, so that volume is kept for small strains only: a stretched bar bulges where nu is near 0.5.
template <class T>
struct LinearCorotated {
  static constexpr std::string_view kName = "linear_corotated";
  static constexpr std::string_view kSummary =
      "Hooke's law in a frame that turns with the material; cheap soft bodies.";
  static constexpr std::string_view kSource = "Mueller and Gross 2004; Stomakhin et al. 2012";
  static constexpr std::string_view kFormula =
      "psi = mu |S - I|^2 + lambda/2 tr(S - I)^2; tau_i = sigma_i (2 mu (sigma_i - 1) + lambda sum (sigma_k - 1))";
  static constexpr std::array kParameters = {kYoungsModulus, kPoissonRatio};
  static constexpr std::array<HistoryColumn, 0> kHistory = {};
  static constexpr double kMinimumJ = -std::numeric_limits<double>::infinity();

  T mu, lambda;  // Pa

  HWY_INLINE explicit LinearCorotated(const ModelParameters& parameters)
      : mu(constant<T>(lame_mu(parameters.values[0], parameters.values[1]))),
        lambda(constant<T>(lame_lambda(parameters.values[0], parameters.values[1]))) {}

  HWY_INLINE T volume_ratio(T J, const T* /*history*/) const { return J; }

  template <int dim>
  HWY_INLINE T energy(const Mat<T, dim>& F, const T* /*history*/) const {
    const Vec<T, dim> sigma = svd(F).sigma;
    T trace = T(0), squares = T(0);
    for (int i = 0; i < dim; ++i) {
      const T strain = sigma[i] - T(1);
      trace = trace + strain;
      squares = mul_add(strain, strain, squares);
    }
    return mul_add(mu, squares, T(0.5) * lambda * trace * trace);
  }

  template <int dim>
  HWY_INLINE Response<T, dim> update(Mat<T, dim>& F, T* /*history*/, const Mat<T, dim>& grad_v, T dt) const {
    F = deformed(F, grad_v, dt);
    const Svd<T, dim> s = svd(F);
    Response<T, dim> response;
    T trace = T(0);
    response.J = T(1);
    for (int i = 0; i < dim; ++i) {
      trace = trace + (s.sigma[i] - T(1));
      response.J = response.J * s.sigma[i];
    }
    const T pull = lambda * trace;
    Vec<T, dim> principal;
    for (int i = 0; i < dim; ++i) principal[i] = s.sigma[i] * mul_add(mu + mu, s.sigma[i] - T(1), pull);
    response.tau = rotated_diagonal(s.U, principal);
    response.tau_zz = pull;
    // sigma^2 d2 psi / d sigma^2 along the longest principal stretch.
    response.wave_modulus = (lambda + mu + mu) * max(s.sigma[0] * s.sigma[0], T(1));
    return response;
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace firn
HWY_AFTER_NAMESPACE();

#endif  // FIRN_MATERIALS_LINEAR_COROTATED_INL_H_
