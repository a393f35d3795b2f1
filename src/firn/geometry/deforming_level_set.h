#pragma once

#include <firn/geometry/deforming_shape.h>
#include <firn/geometry/level_set.h>
#include <firn/geometry/sequence_clock.h>
#include <firn/geometry/vector_grid.h>

#include <memory>
#include <vector>

namespace firn {

/// One entry of a sequence of level sets.
struct LevelSetFrame {
  std::shared_ptr<const LevelSet> distance;
  std::shared_ptr<const VectorGrid> velocity;  ///< m/s; may be null
};

/// The solid inside level sets that are interpolated linearly in time at fixed places: phi = sum w_k phi_k. That is a
/// distance next to the surface as long as one entry's surface, with the nodes on both sides of it, lies in the
/// narrow band of the next, and a bound elsewhere.
///
/// A level set knows its motion only across the surface: n v = -(d phi / d t) / |grad phi|. Along the surface the
/// velocity is that of the entries' velocity grids, and zero without them.
class DeformingLevelSet final : public DeformingShape<3> {
 public:
  /// Throws Error (usage) unless there is one frame for each entry of the clock.
  DeformingLevelSet(std::vector<LevelSetFrame> frames, SequenceClock clock, bool inverted = false);

  std::shared_ptr<const ShapeInMotion<3>> at(double t) const override;
  const std::vector<double>& times() const override { return clock_.times(); }

 private:
  friend class LevelSetInstant;

  std::vector<LevelSetFrame> frames_;
  std::vector<double> changes_;  ///< of the distance next to the surface from each entry to the next at most, m
  SequenceClock clock_;
  bool inverted_;
};

}  // namespace firn
