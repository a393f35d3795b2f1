#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace firn {

/// Version of the checkpoint format, docs/checkpoints.md. Readers refuse a higher one.
inline constexpr int kCheckpointFormatVersion = 1;

/// One quantity of all particles of a material, component after component: value c of particle p is
/// values[c * particles + p]. Stored as it is in memory, bit for bit.
struct CheckpointColumn {
  std::string name;
  std::size_t components = 1;
  std::variant<std::vector<float>, std::vector<double>, std::vector<std::uint16_t>, std::vector<std::uint32_t>,
               std::vector<std::uint64_t>>
      values;

  std::size_t value_count() const;
};

/// The particles of one material in the order in which they lie in memory, which decides the order of sums.
struct CheckpointMaterial {
  std::string name;   ///< as in the scene
  std::string model;  ///< its constitutive model
  std::size_t particles = 0;
  std::vector<CheckpointColumn> columns;
  std::map<std::string, double> numbers;  ///< what time step control knows of it
};

/// The state between two steps. What is not a column has a name, so that parts of the simulation with a memory of their
/// own (emitters, sinks, the time step control) add entries without a new format.
struct CheckpointState {
  std::map<std::string, double> numbers;
  std::map<std::string, std::int64_t> counters;
  std::map<std::string, std::string> texts;
  std::vector<CheckpointMaterial> materials;
};

/// Everything that a run needs to go on with the same bits.
struct Checkpoint {
  std::string firn_version;
  std::string arithmetic;  ///< "fused" or "separate" multiply-add: the two families of bits, docs/determinism.md
  std::string layout;      ///< dimension, precision, kernel, cells: what must agree for the columns to mean the same
  std::string scene_text;  ///< the resolved scene
  std::map<std::string, std::string> scene_keys;  ///< of what decides the result, with hashes of the files it names
  CheckpointState state;
  /// The beginning of the frame that `state` lies in, for taking it back; only between frames' ends.
  std::optional<CheckpointState> frame_start;
};

}  // namespace firn
