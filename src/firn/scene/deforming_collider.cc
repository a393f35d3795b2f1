#include <firn/core/error.h>
#include <firn/core/log.h>
#include <firn/io/mesh_sequence.h>
#include <firn/io/vdb_file.h>
#include <firn/scene/deforming_collider.h>
#include <firn/scene/sequence_files.h>
#include <fmt/format.h>

#include <string_view>

namespace firn {
namespace {

namespace fs = std::filesystem;

/// A cycle that closes to better than this share of its size goes on without a jump that anyone could see.
constexpr double kClosed = 1e-3;

SequenceClock clock_of(const ColliderSettings& settings, std::size_t entries) {
  std::vector<double> times = settings.times;
  if (settings.fps) {
    times.clear();
    for (std::size_t k = 0; k < entries; ++k) times.push_back(static_cast<double>(k) / *settings.fps);
  }
  return {std::move(times), static_cast<Interpolation>(settings.interpolation), static_cast<AtEnd>(settings.at_end)};
}

std::shared_ptr<const DeformingShape<3>> deforming_mesh(const Scene& scene, const ColliderSettings& settings) {
  const std::vector<fs::path> files = sequence_files(scene, settings);
  MeshSequence sequence = read_mesh_sequence(files, clock_of(settings, files.size()), scene.strict_mesh);
  if (settings.scale != 1) {
    for (auto& positions : sequence.positions) {
      for (Vec3d& x : positions) x = settings.scale * x;
    }
  }
  if (settings.at_end == ColliderSettings::AtEnd::cycle) {
    const double gap = gap_of_cycle(sequence);
    const double size = bounds(sequence.mesh_at(sequence.clock.times().front())).largest_side();
    if (gap > kClosed * size) {
      log_warning(
          fmt::format("collider \"{}\": the last mesh of the cycle, {}, is up to {:.2g} m away from the first, {}: "
                      "the surface jumps when it begins again; end with the form of the first mesh",
                      settings.name, files.back().filename().string(), gap, files.front().filename().string()));
    }
  }
  return std::make_shared<DeformingMesh>(std::move(sequence), settings.inverted);
}

std::shared_ptr<const DeformingShape<3>> deforming_level_set(const Scene& scene, const ColliderSettings& settings) {
  const std::vector<fs::path> files = sequence_files(scene, settings);
  return std::make_shared<DeformingLevelSet>(read_level_sets(files, settings.scale), clock_of(settings, files.size()),
                                             settings.inverted);
}

}  // namespace

std::shared_ptr<const DeformingShape<3>> deforming_shape(const Scene& scene, const ColliderSettings& settings) {
  try {
    return settings.shape == ShapeSettings::Shape::mesh_sequence ? deforming_mesh(scene, settings)
                                                                 : deforming_level_set(scene, settings);
  } catch (const Error& error) {
    throw Error(error.kind(), fmt::format("collider \"{}\": {}", settings.name, error.what()));
  }
}

}  // namespace firn
