#include <firn/core/parallel.h>
#include <firn/integrators/block_colliders.h>
#include <firn/integrators/verb_timer.h>
#include <firn/integrators/verbs.h>
#include <firn/materials/update_stress.h>
#include <firn/transfer/gather.h>
#include <firn/transfer/scatter.h>

#include <algorithm>
#include <cstring>

namespace firn {
namespace {

/// Blocks that hold particles of any material, and for each material its particles in each of them.
template <class Real, int dim>
std::vector<std::uint64_t> unite_blocks(std::vector<MaterialSet<Real, dim>>& materials) {
  std::vector<std::uint64_t> blocks;
  for (const auto& material : materials) {
    for (const BlockRange& range : material.particles.blocks()) blocks.push_back(range.block);
  }
  std::sort(blocks.begin(), blocks.end());
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  for (auto& material : materials) {
    material.ranges.clear();
    auto own = material.particles.blocks().begin();
    const auto end = material.particles.blocks().end();
    for (const std::uint64_t block : blocks) {
      material.ranges.push_back(own != end && own->block == block ? *own++ : BlockRange{block, 0, 0});
    }
  }
  return blocks;
}

template <class Real, int dim>
void evaluate_body_force(World<Real, dim>& world) {
  constexpr std::size_t kGrain = 1 << 12;
  for (auto& material : world.materials) {
    auto& particles = material.particles;
    parallel_chunks(particles.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) {
        const auto x = particles.position(p, world.grid.dx(), world.grid.kernel());
        const auto a = world.body_force(x, particles.id()[p], world.t);
        for (int i = 0; i < dim; ++i) particles.real(Field::acceleration, i)[p] = static_cast<Real>(a[i]);
      }
    });
  }
}

/// Copies the node values that block b's particles touch into one tile.
template <class Real, int dim, class NodesOf>
void load_tile(const Grid<Real, dim>& grid, std::size_t b, const NodesOf& nodes_of, Real* tile) {
  const int side = tile_side(grid.kernel()), beyond = side - kBlockSide;
  for (int o = 0; o < kReach<dim>; ++o) {
    const Real* nodes = nodes_of(static_cast<std::size_t>(grid.node_block_of(b, o)));
    int from[3] = {0, 0, 0}, count[3] = {1, 1, 1};
    for (int d = 0; d < dim; ++d) {
      const bool upper = (o >> (dim - 1 - d) & 1) != 0;
      from[3 - dim + d] = upper ? kBlockSide : 0;
      count[3 - dim + d] = upper ? beyond : kBlockSide;
    }
    for (int i = 0; i < count[0]; ++i) {
      for (int j = 0; j < count[1]; ++j) {
        const int source = (i * kBlockSide + j) * kBlockSide;
        const int target = ((from[0] + i) * side + from[1] + j) * side + from[2];
        std::memcpy(tile + target * kNodeWidth, nodes + source * kNodeWidth,
                    static_cast<std::size_t>(count[2] * kNodeWidth) * sizeof(Real));
      }
    }
  }
}

/// Applies the colliders near a block to its particles' velocities.
template <class Real, int dim>
class ColliderConstraint final : public ParticleConstraint<Real, dim> {
 public:
  ColliderConstraint(const Particles<Real, dim>& particles, const Grid<Real, dim>& grid,
                     std::span<const PosedCollider<dim>* const> colliders)
      : particles_(particles), grid_(grid), colliders_(colliders) {}

  void apply(std::uint32_t first, std::uint32_t count, Real* const (&v)[dim], Real* const (&u)[dim]) const override {
    for (std::uint32_t lane = 0; lane < count; ++lane) {
      const auto x = particles_.position(first + lane, grid_.dx(), grid_.kernel());
      for (const PosedCollider<dim>* collider : colliders_) {
        if (!(collider->distance(x) < 0)) continue;
        for (Real* const(*velocity)[dim] : {&v, &u}) {
          Vec<double, dim> w;
          for (int i = 0; i < dim; ++i) w[i] = (*velocity)[i][lane];
          w = collider->admissible(x, w);
          for (int i = 0; i < dim; ++i) (*velocity)[i][lane] = static_cast<Real>(w[i]);
        }
      }
    }
  }

 private:
  const Particles<Real, dim>& particles_;
  const Grid<Real, dim>& grid_;
  std::span<const PosedCollider<dim>* const> colliders_;
};

template <class Real, int dim>
void note_failure(StepReport& report, const World<Real, dim>& world, std::size_t material, std::uint32_t particle,
                  std::string_view cause) {
  if (report.failure) return;
  report.failure = {material, particle, world.materials[material].particles.id()[particle], cause};
}

}  // namespace

template <class Real, int dim>
void sort_by_cell(World<Real, dim>& world) {
  const VerbTimer timer(world.verb_times, Verb::sort_by_cell);
  for (auto& material : world.materials) {
    material.particles.sort_by_cell(material.movers);
    material.movers.clear();
  }
  world.grid.activate(unite_blocks(world.materials));
}

template <class Real, int dim>
void scatter(World<Real, dim>& world, double dt) {
  const VerbTimer timer(world.verb_times, Verb::scatter);
  if (world.body_force) evaluate_body_force(world);
  Grid<Real, dim>& grid = world.grid;
  const ScatterBlock<Real, dim> scatter_block = scatter_function<Real, dim>(world.transfer);
  std::vector<ParticleColumns<Real, dim>> columns;
  for (auto& material : world.materials) columns.emplace_back(material.particles);
  const std::size_t tile_numbers = static_cast<std::size_t>(tile_nodes<dim>(grid.kernel()) * kNodeWidth);
  parallel_each(grid.particle_blocks().size(), [&](std::size_t b) {
    for (int layer = 0; layer < (grid.has_velocity_change() ? 2 : 1); ++layer) {
      Real* tile = grid.tile(b, layer);
      std::fill_n(tile, tile_numbers, Real(0));
      for (std::size_t m = 0; m < world.materials.size(); ++m) {
        const BlockRange& range = world.materials[m].ranges[b];
        scatter_block(columns[m], range.begin, range.end, grid.dx(), layer == 0 ? dt : 0, world.transfer, tile);
      }
    }
  });
}

template <class Real, int dim>
void gather(World<Real, dim>& world, double dt, StepReport& report) {
  const VerbTimer timer(world.verb_times, Verb::gather);
  Grid<Real, dim>& grid = world.grid;
  const GatherBlock<Real, dim> gather_block = gather_function<Real, dim>(world.transfer);
  const BlockColliders<dim> block_colliders(world.colliders, world.t + dt, grid.dx());
  const bool flip = world.transfer.flip > 0;
  const std::size_t blocks = grid.particle_blocks().size();
  std::vector<ParticleColumns<Real, dim>> columns;
  std::vector<std::vector<GatherReport>> reports(world.materials.size(), std::vector<GatherReport>(blocks));
  for (auto& material : world.materials) {
    columns.emplace_back(material.particles);
    material.movers_of_block.resize(std::max(material.movers_of_block.size(), blocks));
  }

  parallel_each(blocks, [&](std::size_t b) {
    constexpr int kLargestTile = tile_nodes<dim>(Kernel::cubic) * kNodeWidth;
    alignas(64) Real velocity[kLargestTile];
    alignas(64) Real change[kLargestTile];
    load_tile(
        grid, b, [&](std::size_t g) { return grid.nodes(g); }, velocity);
    if (flip)
      load_tile(
          grid, b, [&](std::size_t g) { return grid.velocity_change(g); }, change);
    const auto near = block_colliders.near(grid.particle_blocks()[b], cell_offset(grid.kernel()));
    for (std::size_t m = 0; m < world.materials.size(); ++m) {
      auto& material = world.materials[m];
      const ColliderConstraint<Real, dim> constraint(material.particles, grid, near);
      const GatherTask<Real, dim> task = {
          velocity, change, grid.dx(), dt, world.transfer, grid.period(), near.empty() ? nullptr : &constraint};
      material.movers_of_block[b].clear();
      const BlockRange& range = material.ranges[b];
      reports[m][b] = gather_block(columns[m], range.begin, range.end, task, material.movers_of_block[b]);
    }
  });

  for (std::size_t m = 0; m < world.materials.size(); ++m) {
    auto& material = world.materials[m];
    GatherReport total;
    for (std::size_t b = 0; b < blocks; ++b) {
      total = merge(total, reports[m][b]);
      const auto& moved = material.movers_of_block[b];
      material.movers.insert(material.movers.end(), moved.begin(), moved.end());
    }
    material.max_speed = total.max_speed;
    if (total.failed != GatherReport::kNone) note_failure(report, world, m, total.failed, "its velocity is not finite");
  }
}

template <class Real, int dim>
void update_stress(World<Real, dim>& world, double dt, StepReport& report) {
  const VerbTimer timer(world.verb_times, Verb::update_stress);
  constexpr std::size_t kGrain = 1 << 12;
  for (std::size_t m = 0; m < world.materials.size(); ++m) {
    auto& material = world.materials[m];
    auto& particles = material.particles;
    const UpdateStress<Real, dim> update = update_stress_function<Real, dim>(material.model);
    const Field gradient = particles.has(Field::grad_v) ? Field::grad_v : Field::affine;
    MaterialColumns<Real, dim> columns = {};
    for (int e = 0; e < dim * dim; ++e) {
      columns.grad_v[e] = particles.real(gradient, e);
      columns.strain[e] = particles.real(Field::strain, e);
    }
    for (int h = 0; h < particles.history_count(); ++h) columns.history[h] = particles.history(h);
    for (int s = 0; s < kStressComponents<dim>; ++s) columns.stress[s] = particles.real(Field::stress, s);

    std::vector<StressReport> reports((particles.size() + kGrain - 1) / kGrain);
    parallel_chunks(particles.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      reports[begin / kGrain] = update(material.parameters, columns, begin, end, static_cast<Real>(dt));
    });
    StressReport total;
    for (const StressReport& part : reports) total = merge(total, part);
    material.wave_speed = total.wave_speed;
    if (total.failed != StressReport::kNone) {
      note_failure(report, world, m, static_cast<std::uint32_t>(total.failed),
                   "its strain is not finite or turned inside out");
    }
  }
}

#define FIRN_INSTANTIATE(Real, dim)                                        \
  template void sort_by_cell<Real, dim>(World<Real, dim>&);                \
  template void scatter<Real, dim>(World<Real, dim>&, double);             \
  template void gather<Real, dim>(World<Real, dim>&, double, StepReport&); \
  template void update_stress<Real, dim>(World<Real, dim>&, double, StepReport&);
FIRN_INSTANTIATE(float, 2)
FIRN_INSTANTIATE(float, 3)
FIRN_INSTANTIATE(double, 2)
FIRN_INSTANTIATE(double, 3)
#undef FIRN_INSTANTIATE

}  // namespace firn
