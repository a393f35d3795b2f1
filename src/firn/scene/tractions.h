#pragma once

#include <firn/integrators/world.h>
#include <firn/scene/settings.h>
#include <firn/seeding/region.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace firn {

/// A body that has just been filled.
template <int dim>
struct FilledBody {
  std::size_t number;  ///< in Scene::bodies
  const Region<dim>& region;
  std::span<const Vec<double, dim>> positions;  ///< of its particles, m
  std::uint32_t first_id;                       ///< of these, which are consecutive
  double particle_mass;                         ///< kg
  double particle_volume;                       ///< m^3 (m^2 in 2D)
};

/// The scene's forces per area on the surface of its bodies.
///
/// The load goes to the particles at the surface: f_i = sum_p N_i(x_p) A_p t, the traction integral of the material
/// point method with particles for quadrature points (Zhang, Chen and Liu 2016, The Material Point Method). There A_p
/// is the particle's volume over the thickness of a boundary layer that the user guesses; here it comes from the
/// surface itself: lines a quarter of a particle spacing apart cut the body's region along the direction that is
/// loaded, and where one leaves the body inside the traction's shape, its share of the area goes to the nearest
/// particle. The resultant is stress times area seen along the direction, wherever the particles lie. Lines along both
/// directions of each axis give the vector area that a pressure acts on. Areas and normals are those of t = 0 and go
/// with the particles: nominal stress, a dead load.
///
/// Forces on grid nodes near the present surface, found from the gradient of their mass, were rejected: that gradient
/// also sees the noise inside the body.
template <int dim>
class Tractions {
 public:
  /// Error as region_of().
  explicit Tractions(const Scene& scene);
  ~Tractions();

  /// Finds the loaded particles of a body.
  void attach(const FilledBody<dim>& body);
  /// Error(usage) for a traction without a surface. Call when all bodies are attached.
  void check() const;

  /// Area that traction i acts on, seen along the normal of a stress; for a pressure the sum of what is seen along both
  /// directions of each axis. m^2 (m in 2D)
  double area(std::size_t i) const;
  /// Acceleration of the particle with this id at x (m) and time t (s), m/s^2.
  Vec<double, dim> acceleration(const Vec<double, dim>& x, std::uint32_t id, double t) const;

 private:
  class One;
  std::vector<std::unique_ptr<One>> tractions_;
};

extern template class Tractions<2>;
extern template class Tractions<3>;

}  // namespace firn
