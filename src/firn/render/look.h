#pragma once

#include <firn/core/linear_algebra.h>
#include <firn/state/snapshot.h>

#include <string_view>

namespace firn {

/// How a substance reflects light. Colours are linear RGB.
struct Look {
  std::string_view name;  ///< of a preset or of a model
  Vec3f color;            ///< diffuse reflectance
  float wrap = 0;         ///< light carried past the terminator by scattering inside, 0 (none) to 1
  float smooth = 0;       ///< 1: shaded by the surface of the whole body, 0: each particle as a ball
  float jitter = 0;       ///< largest relative change of brightness from particle to particle
  float sparkle = 0;      ///< brightness of the glints of single particles in the sun
  float gloss = 0;        ///< strength of the sun's highlight and of the mirrored sky at grazing angles
  Vec3f glow = {};        ///< light scattered through the body where it is thin, relative to the sun's
};

/// The look of the preset, else of the model, else a neutral one.
const Look& find_look(const SnapshotMaterial& material);

/// Colours of what has no material.
extern const Vec3f kGroundColor;
extern const Vec3f kColliderColor;

}  // namespace firn
