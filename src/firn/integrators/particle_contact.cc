#include <firn/geometry/first_hit.h>
#include <firn/integrators/particle_contact.h>

namespace firn {
namespace {

/// Turns that a way may take: along surfaces first, as in a corner; then it ends where it is stopped.
constexpr int kTurns = 8, kStops = 4;

/// Of a cell: the least step of the search for the surface, and how far a particle is pushed out in one step.
constexpr double kSearchStep = 1.0 / 16, kPush = 0.1;

/// Whether a way in the frame may meet the surface. Written so that a way that is not finite does not, and the particle
/// is found by whoever looks for failed ones. @param closing how far the surface may come towards the way meanwhile
template <int dim>
bool in_reach(double distance, const Vec<double, dim>& way, double closing = 0) {
  if (closing > 0) return distance >= 0 && distance <= std::sqrt(static_cast<double>(dim)) * (norm(way) + closing);
  return distance >= 0 && distance * distance <= dim * dot(way, way);
}

}  // namespace

template <class Real, int dim>
bool ParticleContact<Real, dim>::apply(MovingParticle<dim>& particle, std::vector<ColliderLoad>& loads) const {
  // Most particles of a block near a collider are neither inside nor can get there.
  const Vec<double, dim> target = particle.x + dt_ * particle.u;
  bool inside = false, near = false;
  for (const Near* collider : colliders_) {
    const double distance = collider->before.shape().distance(collider->before.to_frame(particle.x));
    inside = inside || collider->before.pose().scale * distance < touch(collider->before);
    if (collider->after.collider().is_filled) continue;
    near = near || in_reach(distance,
                            collider->moves() ? collider->after.to_frame(target) - collider->before.to_frame(particle.x)
                                              : dt_ * particle.u,
                            collider->deformation() / collider->before.pose().scale);
  }
  const bool held = inside && hold_inside(particle, loads);
  const bool stopped = swept_ && (near || held) && sweep(particle, loads);
  return held || stopped;
}

/// v as its column will hold it, and the momentum that this takes, to the collider.
template <class Real, int dim>
void ParticleContact<Real, dim>::make_admissible(const PosedCollider<dim>& collider, std::size_t place,
                                                 const Vec<double, dim>& x, const Vec<double, dim>& n,
                                                 MovingParticle<dim>& particle,
                                                 std::vector<ColliderLoad>& loads) const {
  Vec<double, dim> v = collider.admissible(x, n, particle.v);
  for (int i = 0; i < dim; ++i) v[i] = static_cast<double>(static_cast<Real>(v[i]));
  loads[place].add(particle.mass * (particle.v - v), x - collider.pose().origin);
  particle.v = v;
}

template <class Real, int dim>
bool ParticleContact<Real, dim>::hold_inside(MovingParticle<dim>& particle, std::vector<ColliderLoad>& loads) const {
  bool changed = false;
  for (const Near* near : colliders_) {
    if (!(near->before.distance(particle.x) < touch(near->before))) continue;
    const Vec<double, dim> n = near->before.normal(particle.x);
    make_admissible(near->before, near->place, particle.x, n, particle, loads);
    particle.u = near->before.admissible(particle.x, n, particle.u);
    changed = true;
    if (!near->after.collider().push_out) continue;
    const Vec<double, dim> target = particle.x + dt_ * particle.u;
    const double depth = margin_ - near->after.distance(target);
    if (depth > 0) particle.u += (std::min(depth, kPush * dx_) / dt_) * near->after.normal(target);
  }
  return changed;
}

template <class Real, int dim>
auto ParticleContact<Real, dim>::first_collision(const Vec<double, dim>& x, const Vec<double, dim>& target) const
    -> std::optional<Collision> {
  std::optional<Collision> first;
  for (const Near* near : colliders_) {
    if (near->after.collider().is_filled) continue;
    const double per_unit = 1 / near->after.pose().scale;
    const Vec<double, dim> from = near->start(x, margin_ * per_unit), to = near->after.to_frame(target);
    const Shape<dim>& shape = near->after.shape();
    if (!in_reach(shape.distance(from), to - from)) continue;
    const auto hit = first_hit(shape, from, to, {0.5 * margin_ * per_unit, kSearchStep * dx_ * per_unit});
    if (!hit || (first && first->fraction <= hit->fraction)) continue;
    first = {near, hit->fraction, hit->point, hit->normal, (1 - hit->fraction) * (to - from)};
  }
  return first;
}

template <class Real, int dim>
bool ParticleContact<Real, dim>::sweep(MovingParticle<dim>& particle, std::vector<ColliderLoad>& loads) const {
  Vec<double, dim> target = particle.x + dt_ * particle.u;
  bool changed = false;
  for (int turn = 0;; ++turn) {
    const auto hit = first_collision(particle.x, target);
    if (!hit) break;
    const PosedCollider<dim>& after = hit->near->after;
    if (turn == kTurns + kStops) {
      // Other colliders close on it: it stays where they leave it.
      ++loads[hit->near->place].caught;
      break;
    }
    const Vec<double, dim> n = after.pose().rotation * hit->normal;
    make_admissible(after, hit->near->place, after.to_world(hit->point), n, particle, loads);
    const double gap = margin_ / after.pose().scale - after.shape().distance(hit->point);
    Vec<double, dim> end = hit->point + std::max(gap, 0.0) * hit->normal;
    if (turn < kTurns) end += after.slide(hit->normal, hit->rest);
    target = after.to_world(end);
    changed = true;
  }
  if (changed) particle.u = (1 / dt_) * (target - particle.x);
  return changed;
}

template class ParticleContact<float, 2>;
template class ParticleContact<float, 3>;
template class ParticleContact<double, 2>;
template class ParticleContact<double, 3>;

}  // namespace firn
