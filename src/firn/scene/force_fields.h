#pragma once

#include <firn/integrators/world.h>
#include <firn/scene/settings.h>
#include <firn/scene/tractions.h>

#include <memory>

namespace firn {

/// The sum of the scene's fields and tractions; empty if it has none.
///
/// attractor: a = strength f(r / radius) towards the centre, with f(s) = s inside and 1 / s^2 beyond: the gravity of a
/// homogeneous ball. vortex: a = strength f(r / radius) along axis x r, with f(s) = s inside and 1 / s beyond:
/// Rankine's profile. wind: a = (u - v) / response_time with the air's velocity u: Stokes' drag.
template <int dim>
BodyForce<dim> force_of(const Scene& scene, std::shared_ptr<const Tractions<dim>> tractions = nullptr);

}  // namespace firn
