#include <firn/scene/carried.h>
#include <firn/scene/collider_shape.h>

#include <algorithm>

namespace firn {

template <int dim>
Carried<dim>::Carried(const Scene& scene, const RegionSettings& settings) : settings_(settings) {
  ColliderSettings carrier;
  with_collider_ = !settings.moves_with.empty();
  if (with_collider_) {
    carrier = *std::ranges::find(scene.colliders, settings.moves_with, &ColliderSettings::name);
  } else {
    if (settings.keyframes.empty() && settings.trajectory.empty()) return;
    carrier.name = settings.name;
    carrier.rotation = settings.rotation;
    carrier.keyframes = settings.keyframes;
    carrier.trajectory = settings.trajectory;
    carrier.interpolation = settings.interpolation;
    settings_.position = settings_.rotation = {};
  }
  Collider<dim> collider;
  set_motion<dim>(scene, carrier, collider);
  motion_ = collider.motion;
  keyframes_ = collider.keyframes;
  moves_ = keyframes_ || !motion_.is_static();
  first_ = collider.pose_at(0);
}

template <int dim>
Pose<dim> Carried<dim>::pose_at(double t) const {
  if (!moves_) return {};
  Pose<dim> pose = keyframes_ ? keyframes_->pose_at(t) : motion_.pose_at(t);
  if (!with_collider_) return pose;
  // The frame of the collider goes back to what it was at t = 0, and on to what it is.
  const Vec<double, dim> collider_origin = pose.origin, collider_velocity = pose.velocity;
  pose.rotation = pose.rotation * transpose(first_.rotation);
  pose.scale /= first_.scale;
  const Vec<double, dim> shift = -pose.scale * (pose.rotation * first_.origin);
  pose.velocity = {};
  pose.origin = {};
  pose.velocity = collider_velocity + pose.velocity_at(shift);
  pose.origin = collider_origin + shift;
  return pose;
}

template <int dim>
double Carried<dim>::fastest(const Bounds<dim>& box, double from, double to) const {
  if (!moves_) return 0;
  double speed = 0;
  const auto look_at = [&](double t) { speed = std::max(speed, fastest_in<dim>(pose_at(t), box)); };
  constexpr int kLooks = 256;
  for (int i = 0; i <= kLooks; ++i) look_at(from + (to - from) * i / kLooks);
  if (!keyframes_) return speed;
  // Short moves between keyframes may lie between two looks.
  const auto& frames = keyframes_->keyframes();
  for (std::size_t k = 1; k < frames.size(); ++k) {
    for (const double share : {0.25, 0.5, 0.75}) {
      const double t = frames[k - 1].time + share * (frames[k].time - frames[k - 1].time);
      if (t >= from && t <= to) look_at(t);
    }
  }
  return speed;
}

template class Carried<2>;
template class Carried<3>;

}  // namespace firn
