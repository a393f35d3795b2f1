#pragma once

#include <firn/scene/settings.h>
#include <firn/seeding/sampling.h>

namespace firn {

/// Share of a body's samples outside limits.box. With limits.clip they are left out, and a warning tells the share;
/// otherwise Error(usage) does. Error(usage) also if nothing of the body is inside. 0 without a box.
template <int dim>
double clip_to_box(const Scene& scene, const BodySettings& body, Samples<dim>& samples);

}  // namespace firn
