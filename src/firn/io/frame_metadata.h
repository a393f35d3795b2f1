#pragma once

#include <cstdint>
#include <string>

namespace firn {

/// Version of the /Firn group of frame files. Readers refuse a higher one.
inline constexpr int kFrameFormatVersion = 1;

/// What a frame file says about its run beside the snapshot itself. Nothing in it may depend on the machine, the clock
/// or the number of threads: equal runs give equal bytes.
struct FrameMetadata {
  std::int64_t frame = 1;    ///< frame 1 is t = 0
  std::string precision;     ///< "single" or "double": of the simulation
  std::string scene_hash;    ///< of the resolved scene
  std::string firn_version;  ///< of the program that computed the frame
  std::string up = "y";      ///< axis that points up: "y" or "z"; "" in frames that do not tell
};

}  // namespace firn
