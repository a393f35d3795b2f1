#pragma once

#include <memory>
#include <string_view>

#include "presets/preset_scene.h"

namespace firn::test {

/// A layer of a preset on a sticky slope, without end along the slope: gravity is tilted by `degrees` instead. Plane
/// strain; x points down the slope, y out of it. Cells are thickness / cells wide.
struct Layer {
  std::string_view preset;
  double thickness;  // m
  double degrees;
  double end_time;  // s
  int frames = 200;
  int cells = 8;
  double speed = 0;  // along the slope at the start, m/s
  std::string_view transfer = "apic";
};
std::unique_ptr<Simulation> layer_on_slope(const Layer& layer);

/// Speed down the slope at the surface, averaged over the outer eighth of a new layer and the second half of its run,
/// m/s. Below yield a layer swings elastically, to no effect in the mean.
double mean_surface_speed(const Layer& layer);

}  // namespace firn::test
