#pragma once

#include <firn/materials/model_info.h>
#include <firn/materials/point_driver.h>
#include <gtest/gtest.h>

#include <optional>
#include <string_view>
#include <vector>

namespace firn::test {

/// A parameter of a preset, or its density. A preset without it fails the test, unless a number stands in.
inline double number(std::string_view preset_name, std::string_view parameter,
                     std::optional<double> otherwise = std::nullopt) {
  const Preset& preset = *find_preset(preset_name);
  if (parameter == "density") return preset.density;
  for (const Preset::Value& value : preset.values) {
    if (value.parameter == parameter) return value.value;
  }
  if (!otherwise) ADD_FAILURE() << preset_name << " has no " << parameter;
  return otherwise.value_or(0);
}

/// One point of a preset, driven along a path (point_driver.h).
inline std::vector<PointState> drive(std::string_view preset_name, PointPath path, double strain, double pressure = 0,
                                     double rate = 1) {
  const Preset& preset = *find_preset(preset_name);
  PointRequest request;
  request.model = model_number(preset.model);
  request.parameters.density = preset.density;
  for (const Parameter& p : find_model(preset.model)->parameters) {
    request.parameters.values.push_back(number(preset_name, p.name));
  }
  request.path = path, request.strain = strain, request.pressure = pressure, request.rate = rate;
  return drive_point(request);
}

}  // namespace firn::test
