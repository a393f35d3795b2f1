#include <firn/core/parallel.h>
#include <firn/integrators/block_pass.h>
#include <firn/integrators/verb_timer.h>
#include <firn/integrators/verbs.h>
#include <firn/transfer/scatter.h>

#include <algorithm>

namespace firn {

template <class Real, int dim>
void activate_blocks(World<Real, dim>& world) {
  std::vector<std::uint64_t> blocks;
  for (const auto& material : world.materials) {
    for (std::size_t b = 0; b < material.particles.block_count(); ++b) {
      blocks.push_back(material.particles.block_key(b));
    }
  }
  if (world.materials.size() > 1) {
    std::sort(blocks.begin(), blocks.end());
    blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  }
  for (auto& material : world.materials) {
    material.block_at.resize(blocks.size());
    std::size_t own = 0;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      const bool is_own = own < material.particles.block_count() && material.particles.block_key(own) == blocks[b];
      material.block_at[b] = is_own ? static_cast<std::int32_t>(own++) : -1;
    }
  }
  world.grid.activate(std::move(blocks));
}

template <class Real, int dim>
void sort_by_block(World<Real, dim>& world) {
  const VerbTimer timer(world.verb_times, Verb::sort_by_block);
  for (auto& material : world.materials) material.particles.sort_by_block();
  activate_blocks(world);
}

template <class Real, int dim>
void scatter(World<Real, dim>& world, double dt) {
  const VerbTimer timer(world.verb_times, Verb::scatter);
  Grid<Real, dim>& grid = world.grid;
  const ScatterBlock<Real, dim> scatter_block = scatter_function<Real, dim>(world.transfer);
  const ThinColliders<dim> thin(world.colliders, world.t, grid.dx(), grid.kernel());
  world.walls.tiles.clear();
  add_wall_tiles(thin, grid.particle_blocks(), world.walls);
  parallel_each(grid.particle_blocks().size(), [&](std::size_t b) {
    const Index<dim> origin = block_origin<dim>(grid.particle_blocks()[b]);
    WallScatter<Real, dim> walls(world, thin, grid.particle_blocks()[b]);
    std::fill_n(grid.tile(b), grid.tile_size(), Real(0));
    for (auto& material : world.materials) {
      if (material.block_at[b] < 0) continue;
      const auto own = static_cast<std::size_t>(material.block_at[b]);
      material.particles.for_each_chunk(own, [&](const auto& columns, std::uint32_t, std::uint32_t count) {
        if (world.body_force) evaluate_body_force<Real, dim>(world, columns, count, origin, world.t);
        walls.scatter(scatter_block, columns, count, dt, grid.tile(b));
      });
    }
  });
}

template <class Real, int dim>
void gather(World<Real, dim>& world, double dt, StepReport& report) {
  const VerbTimer timer(world.verb_times, Verb::gather);
  const GatherBlock<Real, dim> gather_block = gather_function<Real, dim>(world.transfer);
  const BlockColliders<dim> colliders(world.colliders, world.t, dt, world.grid.dx());
  const ThinColliders<dim> thin(world.colliders, world.t, world.grid.dx(), world.grid.kernel());
  const std::size_t blocks = world.grid.particle_blocks().size();
  std::vector<std::vector<BlockReport>> reports(world.materials.size());
  for (auto& blocks_of_material : reports) blocks_of_material.resize(blocks);
  parallel_each(blocks, [&](std::size_t b) {
    BlockNodes<Real, dim> nodes(world, colliders, thin, dt, b);
    for (std::size_t m = 0; m < world.materials.size(); ++m) {
      auto& material = world.materials[m];
      if (material.block_at[b] < 0) continue;
      const auto own = static_cast<std::size_t>(material.block_at[b]);
      BlockReport& block = reports[m][b];
      material.particles.for_each_chunk(own, [&](const auto& columns, std::uint32_t first, std::uint32_t count) {
        const GatherReport gathered =
            gather_block(columns, count, nodes.task(world, dt, first, block.loads), material.particles.leavers(own));
        block.max_speed = std::max(block.max_speed, gathered.max_speed);
        if (gathered.failed != GatherReport::kNone) {
          block.template note_failure<Real, dim>(world, m, columns, gathered.failed - first,
                                                 {nodes.origin(), material.particles.leavers(own), first},
                                                 kMotionFailed);
        }
      });
    }
  });
  for (std::size_t m = 0; m < world.materials.size(); ++m) {
    combine(world, m, reports[m], true, false, report);
  }
}

template <class Real, int dim>
void update_stress(World<Real, dim>& world, double dt, StepReport& report) {
  const VerbTimer timer(world.verb_times, Verb::update_stress);
  for (std::size_t m = 0; m < world.materials.size(); ++m) {
    auto& material = world.materials[m];
    auto& particles = material.particles;
    const UpdateStress<Real, dim> update = update_stress_function<Real, dim>(material.model);
    std::vector<BlockReport> reports(particles.block_count());
    parallel_each(particles.block_count(), [&](std::size_t b) {
      const Index<dim> origin = block_origin<dim>(particles.block_key(b));
      particles.for_each_chunk(b, [&](const auto& columns, std::uint32_t first, std::uint32_t count) {
        const StressReport updated =
            update(material.parameters, material_columns<Real, dim>(columns, particles.history_count()), 0, count,
                   static_cast<Real>(dt));
        reports[b].wave_speed = std::max(reports[b].wave_speed, updated.wave_speed);
        reports[b].kinematic_viscosity = std::max(reports[b].kinematic_viscosity, updated.kinematic_viscosity);
        if (updated.failed != StressReport::kNone) {
          reports[b].template note_failure<Real, dim>(world, m, columns, static_cast<std::uint32_t>(updated.failed),
                                                      {origin, particles.leavers(b), first}, kStrainFailed);
        }
      });
    });
    combine(world, m, reports, false, true, report);
  }
}

#define FIRN_INSTANTIATE(Real, dim)                                        \
  template void activate_blocks<Real, dim>(World<Real, dim>&);             \
  template void sort_by_block<Real, dim>(World<Real, dim>&);               \
  template void scatter<Real, dim>(World<Real, dim>&, double);             \
  template void gather<Real, dim>(World<Real, dim>&, double, StepReport&); \
  template void update_stress<Real, dim>(World<Real, dim>&, double, StepReport&);
FIRN_INSTANTIATE(float, 2)
FIRN_INSTANTIATE(float, 3)
FIRN_INSTANTIATE(double, 2)
FIRN_INSTANTIATE(double, 3)
#undef FIRN_INSTANTIATE

}  // namespace firn
