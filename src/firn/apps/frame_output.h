#pragma once

#include <firn/apps/run_folder.h>
#include <firn/apps/scene_view.h>
#include <firn/io/probe_table.h>
#include <firn/render/film.h>
#include <firn/render/scene_view.h>
#include <firn/simulation/simulation.h>

#include <condition_variable>
#include <deque>
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

/// Writes frames, the row of statistics, pictures and the film in a thread of its own, while the next frame is
/// computed.
class FrameOutput {
 public:
  FrameOutput(const Scene& scene, const RunFolder& folder, const FrameHistory& history = {});
  /// Stops without closing the film if finish() was not called.
  ~FrameOutput();
  FrameOutput(const FrameOutput&) = delete;
  FrameOutput& operator=(const FrameOutput&) = delete;

  /// Hands a frame over; waits while two are still unwritten. Throws what went wrong with an earlier one.
  void submit(FinishedFrame frame);

  /// Waits until every frame that was handed over is on the disk. Throws what went wrong.
  void wait();

  /// Waits for everything and closes the film. Throws what went wrong.
  void finish();

  bool has_film() const { return film_ != nullptr; }

 private:
  void work();
  void write(const FinishedFrame& frame);
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

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<FinishedFrame> queue_;
  bool busy_ = true, closing_ = false;
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace firn
