#if defined(FIRN_MATERIALS_RANKINE_DAMAGE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FIRN_MATERIALS_RANKINE_DAMAGE_INL_H_
#undef FIRN_MATERIALS_RANKINE_DAMAGE_INL_H_
#else
#define FIRN_MATERIALS_RANKINE_DAMAGE_INL_H_
#endif

#include <firn/materials/crack_band.h>
#include <firn/materials/hencky_strain-inl.h>

HWY_BEFORE_NAMESPACE();
namespace firn {
namespace HWY_NAMESPACE {

/// Brittle solid that cracks in tension and bears pressure across closed cracks: Hooke's law of Hencky strains with
/// damage D in the tensile principal stresses (unilateral damage after Ladeveze 1983; Lemaitre and Desmorat 2005,
/// section 7.2.2), Rankine's criterion, and linear softening of a crack band as wide as a cell h (Bazant and Oh 1983;
/// as in Homel and Herbold 2017).
///
///   E strain_i = tau_i^+ / (1 - D) + tau_i^- - nu (tau_j + tau_k)                      along the columns of U
///   D = max over time of 1 - f_t (E e_f - s) / ((E e_f - f_t) s),  in [0, 1],  s = max tau_i^+ / (1 - D)
///   e_f = 2 G_f / (h f_t)
///
/// Pulled without lateral stress, tau = (1 - D) E strain: up to f_t, then down a straight line to zero at e_f, which
/// takes G_f / h per volume, G_f per area of the crack, whatever h is. A cell of h >= 2 G_f E / f_t^2 would store more
/// than that before it cracks and is refused.
///
/// The law is written for the compliance, because this has a potential for every D: psi = sum tau_i strain_i / 2 with
/// d psi / d D = -sum (tau_i^+ / (1 - D))^2 / (2 E) <= 0, so that closed paths never yield energy. Multiplying the
/// positive principal stresses of the undamaged law by 1 - D has none, and the split of strains by their signs (Miehe
/// 2010) misses G_f by lambda + 2 mu over E.
///
/// The whole strain is elastic: cracks close where they opened, at the strain 0. There is no strength in compression.
/// Valid for J > 0.
template <class T>
struct RankineDamage {
  static constexpr std::string_view kName = "rankine_damage";
  static constexpr std::string_view kSummary =
      "Brittle solid: cracks in tension, closed cracks bear pressure; concrete, ceramics, ice.";
  static constexpr std::string_view kSource = "Ladeveze 1983; Bazant and Oh 1983; Homel and Herbold 2017";
  static constexpr std::string_view kFormula =
      "E strain_i = tau_i^+ / (1 - D) + tau_i^- - nu (tau_j + tau_k); in uniaxial tension (1 - D) E strain falls from "
      "cracking_stress along a line that takes fracture_energy per area of a crack one cell wide";
  static constexpr std::array kParameters = {
      kYoungsModulus,
      kPoissonRatio,
      Parameter{.name = "cracking_stress",
                .unit = "Pa",
                .default_value = 1e3,
                .minimum = 0,
                .maximum = 1e12,
                .minimum_allowed = false,
                .help = "Tensile strength: largest principal stress that undamaged material bears (Rankine)."},
      Parameter{.name = "fracture_energy",
                .unit = "J/m^2",
                .default_value = 1,
                .minimum = 0,
                .maximum = 1e12,
                .minimum_allowed = false,
                .help = "Work that opens a crack, per its area; cells must be smaller than 2 fracture_energy "
                        "youngs_modulus / cracking_stress^2.",
                .hint = "glass is near 10, ice 1, concrete 100"},
  };
  static constexpr std::array<HistoryColumn, 1> kHistory = {
      {{"damage", "", "Share of the stiffness in tension that cracks have taken: 0 whole, 1 broken.", 0}}};
  static constexpr double kMinimumJ = 0;

  T youngs_modulus, modulus;  // Pa; of a bar and of waves
  T poisson_ratio;            // -
  T cracking_strain;          // -, f_t / E
  T opening_strain;           // -, e_f
  T softening;                // -, cracking_strain / (opening_strain - cracking_strain)

  HWY_INLINE explicit RankineDamage(const ModelParameters& parameters)
      : RankineDamage(parameters, parameters.values[2] / parameters.values[0],
                      firn::opening_strain(parameters.values[2], parameters.values[3], parameters.cell_size)) {}

  /// Why the model cannot be used with these parameters; "" if it can.
  static std::string refusal(const ModelParameters& parameters) {
    return crack_band_refusal(parameters.values[0], parameters.values[2], parameters.values[3], parameters.cell_size);
  }

  HWY_INLINE T volume_ratio(T J, const T* /*history*/) const { return J; }

  template <int dim>
  HWY_INLINE T energy(const Mat<T, dim>& F, const T* history) const {
    const Vec<T, 3> strain = hencky_strain(F, T(0)).strain;
    const Vec<T, 3> stress = principal_stress(strain, T(1) - history[0]).tau;
    T sum = stress[0] * strain[0];
    for (int i = 1; i < 3; ++i) sum = mul_add(stress[i], strain[i], sum);
    return T(0.5) * youngs_modulus * sum;
  }

  template <int dim>
  HWY_INLINE Response<T, dim> update(Mat<T, dim>& F, T* history, const Mat<T, dim>& grad_v, T dt) const {
    F = deformed(F, grad_v, dt);
    const HenckyStrain<T, dim> h = hencky_strain(F, T(0));
    const T damage = grown(h.strain, history[0]);
    // Written so that a damage that is not a number stays one, and shows in the stress.
    history[0] = select(damage > history[0], damage, history[0]);
    const Vec<T, 3> stress = principal_stress(h.strain, T(1) - history[0]).tau;

    Response<T, dim> response;
    Vec<T, dim> principal;
    T lowest = T(0);
    for (int i = 0; i < dim; ++i) {
      principal[i] = youngs_modulus * stress[i];
      lowest = min(principal[i], lowest);
    }
    response.tau = rotated_diagonal(h.U, principal);
    response.tau_zz = youngs_modulus * stress[2];
    response.J = h.J;
    // Of the whole material: a crack that closes is as stiff.
    response.wave_modulus = modulus - lowest;
    return response;
  }

  /// Stresses over E.
  struct Principal {
    Vec<T, 3> tau;  ///< nominal, of the cracked material
    T largest;      ///< s, the largest one between the cracks
  };

  /// Inverts the compliance for a sound part 1 - D. With t the trace of tau / E and x_i = strain_i + nu t, tensile
  /// stresses are x_i times (1 - D) / (1 + nu (1 - D)) and others x_i / (1 + nu). What is left is one equation for t,
  /// of which the two sides differ by a convex function of four straight pieces: Newton's steps from the trace of the
  /// undamaged law, which is never too low, reach its zero in four.
  HWY_INLINE Principal principal_stress(const Vec<T, 3>& strain, T sound) const {
    const T per_tension = T(1) / mul_add(poisson_ratio, sound, T(1));
    const T tensile = sound * per_tension, compressive = T(1) / (T(1) + poisson_ratio);
    T trace = (strain[0] + strain[1] + strain[2]) / (T(1) - poisson_ratio - poisson_ratio);
    for (int step = 0; step < 4; ++step) {
      T weights = T(0), weighted = T(0);
      for (int i = 0; i < 3; ++i) {
        const T weight = select(mul_add(poisson_ratio, trace, strain[i]) > T(0), tensile, compressive);
        weights = weights + weight;
        weighted = mul_add(weight, strain[i], weighted);
      }
      trace = weighted / (T(1) - poisson_ratio * weights);
    }
    Principal result;
    result.largest = T(0);
    for (int i = 0; i < 3; ++i) {
      const T x = mul_add(poisson_ratio, trace, strain[i]);
      result.tau[i] = x * select(x > T(0), tensile, compressive);
      result.largest = max(x * per_tension, result.largest);
    }
    return result;
  }

  /// D = damage_of(s(D)) for the present strain, if that is above the old D. The right side falls as D grows, so that
  /// the first substitution is too high and the second too low; the secant through both leaves an error of second order
  /// in the growth. The first alone is late by a step: a bar that is pulled to its strength in ten loses 1 % of it.
  HWY_INLINE T grown(const Vec<T, 3>& strain, T old) const {
    const T high = T(1) - sound_part(principal_stress(strain, T(1) - old).largest);
    const T bounded = select(high > old, high, old);
    const T low = T(1) - sound_part(principal_stress(strain, T(1) - bounded).largest);
    const T rise = bounded - old, fall = max(bounded - low, T(0));
    return old + rise * rise / max(rise + fall, T(std::numeric_limits<Scalar<T>>::min()));
  }

  /// 1 - D for a stress between the cracks, over E.
  HWY_INLINE T sound_part(T stress) const {
    const T softened = softening * (opening_strain / max(stress, cracking_strain) - T(1));
    return select(stress > cracking_strain, max(softened, T(0)), T(1));
  }

 private:
  HWY_INLINE RankineDamage(const ModelParameters& parameters, double cracking, double opening)
      : youngs_modulus(constant<T>(parameters.values[0])),
        modulus(constant<T>(lame_lambda(parameters.values[0], parameters.values[1]) +
                            2 * lame_mu(parameters.values[0], parameters.values[1]))),
        poisson_ratio(constant<T>(parameters.values[1])),
        cracking_strain(constant<T>(cracking)),
        opening_strain(constant<T>(opening)),
        softening(constant<T>(cracking / (opening - cracking))) {}
};

}  // namespace HWY_NAMESPACE
}  // namespace firn
HWY_AFTER_NAMESPACE();

#endif  // FIRN_MATERIALS_RANKINE_DAMAGE_INL_H_
