#pragma once

#include <firn/integrators/world.h>
#include <firn/scene/settings.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace firn {

/// Where the values of parameters that vary go, and for which particles.
template <class Real, int dim>
struct VariedParticles {
  MaterialSet<Real, dim>& material;
  std::size_t first;                               ///< particles from here on
  std::uint32_t first_id;                          ///< the number of that one, which random values are drawn for
  const std::vector<Vec<double, dim>>& positions;  ///< m
};

/// Gives the particles of a body the values of the parameters that vary. Random values depend on seed, parameter and
/// the particle's id alone.
/// Error(usage) that names material, parameter, body, position, value and range where a value is not allowed.
template <class Real, int dim>
void vary_parameters(const Scene& scene, const MaterialSettings& settings, const BodySettings& body,
                     const VariedParticles<Real, dim>& particles);

/// The parameters that vary in some material, each once.
std::vector<Parameter> varied_parameters(const Scene& scene);

/// What keeps the material from being simulated with cells of this size; "" if nothing does.
std::string material_refusal(const MaterialSettings& settings, double cell_size);

/// The values of its model's parameters, and which of them vary.
ModelParameters model_parameters(const MaterialSettings& settings, double cell_size);

}  // namespace firn
