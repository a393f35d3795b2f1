#pragma once

#include <firn/integrators/block_colliders.h>
#include <firn/integrators/particle_contact.h>
#include <firn/integrators/step.h>
#include <firn/integrators/wall_pass.h>
#include <firn/materials/update_stress.h>
#include <firn/transfer/gather.h>
#include <firn/transfer/tile.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <string_view>
#include <vector>

/// What the verbs on particles share when they work on one block.
namespace firn {

/// Where the columns of a pass lie: lowest cell of their block, which of its particles are on their way elsewhere, and
/// the place of the first particle in the block.
template <int dim>
struct BlockPlace {
  const Index<dim>& origin;
  const std::vector<Leaver>& leavers;
  std::uint32_t first;
};

/// What a pass over one block has to say; combined in the order of blocks.
struct BlockReport {
  double max_speed = 0;                           ///< m/s
  double wave_speed = 0;                          ///< m/s
  double kinematic_viscosity = 0;                 ///< m^2/s
  std::unique_ptr<ParticleFailure> failure = {};  ///< the block's first
  std::vector<ColliderLoad> loads = {};           ///< of each collider, if any is near

  /// Notes the failure of particle p of these columns, unless there is one already.
  template <class Real, int dim>
  void note_failure(const World<Real, dim>& world, std::size_t material, const ParticleColumns<Real, dim>& columns,
                    std::uint32_t p, const BlockPlace<dim>& where, std::string_view cause);
};

/// Puts the reports of all blocks into the material's speeds, the loads of colliders and the step's report.
template <class Real, int dim>
void combine(World<Real, dim>& world, std::size_t m, std::vector<BlockReport>& blocks, bool speeds, bool waves,
             StepReport& report) {
  MaterialSet<Real, dim>& material = world.materials[m];
  double max_speed = 0, wave_speed = 0, viscosity = 0;
  for (BlockReport& block : blocks) {
    max_speed = std::max(max_speed, block.max_speed);
    wave_speed = std::max(wave_speed, block.wave_speed);
    viscosity = std::max(viscosity, block.kinematic_viscosity);
    if (block.failure && !report.failure) report.failure = *block.failure;
    add_loads(block.loads, world.collider_loads);
  }
  if (speeds) material.max_speed = max_speed;
  if (waves) {
    material.wave_speed = wave_speed;
    material.kinematic_viscosity = viscosity;
  }
}

template <class Real, int dim>
Vec<double, dim> position_in_cell(const ParticleColumns<Real, dim>& columns, std::uint32_t p, const Index<dim>& cell,
                                  double dx, Kernel kernel) {
  Vec<double, dim> x;
  for (int d = 0; d < dim; ++d) {
    x[d] = dx * (static_cast<double>(cell[static_cast<std::size_t>(d)]) + cell_offset(kernel) +
                 static_cast<double>(columns.offset[d][p]));
  }
  return x;
}

template <class Real, int dim>
Vec<double, dim> position_in_block(const ParticleColumns<Real, dim>& columns, std::uint32_t p, const Index<dim>& origin,
                                   double dx, Kernel kernel) {
  return position_in_cell<Real, dim>(columns, p, cell_of_code<dim>(origin, columns.cell[p]), dx, kernel);
}

template <class Real, int dim>
void BlockReport::note_failure(const World<Real, dim>& world, std::size_t material,
                               const ParticleColumns<Real, dim>& columns, std::uint32_t p, const BlockPlace<dim>& where,
                               std::string_view cause) {
  if (failure) return;
  failure = std::make_unique<ParticleFailure>();
  failure->material = material;
  failure->id = columns.id[p];
  failure->cause = cause;
  Index<dim> cell = cell_of_code<dim>(where.origin, columns.cell[p]);
  for (const Leaver& leaver : where.leavers) {
    if (columns.cell[p] == kNoCell && leaver.place == where.first + p) cell = cell_of_key<dim>(leaver.cell);
  }
  const auto x = position_in_cell<Real, dim>(columns, p, cell, world.grid.dx(), world.grid.kernel());
  for (int d = 0; d < dim; ++d) {
    failure->position.push_back(x[d]);
    failure->velocity.push_back(static_cast<double>(columns.velocity[d][p]));
  }
  for (int e = 0; e < dim * dim; ++e) failure->strain.push_back(static_cast<double>(columns.strain[e][p]));
}

/// Applies the colliders near a block to its particles, and counts the momentum that they take.
template <class Real, int dim>
class ColliderConstraint final : public ParticleConstraint<Real, dim> {
 public:
  ColliderConstraint(const World<Real, dim>& world, double dt, const Index<dim>& origin,
                     std::span<const StepCollider<dim>* const> colliders)
      : grid_(world.grid), origin_(origin), contact_(world, dt, colliders) {}

  /// Where to count from now on; one load for each collider of the world.
  void count_in(std::vector<ColliderLoad>& loads) { loads_ = &loads; }

  void apply(const ParticleColumns<Real, dim>& particles, std::uint32_t first, std::uint32_t count,
             Real* const (&v)[dim], Real* const (&u)[dim]) const override {
    for (std::uint32_t lane = 0; lane < count; ++lane) {
      MovingParticle<dim> particle = {
          position_in_block<Real, dim>(particles, first + lane, origin_, grid_.dx(), grid_.kernel()),
          static_cast<double>(particles.mass(first + lane)),
          {},
          {}};
      for (int i = 0; i < dim; ++i) {
        particle.v[i] = static_cast<double>(v[i][lane]);
        particle.u[i] = static_cast<double>(u[i][lane]);
      }
      if (!contact_.apply(particle, *loads_)) continue;
      for (int i = 0; i < dim; ++i) {
        v[i][lane] = static_cast<Real>(particle.v[i]);
        u[i][lane] = static_cast<Real>(particle.u[i]);
      }
    }
  }

 private:
  const Grid<Real, dim>& grid_;
  const Index<dim>& origin_;
  ParticleContact<Real, dim> contact_;
  std::vector<ColliderLoad>* loads_ = nullptr;
};

/// What corrects the particles of a block after G2P: first that they do not see all of their nodes, then colliders.
template <class Real, int dim>
class BlockConstraint final : public ParticleConstraint<Real, dim> {
 public:
  /// @param walls, colliders may be null
  BlockConstraint(WallGather<Real, dim>* walls, const ColliderConstraint<Real, dim>* colliders)
      : walls_(walls), colliders_(colliders) {}

  void apply(const ParticleColumns<Real, dim>& particles, std::uint32_t first, std::uint32_t count,
             Real* const (&v)[dim], Real* const (&u)[dim]) const override {
    if (walls_ != nullptr) walls_->apply(particles, first, count, v, u);
    if (colliders_ != nullptr) colliders_->apply(particles, first, count, v, u);
  }

 private:
  WallGather<Real, dim>* walls_;
  const ColliderConstraint<Real, dim>* colliders_;
};

/// Everything that G2P needs of one block of the grid, whichever material it is for.
template <class Real, int dim>
class BlockNodes {
 public:
  BlockNodes(const World<Real, dim>& world, const BlockColliders<dim>& colliders, const ThinColliders<dim>& thin,
             double dt, std::size_t b)
      : origin_(block_origin<dim>(world.grid.particle_blocks()[b])),
        near_(colliders.near(world.grid.particle_blocks()[b], cell_offset(world.grid.kernel()),
                             dt * fastest_node(world, b))),
        constraint_(world, dt, origin_, near_),
        walls_(world, thin, b, velocity_),
        corrections_(walls_.empty() ? nullptr : &walls_, near_.empty() ? nullptr : &constraint_) {
    load(world.grid, b, velocity_);
  }
  BlockNodes(const BlockNodes&) = delete;
  BlockNodes& operator=(const BlockNodes&) = delete;

  const Index<dim>& origin() const { return origin_; }

  /// @param first_place place in the block of the first particle that is gathered
  /// @param loads what colliders take from the particles is added here; stays empty where none is near
  GatherTask<Real, dim> task(const World<Real, dim>& world, double dt, std::uint32_t first_place,
                             std::vector<ColliderLoad>& loads) {
    if (!near_.empty()) {
      loads.resize(world.colliders.size());
      constraint_.count_in(loads);
    }
    return {
        velocity_,           world.grid.dx(), dt,          world.transfer,
        world.grid.period(), origin_,         first_place, near_.empty() && walls_.empty() ? nullptr : &corrections_};
  }

 private:
  /// Speed of the fastest node that the block's particles touch: u is a mean of their velocities.
  static double fastest_node(const World<Real, dim>& world, std::size_t b) {
    double speed = 0;
    for (int o = 0; o < kReach<dim>; ++o) {
      speed = std::max(speed, world.block_speeds[static_cast<std::size_t>(world.grid.node_block_of(b, o))]);
    }
    return speed;
  }

  /// Copies the node values that the block's particles touch into one tile. Nodes at the end of rows that belong to no
  /// cell are zero: they are read with weight zero.
  static void load(const Grid<Real, dim>& grid, std::size_t b, Real* tile) {
    const Kernel kernel = grid.kernel();
    const int layers = grid.layers();
    for (int o = 0; o < kReach<dim>; ++o) {
      const auto g = static_cast<std::size_t>(grid.node_block_of(b, o));
      const Real* nodes = grid.nodes(g);
      for_each_shared_row<dim>(kernel, o, [&](int in_tile, int in_nodes, auto numbers) {
        if (layers == 1) {
          std::memcpy(tile + in_tile, nodes + in_nodes, numbers * sizeof(Real));
        } else {
          std::memcpy(tile + 2 * in_tile, nodes + 2 * in_nodes, 2 * numbers * sizeof(Real));
        }
      });
    }
    const int side = tile_side<dim>(kernel), row = tile_row<dim>(kernel), width = layers * kNodeWidth;
    if (row == side) return;
    for (int r = 0; r < power(side, dim - 1); ++r) std::fill_n(tile + (r * row + side) * width, width, Real(0));
  }

  static constexpr int kLargestTile = tile_nodes<dim>(Kernel::cubic) * kNodeWidth;
  Index<dim> origin_;
  std::vector<const StepCollider<dim>*> near_;
  ColliderConstraint<Real, dim> constraint_;
  WallGather<Real, dim> walls_;
  BlockConstraint<Real, dim> corrections_;
  alignas(64) Real velocity_[2 * kLargestTile];  ///< tile of v_i, and for FLIP in a second layer v_i - v_i^n
};

/// The columns that material laws see.
template <class Real, int dim>
MaterialColumns<Real, dim> material_columns(const ParticleColumns<Real, dim>& particles, int history_count) {
  MaterialColumns<Real, dim> columns = {};
  for (int e = 0; e < dim * dim; ++e) {
    columns.grad_v[e] = particles.velocity_gradient()[e];
    columns.strain[e] = particles.strain[e];
  }
  for (int h = 0; h < history_count; ++h) columns.history[h] = particles.history[h];
  for (int s = 0; s < kStressComponents<dim>; ++s) columns.stress[s] = particles.stress[s];
  return columns;
}

/// Sets the acceleration of the callback for particles that have a cell in the block.
template <class Real, int dim>
void evaluate_body_force(const World<Real, dim>& world, const ParticleColumns<Real, dim>& columns, std::uint32_t count,
                         const Index<dim>& origin, double t) {
  for (std::uint32_t p = 0; p < count; ++p) {
    if (columns.cell[p] == kNoCell) continue;
    const auto x = position_in_block<Real, dim>(columns, p, origin, world.grid.dx(), world.grid.kernel());
    Vec<double, dim> v;
    for (int i = 0; i < dim; ++i) v[i] = columns.velocity[i][p];
    const auto a = world.body_force(x, v, columns.id[p], t);
    for (int i = 0; i < dim; ++i) columns.acceleration[i][p] = static_cast<Real>(a[i]);
  }
}

inline constexpr std::string_view kMotionFailed = "its velocity is not finite";
inline constexpr std::string_view kStrainFailed = "its strain is not finite or turned inside out";

}  // namespace firn
