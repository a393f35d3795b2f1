#if defined(FIRN_MATERIALS_OLDROYD_B_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FIRN_MATERIALS_OLDROYD_B_INL_H_
#undef FIRN_MATERIALS_OLDROYD_B_INL_H_
#else
#define FIRN_MATERIALS_OLDROYD_B_INL_H_
#endif

#include <firn/materials/liquid_pressure-inl.h>

HWY_BEFORE_NAMESPACE();
namespace firn {
namespace HWY_NAMESPACE {

/// Viscoelastic liquid of Oldroyd-B type: a polymer with conformation b, the left Cauchy-Green tensor of its elastic
/// part, in a Newtonian solvent (Oldroyd 1950; Ram et al. 2015), with the pressure of a weakly compressible liquid.
///
///   db/dt = grad_v b + b grad_v^T - (b - I) / relaxation_time
///   tau = shear_modulus (b - I) - J p(J) I + 2 viscosity J dev(D)                Pa
///   psi = shear_modulus/2 (tr b - 3 - ln det b) + psi_p(J)                       J/m^3
///
/// A step deforms b by (I + dt grad_v) b (I + dt grad_v)^T and then relaxes it exactly, b <- I + (b - I)
/// exp(-dt/lambda). Both keep b symmetric and positive definite, whatever dt, which is why b and not the stress is
/// integrated. Steady shear at rate g has the viscosity shear_modulus lambda + viscosity and the normal stress
/// difference 2 shear_modulus lambda^2 g^2; elongation faster than 1 / (2 lambda) grows without bound, as the law says.
///
/// The strain is b (on and above the diagonal; in plane strain b_zz = 1), J is a history column. Valid for J > 0.
template <class T>
struct OldroydB {
  static constexpr std::string_view kName = "oldroyd_b";
  static constexpr std::string_view kSummary =
      "Liquid with a memory: slime and dough, springy at once and runny later.";
  static constexpr std::string_view kSource = "Oldroyd 1950; Ram et al. 2015";
  static constexpr std::string_view kFormula =
      "db/dt = grad_v b + b grad_v^T - (b - I) / relaxation_time; tau = shear_modulus (b - I) - J p I + 2 viscosity J "
      "dev(D), p of newtonian_fluid";
  static constexpr std::array kParameters = {
      kBulkModulus,
      kTaitExponent,
      kViscosity,
      Parameter{.name = "shear_modulus",
                .unit = "Pa",
                .default_value = 1e3,
                .minimum = 0,
                .maximum = 1e12,
                .help = "Shear stiffness against fast deformation."},
      Parameter{.name = "relaxation_time",
                .unit = "s",
                .default_value = 0.5,
                .minimum = 1e-9,
                .maximum = 1e12,
                .help = "Time after which 63 % of the elastic stress is forgotten."},
  };
  static constexpr std::array<HistoryColumn, 1> kHistory = {
      {{"liquid_J", "", "Volume ratio of a viscoelastic liquid.", 1}}};
  static constexpr double kMinimumJ = 0;
  static constexpr StrainKind kStrain = StrainKind::conformation;
  static constexpr bool kViscous = true;

  LiquidPressure<T> liquid;
  T viscosity;      // Pa s
  T shear_modulus;  // Pa
  T rate;           // 1/s, of relaxation

  HWY_INLINE explicit OldroydB(const ModelParameters& parameters)
      : liquid(parameters.values[0], parameters.values[1], 1e30),
        viscosity(constant<T>(parameters.values[2])),
        shear_modulus(constant<T>(parameters.values[3])),
        rate(constant<T>(1 / parameters.values[4])) {}

  HWY_INLINE T volume_ratio(T /*J*/, const T* history) const { return history[0]; }

  template <int dim>
  HWY_INLINE T energy(const Mat<T, dim>& b, const T* history) const {
    const Mat<T, dim> full = mirrored(b);
    return T(0.5) * shear_modulus * (trace(full) - T(dim) - log(determinant(full))) + liquid.energy(history[0]);
  }

  template <int dim>
  HWY_INLINE Response<T, dim> update(Mat<T, dim>& b, T* history, const Mat<T, dim>& grad_v, T dt) const {
    const Mat<T, dim> half = deformed(mirrored(b), grad_v, dt);
    const Mat<T, dim> trial = transpose(deformed(transpose(half), grad_v, dt));
    const T left = exp(-(dt * rate));
    const T J = liquid.moved(history[0], trace(grad_v), dt);
    history[0] = J;
    Response<T, dim> response;
    response.tau_zz = -(J * liquid.pressure(J));
    for (int i = 0; i < dim; ++i) {
      for (int j = i; j < dim; ++j) {
        const T strain = left * (i == j ? trial(i, i) - T(1) : T(0.5) * (trial(i, j) + trial(j, i)));
        b(i, j) = i == j ? T(1) + strain : strain;
        response.tau(i, j) = response.tau(j, i) = shear_modulus * strain + (i == j ? response.tau_zz : T(0));
      }
    }
    // Positive in exact arithmetic: a determinant that is not comes from a spoiled or a hopelessly long state.
    response.J = select(determinant(trial) > T(0), J, T(0));
    add_viscous_stress(viscosity * J, grad_v, response);
    // d tau_ii / d strain_ii - tau_ii of the polymer is shear_modulus (b_ii + 1).
    T longest = b(0, 0);
    for (int i = 1; i < dim; ++i) longest = longest + b(i, i);
    response.wave_modulus = liquid.wave_modulus(J) + shear_modulus * (T(1) + max(longest - T(dim - 1), T(1)));
    return response;
  }

 private:
  template <int dim>
  static HWY_INLINE Mat<T, dim> mirrored(const Mat<T, dim>& b) {
    Mat<T, dim> full;
    for (int i = 0; i < dim; ++i) {
      for (int j = 0; j < dim; ++j) full(i, j) = i <= j ? b(i, j) : b(j, i);
    }
    return full;
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace firn
HWY_AFTER_NAMESPACE();

#endif  // FIRN_MATERIALS_OLDROYD_B_INL_H_
