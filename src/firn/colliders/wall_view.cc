#include <firn/colliders/wall_view.h>

#include <algorithm>
#include <cmath>

namespace firn {

template <int dim>
WallView<dim> wall_view(const PosedCollider<dim>& collider, const Vec<double, dim>& x) {
  WallView<dim> view = {x, collider.distance(x), collider.normal(x)};
  // Inside unions and far from a level set's surface the distance is a bound, so that one step may not be enough.
  for (int i = 0; i < 4 && view.distance < 0; ++i) {
    view.seat = view.seat - view.distance * view.normal;
    const double left = collider.distance(view.seat);
    if (!(left < -0.01 * collider.thickness())) break;
    view.distance = left;
    view.normal = collider.normal(view.seat);
  }
  view.distance = std::max(view.distance, 0.0);
  return view;
}

template <int dim>
bool hides(const PosedCollider<dim>& collider, const WallView<dim>& from, const WallView<dim>& to,
           Vec<double, dim>& normal) {
  const double thickness = collider.thickness(), deep = 0.125 * thickness;
  const Vec<double, dim> way = to.seat - from.seat;
  const double length = norm(way);
  // A distance changes by no more than the way does.
  if (from.distance + to.distance >= length - 2 * deep) return false;

  // Next to a flat wall, which is nearly always, planes tell.
  const double turn = dot(from.normal, to.normal), out = dot(way, from.normal);
  if (turn > 0.9 && std::abs(out - (to.distance - from.distance)) < 0.25 * thickness) return false;
  if (turn < -0.9 && out < -(from.distance + 0.5 * thickness) && dot(way, to.normal) > to.distance + 0.5 * thickness) {
    normal = from.normal;
    return true;
  }

  const double least = std::max(0.25 * thickness, length / 128);
  Vec<double, dim> last = from.seat;
  for (double s = std::max(from.distance, least); s < length;) {
    const Vec<double, dim> x = from.seat + (s / length) * way;
    const double d = collider.distance(x);
    if (d < -deep) {
      normal = collider.normal(last);
      return true;
    }
    if (d + to.distance >= length - s - 2 * deep) return false;
    last = x;
    s += std::max(d, least);
  }
  return false;
}

#define FIRN_INSTANTIATE(dim)                                                                \
  template WallView<dim> wall_view<dim>(const PosedCollider<dim>&, const Vec<double, dim>&); \
  template bool hides<dim>(const PosedCollider<dim>&, const WallView<dim>&, const WallView<dim>&, Vec<double, dim>&);
FIRN_INSTANTIATE(2)
FIRN_INSTANTIATE(3)
#undef FIRN_INSTANTIATE

}  // namespace firn
