#pragma once

#include <firn/core/parameter.h>
#include <firn/materials/model_parameters.h>
#include <firn/state/kernel.h>
#include <firn/state/particles.h>
#include <firn/state/snapshot.h>

#include <span>
#include <string>

namespace firn {

/// The particles of a material, in their blocks, and what a snapshot says of it.
template <class Real, int dim>
struct OutputMaterial {
  const Particles<Real, dim>& particles;
  int model;  ///< its place in all_models()
  const ModelParameters& parameters;
  std::string name, preset = {};
};

/// What all materials have in common.
struct OutputContext {
  double dx;  ///< m
  Kernel kernel;
  /// Parameters that vary in some material of the scene: a column each, zero for models that have no such parameter.
  std::span<const Parameter> varied = {};
};

/// Replaces materials and columns of a snapshot by those of the given materials, each in the order of its ids:
/// position, velocity, id, body, material, J, von Mises stress, pressure, the history of the models that occur and the
/// parameters that vary. The columns are floats for single precision and doubles for double. Particles of models
/// without some history column get its neutral value there.
///
/// Memory of the columns that were there is used again: fresh memory costs more than what is written to it.
template <class Real, int dim>
void fill_snapshot(Snapshot& snapshot, std::span<const OutputMaterial<Real, dim>> materials,
                   const OutputContext& context);

}  // namespace firn
