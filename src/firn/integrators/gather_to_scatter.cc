#include <firn/core/parallel.h>
#include <firn/integrators/block_pass.h>
#include <firn/integrators/verb_timer.h>
#include <firn/integrators/verbs.h>
#include <firn/state/aligned.h>
#include <firn/transfer/scatter.h>

#include <algorithm>

namespace firn {
namespace {

/// Room for the fields of one chunk that do not survive the step. One per thread.
ParticleStorage passing_storage(const ParticleLayout& layout) {
  thread_local AlignedVector<std::byte> memory;
  memory.resize(std::max(memory.size(), static_cast<std::size_t>(layout.bytes) * kChunk));
  return {memory.data(), kChunk};
}

/// One material's way through the fused step.
template <class Real, int dim>
class Pass {
 public:
  /// @param thin, next_thin thin colliders at the beginning of this step and of the next one
  Pass(World<Real, dim>& world, std::size_t m, const BlockColliders<dim>& colliders, const ThinColliders<dim>& thin,
       const ThinColliders<dim>& next_thin, double dt, double next_dt)
      : world_(world),
        m_(m),
        material_(world.materials[m]),
        particles_(material_.particles),
        colliders_(colliders),
        thin_(thin),
        next_thin_(next_thin),
        dt_(dt),
        next_dt_(next_dt),
        gather_(gather_function<Real, dim>(world.transfer)),
        update_(update_stress_function<Real, dim>(material_.model)),
        scatter_(scatter_function<Real, dim>(world.transfer)) {}

  /// Takes the particles that stay in block b of the grid to its tile, and those that leave to the block's outbox.
  void run(std::size_t b, BlockReport& report) {
    Grid<Real, dim>& grid = world_.grid;
    if (m_ == 0) std::fill_n(grid.tile(b), grid.tile_size(), Real(0));
    if (material_.block_at[b] < 0) return;
    const auto own = static_cast<std::size_t>(material_.block_at[b]);
    BlockNodes<Real, dim> nodes(world_, colliders_, thin_, dt_, b);
    WallScatter<Real, dim> walls(world_, next_thin_, grid.particle_blocks()[b]);
    const std::uint32_t particles = particles_.block_size(own);
    const ParticleStorage passing = passing_storage(particles_.layout());
    std::vector<Leaver>& leavers = particles_.leavers(own);
    // A chunk goes through gather, update_stress and scatter together: what passes between those, 72 bytes a particle
    // in single precision, stays in the first-level cache.
    for (std::uint32_t first = 0; first < particles; first += kChunk) {
      const std::uint32_t count = std::min<std::uint32_t>(kChunk, particles - first);
      const auto columns = particles_.columns(own, first, passing);
      particles_.prefetch_kept(own, first + kChunk);
      const std::size_t left_before = leavers.size();
      const GatherReport gathered = gather_(columns, count, nodes.task(world_, dt_, first, report.loads), leavers);
      const StressReport updated =
          update_(material_.parameters, material_columns<Real, dim>(columns, particles_.history_count()), 0, count,
                  static_cast<Real>(dt_));
      if (leavers.size() > left_before) particles_.send(own, left_before, passing);
      note(columns, gathered, updated, {nodes.origin(), leavers, first}, report);
      scatter_chunk(columns, count, nodes.origin(), walls, grid.tile(b));
    }
    particles_.close_gaps_of_kept(own);
  }

  /// Asks for a tile that deliver() will write to be brought into cache. Not for the block's last chunk, which another
  /// thread may just be replacing.
  void prefetch(const Real* tile) const {
    constexpr std::size_t kLine = 64 / sizeof(Real);
    for (std::size_t n = 0; n < world_.grid.tile_size(); n += kLine) __builtin_prefetch(tile + n, 1);
  }

  /// Takes arrivals to their blocks and the blocks' tiles.
  void deliver(typename Particles<Real, dim>::Arrivals arrivals, Real* tile) {
    const std::size_t b = arrivals.block;
    const ParticleStorage passing = passing_storage(particles_.layout());
    const Index<dim> origin = block_origin<dim>(particles_.block_key(b));
    WallScatter<Real, dim> walls(world_, next_thin_, particles_.block_key(b));
    while (arrivals.begin < arrivals.end) {
      const std::uint32_t first = particles_.block_size(b), count = particles_.receive(arrivals, passing);
      scatter_chunk(particles_.columns(b, first, passing), count, origin, walls, tile);
    }
  }

 private:
  void note(const ParticleColumns<Real, dim>& columns, const GatherReport& gathered, const StressReport& updated,
            const BlockPlace<dim>& where, BlockReport& report) const {
    report.max_speed = std::max(report.max_speed, gathered.max_speed);
    report.wave_speed = std::max(report.wave_speed, updated.wave_speed);
    report.kinematic_viscosity = std::max(report.kinematic_viscosity, updated.kinematic_viscosity);
    if (gathered.failed != GatherReport::kNone) {
      report.template note_failure<Real, dim>(world_, m_, columns, gathered.failed - where.first, where, kMotionFailed);
    } else if (updated.failed != StressReport::kNone) {
      report.template note_failure<Real, dim>(world_, m_, columns, static_cast<std::uint32_t>(updated.failed), where,
                                              kStrainFailed);
    }
  }

  void scatter_chunk(const ParticleColumns<Real, dim>& columns, std::uint32_t count, const Index<dim>& origin,
                     WallScatter<Real, dim>& walls, Real* tile) const {
    if (world_.body_force) evaluate_body_force<Real, dim>(world_, columns, count, origin, world_.t + dt_);
    walls.scatter(scatter_, columns, count, next_dt_, tile);
  }

  World<Real, dim>& world_;
  std::size_t m_;
  MaterialSet<Real, dim>& material_;
  Particles<Real, dim>& particles_;
  const BlockColliders<dim>& colliders_;
  const ThinColliders<dim>&thin_, &next_thin_;
  double dt_, next_dt_;
  GatherBlock<Real, dim> gather_;
  UpdateStress<Real, dim> update_;
  ScatterBlock<Real, dim> scatter_;
};

}  // namespace

template <class Real, int dim>
void gather_to_scatter(World<Real, dim>& world, double dt, double next_dt, StepReport& report) {
  const VerbTimer timer(world.verb_times, Verb::gather_to_scatter);
  const BlockColliders<dim> colliders(world.colliders, world.t, dt, world.grid.dx());
  const double dx = world.grid.dx();
  const ThinColliders<dim> thin(world.colliders, world.t, dx, world.grid.kernel());
  const ThinColliders<dim> next_thin(world.colliders, world.t + dt, dx, world.grid.kernel());
  world.walls.tiles.clear();
  add_wall_tiles(next_thin, world.grid.particle_blocks(), world.walls);
  const std::size_t blocks = world.grid.particle_blocks().size();
  // Material by material, so that every tile sums its particles in the order in which scatter would.
  for (std::size_t m = 0; m < world.materials.size(); ++m) {
    auto& material = world.materials[m];
    Pass<Real, dim> pass(world, m, colliders, thin, next_thin, dt, next_dt);
    std::vector<BlockReport> reports(blocks);
    parallel_each(blocks, [&](std::size_t b) { pass.run(b, reports[b]); });
    combine(world, m, reports, true, true, report);

    const auto arrivals = material.particles.route();
    std::vector<std::uint64_t> keys;
    for (const auto& group : arrivals) keys.push_back(material.particles.block_key(group.block));
    world.grid.add_tiles(keys);
    add_wall_tiles(next_thin, keys, world.walls);
    const std::vector<Real*> tiles = world.grid.tiles_of(keys);
    parallel_each(arrivals.size(), [&](std::size_t k) {
      if (k + 1 < arrivals.size()) pass.prefetch(tiles[k + 1]);
      pass.deliver(arrivals[k], tiles[k]);
    });
    material.particles.settle();
  }
  activate_blocks(world);
}

#define FIRN_INSTANTIATE(Real, dim) \
  template void gather_to_scatter<Real, dim>(World<Real, dim>&, double, double, StepReport&);
FIRN_INSTANTIATE(float, 2)
FIRN_INSTANTIATE(float, 3)
FIRN_INSTANTIATE(double, 2)
FIRN_INSTANTIATE(double, 3)
#undef FIRN_INSTANTIATE

}  // namespace firn
