#pragma once

#include <firn/colliders/collider_load.h>
#include <firn/integrators/block_colliders.h>
#include <firn/integrators/world.h>

#include <optional>
#include <span>
#include <vector>

namespace firn {

/// A particle that G2P has given new velocities and that has not moved yet.
template <int dim>
struct MovingParticle {
  Vec<double, dim> x;  ///< where it is, m
  double mass;         ///< kg
  Vec<double, dim> v;  ///< its velocity, m/s; numbers of the columns' precision
  Vec<double, dim> u;  ///< what it is going to move with, m/s
};

/// What colliders do to particles in one step.
///
/// 1. A particle inside a collider, or touching a sticky one, gets admissible v and u; with `push_out` it is also moved towards the surface.
/// 2. All others are stopped where their way meets a collider. In the frame of a collider the way is the straight one
///    from the inverse of the frame at t of x to the inverse of the frame at t + dt of x + dt u, so that material that
///    runs into a wall and a wall that runs into material are the same. From the first place where the way enters, what
///    is left of it goes on as the contact allows (nowhere for sticky, along the surface less friction for the others),
///    a hair's breadth outside; v becomes admissible for the normal there. The new way is tried again, against all
///    colliders.
template <class Real, int dim>
class ParticleContact {
 public:
  /// @param colliders those that are near the particle
  ParticleContact(const World<Real, dim>& world, double dt, std::span<const StepCollider<dim>* const> colliders)
      : colliders_(colliders),
        dx_(world.grid.dx()),
        dt_(dt),
        margin_(dx_ * kMargin<Real>),
        swept_(world.swept_contact) {}

  /// Returns whether v or u has changed. @param loads of all colliders of the world
  bool apply(MovingParticle<dim>& particle, std::vector<ColliderLoad>& loads) const;

 private:
  using Near = StepCollider<dim>;

  /// Where a particle is put outside of a surface, in cells: more than rounding takes from a position, which is an
  /// offset in a cell, and than a frame's place at t differs between the end of one step and the beginning of the next.
  template <class Number>
  static constexpr double kMargin = sizeof(Number) == 4 ? 4e-6 : 1e-8;

  /// How near a particle, m, counts as inside. One that a sticky collider has stopped lies a margin outside, and what
  /// touches it must not get away.
  double touch(const PosedCollider<dim>& collider) const {
    return collider.collider().contact == Contact::sticky ? 2 * margin_ : 0;
  }
  bool hold_inside(MovingParticle<dim>& particle, std::vector<ColliderLoad>& loads) const;
  bool sweep(MovingParticle<dim>& particle, std::vector<ColliderLoad>& loads) const;
  void make_admissible(const PosedCollider<dim>& collider, std::size_t place, const Vec<double, dim>& x,
                       const Vec<double, dim>& n, MovingParticle<dim>& particle,
                       std::vector<ColliderLoad>& loads) const;

  /// The first of all collisions on the way to `target`.
  struct Collision {
    const Near* near;
    double fraction;
    Vec<double, dim> point, normal, rest;  ///< in the frame; the rest of the way
  };
  std::optional<Collision> first_collision(const Vec<double, dim>& x, const Vec<double, dim>& target) const;

  std::span<const StepCollider<dim>* const> colliders_;
  double dx_, dt_, margin_;
  bool swept_;
};

}  // namespace firn
