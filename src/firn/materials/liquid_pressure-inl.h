#if defined(FIRN_MATERIALS_LIQUID_PRESSURE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FIRN_MATERIALS_LIQUID_PRESSURE_INL_H_
#undef FIRN_MATERIALS_LIQUID_PRESSURE_INL_H_
#else
#define FIRN_MATERIALS_LIQUID_PRESSURE_INL_H_
#endif

#include <firn/materials/model-inl.h>

#include <limits>

HWY_BEFORE_NAMESPACE();
namespace firn {
namespace HWY_NAMESPACE {

inline constexpr Parameter kBulkModulus = {
    .name = "bulk_modulus",
    .unit = "Pa",
    .default_value = 1e6,
    .minimum = 1e-3,
    .maximum = 1e13,
    .help =
        "Stiffness against compression. The time step shrinks with its square root: 100 times the largest pressure "
        "keeps density within 1 %, the real 2.2e9 of water is seldom worth it.",
};

inline constexpr Parameter kTaitExponent = {
    .name = "tait_exponent",
    .unit = "",
    .default_value = 7,
    .minimum = 1.01,
    .maximum = 15,
    .help = "How fast a liquid stiffens when compressed; 7 for water.",
};

inline constexpr Parameter kViscosity = {
    .name = "viscosity",
    .unit = "Pa s",
    .default_value = 1e-3,
    .minimum = 0,
    .maximum = 1e9,
    .help = "Shear stress per shear rate. The time step of a viscous liquid shrinks with the square of the cell size.",
    .hint = "water is 1e-3, olive oil 0.08, honey 5 to 10, tar 1e5",
};

inline constexpr Parameter kTensileStrength = {
    .name = "tensile_strength",
    .unit = "Pa",
    .default_value = 1e12,
    .minimum = 0,
    .maximum = 1e12,
    .help = "Tension at which a liquid opens; what opens is empty and forgotten. 1e12 never opens, 0 bears no tension.",
};

/// Tait's law for the pressure of a liquid (Becker and Teschner 2007, eq. 7; Tampubolon et al. 2017), with K the bulk
/// modulus at rest and J the volume ratio:
///
///   p = K / gamma (J^-gamma - 1)                                                 Pa, positive in compression
///   psi = K / gamma ((J^(1 - gamma) - 1) / (gamma - 1) + J - 1)                  J/m^3, p = -d psi / dJ
///   rho_0 c^2 = -J^2 dp/dJ = K J^(1 - gamma)                                     Pa
template <class T>
struct LiquidPressure {
  T K, K_over_gamma;  // Pa
  T gamma;            // -
  T largest_J;        // -, at which the tensile strength is reached

  HWY_INLINE LiquidPressure(double bulk, double exponent, double tensile_strength)
      : K(constant<T>(bulk)),
        K_over_gamma(constant<T>(bulk / exponent)),
        gamma(constant<T>(exponent)),
        largest_J(constant<T>(volume_at(bulk / exponent, exponent, tensile_strength))) {}

  /// J^-gamma.
  HWY_INLINE T power(T J) const { return exp(-(gamma * log(max(J, T(std::numeric_limits<Scalar<T>>::min()))))); }
  HWY_INLINE T pressure(T J) const { return K_over_gamma * (power(J) - T(1)); }
  HWY_INLINE T energy(T J) const { return K_over_gamma * ((J * power(J) - T(1)) / (gamma - T(1)) + (J - T(1))); }
  /// Not below K: where an expanded liquid closes again it is stiff at once.
  HWY_INLINE T wave_modulus(T J) const { return K * max(J * power(J), T(1)); }

  /// J moved forward by dt; what opens beyond the tensile strength is cut off. What is not finite stays so.
  HWY_INLINE T moved(T J, T divergence, T dt) const {
    const T next = mul_add(dt * divergence, J, J);
    return select(next <= T(std::numeric_limits<Scalar<T>>::max()), min(largest_J, next), next);
  }

 private:
  /// No tension exceeds K / gamma: a stronger liquid never opens.
  static double volume_at(double K_over_gamma, double exponent, double tensile_strength) {
    const double left = 1 - tensile_strength / K_over_gamma;
    return left > 0 ? std::pow(left, -1 / exponent) : 1e30;
  }
};

/// Adds 2 viscosity J dev(D), D the symmetric part of grad_v, to tau (and its out-of-plane component): the Kirchhoff
/// stress of a Newtonian liquid, Pa.
template <class T, int dim>
HWY_INLINE void add_viscous_stress(T viscosity_J, const Mat<T, dim>& grad_v, Response<T, dim>& response) {
  const T mean = trace(grad_v) * constant<T>(1.0 / 3);
  for (int i = 0; i < dim; ++i) {
    for (int j = 0; j < dim; ++j) {
      const T rate = i == j ? (grad_v(i, i) - mean) + (grad_v(i, i) - mean) : grad_v(i, j) + grad_v(j, i);
      response.tau(i, j) = mul_add(viscosity_J, rate, response.tau(i, j));
    }
  }
  response.tau_zz = response.tau_zz - (viscosity_J + viscosity_J) * mean;
  response.viscosity = viscosity_J;
}

}  // namespace HWY_NAMESPACE
}  // namespace firn
HWY_AFTER_NAMESPACE();

#endif  // FIRN_MATERIALS_LIQUID_PRESSURE_INL_H_
