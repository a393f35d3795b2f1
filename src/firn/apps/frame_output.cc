#include <firn/apps/frame_output.h>
#include <firn/core/error.h>
#include <firn/core/log.h>
#include <firn/io/frame_reader.h>
#include <firn/io/frame_series.h>
#include <firn/io/frame_writer.h>
#include <firn/io/stats_table.h>
#include <firn/scene/probe_points.h>
#include <firn/scene/resolved.h>
#include <fmt/format.h>

#include <chrono>
#include <ctime>
#include <map>
#include <utility>

namespace firn {
namespace {

/// Processor time of the calling thread, s.
double thread_seconds() {
  timespec time = {};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

FrameMetadata metadata_of(const Scene& scene) {
  FrameMetadata metadata;
  metadata.precision = scene.precision == Scene::Precision::single ? "single" : "double";
  metadata.scene_hash = scene_hash(scene);
  metadata.firn_version = FIRN_VERSION;
  metadata.up.assign(1, scene.up == Scene::Up::y ? 'y' : 'z');
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

StatsTable stats_of(const Scene& scene, const RunFolder& folder, const FrameHistory& history) {
  if (history.frames == 0) return StatsTable(folder.stats(), further_columns(scene));
  return StatsTable::resume(folder.stats(), further_columns(scene), history.frames, history.keeps_later);
}

std::vector<ProbeTable> probes_of(const Scene& scene, const RunFolder& folder, const FrameHistory& history) {
  std::vector<ProbeTable> tables;
  for (const ProbeSettings& probe : scene.probes) {
    const std::filesystem::path path = folder.probe(probe.name);
    tables.push_back(history.frames == 0 ? ProbeTable(path)
                                         : ProbeTable::resume(path, history.frames, history.keeps_later));
  }
  return tables;
}

/// The frames that are there, by number. Those that a changed scene makes wrong are removed.
std::map<std::int64_t, SeriesFrame> frames_of(const Scene& scene, const RunFolder& folder,
                                              const FrameHistory& history) {
  std::map<std::int64_t, SeriesFrame> frames;
  if (history.frames == 0) return frames;
  const auto exists = [&](std::int64_t frame) {
    std::error_code error;
    return std::filesystem::exists(folder.particles() / frame_file_name(frame), error);
  };
  std::int64_t missing = 0;
  for (std::int64_t frame = 1; frame <= history.frames || exists(frame); ++frame) {
    const std::string name = frame_file_name(frame);
    if (frame > history.frames && !history.keeps_later) {
      std::error_code error;
      std::filesystem::remove(folder.particles() / name, error);
      std::filesystem::remove(folder.image(frame), error);
    } else if (exists(frame)) {
      frames[frame] = {name, static_cast<double>(frame - 1) / scene.frame_rate};
    } else {
      ++missing;
    }
  }
  if (missing > 0) {
    log_warning(
        fmt::format("{} of the frames 1 to {} are missing in {}; firn resume --from-frame computes frames again",
                    missing, history.frames, folder.particles().string()));
  }
  return frames;
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
  std::map<std::int64_t, SeriesFrame> frames = {};

  void write_series(const RunFolder& folder) const {
    std::vector<SeriesFrame> series;
    for (const auto& [number, frame] : frames) series.push_back(frame);
    write_frame_series(folder.particles() / kFrameSeriesName, series);
  }
};

FrameOutput::FrameOutput(const Scene& scene, const RunFolder& folder, const FrameHistory& history)
    : scene_(scene),
      drawing_(scene_),
      folder_(folder),
      history_(history),
      files_(new Files{stats_of(scene_, folder, history), probes_of(scene_, folder, history), metadata_of(scene),
                       frames_of(scene, folder, history)}),
      written_(history.frames) {
  if (history.frames > 0) files_->write_series(folder);
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
    next_.reset();
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void FrameOutput::wait_until_empty(std::unique_lock<std::mutex>& lock) {
  const auto start = std::chrono::steady_clock::now();
  // Pictures that a resumed run's film begins with hold no frame.
  changed_.wait(lock, [&] { return (!next_ && !holds_frame_) || failure_ != nullptr; });
  cost_.waiting += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (failure_ != nullptr) std::rethrow_exception(failure_);
}

Snapshot FrameOutput::wait_for_room() {
  std::unique_lock lock(mutex_);
  wait_until_empty(lock);
  return std::exchange(spare_, {});
}

void FrameOutput::submit(FinishedFrame frame) {
  std::unique_lock lock(mutex_);
  wait_until_empty(lock);
  next_ = std::move(frame);
  changed_.notify_all();
}

std::int64_t FrameOutput::written() const {
  const std::lock_guard lock(mutex_);
  return written_;
}

OutputCost FrameOutput::cost() const {
  const std::lock_guard lock(mutex_);
  return cost_;
}

void FrameOutput::wait() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return (!next_ && !busy_) || failure_ != nullptr; });
  if (failure_ != nullptr) std::rethrow_exception(failure_);
  files_->stats.sync();
  for (const ProbeTable& probe : files_->probes) probe.sync();
}

void FrameOutput::finish() {
  wait();
  if (film_ != nullptr) film_->close();
}

void FrameOutput::work() {
  // The film's pictures of earlier frames come first; until then `busy_` is set.
  bool is_history_drawn = false;
  while (true) {
    std::optional<FinishedFrame> frame;
    if (is_history_drawn) {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return closing_ || next_; });
      if (closing_) return;
      frame = std::exchange(next_, std::nullopt);
      busy_ = holds_frame_ = true;
    }
    std::exception_ptr failure;
    try {
      if (is_history_drawn) {
        const double start = thread_seconds();
        write(*frame);
        note_written(frame->report.frame, thread_seconds() - start);
        draw(*frame);
      } else {
        draw_history();
        is_history_drawn = true;
      }
    } catch (...) {
      failure = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    if (frame) spare_ = std::move(frame->snapshot);
    busy_ = holds_frame_ = false;
    if (failure != nullptr) failure_ = failure;
    changed_.notify_all();
    if (failure != nullptr) return;
  }
}

void FrameOutput::note_written(std::int64_t frame, double seconds) {
  const std::lock_guard lock(mutex_);
  written_ = frame;
  cost_.writing += seconds;
}

void FrameOutput::write(const FinishedFrame& frame) {
  const std::string name = frame_file_name(frame.report.frame);
  FrameMetadata metadata = files_->metadata;
  metadata.frame = frame.report.frame;
  write_frame(folder_.particles() / name, frame.snapshot, metadata);
  files_->frames[frame.report.frame] = {name, frame.snapshot.time};
  files_->write_series(folder_);
  files_->stats.append(row_of(frame));
  for (std::size_t i = 0; i < files_->probes.size(); ++i) {
    files_->probes[i].append(frame.report.frame, frame.report.time, frame.probes[i]);
  }
}

Image FrameOutput::draw(const Snapshot& snapshot) {
  View view = drawing_.view_at(snapshot.time);
  if (!view.camera) {
    if (!camera_) camera_ = automatic_camera(snapshot, view);
    view.camera = camera_;
  }
  return render_snapshot(snapshot, view);
}

void FrameOutput::draw(const FinishedFrame& frame) {
  const int every = scene_.render.every_nth;
  if (every == 0 || (frame.report.frame - 1) % every != 0) return;
  const Image image = draw(frame.snapshot);
  write_png(folder_.image(frame.report.frame), image);
  if (film_ != nullptr) film_->add(image);
}

void FrameOutput::draw_history() {
  const int every = scene_.render.every_nth;
  if (every == 0) return;
  for (std::int64_t frame = 1; frame <= history_.frames; frame += every) {
    {
      const std::lock_guard lock(mutex_);
      if (closing_) return;
    }
    if (!files_->frames.contains(frame)) continue;
    const std::filesystem::path path = folder_.particles() / frame_file_name(frame);
    try {
      // The first one's camera is everybody's.
      if (!camera_ && !drawing_.view_at(0).camera) {
        const Snapshot first = read_frame(path);
        camera_ = automatic_camera(first, drawing_.view_at(first.time));
      }
      if (film_ == nullptr) return;
      std::optional<Image> image = read_png(folder_.image(frame));
      if (!image || image->width != scene_.render.width || image->height != scene_.render.height) {
        image = draw(read_frame(path));
        write_png(folder_.image(frame), *image);
      }
      film_->add(*image);
    } catch (const Error& error) {
      log_warning(fmt::format("the film goes without the picture of frame {}: {}", frame, error.what()));
    }
  }
}

}  // namespace firn
