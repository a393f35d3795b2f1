#pragma once

#include <firn/simulation/simulation.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace firn::test {

/// The scene scenes/verification/<name>.toml with these overrides ("key=value"), on one thread.
std::unique_ptr<Simulation> open_scene(const std::string& name, std::vector<std::string> overrides = {});

/// Runs to the scene's end; calls `visit` at every frame, t = 0 included.
void run_frames(Simulation& simulation, const std::function<void()>& visit);
void run_to_end(Simulation& simulation);

/// Particles of a simulation as plain columns, ordered by (material, id): entry p is the same particle at every time as
/// long as none is parked.
struct ParticleColumns {
  std::vector<Vec3d> x, v;                     ///< m, m/s
  std::vector<double> pressure, von_mises, J;  ///< of the Cauchy stress, Pa; volume ratio
  std::vector<int> body;

  std::size_t size() const { return x.size(); }
};
ParticleColumns particles_of(const Simulation& simulation);

/// Axial Cauchy stress, Pa, of a state whose two lateral stresses are equal and larger than it (compression) or smaller
/// (tension): from pressure and von Mises stress, the invariants that frames hold.
double axial_stress(const ParticleColumns& particles, std::size_t p, bool compressed);

/// Mean of a body's velocities.
Vec3d mean_velocity(const ParticleColumns& particles, int body);

/// Part of a bar: the box body `body` from `from` to `to` along the bar, m.
struct Piece {
  std::string body;
  double from = 0, to = 0;
};

/// Overrides that make a 2D scene of box bodies a problem in one dimension, `axis`: cells of this size and just one
/// block of them across, periodic.
std::vector<std::string> slab(double cell_size, int axis, const std::vector<Piece>& pieces);

}  // namespace firn::test
