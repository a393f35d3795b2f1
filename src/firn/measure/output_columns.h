#pragma once

#include <firn/materials/model_parameters.h>
#include <firn/state/particles.h>
#include <firn/state/snapshot.h>

namespace firn {

/// Names of a material as snapshots carry them.
struct MaterialLabel {
  std::string name, model, preset;
};

/// Appends the particles of one material to a snapshot, in the order of their ids: position, velocity, id, body,
/// material, J, von Mises stress, pressure and the models' history. The columns are floats for single precision and
/// doubles for double. Particles of models without some history column get its neutral value there.
///
/// Materials must be appended to a snapshot one after the other, all with the same Real and dim.
template <class Real, int dim>
void append_to_snapshot(Snapshot& snapshot, const Particles<Real, dim>& particles, int model,
                        const ModelParameters& parameters, const MaterialLabel& label, double dx, Kernel kernel);

}  // namespace firn
