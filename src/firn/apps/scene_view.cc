#include <firn/apps/scene_view.h>
#include <firn/geometry/motion.h>
#include <firn/scene/body_region.h>

namespace firn {
namespace {

Vec3f drawn_color(const std::optional<Vec3d>& color) {
  if (!color) return kDefaultColor;
  return {{static_cast<float>((*color)[0]), static_cast<float>((*color)[1]), static_cast<float>((*color)[2])}};
}

void draw_collider(const ColliderSettings& collider, double t, View& view) {
  const RigidMotion<3> motion = {collider.position, rotation_from_degrees(collider.rotation), collider.velocity,
                                 collider.angular_velocity};
  const Vec3f color = drawn_color(collider.color);
  switch (collider.shape) {
    case ColliderSettings::Shape::half_space:
      view.half_spaces.push_back({motion.origin_at(t), motion.rotation_at(t) * collider.normal, color});
      break;
    case ColliderSettings::Shape::box:
      view.boxes.push_back({motion.origin_at(t), motion.rotation_at(t), 0.5 * collider.size, color});
      break;
    case ColliderSettings::Shape::sphere:
      view.spheres.push_back({motion.origin_at(t), collider.radius, color});
      break;
  }
}

}  // namespace

View scene_view(const Scene& scene, double t) {
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
  }
  for (const ColliderSettings& collider : scene.colliders) draw_collider(collider, t, view);
  return view;
}

}  // namespace firn
