#include <algorithm>
#include <cmath>
#include <numbers>

#include "verification_scenes/check.h"
#include "verification_scenes/scene_run.h"

namespace firn::test {
namespace {

constexpr double kGravity = 9.81, kAngle = 24 * std::numbers::pi / 180;
constexpr double kLength = 0.8, kHeight = 0.4;                // m, of the block
constexpr double kSlides = 0.267949192431123, kSticks = 0.5;  // tan 15 degrees; tan 24 degrees is 0.445

/// How the plane lies in the grid.
enum class Plane {
  aligned,  ///< gravity is tilted
  oblique,  ///< the plane is tilted
};

struct Slide {
  double distance = 0;      ///< after 2 s, m
  double acceleration = 0;  ///< from 0.5 to 2 s, m/s^2
  double drift = 0;         ///< from 1 to 2 s, m
};

std::vector<std::string> placed(Plane plane) {
  const double s = std::sin(kAngle), c = std::cos(kAngle);
  if (plane == Plane::aligned) return {fmt::format("gravity=[{}, {}]", kGravity * s, -kGravity * c)};
  const double x = 0.5 * kLength * c + 0.5 * kHeight * s, y = -0.5 * kLength * s + 0.5 * kHeight * c;
  return {fmt::format("gravity=[0, {}]", -kGravity), fmt::format("collider.incline.normal=[{}, {}]", s, c),
          "body.block.rotation=-24", fmt::format("body.block.position=[{}, {}]", x, y)};
}

Slide slide(Plane plane, double cell_size, double friction) {
  std::vector<std::string> overrides = placed(plane);
  overrides.push_back(fmt::format("resolution.cell_size={}", cell_size));
  overrides.push_back(fmt::format("collider.incline.friction={}", friction));
  const auto simulation = open_scene("incline", overrides);
  const Vec3d down = plane == Plane::aligned ? Vec3d{{1, 0, 0}} : Vec3d{{std::cos(kAngle), -std::sin(kAngle), 0}};
  double start = 0, place_at_1 = 0, speed_at_half = 0;
  Slide result;
  run_frames(*simulation, [&] {
    const ParticleColumns particles = particles_of(*simulation);
    double place = 0;
    for (const Vec3d& x : particles.x) place += dot(x, down);
    place /= static_cast<double>(particles.size());
    const double speed = dot(mean_velocity(particles, 0), down), t = simulation->time();
    if (t == 0) start = place;
    if (std::abs(t - 0.5) < 1e-9) speed_at_half = speed;
    if (std::abs(t - 1) < 1e-9) place_at_1 = place;
    result = {place - start, (speed - speed_at_half) / 1.5, place - place_at_1};
  });
  return result;
}

Outcome measure(Level level) {
  const double exact = kGravity * (std::sin(kAngle) - kSlides * std::cos(kAngle));
  const std::string aligned = "acceleration error, aligned plane";
  if (level == Level::control) {
    return {{}, {at_most(aligned, slide(Plane::aligned, 0.1, 1.01 * kSlides).acceleration / exact - 1, 1e-3)}};
  }
  Outcome outcome;
  outcome.table.header = {"plane", "cell, m", "acceleration/theory", "way in 2 s/theory",
                          "sticking: creep from 1 to 2 s, m"};
  double worst[2] = {}, way = 0, creep = 0;
  for (const double h : {0.1, 0.05, 0.025}) {
    if (h < 0.04 && level == Level::quick) continue;
    for (const Plane plane : {Plane::aligned, Plane::oblique}) {
      const Slide slides = slide(plane, h, kSlides), sticks = slide(plane, h, kSticks);
      outcome.table.rows.push_back({plane == Plane::aligned ? "aligned" : "oblique", fmt::format("{}", h),
                                    fmt::format("{:.5f}", slides.acceleration / exact),
                                    fmt::format("{:.5f}", slides.distance / (2 * exact)),
                                    fmt::format("{:.1e}", sticks.drift)});
      double& error = worst[plane == Plane::aligned ? 0 : 1];
      error = std::max(error, std::abs(slides.acceleration / exact - 1));
      way = std::max(way, std::abs(slides.distance / (2 * exact) - 1));
      creep = std::max(creep, std::abs(sticks.drift));
    }
  }
  outcome.gates = {at_most(aligned, worst[0], 1e-3), at_most("acceleration error, oblique plane", worst[1], 1e-2),
                   at_most("error of the way in 2 s", way, 1e-2),
                   at_most("creep of the sticking block, m", creep, 1e-5)};
  return outcome;
}

const Registration registered({"incline", "friction 1 % too high", {"acceleration error, aligned plane"}, measure});

}  // namespace
}  // namespace firn::test
