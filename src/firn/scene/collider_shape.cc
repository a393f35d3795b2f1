#include <firn/core/error.h>
#include <firn/core/log.h>
#include <firn/core/parallel.h>
#include <firn/geometry/combined_shapes.h>
#include <firn/geometry/polygon_shape.h>
#include <firn/geometry/prepare_mesh.h>
#include <firn/geometry/revolution.h>
#include <firn/geometry/round_shapes.h>
#include <firn/geometry/wall_thickness.h>
#include <firn/io/height_map_file.h>
#include <firn/io/level_set_file.h>
#include <firn/io/mesh_reader.h>
#include <firn/io/number_table.h>
#include <firn/scene/body_region.h>
#include <firn/scene/collider_shape.h>
#include <firn/scene/deforming_collider.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace firn {
namespace {

using Kind = ShapeSettings::Shape;

template <int dim>
Vec<double, dim> cut(const Vec3d& v) {
  Vec<double, dim> r;
  for (int i = 0; i < dim; ++i) r[i] = v[i];
  return r;
}

template <int dim>
Mat<double, dim> rotation_of(const Vec3d& degrees) {
  if constexpr (dim == 3) return rotation_from_degrees(degrees);
  if constexpr (dim == 2) return plane_rotation_from_degrees(degrees);
}

/// The shortest turn that takes the y axis, along which shapes lie, to a direction.
Mat3d turn_from_y(const Vec3d& axis) {
  const Vec3d across = cross(Vec3d{{0, 1, 0}}, axis);
  const double sine = norm(across);
  if (sine == 0) return axis[1] < 0 ? diagonal(Vec3d{{1, -1, -1}}) : identity<double, 3>();
  return rotation_by((std::atan2(sine, axis[1]) / sine) * across);
}

template <int dim>
Mat<double, dim> axis_rotation(const Vec3d& axis) {
  if constexpr (dim == 3) return turn_from_y(axis);
  if constexpr (dim == 2) return {{axis[1], axis[0], -axis[0], axis[1]}};
}

TriangleMesh height_field_mesh(const Scene& scene, const ShapeSettings& settings) {
  const bool y_up = scene.up == Scene::Up::y;
  const Vec3d size = y_up ? settings.size : Vec3d{{settings.size[0], settings.size[2], settings.size[1]}};
  TriangleMesh mesh = mesh_of(read_height_map(scene.locate(settings.file)), size, settings.depth);
  if (!y_up) apply({1, turn_from_y({{0, 0, 1}}), {}}, mesh);
  return mesh;
}

ShapePointer<2> polygon_shape(const Scene& scene, const ShapeSettings& settings) {
  Polygon polygon = read_polygon(scene.locate(settings.file));
  for (auto& loop : polygon.loops) {
    for (Vec2d& point : loop) point = settings.scale * point;
  }
  return std::make_shared<PolygonShape>(std::move(polygon));
}

/// Shapes that only one dimension has.
ShapePointer<3> shape_of_dimension(const Scene& scene, const ShapeSettings& settings, double cell, ShapePointer<3>*) {
  const auto along_axis = [&](ShapePointer<3> upright) {
    return std::make_shared<Placed<3>>(std::move(upright), turn_from_y(settings.axis), Vec3d{});
  };
  switch (settings.shape) {
    case Kind::cylinder:
      return along_axis(make_cylinder(settings.radius, settings.length));
    case Kind::cone:
      return along_axis(make_cone(settings.radius, settings.top_radius, settings.length));
    case Kind::torus:
      return along_axis(make_torus(settings.radius, settings.tube_radius));
    default:
      return cached_level_set(*collider_mesh(scene, settings), cell, cache_folder());
  }
}

ShapePointer<2> shape_of_dimension(const Scene& scene, const ShapeSettings& settings, double, ShapePointer<2>*) {
  return polygon_shape(scene, settings);
}

template <int dim>
ShapePointer<dim> combined(const Scene& scene, const ShapeSettings& settings, double cell) {
  std::vector<ShapePointer<dim>> parts;
  for (const std::string& name : settings.parts) {
    const PartSettings& part = *scene.find_part(name);
    parts.push_back(std::make_shared<Placed<dim>>(collider_shape<dim>(scene, part, cell),
                                                  rotation_of<dim>(part.rotation), cut<dim>(part.position)));
  }
  if (settings.shape == Kind::union_) return std::make_shared<Union<dim>>(std::move(parts));
  if (settings.shape == Kind::intersection) return std::make_shared<Intersection<dim>>(std::move(parts));
  return make_difference<dim>(std::move(parts));
}

template <int dim>
ShapePointer<dim> upright_shape(const Scene& scene, const ShapeSettings& settings, double cell) {
  switch (settings.shape) {
    case Kind::half_space:
      return std::make_shared<HalfSpace<dim>>(cut<dim>(settings.normal));
    case Kind::box:
      return std::make_shared<Box<dim>>(0.5 * cut<dim>(settings.size));
    case Kind::rounded_box:
      return std::make_shared<RoundedBox<dim>>(0.5 * cut<dim>(settings.size), settings.radius);
    case Kind::sphere:
      return std::make_shared<Sphere<dim>>(settings.radius);
    case Kind::capsule:
      return std::make_shared<Placed<dim>>(std::make_shared<Capsule<dim>>(settings.radius, settings.length),
                                           axis_rotation<dim>(settings.axis), Vec<double, dim>{});
    case Kind::union_:
    case Kind::intersection:
    case Kind::difference:
      return combined<dim>(scene, settings, cell);
    default:
      return shape_of_dimension(scene, settings, cell, static_cast<ShapePointer<dim>*>(nullptr));
  }
}

Keyframe<3> keyframe_of(double time, const Vec3d& position, const Vec3d& degrees, double scale, Keyframe<3>*) {
  return {time, position, rotation_from_degrees(degrees), scale};
}
Keyframe<2> keyframe_of(double time, const Vec3d& position, const Vec3d& degrees, double scale, Keyframe<2>*) {
  return {time, cut<2>(position), degrees[2] * std::numbers::pi / 180, scale};
}

template <int dim>
std::vector<Keyframe<dim>> read_trajectory(const std::filesystem::path& path, const ColliderSettings& settings) {
  const NumberTable table = read_number_table(path);
  const std::size_t moved = 1 + dim, turned = dim == 3 ? 7 : 4;
  if (table.columns != moved && table.columns != turned) {
    throw Error(ErrorKind::usage, fmt::format("{}: has {} columns; a trajectory has {} or, with rotation, {}",
                                              path.string(), table.columns, moved, turned));
  }
  std::vector<Keyframe<dim>> keyframes;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    Vec3d position = {}, degrees = settings.rotation;
    for (int i = 0; i < dim; ++i) position[i] = table.at(row, 1 + static_cast<std::size_t>(i));
    for (std::size_t c = moved; c < table.columns; ++c) {
      degrees[dim == 3 ? static_cast<int>(c - moved) : 2] = table.at(row, c);
    }
    keyframes.push_back(keyframe_of(table.at(row, 0), position, degrees, 1, static_cast<Keyframe<dim>*>(nullptr)));
  }
  return keyframes;
}

}  // namespace

template <int dim>
ShapePointer<dim> collider_shape(const Scene& scene, const ShapeSettings& settings, double cell) {
  ShapePointer<dim> shape;
  try {
    shape = upright_shape<dim>(scene, settings, cell);
  } catch (const Error& error) {
    const std::string label = fmt::format("\"{}\": ", settings.name);
    // A part has said already which one it is.
    if (std::string_view(error.what()).find("\": ") != std::string_view::npos) throw;
    throw Error(error.kind(), label + error.what());
  }
  return settings.inverted ? std::make_shared<Inverse<dim>>(std::move(shape)) : shape;
}

std::optional<TriangleMesh> collider_mesh(const Scene& scene, const ShapeSettings& settings) {
  if (settings.shape == Kind::height_field) return height_field_mesh(scene, settings);
  if (settings.shape != Kind::mesh) return std::nullopt;
  const std::filesystem::path path = scene.locate(settings.file);
  TriangleMesh mesh = prepare_mesh(read_mesh(path), path.string(), scene.strict_mesh).mesh;
  if (settings.scale != 1) apply({settings.scale, identity<double, 3>(), {}}, mesh);
  return mesh;
}

template <int dim>
void set_motion(const Scene& scene, const ColliderSettings& settings, Collider<dim>& collider) {
  AngularVelocity<dim> spin;
  if constexpr (dim == 3) spin = settings.angular_velocity;
  if constexpr (dim == 2) spin = settings.angular_velocity[2];
  collider.motion = {cut<dim>(settings.position), rotation_of<dim>(settings.rotation), cut<dim>(settings.velocity),
                     spin};
  std::vector<Keyframe<dim>> keyframes;
  for (const KeyframeSettings& key : settings.keyframes) {
    keyframes.push_back(
        keyframe_of(key.time, *key.position, *key.rotation, *key.scale, static_cast<Keyframe<dim>*>(nullptr)));
  }
  const std::filesystem::path path = scene.locate(settings.trajectory);
  if (!settings.trajectory.empty()) keyframes = read_trajectory<dim>(path, settings);
  if (keyframes.empty()) return;
  try {
    collider.keyframes =
        std::make_shared<KeyframeMotion<dim>>(std::move(keyframes), static_cast<Interpolation>(settings.interpolation));
  } catch (const Error& error) {
    throw Error(error.kind(), fmt::format("collider \"{}\": {}{}", settings.name,
                                          settings.trajectory.empty() ? "" : path.string() + ": ", error.what()));
  }
}

/// The thinnest that a collider gets, without the scale of its frame, m.
template <int dim>
double least_thickness(const Collider<dim>& collider) {
  if (!collider.deforming) return wall_thickness<dim>(*collider.shape);
  const std::vector<double>& times = collider.deforming->times();
  std::vector<double> thickness(times.size());
  parallel_each(times.size(),
                [&](std::size_t k) { thickness[k] = wall_thickness<dim>(*collider.deforming->at(times[k])); });
  return *std::min_element(thickness.begin(), thickness.end());
}

/// How thin the walls of a collider are when its motion has shrunk it most, m.
template <int dim>
double thickness_of(const Collider<dim>& collider) {
  double scale = 1;
  if (collider.keyframes) {
    for (const Keyframe<dim>& key : collider.keyframes->keyframes()) scale = std::min(scale, key.scale);
  }
  return scale * least_thickness<dim>(collider);
}

template <int dim>
Collider<dim> make_collider(const Scene& scene, const ColliderSettings& settings, double cell_size) {
  Collider<dim> collider;
  collider.name = settings.name;
  if constexpr (dim == 3) {
    if (settings.is_sequence()) collider.deforming = deforming_shape(scene, settings);
  }
  collider.shape = collider.deforming ? collider.deforming->at(collider.deforming->times().front())
                                      : collider_shape<dim>(scene, settings, 0.5 * cell_size);
  set_motion<dim>(scene, settings, collider);
  collider.contact = static_cast<Contact>(settings.contact);
  collider.friction = settings.friction;
  collider.thickness = thickness_of(collider);
  collider.push_out = settings.push_out;
  return collider;
}

template <int dim>
void warn_of_thin_colliders(const std::vector<Collider<dim>>& colliders, double cell_size) {
  for (const Collider<dim>& collider : colliders) {
    const double thickness = collider.thickness;
    // The measure is good to some per cent.
    if (!(thickness < 1.95 * cell_size)) continue;
    log_warning(
        fmt::format("collider \"{}\" is about {:.2g} m thick, {:.2g} cells: keeping its sides apart takes time, and "
                    "what a mesh has thinner than half a cell may be missing; make it two cells thick, or cells at "
                    "most {:.2g} m",
                    collider.name, thickness, thickness / cell_size, 0.5 * thickness));
  }
}

#define FIRN_INSTANTIATE(dim)                                                                 \
  template ShapePointer<dim> collider_shape<dim>(const Scene&, const ShapeSettings&, double); \
  template void set_motion<dim>(const Scene&, const ColliderSettings&, Collider<dim>&);       \
  template Collider<dim> make_collider<dim>(const Scene&, const ColliderSettings&, double);   \
  template void warn_of_thin_colliders<dim>(const std::vector<Collider<dim>>&, double);
FIRN_INSTANTIATE(2)
FIRN_INSTANTIATE(3)
#undef FIRN_INSTANTIATE

}  // namespace firn
