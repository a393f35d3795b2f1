#include <firn/apps/viewer/hand.h>
#include <firn/scene/schema.h>
#include <fmt/format.h>

#include <algorithm>

namespace firn {
namespace {

/// In which material that is held comes to the speed of the hand, frames.
constexpr double kResponse = 0.125;
/// How far what is held moves in a frame at most, in radii.
constexpr double kReach = 0.5;
/// How long a dropped body is being filled, frames: once and not again, while it falls out of its place.
constexpr double kFilling = 1e-6;

template <class Object>
std::string new_name(const std::vector<Object>& objects, const std::string& stem) {
  for (std::size_t n = objects.size() + 1;; ++n) {
    const std::string name = fmt::format("{}{}", stem, n);
    if (std::none_of(objects.begin(), objects.end(), [&](const Object& o) { return o.name == name; })) return name;
  }
}

std::string material_of(Scene& scene, const std::string& preset) {
  for (const MaterialSettings& material : scene.materials) {
    if (material.preset == preset) return material.name;
  }
  const Section& section = *find_section("material");
  MaterialSettings material;
  section.find("preset")->set(&material, preset);
  material.name = preset;
  while (scene.find_material(material.name) != nullptr) material.name += "_dropped";
  scene.materials.push_back(material);
  return material.name;
}

}  // namespace

FieldSettings pull(Vec3d& at, const Vec3d& to, double radius, double t, double duration, const Scene& scene) {
  const Vec3d way = to - at;
  const double length = norm(way), most = kReach * radius;
  const Vec3d moved = length > most ? (most / length) * way : way;
  FieldSettings field;
  field.name = new_name(scene.fields, "pull");
  field.type = FieldSettings::Type::wind;
  field.response_time = kResponse * duration;
  field.start = t;
  field.stop = t + duration;
  LimitSettings::Box box;
  for (int i = 0; i < scene.dimension; ++i) {
    field.velocity[static_cast<std::size_t>(i)].number = moved[i] / duration;
    box.lower[i] = std::min(at[i], at[i] + moved[i]) - radius;
    box.upper[i] = std::max(at[i], at[i] + moved[i]) + radius;
  }
  field.box = box;
  at += moved;
  return field;
}

void add_drop(Scene& scene, const Drop& drop, double t) {
  EmitterSettings emitter;
  emitter.name = new_name(scene.emitters, "dropped");
  emitter.material = material_of(scene, drop.preset);
  emitter.shape = scene.dimension == 2 ? BodySettings::Shape::disk : BodySettings::Shape::sphere;
  emitter.radius = drop.radius;
  emitter.position = drop.position;
  emitter.keep_full = true;
  emitter.start = t;
  emitter.stop = t + kFilling / scene.frame_rate;
  if (scene.dimension == 2) emitter.position[2] = 0;
  scene.emitters.push_back(emitter);
}

ColliderSettings placed_collider(const Scene& scene, ShapeSettings::Shape shape, const Vec3d& position, double radius) {
  ColliderSettings collider;
  collider.name = new_name(scene.colliders, "placed");
  collider.shape = shape;
  collider.position = position;
  if (shape == ShapeSettings::Shape::box) collider.size = {{2 * radius, 2 * radius, 2 * radius}};
  if (shape == ShapeSettings::Shape::sphere) collider.radius = radius;
  if (scene.dimension == 2) collider.position[2] = collider.size[2] = 0;
  collider.contact = ColliderSettings::Contact::separate;
  collider.friction = 0.3;
  collider.push_out = true;
  return collider;
}

}  // namespace firn
