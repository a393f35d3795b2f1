// One of the few files that know OpenVDB. None of them may be compiled with hidden visibility: OpenVDB 10.0 crashes in
// initialize().

#include <firn/surface/vdb_mesh.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <utility>

namespace firn {
namespace {

using openvdb::FloatGrid;

void initialize() {
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
}

/// In voxels, as the transform is left at one: positions then keep all their digits.
FloatGrid::Ptr grid_of(const SphereBlend& blend) {
  using Leaf = FloatGrid::TreeType::LeafNodeType;
  auto grid = FloatGrid::create(blend.outside);
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  for (std::size_t i = 0; i < blend.leaves.size(); ++i) {
    const auto corner = blend.leaves.corner(i);
    auto leaf = std::make_unique<Leaf>(openvdb::Coord(corner[0], corner[1], corner[2]), blend.outside, true);
    std::copy_n(blend.distance.data() + i * LeafSet::kVoxels, LeafSet::kVoxels, leaf->buffer().data());
    grid->tree().addLeaf(leaf.release());
  }
  return grid;
}

Vec3d ours(const openvdb::Vec3s& v, double voxel) { return {{v.x() * voxel, v.y() * voxel, v.z() * voxel}}; }

double signed_volume(const PolygonMesh& mesh) { return enclosed_volume(triangulated(mesh)); }

/// OpenVDB's polygons turn the other way round.
void flip(PolygonMesh& mesh) {
  for (auto& quad : mesh.quads) std::swap(quad[1], quad[3]);
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
}

PolygonMesh mesh_of(const FloatGrid& grid, double voxel, double adaptivity) {
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec3I> triangles;
  std::vector<openvdb::Vec4I> quads;
  openvdb::tools::volumeToMesh(grid, points, triangles, quads, 0.0, adaptivity);
  PolygonMesh mesh;
  mesh.vertices.reserve(points.size());
  for (const openvdb::Vec3s& point : points) mesh.vertices.push_back(ours(point, voxel));
  const auto index = [](openvdb::Index32 i) { return static_cast<std::int32_t>(i); };
  for (const openvdb::Vec3I& t : triangles) mesh.triangles.push_back({index(t[0]), index(t[1]), index(t[2])});
  for (const openvdb::Vec4I& q : quads) mesh.quads.push_back({index(q[0]), index(q[1]), index(q[2]), index(q[3])});
  if (signed_volume(mesh) < 0) flip(mesh);
  return mesh;
}

FloatGrid::Ptr distances_of(const PolygonMesh& mesh, double voxel) {
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec3I> triangles;
  std::vector<openvdb::Vec4I> quads;
  points.reserve(mesh.vertices.size());
  for (const Vec3d& x : mesh.vertices) {
    points.emplace_back(static_cast<float>(x[0] / voxel), static_cast<float>(x[1] / voxel),
                        static_cast<float>(x[2] / voxel));
  }
  const auto index = [](std::int32_t i) { return static_cast<openvdb::Index32>(i); };
  // The split of triangulated(), so that the level set is that of the mesh that is written.
  const TriangleMesh split = triangulated(mesh);
  for (const auto& t : split.triangles) triangles.emplace_back(index(t[0]), index(t[1]), index(t[2]));
  const auto transform = openvdb::math::Transform::createLinearTransform(1.0);
  return openvdb::tools::meshToSignedDistanceField<FloatGrid>(*transform, points, triangles, quads, kBandVoxels,
                                                              kBandVoxels);
}

}  // namespace

PolygonMesh surface_of(const SphereBlend& blend) {
  initialize();
  return mesh_of(*grid_of(blend), blend.leaves.voxel, 0);
}

NarrowBand narrow_band(const PolygonMesh& mesh, double voxel) {
  initialize();
  const FloatGrid::Ptr grid = distances_of(mesh, voxel);
  NarrowBand band;
  band.leaves.voxel = voxel;
  using Leaf = FloatGrid::TreeType::LeafNodeType;
  std::vector<std::pair<std::uint64_t, const Leaf*>> leaves;
  for (auto leaf = grid->tree().cbeginLeaf(); leaf; ++leaf) {
    const openvdb::Coord origin = leaf->origin();
    leaves.emplace_back(packed_cell({origin.x() >> 3, origin.y() >> 3, origin.z() >> 3}), leaf.getLeaf());
  }
  std::ranges::sort(leaves, {}, &std::pair<std::uint64_t, const Leaf*>::first);
  SparseVolume& volume = band.distance;
  volume.name = "surface";
  volume.kind = SparseVolume::Kind::level_set;
  volume.background = static_cast<float>(kBandVoxels * voxel);
  for (const auto& [key, leaf] : leaves) {
    band.leaves.keys.push_back(key);
    std::bitset<LeafSet::kVoxels>& active = volume.active.emplace_back();
    for (openvdb::Index v = 0; v < LeafSet::kVoxels; ++v) {
      volume.values.push_back(leaf->getValue(v) * static_cast<float>(voxel));
      active.set(v, leaf->isValueOn(v));
    }
  }
  return band;
}

PolygonMesh simplified(const PolygonMesh& mesh, double voxel, double adaptivity) {
  initialize();
  if (mesh.vertices.empty()) return mesh;
  return mesh_of(*distances_of(mesh, voxel), voxel, adaptivity);
}

}  // namespace firn
