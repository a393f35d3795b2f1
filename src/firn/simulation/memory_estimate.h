#pragma once

#include <firn/scene/build_world.h>
#include <firn/scene/settings.h>

#include <cstdint>
#include <string>
#include <vector>

namespace firn {

/// One of the arrays that a run keeps or needs now and then.
struct MemoryUse {
  std::string name;
  double bytes = 0;
};

/// Particles that an emitter with a rate makes in the whole run; 0 for one that keeps its shape full, which only the
/// run can tell.
double emitted_particles(const Scene& scene, const EmitterSettings& emitter, const WorldPlan& plan);

/// The arrays of a run with their sizes, the largest first; columns exactly, the grid for bodies without gaps,
/// both with all that emitters with a rate make.
std::vector<MemoryUse> memory_estimate(const Scene& scene, const WorldPlan& plan);

/// Bytes of one checkpoint at the end of a frame, with all that emitters with a rate make; in the middle of one it is
/// twice as large.
double checkpoint_bytes(const Scene& scene, const WorldPlan& plan);

/// "out of memory ...": the largest arrays by name and size, and what to do.
/// @param plan null if there is none yet
std::string memory_message(const Scene& scene, const WorldPlan* plan);

}  // namespace firn
