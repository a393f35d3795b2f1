#pragma once

#include <firn/scene/schema.h>
#include <firn/scene/settings.h>

#include <string>
#include <vector>

namespace firn {

/// What of a scene may change while it is simulated: what steps read anew each time and no particle remembers, such as
/// gravity, limits, friction and the parameters of models. Densities and whatever places particles are not of that
/// kind.
bool is_live(const Section& section, const Key& key);

/// `running` with everything of `wanted` that may change while it is simulated: the live keys of objects that both
/// have, and the materials, colliders, emitters and fields that `wanted` has at the end of these lists and `running`
/// has not. A parameter is live only where the material's model is the same and no particle has a value of its own.
Scene live_part(const Scene& running, const Scene& wanted);

/// True if a simulation of `running` can take over all that decides the result of `wanted`.
bool is_all_live(const Scene& running, const Scene& wanted);

/// What a simulation takes over with a change, one line each: "material.snow.youngs_modulus = 2e5", "a field pull1".
std::vector<std::string> live_differences(const Scene& before, const Scene& after);

}  // namespace firn
