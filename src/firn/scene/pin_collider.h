#pragma once

#include <firn/colliders/collider.h>
#include <firn/scene/settings.h>

namespace firn {

/// A pin as what it does while it acts: a sticky collider that material is inside of. Its grid nodes and particles move
/// with it.
template <int dim>
Collider<dim> pin_collider(const PinSettings& pin);

}  // namespace firn
