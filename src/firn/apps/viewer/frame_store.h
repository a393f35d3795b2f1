#pragma once

#include <firn/simulation/simulation.h>
#include <firn/state/snapshot.h>

#include <cstdint>
#include <map>
#include <memory>

namespace firn {

/// Memory that a snapshot takes, bytes.
std::size_t size_in_memory(const Snapshot& snapshot);

/// Frames that were computed, as many as fit into a part of the memory. If there is no room for one more, the one goes
/// whose neighbours are closest to each other, but never the first or the last: the whole time stays within reach, more
/// coarsely.
class FrameStore {
 public:
  struct Kept {
    FrameReport report;
    std::shared_ptr<const Snapshot> snapshot;
  };

  explicit FrameStore(std::size_t bytes) : budget_(bytes) {}

  /// Frames come in ascending order; one that is there already takes the place of the old one.
  void keep(const FrameReport& report, std::shared_ptr<const Snapshot> snapshot);
  void clear();
  /// The kept frame that is nearest to this one, the earlier of two; null if there is none.
  const Kept* nearest(std::int64_t frame) const;
  /// The first kept frame after this one; null if there is none.
  const Kept* after(std::int64_t frame) const;
  std::size_t size() const { return frames_.size(); }
  std::size_t bytes() const { return bytes_; }

 private:
  /// Takes one away.
  void thin();

  std::size_t budget_, bytes_ = 0;
  std::map<std::int64_t, Kept> frames_;
};

}  // namespace firn
