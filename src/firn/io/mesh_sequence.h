#pragma once

#include <firn/geometry/deforming_mesh.h>

#include <filesystem>
#include <vector>

namespace firn {

/// Reads meshes (see read_mesh()) that differ in the positions of their vertices only; one for each entry of the clock.
/// Vertices that are at one place in all of them become one, and triangles with a corner twice go. The first mesh is
/// judged as prepare_mesh() does, with its warnings; a surface that is inside out there is flipped throughout.
///
/// Throws Error as read_mesh() and prepare_mesh(), and Error (usage), with both files, for meshes whose vertices or
/// triangles are not the same ones and for a surface that is turned inside out later on.
MeshSequence read_mesh_sequence(const std::vector<std::filesystem::path>& files, SequenceClock clock,
                                bool strict = false);

}  // namespace firn
