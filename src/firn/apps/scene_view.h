#pragma once

#include <firn/render/scene_view.h>
#include <firn/scene/settings.h>

namespace firn {

/// How the scene asks to be drawn: size, colours, camera and, where they are at time t, its colliders.
View scene_view(const Scene& scene, double t);

}  // namespace firn
