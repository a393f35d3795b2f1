#include <firn/apps/scene_view.h>
#include <firn/geometry/deforming_mesh.h>
#include <firn/scene/collider_shape.h>
#include <firn/scene/deforming_collider.h>

#include <algorithm>
#include <cmath>

namespace firn {
namespace {

Vec3f drawn_color(const std::optional<Vec3d>& color) {
  if (!color) return kDefaultColor;
  return {{static_cast<float>((*color)[0]), static_cast<float>((*color)[1]), static_cast<float>((*color)[2])}};
}

/// Cells along the longest side of a drawn surface.
constexpr int kSurfaceCells = 128;

Pose<3> in_space(const Pose<3>& pose) { return pose; }
Pose<3> in_space(const Pose<2>& flat) {
  Pose<3> pose;
  pose.scale = flat.scale;
  for (int i = 0; i < 2; ++i) {
    pose.origin[i] = flat.origin[i];
    for (int j = 0; j < 2; ++j) pose.rotation(i, j) = flat.rotation(i, j);
  }
  return pose;
}

/// Where an endless solid is cut off: far around everything that has a place in the scene.
template <int dim>
Bounds<dim> drawn_space(const Scene& scene) {
  double reach = 1;
  const auto include = [&](const Vec3d& position, double size) {
    for (int i = 0; i < 3; ++i) reach = std::max(reach, 3 * (std::abs(position[i]) + size));
  };
  for (const BodySettings& body : scene.bodies) include(body.position, body.scale * (norm(body.size) + body.radius));
  for (const ColliderSettings& collider : scene.colliders) {
    include(collider.position, norm(collider.size) + collider.radius + collider.length);
  }
  return {constant_vector<double, dim>(-reach), constant_vector<double, dim>(reach)};
}

double longest_side(const std::optional<TriangleMesh>& mesh, const Scene& scene) {
  return (mesh ? bounds(*mesh) : drawn_space<3>(scene)).largest_side();
}

ShapeSurface drawn_surface(const Scene& scene, const ColliderSettings& settings, const ShapePointer<3>&) {
  std::optional<TriangleMesh> mesh = collider_mesh(scene, settings);
  if (mesh && !settings.inverted) return surface_of(std::move(*mesh));
  const auto shape = collider_shape<3>(scene, settings, longest_side(mesh, scene) / kSurfaceCells);
  return surface_of(*shape, drawn_space<3>(scene), kSurfaceCells);
}

/// A solid that changes its form, at time t.
ShapeSurface drawn_surface(const Scene& scene, const DeformingShape<3>& shape, bool inverted, double t) {
  if (const auto* mesh = dynamic_cast<const DeformingMesh*>(&shape); mesh != nullptr && !inverted) {
    return surface_of(mesh->sequence().mesh_at(t));
  }
  return surface_of(*shape.at(t), drawn_space<3>(scene), kSurfaceCells);
}

ShapeSurface drawn_surface(const Scene& scene, const ColliderSettings&, const ShapePointer<2>& section) {
  return filled_section_of(*section, drawn_space<2>(scene));
}

/// Whether a View has a kind of its own for this shape.
bool has_own_kind(const ColliderSettings& collider) {
  using Shape = ShapeSettings::Shape;
  return !collider.inverted && collider.look == ColliderSettings::Look::solid &&
         (collider.shape == Shape::half_space || collider.shape == Shape::box || collider.shape == Shape::sphere);
}

void draw_own_kind(const ColliderSettings& collider, int number, const Pose<3>& pose, View& view) {
  const Vec3f color = drawn_color(collider.color);
  if (collider.shape == ShapeSettings::Shape::half_space) {
    view.half_spaces.push_back({pose.origin, pose.rotation * collider.normal, color, number});
  } else if (collider.shape == ShapeSettings::Shape::box) {
    view.boxes.push_back({pose.origin, pose.rotation, 0.5 * pose.scale * collider.size, color, number});
  } else {
    view.spheres.push_back({pose.origin, pose.scale * collider.radius, color, number});
  }
}

}  // namespace

SceneDrawing::SceneDrawing(const Scene& scene) : scene_(scene) {
  for (const ColliderSettings& collider : scene.colliders) {
    if (collider.look == ColliderSettings::Look::hidden) continue;
    if (scene.dimension == 2) add<2>(collider);
    if (scene.dimension == 3) add<3>(collider);
  }
}

template <int dim>
void SceneDrawing::add(const ColliderSettings& settings) {
  Collider<dim> moving;
  set_motion<dim>(scene_, settings, moving);
  Drawn drawn = {&settings, [moving](double t) { return in_space(moving.pose_at(t)); }, {}, {}, {}, {}};
  if (settings.is_sequence()) {
    drawn.deforming = deforming_shape(scene_, settings);
    drawn.solid.color = drawn_color(settings.color);
    drawn.solid.endless = settings.inverted;
    drawn.solid.glass = settings.look == ColliderSettings::Look::glass;
  } else if (!has_own_kind(settings)) {
    ShapePointer<dim> shape;
    if constexpr (dim == 2) {
      shape = collider_shape<2>(scene_, settings, 0);
      drawn.solid.section = shape;
    }
    drawn.solid.surface = std::make_shared<ShapeSurface>(drawn_surface(scene_, settings, shape));
    drawn.solid.color = drawn_color(settings.color);
    drawn.solid.endless = dim == 3 && settings.inverted;
    drawn.solid.glass = settings.look == ColliderSettings::Look::glass;
  }
  colliders_.push_back(std::move(drawn));
}

View SceneDrawing::view_at(double t) const {
  const Scene& scene = scene_;
  View view;
  view.width = scene.render.width;
  view.height = scene.render.height;
  view.samples = scene.render.samples;
  view.up = scene.up == Scene::Up::y ? Vec3d{{0, 1, 0}} : Vec3d{{0, 0, 1}};
  // The sun keeps its place in the picture whichever axis is up.
  if (scene.up == Scene::Up::z) view.sun_direction = {{-0.35, -0.55, 0.75}};
  if (scene.camera.position && scene.camera.target) {
    view.camera = Camera{*scene.camera.position, *scene.camera.target, scene.camera.up, scene.camera.field_of_view};
  }
  // Anything but the word "material" is the name of a column.
  if (scene.render.color_by != "material") view.color_by = scene.render.color_by;
  view.color_range = scene.render.range;
  for (const BodySettings& body : scene.bodies) {
    if (body.color) view.body_colors[body.name] = drawn_color(body.color);
  }
  for (const EmitterSettings& emitter : scene.emitters) {
    if (emitter.color) view.body_colors[emitter.name] = drawn_color(emitter.color);
    if (!emitter.shape) continue;
    const double radius = emitter.scale * std::max(emitter.radius, 0.5 * norm(emitter.size));
    if (emitter.keyframes.empty()) view.expected.emplace_back(emitter.position, radius);
    for (const KeyframeSettings& frame : emitter.keyframes) view.expected.emplace_back(*frame.position, radius);
  }
  for (const Drawn& drawn : colliders_) {
    const Pose<3> pose = drawn.pose_at(t);
    const int number = static_cast<int>(drawn.settings - scene.colliders.data());
    if (drawn.deforming && drawn.form_time != t) {
      drawn.form = std::make_shared<ShapeSurface>(drawn_surface(scene_, *drawn.deforming, drawn.settings->inverted, t));
      drawn.form_time = t;
    }
    if (!drawn.solid.surface && !drawn.deforming) {
      draw_own_kind(*drawn.settings, number, pose, view);
      continue;
    }
    DrawnSolid& solid = view.solids.emplace_back(drawn.solid);
    if (drawn.deforming) solid.surface = drawn.form;
    solid.origin = pose.origin;
    solid.rotation = pose.rotation;
    solid.scale = pose.scale;
    solid.collider = number;
  }
  return view;
}

}  // namespace firn
