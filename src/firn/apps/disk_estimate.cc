#include <firn/apps/disk_estimate.h>
#include <firn/apps/scene_view.h>
#include <firn/apps/work_folder.h>
#include <firn/core/error.h>
#include <firn/core/log.h>
#include <firn/io/checkpoint_file.h>
#include <firn/io/frame_writer.h>
#include <firn/render/image.h>
#include <firn/render/scene_view.h>
#include <firn/scene/resolved.h>
#include <firn/scene/scene_keys.h>
#include <firn/simulation/memory_estimate.h>
#include <firn/simulation/simulation.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

namespace firn {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kFewParticles = 4000;
/// Particle-steps of the small run: about a second.
constexpr double kMostWork = 8e6;
/// Frames of it that are written.
constexpr std::int64_t kSamples = 12;

/// One frame of the small run, written.
struct Sample {
  double bytes_per_particle = 0;
  double particles = 0;
};

double bytes_of(const fs::path& path) {
  std::error_code error;
  const auto size = fs::file_size(path, error);
  return error ? 0 : static_cast<double>(size);
}

/// A frame's bytes, without what every frame has, be it empty.
class FrameScale {
 public:
  explicit FrameScale(const fs::path& folder) : path_(folder / "frame.hdf") {}

  Sample weigh(Snapshot snapshot) {
    const auto particles = static_cast<double>(snapshot.size());
    write_frame(path_, snapshot, {});
    const double bytes = bytes_of(path_);
    for (SnapshotColumn& column : snapshot.columns) {
      std::visit([](auto& values) { values.clear(); }, column.values);
    }
    for (SnapshotMaterial& material : snapshot.materials) material.begin = material.end = 0;
    write_frame(path_, snapshot, {});
    empty_ = bytes_of(path_);
    return {particles > 0 ? (bytes - empty_) / particles : 0, particles};
  }
  double empty_bytes() const { return empty_; }

 private:
  fs::path path_;
  double empty_ = 0;
};

Scene small_scene(const Scene& scene, const WorldPlan& plan) {
  Scene small = scene;
  small.resolution.cell_size.reset();
  small.resolution.particles = std::min(plan.particles, kFewParticles);
  small.probes.clear();
  // A coarser grid would break periodic lengths of a whole number of blocks, and needs bodies to be found from.
  if (norm(scene.method.periodic) > 0 || scene.bodies.empty()) {
    small.resolution = scene.resolution;
  }
  return small;
}

/// The small run, as far as the work allows. Frames after that are taken for the last one.
std::vector<Sample> run_small(Simulation& simulation, FrameScale& scale, Snapshot& drawn) {
  std::vector<Sample> samples(static_cast<std::size_t>(simulation.frame_count()));
  const std::int64_t stride = std::max<std::int64_t>(1, (simulation.frame_count() - 1) / kSamples);
  double work = 0;
  Sample last;
  bool goes_on = true;
  for (std::int64_t frame = 1; frame <= simulation.frame_count(); ++frame) {
    if (frame > 1 && goes_on) {
      try {
        goes_on = simulation
                      .advance_frame([&] {
                        work += static_cast<double>(simulation.particle_count());
                        return work > kMostWork;
                      })
                      .has_value();
      } catch (const Error&) {
        goes_on = false;  // the run itself will say so
      }
    }
    // Where the work ends in the middle of a frame, its beginning has been written already.
    if ((frame - 1) % stride == 0 && (goes_on || frame == 1)) {
      const Snapshot snapshot = simulation.snapshot();
      last = scale.weigh(snapshot);
      if (frame <= simulation.frame_count() / 2 + 1) drawn = snapshot;
    } else if (goes_on) {
      last.particles = static_cast<double>(simulation.particle_count());
    }
    samples[static_cast<std::size_t>(frame - 1)] = last;
  }
  return samples;
}

double picture_bytes(const Scene& scene, const Snapshot& snapshot, const fs::path& folder) {
  const SceneDrawing drawing(scene);
  View view = drawing.view_at(snapshot.time);
  if (!view.camera) view.camera = automatic_camera(snapshot, view);
  write_png(folder / "picture.png", render_snapshot(snapshot, view));
  return bytes_of(folder / "picture.png");
}

/// What a checkpoint has besides its columns: the scene, names, the tables of HDF5.
double checkpoint_overhead(const Simulation& simulation, const fs::path& folder) {
  Checkpoint checkpoint = simulation.checkpoint();
  checkpoint.scene_text = resolved_toml(simulation.scene(), folder);
  checkpoint.scene_keys = scene_keys(simulation.scene());
  double columns = 0;
  for (const CheckpointMaterial& material : checkpoint.state.materials) {
    for (const CheckpointColumn& column : material.columns) {
      const auto width = std::visit([](const auto& values) { return sizeof(values[0]); }, column.values);
      columns += static_cast<double>(column.value_count() * width);
    }
  }
  return static_cast<double>(write_checkpoint(folder / "checkpoint.h5", checkpoint).bytes) - columns;
}

std::int64_t kept_checkpoints(const CheckpointSettings& settings, std::int64_t frames) {
  const std::int64_t by_frames = settings.every_frames > 0 ? frames / settings.every_frames : 0;
  const std::int64_t most = 2 + by_frames;  // the first and the last frame's
  return settings.keep > 0 ? std::min<std::int64_t>(most, settings.keep) : most;
}

}  // namespace

DiskEstimate estimate_disk(const Scene& scene, const WorldPlan& plan) {
  const LogSink sink = set_log_sink({});  // what there is to warn of was said for the scene itself
  DiskEstimate estimate;
  try {
    const WorkFolder folder;
    const std::unique_ptr<Simulation> simulation = Simulation::create(small_scene(scene, plan));
    const double overhead = checkpoint_overhead(*simulation, folder.path());
    // Twice as fine has eight times the particles, or four in 2D.
    const double finer = simulation->plan().particle_volume / plan.particle_volume;
    FrameScale scale(folder.path());
    Snapshot drawn;
    const std::vector<Sample> samples = run_small(*simulation, scale, drawn);
    double particles = 0;
    for (const Sample& sample : samples) {
      particles += sample.particles * finer;
      estimate.frames_bytes += scale.empty_bytes() + sample.bytes_per_particle * sample.particles * finer;
    }
    estimate.frames = static_cast<std::int64_t>(samples.size());
    if (particles > 0) estimate.frame_bytes_per_particle = estimate.frames_bytes / particles;
    if (scene.render.every_nth > 0) {
      estimate.pictures = (estimate.frames - 1) / scene.render.every_nth + 1;
      estimate.pictures_bytes = static_cast<double>(estimate.pictures) * picture_bytes(scene, drawn, folder.path());
    }
    estimate.checkpoint_bytes = checkpoint_bytes(scene, plan) + overhead;
    estimate.checkpoints = kept_checkpoints(scene.checkpoint, estimate.frames);
  } catch (...) {
    set_log_sink(sink);
    throw;
  }
  set_log_sink(sink);
  return estimate;
}

std::uint64_t free_space(const fs::path& folder) {
  std::error_code error;
  fs::path place = fs::absolute(folder, error);
  while (!error && !fs::exists(place, error) && place.has_relative_path()) place = place.parent_path();
  const fs::space_info space = fs::space(place, error);
  return error ? 0 : space.available;
}

}  // namespace firn
