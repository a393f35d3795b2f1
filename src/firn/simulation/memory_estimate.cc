#include <firn/materials/model_info.h>
#include <firn/scene/vary_parameters.h>
#include <firn/simulation/memory_estimate.h>
#include <firn/state/field.h>
#include <firn/state/grid.h>
#include <firn/transfer/transfer_settings.h>
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <optional>

namespace firn {
namespace {

/// Position and velocity, id, body, material, J, pressure, von Mises stress of a snapshot, and some history.
constexpr double kSnapshotNumbers = 14;
/// The frame on its way to the disk, and the file that it becomes.
constexpr double kSnapshots = 1, kFileShare = 0.7;
/// Cells per particle block; a body's surface cuts blocks, which makes half as many again.
constexpr double kBlockCells = 64, kSurfaceShare = 1.5;

double real_bytes(const Scene& scene) { return scene.precision == Scene::Precision::single ? 4 : 8; }

double particle_bytes(const Scene& scene, const MaterialSettings& material) {
  using Transfer = MethodSettings::Transfer;
  ParticleLayout::Options options;
  options.keeps_velocity = scene.method.transfer == Transfer::flip || scene.method.transfer == Transfer::pic_flip;
  options.grad_v = !affine_is_gradient(static_cast<Kernel>(scene.method.kernel), static_cast<Form>(scene.method.form));
  if (const ModelInfo* model = find_model(material.model)) {
    options.history = static_cast<int>(history_columns(*model, scene.dimension).size() + material.varied.size());
  }
  return ParticleLayout::of(scene.dimension, static_cast<int>(real_bytes(scene)), options).bytes;
}

double all_particles(const Scene& scene, const WorldPlan& plan) {
  auto particles = static_cast<double>(plan.particles);
  for (const EmitterSettings& emitter : scene.emitters) particles += emitted_particles(scene, emitter, plan);
  return particles;
}

double all_particle_bytes(const Scene& scene, const WorldPlan& plan) {
  double bytes = 0;
  for (std::size_t b = 0; b < plan.bodies.size() && b < scene.bodies.size(); ++b) {
    const MaterialSettings* material = scene.find_material(scene.bodies[b].material);
    if (material) bytes += static_cast<double>(plan.bodies[b].particles) * particle_bytes(scene, *material);
  }
  for (const EmitterSettings& emitter : scene.emitters) {
    const MaterialSettings* material = scene.find_material(emitter.material);
    if (material) bytes += emitted_particles(scene, emitter, plan) * particle_bytes(scene, *material);
  }
  return bytes;
}

double grid_bytes(const Scene& scene, const WorldPlan& plan) {
  const auto kernel = static_cast<Kernel>(scene.method.kernel);
  const double tile = scene.dimension == 3 ? tile_nodes<3>(kernel) : tile_nodes<2>(kernel);
  const double blocks =
      kSurfaceShare * all_particles(scene, plan) / (kBlockCells * std::max(scene.resolution.particles_per_cell, 1.0));
  return blocks * (tile + kBlockCells) * kNodeWidth * real_bytes(scene);
}

std::string size_text(double bytes) {
  return bytes < 0x1p30 ? fmt::format("{:.1f} MiB", bytes / 0x1p20) : fmt::format("{:.2f} GiB", bytes / 0x1p30);
}

}  // namespace

double emitted_particles(const Scene& scene, const EmitterSettings& emitter, const WorldPlan& plan) {
  if (emitter.keep_full) return 0;
  const double volume_rate =
      emitter.volume_rate ? *emitter.volume_rate : *emitter.mass_rate / scene.find_material(emitter.material)->density;
  const double end = std::min(scene.end_time, emitter.stop.value_or(scene.end_time));
  return std::max(0.0, end - emitter.start) * volume_rate / plan.particle_volume;
}

double checkpoint_bytes(const Scene& scene, const WorldPlan& plan) {
  // A key of 8 bytes in place of the cell's number in its block.
  return all_particle_bytes(scene, plan) + 7 * all_particles(scene, plan);
}

std::vector<MemoryUse> memory_estimate(const Scene& scene, const WorldPlan& plan) {
  const double particles = all_particles(scene, plan);
  const double columns = all_particle_bytes(scene, plan);
  std::vector<MemoryUse> uses = {
      {"the columns of the particles", columns},
      {"the grid", grid_bytes(scene, plan)},
      {"the frame on its way to the disk",
       (kSnapshots + kFileShare) * particles * (kSnapshotNumbers * real_bytes(scene))},
      {"a checkpoint that is written", 2 * checkpoint_bytes(scene, plan)}};
  if (scene.rollback == Scene::Rollback::memory) uses.push_back({"their copy for rollback", columns});
  std::stable_sort(uses.begin(), uses.end(), [](const MemoryUse& a, const MemoryUse& b) { return a.bytes > b.bytes; });
  return uses;
}

std::string memory_message(const Scene& scene, const WorldPlan* plan) {
  constexpr const char* kAdvice = "use fewer particles or larger cells, precision = \"single\" or rollback = \"off\"";
  std::optional<WorldPlan> own;
  if (plan == nullptr) {
    try {
      own = plan_world(scene);
    } catch (const std::exception&) {
      return fmt::format("out of memory while the scene was read; {}", kAdvice);
    }
    plan = &*own;
  }
  std::string list;
  for (const MemoryUse& use : memory_estimate(scene, *plan)) {
    list += fmt::format("{}{} {}", list.empty() ? "" : ", ", use.name, size_text(use.bytes));
  }
  return fmt::format("out of memory: {:.0f} particles need, as far as can be told, {}; {}", all_particles(scene, *plan),
                     list, kAdvice);
}

}  // namespace firn
