// The list of constitutive models. Adding a model is one file, one line here, one test: scene keys, help, checks,
// columns, dispatch and the contract test follow.

#if defined(FIRN_MATERIALS_MODELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FIRN_MATERIALS_MODELS_INL_H_
#undef FIRN_MATERIALS_MODELS_INL_H_
#else
#define FIRN_MATERIALS_MODELS_INL_H_
#endif

#include <firn/materials/cam_clay-inl.h>
#include <firn/materials/drucker_prager-inl.h>
#include <firn/materials/fixed_corotated-inl.h>
#include <firn/materials/hencky-inl.h>
#include <firn/materials/herschel_bulkley-inl.h>
#include <firn/materials/linear_corotated-inl.h>
#include <firn/materials/neo_hookean-inl.h>
#include <firn/materials/newtonian_fluid-inl.h>
#include <firn/materials/oldroyd_b-inl.h>
#include <firn/materials/rankine_damage-inl.h>
#include <firn/materials/snow-inl.h>
#include <firn/materials/von_mises-inl.h>

HWY_BEFORE_NAMESPACE();
namespace firn {
namespace HWY_NAMESPACE {

template <template <class> class... Models>
struct ModelList {
  static constexpr int kCount = sizeof...(Models);
};

using AllModels = ModelList<FixedCorotated, NeoHookean, Hencky, LinearCorotated, Snow, DruckerPrager, VonMises, CamClay,
                            HerschelBulkley, OldroydB, NewtonianFluid, RankineDamage>;

}  // namespace HWY_NAMESPACE
}  // namespace firn
HWY_AFTER_NAMESPACE();

#endif  // FIRN_MATERIALS_MODELS_INL_H_
