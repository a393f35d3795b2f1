#pragma once

#include <functional>
#include <vector>

#include "verification_scenes/scene_run.h"

namespace firn::test {

/// Follows one mode of a small vibration that begins at zero displacement: displacement and velocity are projected on
/// the mode's shape, in which free vibration of angular frequency omega is a circle of (omega q, dq/dt).
class Vibration {
 public:
  /// @param shape displacement of the mode at the undeformed place X
  Vibration(const Simulation& simulation, double omega, std::function<Vec3d(const Vec3d& X)> shape);

  /// To be called at least three times a period.
  void sample();

  /// Period over 2 pi / omega.
  double period() const;
  /// Amplitude over that of the first sample.
  double amplitude() const { return radius_ / first_radius_; }
  /// Kinetic and elastic energy over that of the first sample: now, and the largest so far.
  double energy() const { return energy_; }
  double energy_peak() const { return energy_peak_; }

 private:
  const Simulation& simulation_;
  double omega_;
  std::vector<Vec3d> start_, shape_;
  double first_radius_ = 0, radius_ = 0, angle_ = 0, turned_ = 0;
  double first_energy_ = 0, energy_ = 0, energy_peak_ = 0;
};

}  // namespace firn::test
