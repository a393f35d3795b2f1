#include <firn/core/simd.h>
#include <firn/state/aligned.h>
#include <firn/state/particles.h>
#include <firn/transfer/scatter.h>
#include <firn/transfer/tile.h>
#include <gtest/gtest.h>
#include <sys/mman.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

namespace firn {
namespace {

/// Two volumes, and behind them memory that may not be read, as far as a number of an origin reaches.
template <class Real>
class GuardedVolumes {
 public:
  GuardedVolumes() {
    memory_ = ::mmap(nullptr, kPage + kGuard, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    EXPECT_NE(memory_, MAP_FAILED);
    EXPECT_EQ(::mprotect(memory_, kPage, PROT_READ | PROT_WRITE), 0);
    auto* end = reinterpret_cast<Real*>(static_cast<std::byte*>(memory_) + kPage);
    volumes_ = {end - 2, 2};
    volumes_[0] = Real(0.5);
    volumes_[1] = Real(0.25);
  }
  ~GuardedVolumes() { ::munmap(memory_, kPage + kGuard); }
  GuardedVolumes(const GuardedVolumes&) = delete;
  GuardedVolumes& operator=(const GuardedVolumes&) = delete;

  std::span<const Real> volumes() const { return volumes_; }

 private:
  static constexpr std::size_t kPage = 4096, kGuard = (std::size_t(1) << 16) * sizeof(Real);
  void* memory_;
  std::span<Real> volumes_;
};

template <class Real>
void expect_tail_unread() {
  const GuardedVolumes<Real> guarded;
  Particles<Real, 3> particles({.density = 8});
  particles.append(std::vector<Vec3d>(kChunk, Vec3d{{1.5, 1.5, 1.5}}), 1, Kernel::quadratic, {}, 1, 0, 0);
  particles.sort_by_block();
  ParticleColumns<Real, 3> columns = particles.columns(0, 0);
  columns.volume_of_origin = guarded.volumes();
  const TransferSettings settings = {Kernel::quadratic, Form::mls, 1, 0};
  constexpr auto kNumbers = static_cast<std::size_t>(tile_nodes<3>(Kernel::quadratic) * kNodeWidth);
  for (std::uint32_t count = 1; count <= kChunk; ++count) {
    for (std::uint32_t i = 0; i < kChunk; ++i) {
      columns.origin[i] = i < count ? i % 2 : std::numeric_limits<std::uint16_t>::max();
    }
    AlignedVector<Real> tile(kNumbers, Real(0));
    scatter_function<Real, 3>(settings)(columns, count, 1, 0.01, settings, tile.data());
    double mass = 0;
    for (std::size_t n = kNodeWidth - 1; n < tile.size(); n += kNodeWidth) mass += static_cast<double>(tile[n]);
    EXPECT_NEAR(mass, 8 * (0.5 * ((count + 1) / 2) + 0.25 * (count / 2)), 1e-4) << count;
  }
}

TEST(BatchTail, LooksUpNoVolumesBehindTheLastParticle) {
  for (const std::string& target : available_simd_targets()) {
    SCOPED_TRACE(target);
    select_simd_target(target);
    expect_tail_unread<float>();
    expect_tail_unread<double>();
  }
  select_simd_target(available_simd_targets().back());
}

}  // namespace
}  // namespace firn
