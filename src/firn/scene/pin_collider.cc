#include <firn/geometry/shapes.h>
#include <firn/scene/body_region.h>
#include <firn/scene/pin_collider.h>

namespace firn {
namespace {

template <int dim>
Vec<double, dim> cut(const Vec3d& v) {
  Vec<double, dim> result;
  for (int i = 0; i < dim; ++i) result[i] = v[i];
  return result;
}

}  // namespace

template <int dim>
Collider<dim> pin_collider(const PinSettings& pin) {
  Collider<dim> collider;
  collider.name = pin.name;
  if (pin.shape == PinSettings::Shape::box) {
    collider.shape = std::make_shared<Box<dim>>(0.5 * cut<dim>(pin.size));
  } else {
    collider.shape = std::make_shared<Sphere<dim>>(pin.radius);
  }
  collider.contact = Contact::sticky;
  // The motion is given from the start on, and a collider's from t = 0 on.
  RigidMotion<dim> motion;
  motion.velocity = cut<dim>(pin.velocity);
  motion.origin = cut<dim>(pin.position) - pin.start * motion.velocity;
  if constexpr (dim == 3) {
    motion.angular_velocity = pin.angular_velocity;
    motion.rotation = rotation_from_degrees(pin.rotation);
  } else {
    motion.angular_velocity = pin.angular_velocity[2];
    motion.rotation = plane_rotation_from_degrees(pin.rotation);
  }
  motion.rotation = motion.rotation_at(-pin.start);
  collider.motion = motion;
  return collider;
}

template Collider<2> pin_collider<2>(const PinSettings&);
template Collider<3> pin_collider<3>(const PinSettings&);

}  // namespace firn
