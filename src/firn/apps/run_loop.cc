#include <firn/apps/checkpoint_store.h>
#include <firn/apps/commands.h>
#include <firn/apps/interrupt.h>
#include <firn/apps/run_loop.h>
#include <firn/core/error.h>
#include <firn/scene/value_text.h>
#include <firn/simulation/memory_estimate.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <new>
#include <optional>
#include <utility>

namespace firn {
namespace {

void print_line(const std::string& line) {
  std::fprintf(stdout, "%s\n", one_line(line).c_str());
  std::fflush(stdout);
}

/// The frames of one run, as they come.
class FrameLoop {
 public:
  explicit FrameLoop(const RunJob& job)
      : job_(job),
        store_(job.scene, job.folder, job.info),
        output_(job.scene, job.folder, history_of(job)),
        progress_(job.style, job.simulation.frame_count(), job.simulation.frame()) {}

  /// What is said to be there is there, whatever happens.
  void run() {
    try {
      compute();
    } catch (...) {
      job_.info.frames = output_.written();
      throw;
    }
  }

  /// Everything that was handed over is on the disk, and the film is closed.
  void finish() {
    output_.finish();
    job_.info.frames = output_.written();
    note_cost();
  }
  bool has_film() const { return output_.has_film(); }
  /// After a failure that was taken back.
  void save_last_good() {
    if (!store_.holds(job_.simulation)) save();
  }

 private:
  void compute() {
    Simulation& simulation = job_.simulation;
    if (!job_.is_resumed) hand_over(simulation.report());
    // A scene that was changed must not be mixed up with what the checkpoint before says of it.
    if (!job_.is_resumed || job_.is_changed) save();
    while (simulation.frame() < simulation.frame_count() && !interrupted()) {
      const std::optional<FrameReport> report = simulation.advance_frame([&] { return interrupted() || store_.due(); });
      if (report) hand_over(*report);
      if (!interrupted() && (!report || store_.due_after(report->frame))) save();
    }
    if (!store_.holds(simulation)) save();
  }

  void note_cost() {
    const OutputCost cost = output_.cost();
    job_.info.copying_seconds = before_.copying_seconds + copying_;
    job_.info.waiting_seconds = before_.waiting_seconds + cost.waiting;
    job_.info.writing_seconds = before_.writing_seconds + cost.writing;
  }

  static FrameHistory history_of(const RunJob& job) {
    if (!job.is_resumed) return {};
    return {job.simulation.frame(), !job.is_changed};
  }

  void hand_over(const FrameReport& report) {
    Snapshot memory = output_.wait_for_room();
    const auto start = std::chrono::steady_clock::now();
    Snapshot snapshot = job_.simulation.snapshot(std::move(memory));
    copying_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    output_.submit({std::move(snapshot), report, job_.simulation.totals(), probe_rows(job_.simulation)});
    print_line(progress_.line(report));
    job_.info.frames = report.frame;
    job_.info.particles = report.particles;
    job_.info.wall_seconds += report.wall_seconds;
  }

  void save() {
    // A checkpoint says that everything before it is there.
    output_.wait();
    note_cost();
    store_.save(job_.simulation);
  }

  const RunJob& job_;
  CheckpointStore store_;
  FrameOutput output_;
  Progress progress_;
  const RunInfo before_ = job_.info;  ///< of the run that goes on
  double copying_ = 0;                ///< s
};

/// The status of a run that ends with an error, if it can still be written: the error that is reported is the first.
void note_failure(const RunJob& job, const std::string& message) {
  job.info.status = message;
  try {
    write_run_info(job.folder, job.scene, job.info);
  } catch (const std::exception&) {
    return;
  }
}

Error out_of_memory(const Scene& scene, const WorldPlan* plan) {
  return Error(ErrorKind::resources, memory_message(scene, plan));
}

/// Where a run that cannot go on could be taken up again.
std::string newest_text(const RunJob& job) {
  if (job.info.checkpoints.empty()) return "";
  return fmt::format(
      ". The newest checkpoint is of frame {}: firn resume --allow-changed goes on from it with other "
      "limits.",
      job.info.checkpoints.back().frame);
}

void print_results(const RunJob& job, bool has_film) {
  const RunFolder& folder = job.folder;
  // Of all threads together, as the simulation's own time is.
  const double output =
      job.info.copying_seconds + job.info.waiting_seconds + job.info.writing_seconds / std::max(job.info.threads, 1);
  const double all = job.info.wall_seconds + output;
  // A run of an instant says nothing about costs.
  const char* what = job.scene.render.every_nth > 0 ? "writing frames and waiting for pictures" : "writing frames";
  const std::string share = all > 1 ? fmt::format("; {} took {:.1f} % of it", what, 100 * output / all) : "";
  print_line(fmt::format("done in {}{}", duration_text(all), share));
  print_line(fmt::format("  frames    {}  (open {} in ParaView)", folder.particles().string(),
                         (folder.particles() / "particles.hdf.series").string()));
  if (job.scene.render.every_nth > 0) print_line(fmt::format("  pictures  {}", folder.images().string()));
  if (has_film) print_line(fmt::format("  film      {}", folder.film().string()));
  print_line(fmt::format("  numbers   {}", folder.stats().string()));
  if (!job.scene.probes.empty()) print_line(fmt::format("  probes    {}", folder.probes().string()));
}

}  // namespace

void run_to_end(const RunJob& job) {
  bool has_film = false;
  try {
    FrameLoop loop(job);
    try {
      loop.run();
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::numerical) throw;
      // What was accepted before the failure is kept and readable, and the run can be taken up from there.
      loop.finish();
      if (job.scene.rollback == Scene::Rollback::memory) loop.save_last_good();
      throw Error(error.kind(), error.what() + newest_text(job));
    }
    has_film = loop.has_film() && !interrupted();
    if (!interrupted()) loop.finish();
  } catch (const Error& error) {
    note_failure(job, error.what());
    throw;
  } catch (const std::bad_alloc&) {
    const Error error = out_of_memory(job.scene, &job.simulation.plan());
    note_failure(job, error.what());
    throw error;
  }
  const bool is_finished = job.simulation.frame() == job.simulation.frame_count();
  job.info.status = is_finished && !interrupted() ? "finished" : "interrupted";
  write_run_info(job.folder, job.scene, job.info);
  if (interrupted()) {
    throw Interrupted(fmt::format("stopped after frame {}; everything up to it is in {}, and firn resume goes on",
                                  job.info.frames, job.folder.root.string()));
  }
  if (job.style == Progress::Style::text) print_results(job, has_film);
}

std::unique_ptr<Simulation> create_simulation(const Scene& scene, const Checkpoint* checkpoint,
                                              const PlanCheck& check) {
  try {
    std::unique_ptr<Simulation> simulation = Simulation::create(scene, check);
    if (checkpoint) simulation->restore(*checkpoint);
    return simulation;
  } catch (const std::bad_alloc&) {
    throw out_of_memory(scene, nullptr);
  }
}

}  // namespace firn
