#pragma once

#include <firn/core/parameter.h>

#include <cmath>
#include <numbers>

namespace firn {

// What the models of grains share: sand, soil, snow pack.

inline constexpr Parameter kFrictionAngle = {
    .name = "friction_angle",
    .unit = "degrees",
    .default_value = 30,
    .minimum = 0,
    .maximum = 80,
    .minimum_allowed = false,
    .help = "Mohr-Coulomb angle of internal friction in triaxial compression; 30 degrees rest at a slope of 34.7.",
    .hint = "degrees, not radians: loose sand is near 30, dense sand 40, snow 20 to 40",
};

inline constexpr Parameter kDilationLimit = {
    .name = "dilation_limit",
    .unit = "",
    .default_value = 0.5,
    .minimum = 1e-3,
    .maximum = 10,
    .help = "Largest logarithm of the volume ratio that opened material remembers and must close before it bears load.",
};

/// M = q/p on the cone, from the friction angle in degrees: 6 sin phi / (3 - sin phi) (triaxial compression).
inline double friction_slope(double friction_angle) {
  const double sine = std::sin(friction_angle * std::numbers::pi / 180);
  return 6 * sine / (3 - sine);
}

/// c cot phi, Pa: the tension at the tip of the cone of cohesion c (Pa) and friction angle phi (degrees).
inline double tension_limit(double friction_angle, double cohesion) {
  return cohesion / std::tan(friction_angle * std::numbers::pi / 180);
}

/// The slope, in degrees, at which an endless layer rests: tan = M / sqrt(3), of plane shear at constant volume.
inline double resting_slope(double friction_angle) {
  return std::atan(friction_slope(friction_angle) / std::numbers::sqrt3) * 180 / std::numbers::pi;
}

}  // namespace firn
