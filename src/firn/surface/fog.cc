#include <firn/core/error.h>
#include <firn/core/parallel.h>
#include <firn/surface/cell_list.h>
#include <firn/surface/fog.h>
#include <firn/surface/leaf_set.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace firn {
namespace {

constexpr int kSide = LeafSet::kSide, kVoxels = LeafSet::kVoxels;
/// Half the width of a quadratic B-spline, in voxels.
constexpr double kReach = 1.5;

/// m^3 of each particle.
std::vector<float> particle_volumes(const Snapshot& snapshot) {
  const double spacing = snapshot.particle_spacing, initial = spacing * spacing * spacing;
  const SnapshotColumn* ratio = snapshot.find("J");
  std::vector<float> volumes(snapshot.size());
  for (std::size_t p = 0; p < volumes.size(); ++p) {
    const double J = ratio != nullptr ? value(*ratio, p) : 1;
    volumes[p] = static_cast<float>(initial * J);
  }
  return volumes;
}

/// Weights of the three voxels around a point whose distance to the middle one is d voxels, |d| <= 1/2.
void spline_weights(double d, float (&w)[3]) {
  w[0] = static_cast<float>(0.5 * (0.5 - d) * (0.5 - d));
  w[1] = static_cast<float>(0.75 - d * d);
  w[2] = static_cast<float>(0.5 * (0.5 + d) * (0.5 + d));
}

/// Spreads particles over the voxels of one leaf.
class LeafFog {
 public:
  LeafFog(std::array<std::int32_t, 3> corner, double voxel, std::size_t numbers)
      : corner_(corner), voxel_(voxel), sums_(numbers * kVoxels) {}

  /// @param numbers what is spread, already times the particle's volume; the volume first
  void add(const Vec3d& x, const std::vector<float>& numbers) {
    int base[3];
    float w[3][3];
    for (int a = 0; a < 3; ++a) {
      const double place = x[a] / voxel_, middle = std::floor(place + 0.5);
      base[a] = static_cast<int>(static_cast<std::int64_t>(middle) - 1 - corner_[static_cast<std::size_t>(a)]);
      if (base[a] <= -3 || base[a] >= kSide) return;
      spline_weights(place - middle, w[a]);
    }
    for (int i = std::max(0, -base[0]); i < 3 && base[0] + i < kSide; ++i) {
      for (int j = std::max(0, -base[1]); j < 3 && base[1] + j < kSide; ++j) {
        for (int k = std::max(0, -base[2]); k < 3 && base[2] + k < kSide; ++k) {
          const auto voxel = static_cast<std::size_t>(((base[0] + i) * kSide + base[1] + j) * kSide + base[2] + k);
          const float weight = w[0][i] * w[1][j] * w[2][k];
          for (std::size_t n = 0; n < numbers.size(); ++n) sums_[n * kVoxels + voxel] += weight * numbers[n];
        }
      }
    }
  }

  float sum(std::size_t number, std::size_t voxel) const { return sums_[number * kVoxels + voxel]; }

 private:
  std::array<std::int32_t, 3> corner_;
  double voxel_;
  std::vector<float> sums_;
};

std::vector<const SnapshotColumn*> find_columns(const Snapshot& snapshot, const std::vector<VolumeName>& names) {
  std::vector<const SnapshotColumn*> columns;
  for (const VolumeName& name : names) {
    const SnapshotColumn* column = snapshot.find(name.column);
    if (column == nullptr) throw Error(ErrorKind::usage, fmt::format("there is no column \"{}\"", name.column));
    if (column->components != 1 && column->components != 3) {
      throw Error(ErrorKind::usage, fmt::format("the column \"{}\" has {} numbers; a volume has 1 or 3", name.column,
                                                column->components));
    }
    columns.push_back(column);
  }
  return columns;
}

/// Empty volumes on these leaves, density first.
std::vector<SparseVolume> make_volumes(const LeafSet& leaves, const std::vector<VolumeName>& names,
                                       const std::vector<const SnapshotColumn*>& columns) {
  std::vector<SparseVolume> volumes(1 + names.size());
  volumes[0].name = "density";
  for (std::size_t c = 0; c < names.size(); ++c) {
    SparseVolume& volume = volumes[c + 1];
    volume.name = names[c].volume;
    volume.components = columns[c]->components;
    const bool turns = volume.components == 3 && !columns[c]->unit.empty();  // and a colour does not
    volume.kind = turns ? SparseVolume::Kind::vectors : SparseVolume::Kind::fog;
  }
  for (SparseVolume& volume : volumes) {
    volume.values.resize(leaves.size() * static_cast<std::size_t>(volume.components) * kVoxels);
    volume.active.resize(leaves.size());
  }
  return volumes;
}

void store(const LeafFog& fog, std::size_t leaf, double voxel, std::vector<SparseVolume>& volumes) {
  const auto per_volume = static_cast<float>(1 / (voxel * voxel * voxel));
  std::size_t number = 0;
  for (SparseVolume& volume : volumes) {
    const bool is_density = number == 0;
    for (std::size_t c = 0; c < static_cast<std::size_t>(volume.components); ++c, ++number) {
      float* values = volume.values.data() + (leaf * static_cast<std::size_t>(volume.components) + c) * kVoxels;
      for (std::size_t v = 0; v < kVoxels; ++v) {
        const float filled = fog.sum(0, v);
        if (!(filled > 0)) continue;
        values[v] = is_density ? filled * per_volume : fog.sum(number, v) / filled;
        volume.active[leaf].set(v);
      }
    }
  }
}

}  // namespace

Volumes fog_of(const Snapshot& snapshot, double voxel, const std::vector<VolumeName>& names) {
  if (!(voxel > 0)) throw Error(ErrorKind::usage, fmt::format("a voxel must be larger than 0 m, got {}", voxel));
  const std::vector<const SnapshotColumn*> columns = find_columns(snapshot, names);
  const std::vector<float> filled = particle_volumes(snapshot);
  std::vector<Vec3d> points(snapshot.size());
  for (std::size_t p = 0; p < points.size(); ++p) points[p] = snapshot.position(p);
  const CellList cells(points, kSide * voxel);

  Volumes result;
  result.leaves = leaves_near(points, voxel, kReach * voxel);
  result.volumes = make_volumes(result.leaves, names, columns);
  std::size_t count = 1;
  for (const SnapshotColumn* column : columns) count += static_cast<std::size_t>(column->components);
  parallel_chunks(result.leaves.size(), 1, [&](std::size_t leaf, std::size_t) {
    const auto corner = result.leaves.corner(leaf);
    LeafFog fog(corner, voxel, count);
    std::vector<float> numbers(count);
    Vec3d lower, upper;
    for (int a = 0; a < 3; ++a) {
      lower[a] = (corner[static_cast<std::size_t>(a)] - kReach) * voxel;
      upper[a] = (corner[static_cast<std::size_t>(a)] + kSide - 1 + kReach) * voxel;
    }
    cells.visit_box(lower, upper, [&](std::uint32_t p) {
      for (int a = 0; a < 3; ++a) {
        if (points[p][a] < lower[a] || points[p][a] > upper[a]) return;
      }
      std::size_t n = 0;
      numbers[n++] = filled[p];
      for (const SnapshotColumn* column : columns) {
        for (int c = 0; c < column->components; ++c)
          numbers[n++] = filled[p] * static_cast<float>(value(*column, p, c));
      }
      fog.add(points[p], numbers);
    });
    store(fog, leaf, voxel, result.volumes);
  });
  return result;
}

}  // namespace firn
