#include "verification_scenes/vibration.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace firn::test {
namespace {

double total_energy(const Simulation& simulation) {
  const Totals totals = simulation.totals();
  return totals.kinetic_energy + totals.elastic_energy;
}

}  // namespace

Vibration::Vibration(const Simulation& simulation, double omega, std::function<Vec3d(const Vec3d& X)> shape)
    : simulation_(simulation), omega_(omega), start_(particles_of(simulation).x) {
  for (const Vec3d& X : start_) shape_.push_back(shape(X));
  sample();
  first_radius_ = radius_;
  first_energy_ = energy_;
  energy_ = energy_peak_ = 1;
  turned_ = 0;
}

void Vibration::sample() {
  const ParticleColumns particles = particles_of(simulation_);
  double q = 0, rate = 0, norm = 0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    q += dot(particles.x[p] - start_[p], shape_[p]);
    rate += dot(particles.v[p], shape_[p]);
    norm += dot(shape_[p], shape_[p]);
  }
  const double angle = std::atan2(omega_ * q, rate);
  turned_ += std::remainder(angle - angle_, 2 * std::numbers::pi);
  angle_ = angle;
  radius_ = std::hypot(omega_ * q, rate) / norm;
  energy_ = total_energy(simulation_) / (first_energy_ > 0 ? first_energy_ : 1);
  energy_peak_ = std::max(energy_peak_, energy_);
}

double Vibration::period() const { return omega_ * simulation_.time() / turned_; }

}  // namespace firn::test
