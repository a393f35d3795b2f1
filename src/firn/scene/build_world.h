#pragma once

#include <firn/integrators/world.h>
#include <firn/scene/settings.h>
#include <firn/scene/tractions.h>
#include <firn/state/snapshot.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace firn {

/// What a scene comes to before anything is simulated.
struct WorldPlan {
  struct Body {
    std::string name;
    double volume = 0;           ///< m^3 (m^2 in 2D)
    std::int64_t particles = 0;  ///< that its share of the resolution asks for
    double width_in_cells = 0;   ///< longest side of its bounding box
    double lost = 0;             ///< share that limits.box has cut off; known once particles are placed
  };
  double cell_size = 0;        ///< m
  double particle_volume = 0;  ///< that the resolution asks for, m^3 (m^2 in 2D): the volume of emitted particles
  std::int64_t particles = 0;
  std::vector<Body> bodies;
};

/// Reads meshes and measures bodies, without placing a particle. Warnings about meshes and thin colliders go to the
/// log. Error(usage) for bodies that are too small for the cells or too large for the machine, and for what
/// prepare_mesh refuses.
WorldPlan plan_world(const Scene& scene);

/// A scene ready to be simulated.
template <class Real, int dim>
struct BuiltWorld {
  World<Real, dim> world;
  WorldPlan plan;
  std::shared_ptr<const Tractions<dim>> tractions;  ///< part of world.body_force
};

/// Is shown the plan before the first particle is placed, and may refuse it by throwing.
using PlanCheck = std::function<void(const WorldPlan&)>;

/// Fills the bodies with particles and sets up materials, colliders and the grid. Real and dim must be the scene's.
/// @param check may be empty
template <class Real, int dim>
BuiltWorld<Real, dim> build_world(const Scene& scene, const PlanCheck& check = {});

}  // namespace firn
