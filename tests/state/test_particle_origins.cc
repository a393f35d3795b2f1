#include <firn/core/error.h>
#include <firn/state/particles.h>
#include <gtest/gtest.h>

#include <vector>

namespace firn {
namespace {

TEST(ParticleOrigins, NumbersEachPairOnce) {
  ParticleOrigins<float> origins;
  EXPECT_EQ(origins.number_of(3, 0.5f), 0);
  EXPECT_EQ(origins.number_of(3, 0.25f), 1);
  EXPECT_EQ(origins.number_of(4, 0.5f), 2);
  EXPECT_EQ(origins.number_of(3, 0.25f), 1);
  EXPECT_EQ(origins.body(2), 4);
  EXPECT_EQ(origins.rest_volume(1), 0.25f);
  EXPECT_EQ(origins.rest_volumes().size(), 3u);
}

TEST(ParticleOrigins, HaveRoomFor65536) {
  ParticleOrigins<double> origins;
  for (int i = 0; i < 65536; ++i) ASSERT_EQ(origins.number_of(0, i), i);
  EXPECT_THROW(origins.number_of(1, 0), Error);
  EXPECT_EQ(origins.number_of(0, 65535), 65535) << "those that are known may still be asked for";
}

TEST(ParticleOrigins, StayWithTheirParticles) {
  Particles<float, 2> particles({.density = 2});
  const std::vector<Vec<double, 2>> some = {{{0.5, 0.5}}, {{40.5, 0.5}}}, more = {{{20.5, 0.5}}};
  particles.append(some, 1, Kernel::quadratic, {}, 0.5, 0, 7);
  particles.append(more, 1, Kernel::quadratic, {}, 0.25, 2, 65535);
  particles.sort_by_block();
  particles.set_cell(0, cell_key<2>({{90, 0}}));
  particles.sort_by_block();
  ASSERT_EQ(particles.size(), 3u);
  for (std::size_t p = 0; p < 3; ++p) {
    const bool is_late = particles.id()[p] == 2;
    EXPECT_EQ(particles.body(p), is_late ? 65535 : 7);
    EXPECT_EQ(particles.rest_volume(p), is_late ? 0.25f : 0.5f);
    EXPECT_EQ(particles.mass(p), is_late ? 0.5 : 1);
  }
  const Particles<float, 2> copy = particles;
  EXPECT_EQ(copy.body(0), particles.body(0));
  EXPECT_EQ(copy.hash(), particles.hash());
  EXPECT_THROW(particles.append(more, 1, Kernel::quadratic, {}, 0.25, 3, 65536), Error);
}

}  // namespace
}  // namespace firn
