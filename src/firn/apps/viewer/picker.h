#pragma once

#include <firn/apps/viewer/orbit_camera.h>
#include <firn/render/scene_view.h>
#include <firn/simulation/simulation.h>
#include <firn/state/snapshot.h>

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace firn {

/// What is under the mouse.
struct Picked {
  enum class Kind { nothing, particle, collider };
  Kind kind = Kind::nothing;
  std::int64_t id = 0;  ///< of a particle
  int collider = -1;    ///< number in the scene
  Vec3d point = {};     ///< where the line of sight meets it, m
};

/// The nearest thing that the line of sight meets: a ball of the drawn radius around each particle,
/// or a collider of the view that is not of glass.
/// @param hidden normal and offset (m) of a plane beyond which particles are not seen; a zero normal for none
Picked pick(const Snapshot& snapshot, const View& view, const Ray& ray, const std::pair<Vec3d, double>& hidden = {});

/// Place of a particle with this id in the snapshot; nothing if it is gone.
std::optional<std::size_t> find_particle(const Snapshot& snapshot, std::int64_t id);

/// A named number as the panel shows it.
struct Reading {
  std::string name, value;
};

/// All columns of one particle.
std::vector<Reading> read_particle(const Snapshot& snapshot, std::size_t particle);
/// The grid cell around a point: its place, how many particles are in it, and their means.
std::vector<Reading> read_cell(const Snapshot& snapshot, const Vec3d& point);
/// A collider of the scene, and what it bears.
std::vector<Reading> read_collider(const Scene& scene, int collider, const FrameReport& report);

}  // namespace firn
