#pragma once

#include <firn/colliders/collider.h>
#include <firn/scene/settings.h>

namespace firn {

/// A pin as what it does while it acts: a sticky collider that material is inside of. Its grid nodes and particles move
/// with it. Error as make_collider(), and Error(usage) for a pin that moves with a collider whose scale at t = 0 is
/// not 1.
template <int dim>
Collider<dim> pin_collider(const Scene& scene, const PinSettings& pin, double cell_size);

}  // namespace firn
