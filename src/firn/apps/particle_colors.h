#pragma once

#include <firn/core/linear_algebra.h>
#include <firn/scene/settings.h>
#include <firn/state/snapshot.h>

#include <vector>

namespace firn {

/// Linear RGB of every particle: of its body in the scene, or of the look of its material.
/// @param scene may be null
std::vector<Vec3f> particle_colors(const Snapshot& snapshot, const Scene* scene);

/// Adds the column "color" (point_files.h) with them.
void add_color_column(Snapshot& snapshot, const Scene* scene);
/// The same as linear RGB, 0 to 1, as volumes have it.
void add_light_column(Snapshot& snapshot, const Scene* scene);

}  // namespace firn
