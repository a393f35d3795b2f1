// What every constitutive model shares. A model is a template over T (a number or Lanes) in a file of its own:
//
//   template <class T> struct Name {
//     static constexpr std::string_view kName, kSummary, kSource, kFormula;
//     static constexpr std::array kParameters = {...};           Parameter, in the order of ModelParameters::values
//     static constexpr std::array<HistoryColumn, n> kHistory;    per-particle memory besides the strain
//     static constexpr double kMinimumJ;                         states with J at or below it are reported as failed
//     static constexpr StrainKind kStrain;                       what is stored of the strain; F where it is left out
//     static constexpr bool kViscous = true;                     sets Response::viscosity; false where it is left out
//     explicit Name(const ModelParameters&);
//     template <int dim> T energy(const Mat<T, dim>& F, const T* history) const;       J/m^3, undeformed
//     template <int dim> Response<T, dim> update(Mat<T, dim>& F, T* history, const Mat<T, dim>& grad_v, T dt) const;
//     T volume_ratio(T J, const T* history) const;               J is the determinant of the strain matrix
//     static std::string refusal(const ModelParameters&);        see ModelInfo; may be left out
//   };
//
// All members are T or structs of T: where parameters vary, the lanes of a model are made of the models of single
// particles. F is the strain matrix, of which only the entries of kStrain mean anything. Two dimensions mean plane
// strain: F_zz = 1.

#if defined(FIRN_MATERIALS_MODEL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FIRN_MATERIALS_MODEL_INL_H_
#undef FIRN_MATERIALS_MODEL_INL_H_
#else
#define FIRN_MATERIALS_MODEL_INL_H_
#endif

#include <firn/core/linear_algebra-inl.h>
#include <firn/core/svd-inl.h>
#include <firn/materials/history_column.h>
#include <firn/materials/model_parameters.h>
#include <firn/materials/strain_kind.h>

#include <array>
#include <string_view>

HWY_BEFORE_NAMESPACE();
namespace firn {
namespace HWY_NAMESPACE {

/// What a model answers for one state.
template <class T, int dim>
struct Response {
  Mat<T, dim> tau;  ///< Kirchhoff stress P F^T = J sigma, Pa; tension is positive
  T tau_zz;         ///< out-of-plane Kirchhoff stress, Pa; only used in two dimensions
  T J;              ///< det F of the strain that is stored
  T wave_modulus;   ///< Pa: density times the square of the fastest elastic wave's speed
  T viscosity;      ///< Pa s, dynamic viscosity times J; set by models with kViscous only
};

/// What a model stores of the strain.
template <class Model>
constexpr StrainKind strain_kind() {
  if constexpr (requires { Model::kStrain; }) return Model::kStrain;
  return StrainKind::deformation_gradient;
}

/// Whether a model answers with a viscosity, which limits the time step.
template <class Model>
constexpr bool is_viscous() {
  if constexpr (requires { Model::kViscous; }) return Model::kViscous;
  return false;
}

/// A parameter or a constant as T.
template <class T>
HWY_INLINE T constant(double value) {
  return T(static_cast<Scalar<T>>(value));
}

/// (I + dt grad_v) F, the explicit update of the deformation gradient (Jiang et al. 2016, eq. 181).
template <class T, int dim>
HWY_INLINE Mat<T, dim> deformed(const Mat<T, dim>& F, const Mat<T, dim>& grad_v, T dt) {
  Mat<T, dim> r;
  for (int i = 0; i < dim; ++i) {
    for (int j = 0; j < dim; ++j) {
      T s = grad_v(i, 0) * F(0, j);
      for (int k = 1; k < dim; ++k) s = mul_add(grad_v(i, k), F(k, j), s);
      r(i, j) = mul_add(dt, s, F(i, j));
    }
  }
  return r;
}

/// U diag(d) U^T.
template <class T, int dim>
HWY_INLINE Mat<T, dim> rotated_diagonal(const Mat<T, dim>& U, const Vec<T, dim>& d) {
  return compose(U, d, U);
}

}  // namespace HWY_NAMESPACE
}  // namespace firn
HWY_AFTER_NAMESPACE();

#endif  // FIRN_MATERIALS_MODEL_INL_H_
