#pragma once

#include <firn/materials/update_stress.h>

#include <array>
#include <optional>
#include <string_view>
#include <vector>

namespace firn {

/// What is done to a single point of material.
enum class PointPath {
  shear,     ///< simple shear, x sliding along y, at constant volume
  uniaxial,  ///< stretched (or shortened) along x, with sides free of stress, or under the pressure
  triaxial,  ///< pressed all round first, then shortened along x while the sides keep their pressure
  cyclic,    ///< simple shear to and fro
};
inline constexpr std::array<std::string_view, 4> kPointPathNames = {"shear", "uniaxial", "triaxial", "cyclic"};
std::optional<PointPath> find_point_path(std::string_view name);

struct PointRequest {
  int model = 0;  ///< place in all_models()
  ModelParameters parameters;
  PointPath path = PointPath::shear;
  double strain = 0.1;  ///< to go to: shear, or logarithm of the axial stretch (its amount in a triaxial test);
                        ///< amplitude of a cycle
  double rate = 1;      ///< 1/s, > 0
  double pressure = 0;  ///< Pa, >= 0, all round before the path begins; held at the sides of a triaxial test
  int steps = 1000;     ///< of the whole path
  int cycles = 2;
};

/// One point of the curve. Three dimensions, double precision.
struct PointState {
  double time = 0;                    ///< s
  double strain = 0;                  ///< as PointRequest::strain
  std::array<double, 6> stress = {};  ///< Cauchy, Pa: xx yy zz xy xz yz
  double pressure = 0;                ///< Pa, -tr/3
  double von_mises = 0;               ///< Pa, sqrt(3/2) |dev|
  double volume_ratio = 1;
  double energy = 0;                                    ///< J per m^3 of undeformed material, stored
  double work = 0;                                      ///< J per m^3 of undeformed material, done on the point
  double wave_speed = 0;                                ///< m/s
  std::array<double, kMaxHistoryColumns> history = {};  ///< as the model declares
};

/// Drives one point of material through strain, without a grid, by the function that simulations call. The first state
/// is the undeformed one, under `pressure`. Error(usage) for numbers out of range; Error(numerical) if the material
/// fails, or cannot be brought under the pressure or its sides be kept at theirs, with the strain at which it happens.
std::vector<PointState> drive_point(const PointRequest& request);

}  // namespace firn
