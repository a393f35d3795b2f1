#include <firn/core/parallel.h>
#include <firn/surface/leaf_set.h>
#include <firn/surface/sphere_blend.h>

#include <algorithm>
#include <cmath>

namespace firn {
namespace {

constexpr int kSide = LeafSet::kSide, kVoxels = LeafSet::kVoxels;
constexpr std::size_t kGrain = 512;

/// Sums over the points near the voxels of one leaf; lengths in voxels from its corner.
struct alignas(64) LeafSums {
  float weight[kVoxels] = {};
  float nearest[kVoxels];  ///< squared distance
  float moment[3][kVoxels] = {};

  explicit LeafSums(float farthest) { std::fill_n(nearest, kVoxels, farthest * farthest); }
};

/// Adds a point to the eight voxels of a row. Apart, and with nothing but plain loops of eight, for the sake of
/// vectorisation.
inline void add_to_row(LeafSums& sums, int row, const float (&x)[3], float square_ij, float square_reach,
                       float over_square) {
  float* __restrict weight = sums.weight + row;
  float* __restrict nearest = sums.nearest + row;
  float* __restrict mx = sums.moment[0] + row;
  float* __restrict my = sums.moment[1] + row;
  float* __restrict mz = sums.moment[2] + row;
  for (int k = 0; k < kSide; ++k) {
    const float dz = x[2] - static_cast<float>(k);
    const float square = square_ij + dz * dz;
    const float t = std::max(square_reach - square, 0.0F) * over_square;
    const float w = t * t * t;
    weight[k] += w;
    nearest[k] = std::min(nearest[k], square);
    mx[k] += w * x[0];
    my[k] += w * x[1];
    mz[k] += w * x[2];
  }
}

void add_point(LeafSums& sums, const float (&x)[3], float reach) {
  const float square = reach * reach, over = 1 / square;
  const auto first = [&](float c) { return std::max(0, static_cast<int>(std::ceil(c - reach))); };
  const auto last = [&](float c) { return std::min(kSide - 1, static_cast<int>(std::floor(c + reach))); };
  if (first(x[2]) > last(x[2])) return;
  for (int i = first(x[0]); i <= last(x[0]); ++i) {
    const float dx = x[0] - static_cast<float>(i), square_i = dx * dx;
    for (int j = first(x[1]); j <= last(x[1]); ++j) {
      const float dy = x[1] - static_cast<float>(j), square_ij = square_i + dy * dy;
      if (square_ij < square) add_to_row(sums, (i * kSide + j) * kSide, x, square_ij, square, over);
    }
  }
}

/// From the sums to distances, m.
void finish(const LeafSums& sums, const BlendLengths& lengths, float outside, float* distance) {
  const auto voxel = static_cast<float>(lengths.voxel), radius = static_cast<float>(lengths.radius),
             cover = static_cast<float>(lengths.cover);
  for (int v = 0; v < kVoxels; ++v) {
    const float weight = sums.weight[v];
    if (!(weight > 0)) {
      distance[v] = outside;
      continue;
    }
    const float at[3] = {static_cast<float>(v / (kSide * kSide)), static_cast<float>(v / kSide % kSide),
                         static_cast<float>(v % kSide)};
    float square = 0;
    for (int a = 0; a < 3; ++a) {
      const float d = sums.moment[a][v] / weight - at[a];
      square += d * d;
    }
    const float blend = std::sqrt(square) * voxel - radius, single = std::sqrt(sums.nearest[v]) * voxel - cover;
    distance[v] = std::min(std::max(blend, single), outside);
  }
}

}  // namespace

SphereBlend blend_spheres(std::span<const Vec3d> points, const CellList& cells, const BlendLengths& lengths) {
  SphereBlend blend;
  blend.leaves = leaves_near(points, lengths.voxel, lengths.reach + lengths.voxel);
  blend.outside = static_cast<float>(lengths.reach - lengths.radius);
  blend.distance.resize(blend.leaves.size() * kVoxels);
  const double voxel = lengths.voxel;
  const auto reach = static_cast<float>(lengths.reach / voxel);
  parallel_chunks(blend.leaves.size(), 1, [&](std::size_t leaf, std::size_t) {
    const auto corner = blend.leaves.corner(leaf);
    Vec3d first, lower, upper;
    for (int a = 0; a < 3; ++a) {
      first[a] = corner[static_cast<std::size_t>(a)] * voxel;
      lower[a] = first[a] - lengths.reach;
      upper[a] = first[a] + (kSide - 1) * voxel + lengths.reach;
    }
    LeafSums sums(reach);
    cells.visit_box(lower, upper, [&](std::uint32_t p) {
      float x[3];
      for (int a = 0; a < 3; ++a) {
        if (points[p][a] < lower[a] || points[p][a] > upper[a]) return;
        x[a] = static_cast<float>((points[p][a] - first[a]) / voxel);
      }
      add_point(sums, x, reach);
    });
    finish(sums, lengths, blend.outside, blend.distance.data() + leaf * kVoxels);
  });
  return blend;
}

std::vector<Vec3f> blended(std::span<const Vec3d> points, const CellList& cells, double reach,
                           std::span<const Vec3f> values, std::span<const Vec3d> places) {
  std::vector<Vec3f> means(places.size(), Vec3f{});
  const Vec3d around = {{reach, reach, reach}};
  parallel_chunks(places.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      float total = 0;
      Vec3f sum = {};
      cells.visit_box(places[i] - around, places[i] + around, [&](std::uint32_t p) {
        const Vec3d d = points[p] - places[i];
        const double t = 1 - dot(d, d) / (reach * reach);
        if (!(t > 0)) return;
        const auto w = static_cast<float>(t * t * t);
        total += w;
        sum = sum + w * values[p];
      });
      if (total > 0) means[i] = (1 / total) * sum;
    }
  });
  return means;
}

}  // namespace firn
