// Logarithmic (Hencky) strain and the elasticity that is linear in it: shared by the elastic model and by the plastic
// ones, whose return maps are plain vector operations on principal logarithmic strains.

#if defined(FIRN_MATERIALS_HENCKY_STRAIN_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FIRN_MATERIALS_HENCKY_STRAIN_INL_H_
#undef FIRN_MATERIALS_HENCKY_STRAIN_INL_H_
#else
#define FIRN_MATERIALS_HENCKY_STRAIN_INL_H_
#endif

#include <firn/materials/model-inl.h>

#include <limits>

HWY_BEFORE_NAMESPACE();
namespace firn {
namespace HWY_NAMESPACE {

/// F = U diag(exp(strain)) V^T. There are three strains in two dimensions too: the last one is out of plane.
template <class T, int dim>
struct HenckyStrain {
  Mat<T, dim> U, V;
  Vec<T, 3> strain;
  T J;  ///< det F, in the plane in two dimensions; where it is not positive or NaN, the strain means nothing
};

/// @param strain_zz the out-of-plane strain; without meaning in three dimensions
template <class T, int dim>
HWY_INLINE HenckyStrain<T, dim> hencky_strain(const Mat<T, dim>& F, T strain_zz) {
  const Svd<T, dim> s = svd(F);
  HenckyStrain<T, dim> h;
  h.U = s.U;
  h.V = s.V;
  h.strain[2] = strain_zz;
  h.J = s.sigma[0];
  for (int i = 1; i < dim; ++i) h.J = h.J * s.sigma[i];
  // Lanes give no promise for the logarithm of what is not positive; J keeps the record.
  for (int i = 0; i < dim; ++i) h.strain[i] = log(max(s.sigma[i], T(std::numeric_limits<Scalar<T>>::min())));
  return h;
}

/// A strain as its mean and what is left, the change of shape.
template <class T>
struct StrainParts {
  T trace;
  Vec<T, 3> deviator;
  T norm;  ///< |deviator|
};

template <class T>
HWY_INLINE StrainParts<T> split(const Vec<T, 3>& strain) {
  StrainParts<T> parts;
  parts.trace = strain[0] + strain[1] + strain[2];
  const T mean = parts.trace * constant<T>(1.0 / 3);
  T sum = T(0);
  for (int i = 0; i < 3; ++i) {
    parts.deviator[i] = strain[i] - mean;
    sum = mul_add(parts.deviator[i], parts.deviator[i], sum);
  }
  parts.norm = sqrt(sum);
  return parts;
}

/// trace / 3 + factor * deviator.
template <class T>
HWY_INLINE Vec<T, 3> join(T trace, T factor, const Vec<T, 3>& deviator) {
  const T mean = trace * constant<T>(1.0 / 3);
  Vec<T, 3> strain;
  for (int i = 0; i < 3; ++i) strain[i] = mul_add(factor, deviator[i], mean);
  return strain;
}

/// Replaces the elastic strain where `yielded` holds, in h, in F and, in two dimensions, in the history column
/// strain_zz. Elsewhere F keeps the bits of its trial state instead of recomposed ones.
template <class T, int dim, class Mask>
HWY_INLINE void return_to(const Vec<T, 3>& strain, const Mask& yielded, HenckyStrain<T, dim>& h, Mat<T, dim>& F,
                          T* strain_zz) {
  Vec<T, dim> sigma;
  T J = T(1);
  for (int i = 0; i < dim; ++i) {
    sigma[i] = exp(strain[i]);
    J = J * sigma[i];
  }
  const Mat<T, dim> returned = compose(h.U, sigma, h.V);
  for (int e = 0; e < dim * dim; ++e) F.e[e] = select(yielded, returned.e[e], F.e[e]);
  for (int i = 0; i < 3; ++i) h.strain[i] = select(yielded, strain[i], h.strain[i]);
  if constexpr (dim == 2) *strain_zz = h.strain[2];
  // exp() makes J positive whatever came in; what was turned inside out stays on record.
  h.J = select(yielded && h.J > T(0), J, h.J);
}

/// psi = mu sum strain_i^2 + lambda/2 (sum strain_i)^2, J/m^3.
template <class T>
HWY_INLINE T hencky_energy(T mu, T lambda, const Vec<T, 3>& strain) {
  const T trace = strain[0] + strain[1] + strain[2];
  T squares = strain[0] * strain[0];
  for (int i = 1; i < 3; ++i) squares = mul_add(strain[i], strain[i], squares);
  return mul_add(mu, squares, T(0.5) * lambda * trace * trace);
}

/// tau_i = 2 mu strain_i + lambda sum strain_k, along the columns of U, Pa.
template <class T, int dim>
HWY_INLINE Response<T, dim> hencky_response(T mu, T lambda, const HenckyStrain<T, dim>& h) {
  const T pressure_term = lambda * (h.strain[0] + h.strain[1] + h.strain[2]);
  Response<T, dim> response;
  Vec<T, dim> principal;
  T lowest = T(0);
  for (int i = 0; i < dim; ++i) {
    principal[i] = mul_add(mu + mu, h.strain[i], pressure_term);
    lowest = min(principal[i], lowest);
  }
  response.tau = rotated_diagonal(h.U, principal);
  response.tau_zz = mul_add(mu + mu, h.strain[2], pressure_term);
  response.J = h.J;
  // d tau_i / d strain_i - tau_i: squeezed material is stiffer in space.
  response.wave_modulus = (lambda + mu + mu) - lowest;
  return response;
}

}  // namespace HWY_NAMESPACE
}  // namespace firn
HWY_AFTER_NAMESPACE();

#endif  // FIRN_MATERIALS_HENCKY_STRAIN_INL_H_
