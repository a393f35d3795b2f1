#pragma once

#include <firn/geometry/deforming_shape.h>
#include <firn/geometry/triangle_mesh.h>
#include <firn/scene/settings.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace firn {

/// The solid of a mesh or level set sequence in the collider's frame. Warns of a cycle whose last form is not its
/// first. Throws Error, with the name of the collider, for files that cannot be used.
std::shared_ptr<const DeformingShape<3>> deforming_shape(const Scene& scene, const ColliderSettings& settings);

}  // namespace firn
