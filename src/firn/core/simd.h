#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace firn {

/// Name of the instruction set that per-target code runs on: "baseline", "avx2" or "avx512" on x86-64. The first call
/// obeys the environment variable FIRN_SIMD; an unknown or unavailable name there is an Error(usage) that lists the
/// names.
std::string simd_target();

/// Names that this processor can run, narrowest first; the last one is the default.
std::vector<std::string> available_simd_targets();

/// Makes per-target code run on the named instruction set from now on. Not to be called while a simulation runs.
/// Error(usage) if the name is unknown or the processor lacks it.
void select_simd_target(std::string_view name);

}  // namespace firn

/// The per-target version of an HWY_EXPORTed function that the selected instruction set calls for. The one place where
/// a target is chosen.
#define FIRN_DISPATCH(function) (::firn::simd_target(), HWY_DYNAMIC_DISPATCH(function))
