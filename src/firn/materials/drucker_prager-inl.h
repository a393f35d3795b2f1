#if defined(FIRN_MATERIALS_DRUCKER_PRAGER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FIRN_MATERIALS_DRUCKER_PRAGER_INL_H_
#undef FIRN_MATERIALS_DRUCKER_PRAGER_INL_H_
#else
#define FIRN_MATERIALS_DRUCKER_PRAGER_INL_H_
#endif

#include <firn/materials/friction_angle.h>
#include <firn/materials/hencky_strain-inl.h>

HWY_BEFORE_NAMESPACE();
namespace firn {
namespace HWY_NAMESPACE {

/// Sand: Hencky elasticity with the Drucker-Prager cone (Klar et al. 2016), volume correction (Tampubolon et al. 2017)
/// and cohesion. With p = -tr(tau)/3, positive in compression, and q = sqrt(3/2) |dev tau|,
///
///   q <= M (p + p_t),   M = 6 sin phi / (3 - sin phi),   p_t = c cot phi
///
/// which is the Mohr-Coulomb law of friction angle phi and cohesion c in triaxial compression. In strains it reads
/// |dev| <= slope (t - tr), slope = sqrt(3/2) M K / (3 mu) with the bulk modulus K, t = p_t / K.
///
/// Outside the cone the deviator is scaled back at constant volume (no dilatancy: grains do not swell when sheared).
/// Beyond its tip the grains part: the strain becomes zero, and the volume that opens is added to log_Jp. It has to
/// close before grains touch again, else sand would swell by every stretch that it recovers from. Open sand has no
/// cohesion; closed, it has it again, as wet sand.
///
/// Plane strain is the slice of three dimensions, with M of three dimensions: sheared without change of volume, sand
/// rests at tan(slope) = M / sqrt(3), 34.7 degrees for phi = 30. The stored strain is Fe. Valid for J > 0.
template <class T>
struct DruckerPrager {
  static constexpr std::string_view kName = "drucker_prager";
  static constexpr std::string_view kSummary = "Sand and other grains: friction in proportion to pressure.";
  static constexpr std::string_view kSource = "Klar et al. 2016; Tampubolon et al. 2017";
  static constexpr std::string_view kFormula = "tau of hencky; q <= M (p + c cot phi), M = 6 sin phi / (3 - sin phi)";
  static constexpr std::array kParameters = {
      kYoungsModulus,
      kPoissonRatio,
      kFrictionAngle,
      Parameter{.name = "cohesion",
                .unit = "Pa",
                .default_value = 0,
                .minimum = 0,
                .maximum = 1e12,
                .help = "Shear stress that closed grains bear without pressure; 0 for dry sand."},
      kDilationLimit,
  };
  static constexpr std::array<HistoryColumn, 2> kHistory = {{kLogJp, kElasticStrainZz}};
  static constexpr double kMinimumJ = 0;

  T mu, lambda;      // Pa
  T slope;           // -, |dev strain| per volume strain
  T tip;             // -, volume strain at the tip of the cone
  T dilation_limit;  // -

  HWY_INLINE explicit DruckerPrager(const ModelParameters& parameters)
      : mu(constant<T>(lame_mu(parameters.values[0], parameters.values[1]))),
        lambda(constant<T>(lame_lambda(parameters.values[0], parameters.values[1]))),
        slope(constant<T>(std::sqrt(1.5) * friction_slope(parameters.values[2]) *
                          bulk_modulus(parameters.values[0], parameters.values[1]) /
                          (3 * lame_mu(parameters.values[0], parameters.values[1])))),
        tip(constant<T>(tension_limit(parameters.values[2], parameters.values[3]) /
                        bulk_modulus(parameters.values[0], parameters.values[1]))),
        dilation_limit(constant<T>(parameters.values[4])) {}

  HWY_INLINE T volume_ratio(T J, const T* history) const { return J * exp(history[0] + history[1]); }

  template <int dim>
  HWY_INLINE T energy(const Mat<T, dim>& Fe, const T* history) const {
    return hencky_energy(mu, lambda, hencky_strain(Fe, dim == 2 ? history[1] : T(0)).strain);
  }

  template <int dim>
  HWY_INLINE Response<T, dim> update(Mat<T, dim>& Fe, T* history, const Mat<T, dim>& grad_v, T dt) const {
    Fe = deformed(Fe, grad_v, dt);
    HenckyStrain<T, dim> h = hencky_strain(Fe, dim == 2 ? history[1] : T(0));
    const StrainParts<T> trial = split(h.strain);
    const T trace = trial.trace + history[0];  // what has opened closes first
    const auto closed = history[0] == T(0);
    const auto parted = trace > select(closed, tip, T(0));
    const T radius = slope * (tip - trace);
    const auto sliding = trial.norm > radius;
    const T factor = select(sliding, radius / trial.norm, T(1));
    const Vec<T, 3> touching = join(trace, factor, trial.deviator);
    Vec<T, 3> strain;
    for (int i = 0; i < 3; ++i) strain[i] = select(parted, T(0), touching[i]);
    return_to(strain, parted || sliding || !closed, h, Fe, history + 1);
    history[0] = select(parted, min(trace, dilation_limit), T(0));
    return hencky_response(mu, lambda, h);
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace firn
HWY_AFTER_NAMESPACE();

#endif  // FIRN_MATERIALS_DRUCKER_PRAGER_INL_H_
