// Nanoseconds per particle of gather and scatter: one block with its tile, chunk by chunk as in the fused step, one
// thread. The least of many repetitions: other work on the machine only ever adds.

#include <firn/core/simd.h>
#include <firn/state/aligned.h>
#include <firn/state/particles.h>
#include <firn/transfer/gather.h>
#include <firn/transfer/scatter.h>
#include <firn/transfer/tile.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace firn {
namespace {

constexpr int kRepeats = 300, kCallsPerRepeat = 40, kBlockParticles = 512;

/// In [0, 1).
double random_number(std::uint64_t& state) {
  state = state * 6364136223846793005u + 1442695040888963407u;
  return static_cast<double>(state >> 11) * 0x1p-53;
}

/// Particles anywhere in one block of cells of 1 m, with a random state of motion.
template <class Real, int dim>
Particles<Real, dim> particles_of_one_block(const TransferSettings& settings) {
  Particles<Real, dim> particles({.keeps_velocity = settings.flip > 0,
                                  .separate_grad_v = !affine_is_gradient(settings.kernel, settings.form),
                                  .density = 8});
  std::uint64_t random = 1;
  std::vector<Vec<double, dim>> positions(kBlockParticles);
  for (auto& x : positions) {
    for (int d = 0; d < dim; ++d) x[d] = kBlockSide<dim> * random_number(random) + cell_offset(settings.kernel);
  }
  particles.append(positions, 1, settings.kernel, {}, 1, 0, 0);
  particles.sort_by_block();
  return particles;
}

template <class Real>
AlignedVector<Real> random_tile(std::size_t numbers) {
  std::uint64_t random = 2;
  AlignedVector<Real> tile(numbers);
  for (Real& number : tile) number = static_cast<Real>(random_number(random));
  return tile;
}

/// Least time per particle over the repetitions, ns.
template <class Work>
double nanoseconds(const Work& work) {
  using Clock = std::chrono::steady_clock;
  double best = 1e30;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    const auto start = Clock::now();
    for (int call = 0; call < kCallsPerRepeat; ++call) work();
    const std::chrono::duration<double, std::nano> elapsed = Clock::now() - start;
    best = std::min(best, elapsed.count() / (double(kCallsPerRepeat) * kBlockParticles));
  }
  return best;
}

template <class Real, int dim>
void time_transfers(const char* what, const TransferSettings& settings) {
  Particles<Real, dim> particles = particles_of_one_block<Real, dim>(settings);
  AlignedVector<std::byte> memory(static_cast<std::size_t>(particles.layout().bytes) * kChunk);
  const ParticleStorage passing = {memory.data(), kChunk};
  const auto numbers = static_cast<std::size_t>(tile_nodes<dim>(settings.kernel) * kNodeWidth);
  const AlignedVector<Real> velocity = random_tile<Real>(2 * numbers);
  AlignedVector<Real> tiles(2 * numbers, Real(0));
  // Without time, particles stay where they are; the operations are those of any other step.
  const GatherTask<Real, dim> task = {velocity.data(), 1, 0, settings, {}, {}, 0, nullptr};
  const auto gather = gather_function<Real, dim>(settings);
  const auto scatter = scatter_function<Real, dim>(settings);
  std::vector<Leaver> leavers;
  const auto for_each_chunk = [&](const auto& body) {
    for (std::uint32_t first = 0; first < kBlockParticles; first += kChunk) {
      body(particles.columns(0, first, passing));
    }
  };
  const double gather_time = nanoseconds([&] {
    for_each_chunk([&](const ParticleColumns<Real, dim>& columns) { gather(columns, kChunk, task, leavers); });
  });
  // The stress that scatter reads was never computed: what adds up in the tiles must stay finite.
  std::fill(memory.begin(), memory.end(), std::byte(0));
  const double scatter_time = nanoseconds([&] {
    for_each_chunk(
        [&](const ParticleColumns<Real, dim>& columns) { scatter(columns, kChunk, 1, 0, settings, tiles.data()); });
  });
  std::printf("%dD %-7s %-24s %8.2f %8.2f\n", dim, sizeof(Real) == 4 ? "single" : "double", what, gather_time,
              scatter_time);
}

template <class Real, int dim>
void time_all() {
  constexpr TransferSettings kApic = {Kernel::quadratic, Form::mls, 1, 0};
  time_transfers<Real, dim>("quadratic APIC", kApic);
  time_transfers<Real, dim>("quadratic FLIP", {Kernel::quadratic, Form::mls, 0, 1});
  time_transfers<Real, dim>("quadratic APIC gradient", {Kernel::quadratic, Form::gradient, 1, 0});
  time_transfers<Real, dim>("linear APIC gradient", {Kernel::linear, Form::gradient, 1, 0});
  time_transfers<Real, dim>("cubic APIC", {Kernel::cubic, Form::mls, 1, 0});
}

}  // namespace
}  // namespace firn

int main() {
  std::printf("SIMD target %s; ns per particle, data in cache\n", firn::simd_target().c_str());
  std::printf("%-35s %8s %8s\n", "", "gather", "scatter");
  firn::time_all<float, 3>();
  firn::time_all<double, 3>();
  firn::time_all<float, 2>();
}
