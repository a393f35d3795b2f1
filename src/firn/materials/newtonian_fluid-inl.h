#if defined(FIRN_MATERIALS_NEWTONIAN_FLUID_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FIRN_MATERIALS_NEWTONIAN_FLUID_INL_H_
#undef FIRN_MATERIALS_NEWTONIAN_FLUID_INL_H_
#else
#define FIRN_MATERIALS_NEWTONIAN_FLUID_INL_H_
#endif

#include <firn/materials/liquid_pressure-inl.h>

HWY_BEFORE_NAMESPACE();
namespace firn {
namespace HWY_NAMESPACE {

/// Water, honey: a weakly compressible Newtonian liquid (Becker and Teschner 2007; Tampubolon et al. 2017).
///
///   tau = -J p(J) I + 2 viscosity J dev(D)          Pa, p by LiquidPressure, D = (grad_v + grad_v^T) / 2
///   J <- J (1 + dt tr(grad_v))
///
/// The stored strain is J alone: a liquid forgets its shape, and F would degenerate. Valid for J > 0. The viscous
/// stress is that of the velocity gradient of the step, also with dt = 0. An explicit step needs dt <= factor rho dx^2
/// / viscosity besides the limit of the acoustic wave.
template <class T>
struct NewtonianFluid {
  static constexpr std::string_view kName = "newtonian_fluid";
  static constexpr std::string_view kSummary = "Weakly compressible liquid with constant viscosity: water, oil, honey.";
  static constexpr std::string_view kSource = "Becker and Teschner 2007; Tampubolon et al. 2017";
  static constexpr std::string_view kFormula =
      "p = bulk_modulus / gamma (J^-gamma - 1); tau = -J p I + 2 viscosity J dev(D)";
  static constexpr std::array kParameters = {kBulkModulus, kTaitExponent, kViscosity, kTensileStrength};
  static constexpr std::array<HistoryColumn, 0> kHistory = {};
  static constexpr double kMinimumJ = 0;
  static constexpr StrainKind kStrain = StrainKind::volume_ratio;
  static constexpr bool kViscous = true;

  LiquidPressure<T> liquid;
  T viscosity;  // Pa s

  HWY_INLINE explicit NewtonianFluid(const ModelParameters& parameters)
      : liquid(parameters.values[0], parameters.values[1], parameters.values[3]),
        viscosity(constant<T>(parameters.values[2])) {}

  HWY_INLINE T volume_ratio(T J, const T* /*history*/) const { return J; }

  template <int dim>
  HWY_INLINE T energy(const Mat<T, dim>& F, const T* /*history*/) const {
    return liquid.energy(F(0, 0));
  }

  template <int dim>
  HWY_INLINE Response<T, dim> update(Mat<T, dim>& F, T* /*history*/, const Mat<T, dim>& grad_v, T dt) const {
    const T J = liquid.moved(F(0, 0), trace(grad_v), dt);
    F(0, 0) = J;
    Response<T, dim> response = {};
    response.J = J;
    response.tau_zz = -(J * liquid.pressure(J));
    for (int i = 0; i < dim; ++i) response.tau(i, i) = response.tau_zz;
    add_viscous_stress(viscosity * J, grad_v, response);
    response.wave_modulus = liquid.wave_modulus(J);
    return response;
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace firn
HWY_AFTER_NAMESPACE();

#endif  // FIRN_MATERIALS_NEWTONIAN_FLUID_INL_H_
