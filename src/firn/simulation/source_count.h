#pragma once

#include <cstdint>

namespace firn {

/// Particles that an emitter has made, or a sink removed, since the start.
struct SourceCount {
  std::int64_t particles = 0;
  double mass = 0;  ///< kg
};

}  // namespace firn
