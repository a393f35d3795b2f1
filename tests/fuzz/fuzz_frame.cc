#include <firn/io/frame_reader.h>
#include <firn/io/frame_writer.h>
#include <fmt/format.h>

#include <cmath>

#include "fuzz/edited_hdf5.h"
#include "fuzz/fuzz_target.h"
#include "io/frame_samples.h"

using namespace firn;

namespace {

void require_consistent(const Snapshot& snapshot) {
  fuzz::require(snapshot.dimension == 2 || snapshot.dimension == 3, "another dimension was accepted");
  std::size_t begin = 0;
  for (const SnapshotMaterial& material : snapshot.materials) {
    fuzz::require(material.begin == begin && material.end >= begin, "materials with gaps were accepted");
    begin = material.end;
  }
  for (const SnapshotColumn& column : snapshot.columns) {
    const std::size_t stored = std::visit([](const auto& values) { return values.size(); }, column.values);
    fuzz::require(column.components >= 1, "a column without components was accepted");
    fuzz::require(stored == snapshot.size() * static_cast<std::size_t>(column.components),
                  fmt::format("column \"{}\" has {} values", column.name, stored));
  }
  fuzz::require(snapshot.find("position") == &snapshot.columns[0], "a frame without positions was accepted");
}

/// With room for the last bits: what is accepted comes back in the same bytes.
void require_stable(const Snapshot& snapshot, const FrameMetadata& metadata) {
  const auto written =
      fuzz::must_accept("a frame that was read is not written", [&] { return frame_bytes(snapshot, metadata); });
  FrameMetadata again_metadata;
  const Snapshot again = fuzz::must_accept("a frame of ours is refused",
                                           [&] { return parse_frame(written, "again.hdf", &again_metadata); });
  fuzz::require(frame_bytes(again, again_metadata) == written, "a frame changes when it is written and read");
}

void read(const std::vector<std::byte>& bytes) {
  FrameMetadata metadata;
  const Snapshot snapshot = parse_frame(bytes, "frame.hdf", &metadata);
  require_consistent(snapshot);
  require_stable(snapshot, metadata);
}

}  // namespace

// The first byte decides: 0 for bytes as they lie on a disk, which are for the gate; else edits of a whole frame.
FIRN_FUZZ_TARGET(frame) {
  if (bytes.empty()) return;
  const std::string_view rest = bytes.substr(1);
  if (bytes[0] == 0) {
    const auto* first = reinterpret_cast<const std::byte*>(rest.data());
    return read({first, first + rest.size()});
  }
  static const std::vector<std::byte> original = frame_bytes(sample_snapshot(4), sample_metadata());
  read(fuzz::edited_file(original, rest));
}
