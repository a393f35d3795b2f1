#include <firn/core/error.h>
#include <firn/core/parallel.h>
#include <firn/surface/cell_list.h>
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace firn {
namespace {

constexpr std::int64_t kHalf = 1 << 20;
constexpr int kBits = 21;
constexpr std::size_t kGrain = 8192;

struct Entry {
  std::uint64_t cell;
  std::uint32_t point;
  bool operator<(const Entry& other) const { return cell != other.cell ? cell < other.cell : point < other.point; }
};

}  // namespace

std::uint64_t packed_cell(const std::int64_t (&ijk)[3]) {
  std::uint64_t key = 0;
  for (const std::int64_t n : ijk) {
    if (n < -kHalf || n >= kHalf) {
      throw Error(ErrorKind::usage, "particles lie too far from the origin for voxels of this size; use larger ones");
    }
    key = key << kBits | static_cast<std::uint64_t>(n + kHalf);
  }
  return key;
}

void unpack_cell(std::uint64_t key, std::int32_t (&ijk)[3]) {
  for (int i = 2; i >= 0; --i) {
    ijk[i] = static_cast<std::int32_t>(static_cast<std::int64_t>(key & ((1U << kBits) - 1)) - kHalf);
    key >>= kBits;
  }
}

CellList::CellList(std::span<const Vec3d> points, double cell) : cell_(cell) {
  if (points.size() > UINT32_MAX) {
    throw Error(ErrorKind::usage,
                fmt::format("{} particles; surfaces and volumes can be made of 2^32 at most", points.size()));
  }
  std::vector<Entry> entries(points.size());
  // One answer whichever thread meets a bad point first.
  std::atomic<bool> is_finite = true, is_near = true;
  parallel_chunks(points.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      std::int64_t ijk[3] = {};
      for (int i = 0; i < 3; ++i) {
        const double c = std::floor(points[p][i] / cell);
        if (!std::isfinite(c)) is_finite = false;
        // One cell is left at the border for those that look around themselves.
        if (!(std::abs(c) < static_cast<double>(kHalf - 2)))
          is_near = false;
        else
          ijk[i] = static_cast<std::int64_t>(c);
      }
      entries[p] = {is_near ? packed_cell(ijk) : 0, static_cast<std::uint32_t>(p)};
    }
  });
  if (!is_finite) throw Error(ErrorKind::usage, "some positions are not finite; the frame cannot become a volume");
  if (!is_near) {
    throw Error(ErrorKind::usage,
                fmt::format("particles lie too far from the origin for cells of {:.3g} m; use larger voxels", cell));
  }
  tbb::parallel_sort(entries.begin(), entries.end());
  order_.resize(entries.size());
  for (std::size_t at = 0; at < entries.size(); ++at) {
    order_[at] = entries[at].point;
    if (at == 0 || entries[at].cell != entries[at - 1].cell) {
      cells_.push_back(entries[at].cell);
      starts_.push_back(at);
    }
  }
  starts_.push_back(entries.size());
}

void CellList::cells_of(const Vec3d& x, std::int64_t (&ijk)[3]) const {
  for (int i = 0; i < 3; ++i) {
    const double c = std::floor(x[i] / cell_);
    ijk[i] = std::clamp(static_cast<std::int64_t>(c), -kHalf, kHalf - 1);
  }
}

CellList::Range CellList::row(std::int64_t i, std::int64_t j, std::int64_t low, std::int64_t high) const {
  const auto first = std::ranges::lower_bound(cells_, packed_cell({i, j, low}));
  const auto last = std::upper_bound(first, cells_.end(), packed_cell({i, j, high}));
  return {starts_[static_cast<std::size_t>(first - cells_.begin())],
          starts_[static_cast<std::size_t>(last - cells_.begin())]};
}

}  // namespace firn
