#include <firn/io/checkpoint_file.h>
#include <fmt/format.h>

#include "fuzz/edited_hdf5.h"
#include "fuzz/fuzz_target.h"
#include "io/checkpoint_samples.h"

using namespace firn;

namespace {

CheckpointStamp stamp(const std::vector<std::byte>& bytes) {
  return stamp_of({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

void require_consistent(const CheckpointState& state) {
  for (const CheckpointMaterial& material : state.materials) {
    for (const CheckpointColumn& column : material.columns) {
      fuzz::require(column.components >= 1, "a column without components was accepted");
      fuzz::require(column.value_count() == column.components * material.particles,
                    fmt::format("column \"{}\" has {} values", column.name, column.value_count()));
    }
  }
}

/// What is accepted comes back in the same bytes.
void read(const std::vector<std::byte>& bytes) {
  const Checkpoint checkpoint = parse_checkpoint(bytes, stamp(bytes), "checkpoint.h5");
  require_consistent(checkpoint.state);
  if (checkpoint.frame_start) require_consistent(*checkpoint.frame_start);
  const auto written =
      fuzz::must_accept("a checkpoint that was read is not written", [&] { return checkpoint_bytes(checkpoint); });
  const Checkpoint again = fuzz::must_accept("a checkpoint of ours is refused",
                                             [&] { return parse_checkpoint(written, stamp(written), "again.h5"); });
  fuzz::require(checkpoint_bytes(again) == written, "a checkpoint changes when it is written and read");
}

/// The gate: bytes that are not those of the stamp are refused before anything else is done with them.
void require_refused(const std::vector<std::byte>& bytes, const CheckpointStamp& other) {
  if (stamp(bytes) == other) return;
  try {
    parse_checkpoint(bytes, other, "checkpoint.h5");
  } catch (const Error& error) {
    fuzz::require(std::string(error.what()).find("run.json says") != std::string::npos, "refused, but not by the gate");
    return;
  }
  throw fuzz::Finding("bytes that do not match the stamp were accepted");
}

}  // namespace

// The first byte decides: 0 for bytes as they lie on a disk, 1 and more for edits of a whole checkpoint.
FIRN_FUZZ_TARGET(checkpoint) {
  if (bytes.empty()) return;
  const std::string_view rest = bytes.substr(1);
  static const std::vector<std::byte> original = checkpoint_bytes(sample_checkpoint(3, true));
  static const CheckpointStamp original_stamp = stamp(original);
  if (bytes[0] == 0) {
    const auto* first = reinterpret_cast<const std::byte*>(rest.data());
    const std::vector<std::byte> raw(first, first + rest.size());
    require_refused(raw, original_stamp);
    return read(raw);
  }
  read(fuzz::edited_file(original, rest));
}
