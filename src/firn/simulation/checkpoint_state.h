#pragma once

#include <firn/integrators/world.h>
#include <firn/io/checkpoint.h>
#include <firn/simulation/simulation.h>

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace firn {

/// What time step control knows of a material: largest speed, wave speed (m/s) and kinematic viscosity (m^2/s).
using MaterialSpeeds = std::array<double, 3>;

/// Every column of the particles but the acceleration of a body force, which belongs to a scatter.
template <class Real, int dim>
CheckpointMaterial save_material(const MaterialSet<Real, dim>& material, const Particles<Real, dim>& particles,
                                 const MaterialSpeeds& speeds);

/// The particles in the order in which they lay, sorted into blocks.
/// @param material where they belong: name, model and columns must be those of the checkpoint
/// @param bodies how many there are, emitters included
/// Error(files) if they are not, or if a value cannot be.
template <class Real, int dim>
Particles<Real, dim> load_particles(const CheckpointMaterial& saved, const MaterialSet<Real, dim>& material,
                                    bool keeps_velocity, std::size_t bodies);

/// The speeds of a saved material. Error(files) if one is missing.
MaterialSpeeds load_speeds(const CheckpointMaterial& saved);

/// All of a report but what emitters and sinks have counted.
void save_report(const FrameReport& report, const Scene& scene, CheckpointState& state);
FrameReport load_report(const CheckpointState& state, const Scene& scene);

/// What the scene's colliders have taken since the frame began: the first of the world's, without its pins. One that
/// the scene has and the checkpoint has not was added since and has taken nothing.
void save_loads(const std::vector<ColliderLoad>& loads, const Scene& scene, CheckpointState& state);
std::vector<ColliderLoad> load_loads(const CheckpointState& state, const Scene& scene);

/// What each emitter has made or each sink removed. @param objects of the scene @param kind "emitter" or "sink"
template <class Object>
void save_counts(const std::vector<SourceCount>& counts, const std::vector<Object>& objects, std::string_view kind,
                 CheckpointState& state);
template <class Object>
std::vector<SourceCount> load_counts(const CheckpointState& state, const std::vector<Object>& objects,
                                     std::string_view kind);

/// An entry of a checkpoint. Error(files) that names it if it is missing.
double number_of(const CheckpointState& state, std::string_view name);
std::int64_t counter_of(const CheckpointState& state, std::string_view name);
const std::string& text_of(const CheckpointState& state, std::string_view name);

/// In words, what must agree for the columns of a checkpoint to mean the same.
template <class Real, int dim>
std::string layout_text(const World<Real, dim>& world);

}  // namespace firn
