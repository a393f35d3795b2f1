#pragma once

#include <firn/core/parameter.h>
#include <firn/materials/model_parameters.h>
#include <firn/state/particles.h>
#include <firn/state/snapshot.h>

#include <string>
#include <vector>

namespace firn {

/// Names of a material as snapshots carry them.
struct MaterialLabel {
  std::string name, model, preset;
  /// Parameters that vary in some material of the scene: a column each, zero for models that have no such parameter.
  std::vector<Parameter> varied = {};
};

/// Appends the particles of one material to a snapshot, in the order of their ids: position, velocity, id, body,
/// material, J, von Mises stress, pressure, the models' history and parameters that vary. The columns are floats for
/// single precision and doubles for double. Particles of models without some history column get its neutral value
/// there.
///
/// Materials must be appended to a snapshot one after the other, all with the same Real and dim.
template <class Real, int dim>
void append_to_snapshot(Snapshot& snapshot, const Particles<Real, dim>& particles, int model,
                        const ModelParameters& parameters, const MaterialLabel& label, double dx, Kernel kernel);

}  // namespace firn
