#pragma once

#include <firn/render/particle_color.h>
#include <firn/render/scene_view.h>

namespace firn {

/// render_snapshot without text, in 3D: nearest hits of camera rays, lit by the sun with soft shadows and by the sky
/// with ambient occlusion.
Image cast_picture(const Snapshot& snapshot, const View& view, const Camera& camera, const ParticleLooks& looks);

/// The same in 2D: particles as disks, colliders cut by the plane of the picture.
Image flat_picture(const Snapshot& snapshot, const View& view, const Camera& camera, const ParticleLooks& looks);

}  // namespace firn
