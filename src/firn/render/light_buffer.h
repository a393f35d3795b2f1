#pragma once

#include <firn/core/linear_algebra.h>
#include <firn/render/image.h>

#include <vector>

namespace firn {

/// What the samples of one pixel found, summed; `surface` of them met something.
struct PixelLight {
  Vec3f direct = {};   ///< light that is final: sky, and sun on particles
  Vec3f sun = {};      ///< light of the sun on planes and colliders if nothing shadowed it
  Vec3f ambient = {};  ///< light of the sky on surfaces if nothing hid the sky
  Vec3f albedo = {};   ///< reflectance of the surfaces
  Vec3f normal = {};
  float depth = 0;        ///< m
  float surface = 0;      ///< samples that met a surface
  float sky_rays = 0;     ///< of these, how many looked for the sky in one direction
  float sky_visible = 0;  ///< and saw it
  float flat = 0;         ///< samples on planes and colliders
  float sun_visible = 0;  ///< of these, how many saw one random point of the sun
};

/// The light of a picture before its noise is averaged out.
struct LightBuffer {
  int width, height;
  float samples;
  float tolerance;  ///< m, differences of depth that still count as one surface
  std::vector<PixelLight> pixels;

  /// Averages visibility over 4 x 4 pixels of the same surface and gives the picture. Neighbouring pixels use 16
  /// different parts of one well spread set of directions, so that this average is over the whole set.
  Image resolve() const;
};

}  // namespace firn
