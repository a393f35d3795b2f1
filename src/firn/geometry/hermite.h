#pragma once

namespace firn {

/// Weights of a cubic Hermite curve on an interval of length h, s: of the values at its ends and of the tangents there.
struct Hermite {
  double v0, v1, m0, m1;
};

/// At u in [0, 1].
inline Hermite hermite(double u, double h) {
  const double w = 1 - u;
  return {w * w * (1 + 2 * u), u * u * (3 - 2 * u), h * u * w * w, -h * u * u * w};
}

/// The time derivatives of hermite().
inline Hermite hermite_rate(double u, double h) {
  const double w = 1 - u;
  return {-6 * u * w / h, 6 * u * w / h, w * (1 - 3 * u), u * (3 * u - 2)};
}

/// The slope at the middle one of three values, that of the parabola through them, as a sum of the differences: the
/// nearer neighbour counts more.
struct MiddleSlope {
  double from_before, from_after;

  /// @param before, after times between the values, s
  MiddleSlope(double before, double after)
      : from_before(after / (before + after) / before), from_after(before / (before + after) / after) {}
};

}  // namespace firn
