#include <firn/simulation/endless_step.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

namespace firn {
namespace {

constexpr double kMostSteps = 1e12;

double square_of(const std::vector<double>& v) {
  double square = 0;
  for (const double component : v) square += component * component;
  return square;
}

}  // namespace

bool is_endless(const TimeStep& step, double frame_rate) {
  return step.limit != "frame" && !(step.dt * kMostSteps * frame_rate > 1);
}

template <class Real, int dim>
ParticleFailure fastest_particle(const World<Real, dim>& world) {
  ParticleFailure failure;
  failure.cause = kTooFast;
  double fastest = -1;
  for (std::size_t m = 0; m < world.materials.size(); ++m) {
    const auto& particles = world.materials[m].particles;
    for (std::uint32_t p = 0; p < particles.size(); ++p) {
      std::vector<double> velocity;
      for (int d = 0; d < dim; ++d) velocity.push_back(particles.real(Field::velocity, d)[p]);
      const double square = square_of(velocity);
      if (!(square > fastest)) continue;
      fastest = square;
      failure.material = m;
      failure.id = particles.id()[p];
      failure.velocity = std::move(velocity);
      const auto x = particles.position(p, world.grid.dx(), world.grid.kernel());
      failure.position.assign(x.e, x.e + dim);
    }
  }
  return failure;
}

std::string describe_endless(const ParticleFailure& failure, const std::string& material, const std::string& limit,
                             std::uint64_t step, double t, double dt) {
  return fmt::format(
      "step {} at t = {:.6g} s would take dt = {:.3g} s, more than {:g} steps to a frame, by {}: the fastest particle "
      "is "
      "{} of \"{}\" at x = ({:.4g}) m with {:.4g} m/s; lower velocities, forces or stiffnesses, or set limits.speed to "
      "park such particles",
      step, t, dt, kMostSteps, limit, failure.id, material, fmt::join(failure.position, ", "),
      std::sqrt(square_of(failure.velocity)));
}

template ParticleFailure fastest_particle<float, 2>(const World<float, 2>&);
template ParticleFailure fastest_particle<float, 3>(const World<float, 3>&);
template ParticleFailure fastest_particle<double, 2>(const World<double, 2>&);
template ParticleFailure fastest_particle<double, 3>(const World<double, 3>&);

}  // namespace firn
