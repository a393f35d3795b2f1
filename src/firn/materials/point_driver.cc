#include <firn/core/error.h>
#include <firn/core/linear_algebra.h>
#include <firn/materials/model_info.h>
#include <firn/materials/point_driver.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace firn {
namespace {

/// Columns of one particle, padded for SIMD vectors of any width.
class Point {
 public:
  Point(int model, const ModelParameters& parameters)
      : model_(model), parameters_(parameters), update_(update_stress_function<double, 3>(model)) {
    const ModelInfo& info = all_models()[static_cast<std::size_t>(model)];
    for (int e = 0; e < 9; ++e) strain_[e][0] = e % 4 == 0 ? 1 : 0;
    for (std::size_t h = 0; h < info.history.size(); ++h) history_[h][0] = info.history[h].initial_value;
  }

  /// Moves the point by dt at a velocity gradient.
  void move(const Mat3d& grad_v, double dt) {
    MaterialColumns<double, 3> columns = {};
    for (int e = 0; e < 9; ++e) {
      grad_v_[e][0] = grad_v.e[e];
      columns.grad_v[e] = grad_v_[e].data();
      columns.strain[e] = strain_[e].data();
    }
    for (int h = 0; h < kMaxHistoryColumns; ++h) columns.history[h] = history_[h].data();
    for (int s = 0; s < 6; ++s) columns.stress[s] = stress_[s].data();
    report_ = update_(parameters_, columns, 0, 1, dt);
  }

  bool failed() const { return report_.failed != StressReport::kNone; }

  PointState state() const {
    PointState s;
    Mat3d F;
    for (int e = 0; e < 9; ++e) F.e[e] = strain_[e][0];
    for (int h = 0; h < kMaxHistoryColumns; ++h) s.history[static_cast<std::size_t>(h)] = history_[h][0];
    s.volume_ratio = volume_ratio(model_, parameters_, determinant(F), s.history.data());
    s.energy = energy_density<3>(model_, parameters_, F.e, s.history.data());
    for (std::size_t c = 0; c < 6; ++c) s.stress[c] = stress_[c][0] / s.volume_ratio;
    s.pressure = -(s.stress[0] + s.stress[1] + s.stress[2]) / 3;
    double squares = 0;
    for (std::size_t c = 0; c < 6; ++c) {
      const double deviator = c < 3 ? s.stress[c] + s.pressure : s.stress[c];
      squares += (c < 3 ? 1 : 2) * deviator * deviator;
    }
    s.von_mises = std::sqrt(1.5 * squares);
    s.wave_speed = report_.wave_speed;
    return s;
  }

  /// Work per undeformed volume of the present stress in a small motion, J/m^3.
  double work(const Mat3d& motion) const {
    return stress_[0][0] * motion(0, 0) + stress_[1][0] * motion(1, 1) + stress_[2][0] * motion(2, 2) +
           stress_[3][0] * (motion(0, 1) + motion(1, 0));
  }

 private:
  using Column = std::array<double, 8>;
  int model_;
  ModelParameters parameters_;
  UpdateStress<double, 3> update_;
  StressReport report_;
  Column grad_v_[9] = {}, strain_[9] = {}, history_[kMaxHistoryColumns] = {}, stress_[6] = {};
};

/// The x at which a function that grows with x is zero: the guess if it is one, else by regula falsi with the Illinois
/// rule after bracketing outwards from `width` around the guess. Without a change of sign, NaN.
template <class Function>
double find_root(const Function& f, double guess, double width, double tolerance) {
  if (std::fabs(f(guess)) <= tolerance) return guess;
  double low = guess - width, high = guess + width, at_low = f(low), at_high = f(high);
  for (int n = 0; n < 20 && !(at_low <= 0 && at_high >= 0); ++n) {
    width *= 2;
    if (!(at_low <= 0)) at_low = f(low -= width);
    if (!(at_high >= 0)) at_high = f(high += width);
  }
  if (!(at_low <= 0 && at_high >= 0)) return std::nan("");
  for (int n = 0, side = 0; n < 200; ++n) {
    double middle = (low * at_high - high * at_low) / (at_high - at_low);
    if (!(middle > low && middle < high)) middle = 0.5 * (low + high);
    const double value = f(middle);
    if (std::fabs(value) <= tolerance || !(middle > low && middle < high)) return middle;
    if (value <= 0) {
      low = middle, at_low = value;
      if (side == -1) at_high *= 0.5;
      side = -1;
    } else {
      high = middle, at_high = value;
      if (side == 1) at_low *= 0.5;
      side = 1;
    }
  }
  return 0.5 * (low + high);
}

Mat3d diagonal(double x, double y, double z) { return {{x, 0, 0, 0, y, 0, 0, 0, z}}; }

std::string model_name(const PointRequest& request) {
  return std::string(all_models()[static_cast<std::size_t>(request.model)].name);
}

void check(const PointRequest& request) {
  const auto refuse = [](const char* what, double value, const char* range) {
    throw Error(ErrorKind::usage, fmt::format("{} of a point test must be {}, got {:g}", what, range, value));
  };
  if (!(std::fabs(request.strain) > 0 && std::fabs(request.strain) <= 100)) {
    refuse("strain", request.strain, "between -100 and 100 and not 0");
  }
  if (!(request.rate > 0 && request.rate <= 1e12)) refuse("rate", request.rate, "in (0, 1e12] 1/s");
  if (!(request.pressure >= 0 && request.pressure <= 1e13)) refuse("pressure", request.pressure, "in [0, 1e13] Pa");
  if (!(request.steps >= 1 && request.steps <= 10000000)) refuse("steps", request.steps, "in [1, 1e7]");
  if (!(request.cycles >= 1 && request.cycles <= 1000)) refuse("cycles", request.cycles, "in [1, 1000]");
}

/// Squeezes the undeformed point all round until it is under the pressure.
Point pressed(const PointRequest& request) {
  const Point fresh(request.model, request.parameters);
  const auto squeezed = [&](double strain) {
    // A hundred small steps: plastic material packs on the way.
    Point point = fresh;
    for (int n = 0; n < 100; ++n) {
      const double step = std::expm1(-strain / 100);
      point.move(diagonal(step, step, step), 1);
    }
    point.move(Mat3d{}, 0);
    return point;
  };
  const auto missing = [&](double strain) { return squeezed(strain).state().pressure - request.pressure; };
  const double strain = request.pressure > 0 ? find_root(missing, 0, 1e-4, 1e-9 * request.pressure) : 0;
  if (!(std::fabs(strain) < 5)) {
    throw Error(ErrorKind::numerical,
                fmt::format("{} cannot be brought under a pressure of {:g} Pa: lower the pressure", model_name(request),
                            request.pressure));
  }
  return squeezed(strain);
}

/// The velocity gradient that shortens x at `rate` while the stress across stays at minus `pressure`.
Mat3d axial_motion(const Point& point, double rate, double dt, double pressure) {
  const auto sideways = [&](double lateral) {
    Point trial = point;
    trial.move(diagonal(rate, lateral, lateral), dt);
    return trial.state().stress[1] + pressure;
  };
  const double start = point.state().von_mises + std::fabs(point.state().pressure) + pressure;
  const double lateral = find_root(sideways, -0.5 * rate, 0.5 * std::fabs(rate), 1e-10 * start);
  return diagonal(rate, lateral, lateral);
}

/// Rate of strain in step n, 1/s.
double rate_at(const PointRequest& request, int n) {
  if (request.path == PointPath::triaxial) return -request.rate;
  if (request.path != PointPath::cyclic) return std::copysign(request.rate, request.strain);
  const double phase = std::fmod((n + 0.5) / request.steps * request.cycles, 1.0);
  return std::copysign(request.rate, request.strain) * (phase < 0.25 || phase > 0.75 ? 1 : -1);
}

}  // namespace

std::optional<PointPath> find_point_path(std::string_view name) {
  const auto found = std::ranges::find(kPointPathNames, name);
  if (found == kPointPathNames.end()) return std::nullopt;
  return static_cast<PointPath>(found - kPointPathNames.begin());
}

std::vector<PointState> drive_point(const PointRequest& request) {
  check(request);
  const bool axial = request.path == PointPath::uniaxial || request.path == PointPath::triaxial;
  const double length = std::fabs(request.strain) * (request.path == PointPath::cyclic ? 4 * request.cycles : 1);
  const double dt = length / request.rate / request.steps;
  Point point = pressed(request);
  std::vector<PointState> states = {point.state()};
  states.reserve(static_cast<std::size_t>(request.steps) + 1);
  double strain = 0, work = 0;
  for (int n = 0; n < request.steps; ++n) {
    const double rate = rate_at(request, n);
    // Exact for a stretch: each step multiplies by exp(rate dt).
    const double stretch_rate = std::expm1(rate * dt) / dt;
    const Mat3d motion =
        axial ? axial_motion(point, stretch_rate, dt, request.pressure) : Mat3d{{0, rate, 0, 0, 0, 0, 0, 0, 0}};
    strain += rate * dt;
    const double before = point.work(dt * motion);
    point.move(motion, dt);
    work += 0.5 * (before + point.work(dt * motion));
    if (point.failed() || !std::isfinite(motion(1, 1))) {
      throw Error(ErrorKind::numerical,
                  fmt::format("{} fails at a strain of {:g}: {}", model_name(request), strain,
                              point.failed() && std::isfinite(motion(1, 1))
                                  ? "its state is not finite or turned inside out; use more steps"
                                  : "no motion of the sides keeps their stress; use more steps or less strain"));
    }
    PointState state = point.state();
    state.time = (n + 1) * dt;
    state.strain = strain;
    state.work = work;
    states.push_back(state);
  }
  return states;
}

}  // namespace firn
