#include <firn/core/error.h>
#include <firn/geometry/combined_shapes.h>
#include <firn/scene/collider_shape.h>
#include <firn/scene/pin_collider.h>
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

namespace firn {
namespace {

/// The pin's shape, placed in the frame of the collider that carries it, with that collider's motion.
template <int dim>
void ride(const Scene& scene, const PinSettings& pin, Collider<dim>& collider) {
  const ColliderSettings& carrier = *std::ranges::find(scene.colliders, pin.moves_with, &ColliderSettings::name);
  const Pose<dim> own = collider.pose_at(0);
  set_motion<dim>(scene, carrier, collider);
  const Pose<dim> frame = collider.pose_at(0);
  if (frame.scale != 1) {
    throw Error(ErrorKind::usage, fmt::format("pin \"{}\": collider \"{}\" has the scale {} at t = 0, where the pin's "
                                              "size is given; let it be 1 there",
                                              pin.name, carrier.name, frame.scale));
  }
  const Mat<double, dim> back = transpose(frame.rotation);
  collider.shape =
      std::make_shared<Placed<dim>>(std::move(collider.shape), back * own.rotation, back * (own.origin - frame.origin));
}

}  // namespace

template <int dim>
Collider<dim> pin_collider(const Scene& scene, const PinSettings& pin, double cell_size) {
  Collider<dim> collider = make_collider<dim>(scene, pin, cell_size);
  collider.contact = Contact::sticky;
  collider.is_filled = true;
  if (!pin.moves_with.empty()) {
    ride<dim>(scene, pin, collider);
  } else if (!collider.keyframes) {
    // The motion is given from the start on, and a collider's from t = 0 on.
    RigidMotion<dim>& motion = collider.motion;
    motion.origin = motion.origin_at(-pin.start);
    motion.rotation = motion.rotation_at(-pin.start);
  }
  return collider;
}

template Collider<2> pin_collider<2>(const Scene&, const PinSettings&, double);
template Collider<3> pin_collider<3>(const Scene&, const PinSettings&, double);

}  // namespace firn
