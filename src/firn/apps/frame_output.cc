#include <firn/apps/frame_output.h>
#include <firn/core/log.h>
#include <firn/io/frame_series.h>
#include <firn/io/frame_writer.h>
#include <firn/io/stats_table.h>
#include <firn/scene/probe_points.h>
#include <firn/scene/resolved.h>
#include <fmt/format.h>

#include <utility>

namespace firn {
namespace {

constexpr std::size_t kMostWaiting = 2;

FrameMetadata metadata_of(const Scene& scene) {
  FrameMetadata metadata;
  metadata.precision = scene.precision == Scene::Precision::single ? "single" : "double";
  metadata.scene_hash = scene_hash(scene);
  metadata.firn_version = FIRN_VERSION;
  return metadata;
}

StatsRow row_of(const FinishedFrame& frame) {
  const Totals& totals = frame.totals;
  StatsRow row;
  row.frame = frame.report.frame;
  row.time = frame.report.time;
  row.steps = frame.report.steps;
  row.dt = frame.report.dt;
  row.limit = frame.report.limit;
  row.particles = frame.report.particles;
  row.mass = totals.mass;
  for (int i = 0; i < 3; ++i) {
    row.momentum[i] = totals.momentum[i];
    row.angular_momentum[i] = totals.angular_momentum[i];
  }
  row.kinetic_energy = totals.kinetic_energy;
  row.elastic_energy = totals.elastic_energy;
  row.gravitational_energy = totals.gravitational_energy;
  row.max_speed = totals.max_speed;
  row.volume = totals.volume;
  row.volume_drift = totals.volume_drift();
  row.min_J = totals.min_J;
  row.max_J = totals.max_J;
  row.wall_seconds = frame.report.wall_seconds;
  row.further = {static_cast<double>(frame.report.parked)};
  for (const ColliderReport& collider : frame.report.colliders) {
    for (const double f : collider.force.e) row.further.push_back(f);
    for (const double m : collider.torque.e) row.further.push_back(m);
    row.further.push_back(static_cast<double>(collider.inside.particles));
    row.further.push_back(collider.inside.depth);
    row.further.push_back(static_cast<double>(collider.caught));
  }
  for (const auto* counts : {&frame.report.emitted, &frame.report.removed}) {
    for (const SourceCount& count : *counts) {
      row.further.push_back(static_cast<double>(count.particles));
      row.further.push_back(count.mass);
    }
  }
  return row;
}

std::vector<std::string> further_columns(const Scene& scene) {
  std::vector<std::string> names = {"parked"};
  for (const ColliderSettings& collider : scene.colliders) {
    for (const char* column :
         {"force_x", "force_y", "force_z", "torque_x", "torque_y", "torque_z", "inside", "depth", "caught"}) {
      names.push_back(fmt::format("{}.{}", collider.name, column));
    }
  }
  const auto add = [&](const auto& objects, const char* what) {
    for (const auto& object : objects) {
      names.push_back(fmt::format("{}.{}_particles", object.name, what));
      names.push_back(fmt::format("{}.{}_mass", object.name, what));
    }
  };
  add(scene.emitters, "emitted");
  add(scene.sinks, "removed");
  return names;
}

}  // namespace

std::vector<std::vector<ProbeRow>> probe_rows(const Simulation& simulation) {
  std::vector<std::vector<ProbeRow>> all;
  for (const ProbeSettings& probe : simulation.scene().probes) {
    const std::vector<Vec3d> points = probe_points(probe);
    const std::vector<ProbeValue> values = simulation.probe(points);
    std::vector<ProbeRow>& rows = all.emplace_back();
    for (std::size_t i = 0; i < points.size(); ++i) {
      rows.push_back({points[i], values[i].density, values[i].velocity, values[i].pressure});
    }
  }
  return all;
}

struct FrameOutput::Files {
  StatsTable stats;
  std::vector<ProbeTable> probes;
  FrameMetadata metadata;
  std::vector<SeriesFrame> series = {};
};

FrameOutput::FrameOutput(const Scene& scene, const RunFolder& folder)
    : scene_(scene),
      drawing_(scene_),
      folder_(folder),
      files_(new Files{StatsTable(folder.stats(), further_columns(scene_)), {}, metadata_of(scene)}) {
  for (const ProbeSettings& probe : scene.probes) files_->probes.emplace_back(folder.probe(probe.name));
  if (scene.render.film && scene.render.every_nth > 0) {
    if (program_exists("ffmpeg")) {
      film_ = std::make_unique<Film>(folder.film(), scene.render.width, scene.render.height,
                                     scene.render.film_rate_of(scene.frame_rate / scene.render.every_nth));
    } else {
      log_warning("there is no ffmpeg, so the pictures stay without a film; install the package ffmpeg");
    }
  }
  thread_ = std::thread([this] { work(); });
}

FrameOutput::~FrameOutput() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
    queue_.clear();
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void FrameOutput::submit(FinishedFrame frame) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return queue_.size() < kMostWaiting || failure_ != nullptr; });
  if (failure_ != nullptr) std::rethrow_exception(failure_);
  queue_.push_back(std::move(frame));
  changed_.notify_all();
}

void FrameOutput::finish() {
  {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return (queue_.empty() && !busy_) || failure_ != nullptr; });
    if (failure_ != nullptr) std::rethrow_exception(failure_);
  }
  if (film_ != nullptr) film_->close();
}

void FrameOutput::work() {
  while (true) {
    FinishedFrame frame;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return closing_ || !queue_.empty(); });
      if (closing_) return;
      frame = std::move(queue_.front());
      queue_.pop_front();
      busy_ = true;
      changed_.notify_all();
    }
    std::exception_ptr failure;
    try {
      write(frame);
      draw(frame);
    } catch (...) {
      failure = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    busy_ = false;
    if (failure != nullptr) failure_ = failure;
    changed_.notify_all();
    if (failure != nullptr) return;
  }
}

void FrameOutput::write(const FinishedFrame& frame) {
  const std::string name = frame_file_name(frame.report.frame);
  FrameMetadata metadata = files_->metadata;
  metadata.frame = frame.report.frame;
  write_frame(folder_.particles() / name, frame.snapshot, metadata);
  files_->series.push_back({name, frame.snapshot.time});
  write_frame_series(folder_.particles() / kFrameSeriesName, files_->series);
  files_->stats.append(row_of(frame));
  for (std::size_t i = 0; i < files_->probes.size(); ++i) {
    files_->probes[i].append(frame.report.frame, frame.report.time, frame.probes[i]);
  }
}

void FrameOutput::draw(const FinishedFrame& frame) {
  const int every = scene_.render.every_nth;
  if (every == 0 || (frame.report.frame - 1) % every != 0) return;
  View view = drawing_.view_at(frame.snapshot.time);
  if (!view.camera) {
    if (!camera_) camera_ = automatic_camera(frame.snapshot, view);
    view.camera = camera_;
  }
  const Image image = render_snapshot(frame.snapshot, view);
  write_png(folder_.image(frame.report.frame), image);
  if (film_ != nullptr) film_->add(image);
}

}  // namespace firn
