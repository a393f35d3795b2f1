#pragma once

#include <firn/apps/frame_output.h>
#include <firn/apps/progress.h>
#include <firn/apps/run_folder.h>
#include <firn/simulation/simulation.h>

#include <functional>
#include <memory>

namespace firn {

/// A run, from its first frame or from a checkpoint on.
struct RunJob {
  const Scene& scene;
  const RunFolder& folder;
  RunInfo& info;
  Simulation& simulation;
  Progress::Style style = Progress::Style::text;
  bool is_resumed = false;  ///< the simulation's present frame is on the disk already
  bool is_changed = false;  ///< what lies on the disk after it is another scene's
};

/// Computes all frames that are left, with their output and checkpoints, and keeps run.json up to date. Throws
/// Interrupted after the checkpoint that a first SIGINT or SIGTERM asks for, and Error as Simulation and the writers
/// do.
void run_to_end(const RunJob& job);

/// Simulation::create and, given a checkpoint, restore(); if there is not enough memory, Error(resources) with the
/// largest arrays.
/// @param check is shown the plan before a particle is placed; may be empty
std::unique_ptr<Simulation> create_simulation(const Scene& scene, const Checkpoint* checkpoint = nullptr,
                                              const PlanCheck& check = {});

}  // namespace firn
