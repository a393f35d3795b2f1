#include <firn/core/error.h>
#include <firn/core/parallel.h>
#include <firn/geometry/closest_point.h>
#include <firn/geometry/level_set.h>
#include <firn/geometry/mesh_inside.h>
#include <fmt/format.h>

#include <cmath>

namespace firn {
namespace {

constexpr int kSide = 8, kRow = kSide + 1;
constexpr std::size_t kNodes = std::size_t(kRow) * kRow * kRow;
constexpr std::size_t kMostFine = std::size_t(1) << 18, kMostBlocks = std::size_t(1) << 26;

/// Signed distances to a mesh, one after the other along a path: the last answer bounds the next one.
class DistanceWalk {
 public:
  DistanceWalk(const TriangleBvh& tree, const MeshInside& inside, bool closed)
      : tree_(tree), inside_(inside), closed_(closed) {}

  double at(const Vec3d& x) {
    const double moved = norm(x - last_);
    const double far = closest_point(tree_, x, known_ ? std::abs(value_) + moved : kEndless).distance;
    // No surface lies between two points that are nearer to each other than both together to the surface.
    const bool same_side = closed_ && known_ && std::abs(value_) + far > moved * (1 + 1e-9);
    const bool is_inside = same_side ? std::signbit(value_) : inside_.contains(x);
    value_ = is_inside ? -far : far;
    last_ = x;
    known_ = true;
    return value_;
  }

 private:
  static constexpr double kEndless = std::numeric_limits<double>::infinity();
  const TriangleBvh& tree_;
  const MeshInside& inside_;
  bool closed_, known_ = false;
  Vec3d last_ = {};
  double value_ = 0;
};

struct BlockIndex {
  std::int32_t b[3];
};

BlockIndex unflat(const LevelSet::Data& data, std::size_t block) {
  const auto n1 = static_cast<std::size_t>(data.blocks[1]), n2 = static_cast<std::size_t>(data.blocks[2]);
  return {{static_cast<std::int32_t>(block / (n1 * n2)), static_cast<std::int32_t>(block / n2 % n1),
           static_cast<std::int32_t>(block % n2)}};
}

Vec3d corner_of(const LevelSet::Data& data, std::size_t block) {
  const BlockIndex index = unflat(data, block);
  Vec3d corner = data.lower;
  for (int i = 0; i < 3; ++i) corner[i] += data.cell * kSide * index.b[i];
  return corner;
}

LevelSet::Data empty_grid(const Bounds<3>& mesh, double cell) {
  require_positive("level set", "cell size", cell);
  LevelSet::Data data;
  data.cell = cell;
  data.mesh_lower = mesh.lower;
  data.mesh_upper = mesh.upper;
  double blocks = 1;
  for (int i = 0; i < 3; ++i) {
    // Two cells of margin, so that next to the surface the grid has node values on both sides.
    const double count = std::ceil((mesh.size()[i] / cell + 4) / kSide);
    blocks *= count;
    if (blocks <= kMostBlocks) data.blocks[i] = static_cast<std::int32_t>(count);
    data.lower[i] = mesh.center()[i] - 0.5 * count * kSide * cell;
  }
  if (!(blocks <= kMostBlocks)) {
    throw Error(ErrorKind::usage,
                fmt::format("level set: {:.3g} m with cells of {:.3g} m are more than 2^26 blocks; use larger cells",
                            mesh.largest_side(), cell));
  }
  return data;
}

LevelSet::Data sample(const TriangleMesh& mesh, double cell) {
  LevelSet::Data data = empty_grid(bounds(mesh), cell);
  const MeshInside inside(mesh);
  const TriangleBvh tree(mesh);
  const bool closed = inspect(mesh).has_whole_winding_numbers();
  const auto row = static_cast<std::size_t>(data.blocks[2]);
  data.center.resize(static_cast<std::size_t>(data.blocks[0]) * static_cast<std::size_t>(data.blocks[1]) * row);
  const Vec3d half = constant_vector<double, 3>(0.5 * kSide * cell);
  parallel_chunks(data.center.size(), row, [&](std::size_t begin, std::size_t end) {
    DistanceWalk walk(tree, inside, closed);
    for (std::size_t b = begin; b < end; ++b) data.center[b] = static_cast<float>(walk.at(corner_of(data, b) + half));
  });
  data.fine.assign(data.center.size(), -1);
  std::vector<std::size_t> fine;
  for (std::size_t b = 0; b < data.center.size(); ++b) {
    if (std::abs(data.center[b]) > norm(half) + 2 * cell) continue;
    data.fine[b] = static_cast<std::int32_t>(fine.size());
    fine.push_back(b);
  }
  if (fine.size() > kMostFine) {
    throw Error(ErrorKind::usage,
                fmt::format("level set: cells of {:.3g} m make {} blocks at the surface, more than {}; "
                            "use larger cells",
                            cell, fine.size(), kMostFine));
  }
  data.nodes.resize(fine.size() * kNodes);
  parallel_each(fine.size(), [&](std::size_t f) {
    const Vec3d corner = corner_of(data, fine[f]);
    DistanceWalk walk(tree, inside, closed);
    float* node = data.nodes.data() + f * kNodes;
    for (int i = 0; i < kRow; ++i) {
      for (int j = 0; j < kRow; ++j) {
        for (int n = 0; n < kRow; ++n) {
          // There and back, so that each node is next to the one before.
          const int jj = i % 2 == 0 ? j : kRow - 1 - j, k = (i * kRow + j) % 2 == 0 ? n : kRow - 1 - n;
          const Vec3d x = corner + Vec3d{{cell * i, cell * jj, cell * k}};
          node[(i * kRow + jj) * kRow + k] = static_cast<float>(walk.at(x));
        }
      }
    }
  });
  return data;
}

/// The cell of a place in a block, and how far into it.
void split(const Vec3d& in_block, int (&cell)[3], Vec3d& part) {
  for (int i = 0; i < 3; ++i) {
    cell[i] = std::clamp(static_cast<int>(in_block[i]), 0, kSide - 1);
    part[i] = std::clamp(in_block[i] - cell[i], 0.0, 1.0);
  }
}

double mix(double a, double b, double part) { return a + part * (b - a); }

}  // namespace

LevelSet::LevelSet(const TriangleMesh& mesh, double cell) : data_(sample(mesh, cell)) {}

LevelSet::LevelSet(Data data) : data_(std::move(data)) {
  if (!is_consistent(data_)) throw Error(ErrorKind::files, "level set: its parts do not fit together");
}

std::size_t LevelSet::flat(const std::int32_t (&b)[3]) const {
  return (static_cast<std::size_t>(b[0]) * static_cast<std::size_t>(data_.blocks[1]) + static_cast<std::size_t>(b[1])) *
             static_cast<std::size_t>(data_.blocks[2]) +
         static_cast<std::size_t>(b[2]);
}

LevelSet::Place LevelSet::place_of(const Vec3d& x) const {
  Place place;
  std::int32_t b[3];
  for (int i = 0; i < 3; ++i) {
    const double cells = (x[i] - data_.lower[i]) / data_.cell;
    b[i] = static_cast<std::int32_t>(std::clamp(std::floor(cells / kSide), 0.0, data_.blocks[i] - 1.0));
    place.in_block[i] = cells - kSide * b[i];
  }
  place.block = flat(b);
  return place;
}

double LevelSet::coarse_distance(const Place& place) const {
  const double center = data_.center[place.block];
  const double off = data_.cell * norm(place.in_block - constant_vector<double, 3>(0.5 * kSide));
  // Blocks without node values are at least two cells away from the surface.
  return std::copysign(std::max(std::abs(center) - off, 2 * data_.cell), center);
}

double LevelSet::distance(const Vec3d& x) const {
  double outside = 0;
  bool in_grid = true;
  for (int i = 0; i < 3; ++i) {
    const double beyond = std::max({data_.mesh_lower[i] - x[i], x[i] - data_.mesh_upper[i], 0.0});
    outside += beyond * beyond;
    in_grid = in_grid && x[i] >= data_.lower[i] && x[i] <= data_.lower[i] + data_.cell * kSide * data_.blocks[i];
  }
  if (!in_grid) return std::sqrt(outside);
  const Place place = place_of(x);
  const std::int32_t fine = data_.fine[place.block];
  if (fine < 0) return coarse_distance(place);
  int c[3];
  Vec3d part;
  split(place.in_block, c, part);
  const float* node = data_.nodes.data() + static_cast<std::size_t>(fine) * kNodes + (c[0] * kRow + c[1]) * kRow + c[2];
  double plane[2];
  for (int i = 0; i < 2; ++i) {
    const float* row = node + i * kRow * kRow;
    plane[i] = mix(mix(row[0], row[1], part[2]), mix(row[kRow], row[kRow + 1], part[2]), part[1]);
  }
  return mix(plane[0], plane[1], part[0]);
}

Vec3d LevelSet::coarse_normal(const Vec3d& x, std::size_t block) const {
  const BlockIndex index = unflat(data_, block);
  Vec3d gradient;
  for (int i = 0; i < 3; ++i) {
    std::int32_t before[3], after[3];
    for (int j = 0; j < 3; ++j) before[j] = after[j] = index.b[j];
    before[i] = std::max(before[i] - 1, 0);
    after[i] = std::min(after[i] + 1, data_.blocks[i] - 1);
    const double width = std::max(after[i] - before[i], 1);
    gradient[i] = (data_.center[flat(after)] - data_.center[flat(before)]) / width;
  }
  if (norm(gradient) > 0) return direction(gradient);
  return direction(x - 0.5 * (data_.mesh_lower + data_.mesh_upper));
}

Vec3d LevelSet::normal(const Vec3d& x) const {
  const Place place = place_of(x);
  Vec3d inside_grid = x;
  for (int i = 0; i < 3; ++i) {
    inside_grid[i] = std::clamp(x[i], data_.mesh_lower[i], data_.mesh_upper[i]);
  }
  const std::int32_t fine = data_.fine[place.block];
  const Vec3d beyond = x - inside_grid;
  if (fine < 0) return norm(beyond) > 2 * data_.cell ? direction(beyond) : coarse_normal(x, place.block);
  int c[3];
  Vec3d part;
  split(place.in_block, c, part);
  const float* node = data_.nodes.data() + static_cast<std::size_t>(fine) * kNodes + (c[0] * kRow + c[1]) * kRow + c[2];
  constexpr int kStride[3] = {kRow * kRow, kRow, 1};
  Vec3d gradient;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const auto slope = [&](int at) { return double(node[at + kStride[i]]) - double(node[at]); };
    gradient[i] = mix(mix(slope(0), slope(kStride[k]), part[k]),
                      mix(slope(kStride[j]), slope(kStride[j] + kStride[k]), part[k]), part[j]);
  }
  return norm(gradient) > 0 ? direction(gradient) : coarse_normal(x, place.block);
}

}  // namespace firn
