#pragma once

#include <firn/apps/run_folder.h>
#include <firn/apps/scene_view.h>
#include <firn/io/probe_table.h>
#include <firn/render/film.h>
#include <firn/render/scene_view.h>
#include <firn/simulation/simulation.h>

#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace firn {

/// One accepted frame on its way to the disk.
struct FinishedFrame {
  Snapshot snapshot;
  FrameReport report;
  Totals totals;
  std::vector<std::vector<ProbeRow>> probes = {};  ///< of each probe of the scene
};

/// What a run that goes on finds in its folder.
struct FrameHistory {
  std::int64_t frames = 0;  ///< those up to here stay as they are
  bool keeps_later = true;  ///< whether what is later stays listed until it is replaced by its like
};

/// The rows of the scene's probes at the frame that the simulation stands at.
std::vector<std::vector<ProbeRow>> probe_rows(const Simulation& simulation);

/// What the output of frames took from the simulation.
struct OutputCost {
  double waiting = 0;  ///< s that the simulation stood still because the frame before was not written yet
  double writing = 0;  ///< s of processor time of the writing thread, pictures not counted
};

/// Writes frames, the row of statistics, pictures and the film in a thread of its own, while the next frame is
/// computed. One frame at most is on its way.
class FrameOutput {
 public:
  FrameOutput(const Scene& scene, const RunFolder& folder, const FrameHistory& history = {});
  /// Stops without closing the film if finish() was not called.
  ~FrameOutput();
  FrameOutput(const FrameOutput&) = delete;
  FrameOutput& operator=(const FrameOutput&) = delete;

  /// Waits until the frame before is on the disk, and gives its memory back for the next: so there is only one copy of
  /// the particles. Throws what went wrong with it.
  Snapshot wait_for_room();

  /// Hands a frame over. Throws what went wrong with an earlier one.
  void submit(FinishedFrame frame);

  /// Waits until every frame that was handed over is on the disk. Throws what went wrong.
  void wait();

  /// Waits for everything and closes the film. Throws what went wrong.
  void finish();

  bool has_film() const { return film_ != nullptr; }

  /// The newest frame that is on the disk; that of the history at first.
  std::int64_t written() const;
  OutputCost cost() const;

 private:
  void wait_until_empty(std::unique_lock<std::mutex>& lock);
  void work();
  void write(const FinishedFrame& frame);
  void note_written(std::int64_t frame, double seconds);
  void draw(const FinishedFrame& frame);
  Image draw(const Snapshot& snapshot);
  void draw_history();

  struct Files;

  const Scene scene_;
  const SceneDrawing drawing_;
  const RunFolder folder_;
  const FrameHistory history_;
  std::unique_ptr<Files> files_;
  std::unique_ptr<Film> film_;
  std::optional<Camera> camera_;  // of the first picture, so that an automatic camera stands still

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<FinishedFrame> next_;
  Snapshot spare_;
  bool busy_ = true, holds_frame_ = false, closing_ = false;
  std::int64_t written_ = 0;
  OutputCost cost_;
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace firn
