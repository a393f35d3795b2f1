#pragma once

#include <firn/integrators/world.h>

#include <cstdint>
#include <string_view>

namespace firn {

/// What tells whether a cube has landed.
struct BenchMotion {
  double kinetic_energy = 0;   ///< of the particle velocities, J
  double upward_momentum = 0;  ///< kg m/s
};

/// Sums in double and in a fixed order.
template <class Real, int dim>
BenchMotion motion_of(const World<Real, dim>& world);

/// Sees the motion of a falling cube now and then, and says when it has landed.
class LandingWatch {
 public:
  enum class Rule {
    half_energy,  ///< kinetic energy below half of its peak
    rebound,      ///< the first rebound is over: momentum has turned upwards and down again
  };

  explicit LandingWatch(Rule rule) : rule_(rule) {}

  /// Materials without plasticity rebound; without that rule they would count as landed when they are squeezed most.
  static Rule rule_of(std::string_view material);

  void note(const BenchMotion& motion);
  bool landed() const { return landed_; }
  double peak_kinetic_energy() const { return peak_; }

 private:
  Rule rule_;
  bool rising_ = false, landed_ = false;
  double peak_ = 0;
};

/// How a landed state came to be.
struct Landing {
  std::uint64_t steps = 0;
  double peak_kinetic_energy = 0;  ///< J
  double kinetic_energy = 0;       ///< of the landed state, J
};

/// Steps a prepared world until it has landed. Error(numerical) if it does not within `most_steps`, or a particle
/// fails.
template <class Real, int dim>
Landing land(World<Real, dim>& world, std::uint64_t most_steps);

}  // namespace firn
