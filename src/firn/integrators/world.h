#pragma once

#include <firn/colliders/collider.h>
#include <firn/colliders/collider_load.h>
#include <firn/integrators/wall_fields.h>
#include <firn/materials/model_parameters.h>
#include <firn/state/grid.h>
#include <firn/state/particles.h>
#include <firn/transfer/transfer_settings.h>

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace firn {

/// The verbs of one step, in order: the headings of docs/algorithm.md and the rows of `firn bench`. The last one does
/// the work of three others and of the next step's scatter, block by block.
enum class Verb { scatter, update_velocity, gather, update_stress, sort_by_block, gather_to_scatter };
inline constexpr std::array<std::string_view, 6> kVerbNames = {"scatter",       "update_velocity", "gather",
                                                               "update_stress", "sort_by_block",   "gather_to_scatter"};

/// Seconds spent in each verb since the start.
using VerbTimes = std::array<double, kVerbNames.size()>;

/// All particles of one material.
template <class Real, int dim>
struct MaterialSet {
  std::string name;  ///< as in the scene
  int model = 0;     ///< place in all_models()
  ModelParameters parameters;
  Particles<Real, dim> particles;

  // What time step control knows from the last step.
  /// The grid's bound on the speed of particles after the last step, m/s. A collider that catches particles between
  /// nodes may carry them faster.
  double max_speed = 0;
  double wave_speed = 0;           ///< m/s
  double kinematic_viscosity = 0;  ///< m^2/s

  /// Number of this material's block at each of the grid's particle blocks; -1 where it has no particles.
  std::vector<std::int32_t> block_at = {};
};

/// Acceleration of a particle, m/s^2: a function of its world position x (m), id and the time t (s), or of its
/// position, velocity v (m/s), id and the time. Called from several threads; must not start parallel work of its own.
template <int dim>
class BodyForce {
 public:
  using Vector = Vec<double, dim>;

  BodyForce() = default;
  template <class Force>
  requires(!std::is_same_v<Force, BodyForce> && std::is_invocable_v<const Force&, const Vector&, std::uint32_t, double>)
      BodyForce(Force force)
      : force_([force = std::move(force)](const Vector& x, const Vector&, std::uint32_t id, double t) {
          return force(x, id, t);
        }) {}
  template <class Force>
  requires(!std::is_same_v<Force, BodyForce> &&
           std::is_invocable_v<const Force&, const Vector&, const Vector&, std::uint32_t, double>)
      BodyForce(Force force)
      : force_(std::move(force)) {}

  explicit operator bool() const { return static_cast<bool>(force_); }
  Vector operator()(const Vector& x, const Vector& v, std::uint32_t id, double t) const { return force_(x, v, id, t); }

 private:
  std::function<Vector(const Vector&, const Vector&, std::uint32_t, double)> force_;
};

/// Everything that a step reads and writes.
template <class Real, int dim>
struct World {
  World(double dx, const TransferSettings& settings, const Period<dim>& period)
      : transfer(settings), grid(dx, settings.kernel, period) {
    grid.keep_velocity_change(settings.flip > 0);
  }

  TransferSettings transfer;
  Grid<Real, dim> grid;
  WallFields<Real> walls;  ///< what the grid holds beside thin colliders
  std::vector<MaterialSet<Real, dim>> materials;
  std::vector<Collider<dim>> colliders;
  /// What each collider has taken; steps only add to it.
  std::vector<ColliderLoad> collider_loads;
  Vec<double, dim> gravity = {};  ///< m/s^2
  BodyForce<dim> body_force;      ///< may be empty; set it before materials are added
  double t = 0;                   ///< s
  std::uint64_t steps = 0;
  double max_collider_speed = 0;  ///< at nodes that are inside colliders or that these may soon reach, m/s
  double max_speed = 0;           ///< no particle is faster after the last step, m/s
  /// Speed of the fastest node of each of the grid's node blocks, m/s: what no particle moves faster than.
  std::vector<double> block_speeds = {};
  /// Whether steps may run gather, update_stress and the next scatter block by block. The bits are the same.
  bool fused = true;
  /// Whether particles are stopped where their way in a step meets a collider. Off only to show what that is for.
  bool swept_contact = true;
  /// The time step that the tiles hold the particles' contributions for, if they hold them.
  std::optional<double> scattered_dt;
  /// Whether all fields of all particles are stored.
  bool drained = true;
  VerbTimes verb_times = {};

  /// Adds a material without particles. Parameters that vary become columns behind the model's history, named as they
  /// are. @param model place in all_models()
  MaterialSet<Real, dim>& add_material(std::string name, int model, const ModelParameters& parameters);
  std::size_t particle_count() const;
};

}  // namespace firn
