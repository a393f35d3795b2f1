#include <firn/apps/viewer/frame_store.h>

#include <limits>
#include <utility>

namespace firn {

std::size_t size_in_memory(const Snapshot& snapshot) {
  std::size_t bytes = sizeof(Snapshot);
  for (const SnapshotColumn& column : snapshot.columns) {
    std::visit([&](const auto& values) { bytes += values.size() * sizeof(values[0]); }, column.values);
  }
  return bytes;
}

void FrameStore::keep(const FrameReport& report, std::shared_ptr<const Snapshot> snapshot) {
  Kept& kept = frames_[report.frame];
  if (kept.snapshot != nullptr) bytes_ -= size_in_memory(*kept.snapshot);
  bytes_ += size_in_memory(*snapshot);
  kept = {report, std::move(snapshot)};
  while (bytes_ > budget_ && frames_.size() > 2) thin();
}

void FrameStore::clear() {
  frames_.clear();
  bytes_ = 0;
}

void FrameStore::thin() {
  auto goes = std::next(frames_.begin());
  std::int64_t smallest = std::numeric_limits<std::int64_t>::max();
  for (auto at = goes; std::next(at) != frames_.end(); ++at) {
    const std::int64_t gap = std::next(at)->first - std::prev(at)->first;
    if (gap >= smallest) continue;
    smallest = gap;
    goes = at;
  }
  bytes_ -= size_in_memory(*goes->second.snapshot);
  frames_.erase(goes);
}

const FrameStore::Kept* FrameStore::nearest(std::int64_t frame) const {
  if (frames_.empty()) return nullptr;
  const auto later = frames_.lower_bound(frame);
  if (later == frames_.begin()) return &later->second;
  const auto earlier = std::prev(later);
  if (later == frames_.end() || frame - earlier->first <= later->first - frame) return &earlier->second;
  return &later->second;
}

const FrameStore::Kept* FrameStore::after(std::int64_t frame) const {
  const auto later = frames_.upper_bound(frame);
  return later == frames_.end() ? nullptr : &later->second;
}

}  // namespace firn
