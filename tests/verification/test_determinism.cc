// The same bits for any number of threads and in every run.

#include <firn/geometry/shapes.h>
#include <firn/integrators/time_step.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <bit>
#include <memory>

#include "support/particle_fields.h"
#include "support/worlds.h"

namespace firn::test {
namespace {

/// Snow and jelly that fall together on a ball that moves and a floor.
template <class Real>
World<Real, 3> snow_and_jelly(const TransferSettings& settings) {
  constexpr double kDx = 0.05;
  World<Real, 3> world(kDx, settings, {});
  world.gravity[2] = -9.81;
  world.colliders.push_back(
      {.name = "floor", .shape = std::make_shared<HalfSpace<3>>(Vec3d{{0, 0, 1}}), .motion = {}, .friction = 0.4});
  world.colliders.push_back({.name = "ball",
                             .shape = std::make_shared<Sphere<3>>(0.2),
                             .motion = {.origin = {{0.3, 0.2, 0}}, .velocity = {{0.5, 0, 0}}},
                             .contact = Contact::sticky});
  world.add_material("snow", model_number("snow"), {{1.4e5, 0.2, 2.5e-2, 7.5e-3, 10, 8}, 400});
  world.add_material("jelly", model_number("neo_hookean"), elastic(1e4, 0.3, 1000));
  Random random(23);
  for (std::size_t m = 0; m < 2; ++m) {
    const Vec3d low = {{0, 0.05, m == 0 ? 0.02 : 0.45}};
    add_particles(world, m, random_points<3>(random, 8000, low, low + Vec3d{{0.6, 0.5, 0.4}}), 1.5e-5);
  }
  for_each_particle(world, [&](auto& particles, std::size_t p, const Vec3d&) {
    set_vector(particles, Field::velocity, p,
               Vec3d{{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-4, -2)}});
  });
  prepare(world);
  return world;
}

template <class Real>
std::vector<std::uint64_t> hashes_after(const TransferSettings& settings, int threads, int steps = 60) {
  std::vector<std::uint64_t> hashes;
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  arena.execute([&] {
    auto world = snow_and_jelly<Real>(settings);
    for (int s = 0; s < steps; ++s) {
      EXPECT_FALSE(step_explicit(world, choose_time_step(world, {}).dt).failure);
    }
    for (const auto& material : world.materials) hashes.push_back(material.particles.hash());
    hashes.push_back(std::bit_cast<std::uint64_t>(world.t));
    hashes.push_back(std::bit_cast<std::uint64_t>(totals(world).kinetic_energy));
  });
  return hashes;
}

template <class Real>
void expect_same_bits(const TransferSettings& settings, int steps = 60) {
  const std::vector<std::uint64_t> one = hashes_after<Real>(settings, 1, steps);
  for (const int threads : {1, 2, 3, 8}) {
    for (int repeat = 0; repeat < 2; ++repeat) {
      EXPECT_EQ(one, hashes_after<Real>(settings, threads, steps)) << threads << " threads";
    }
  }
}

TEST(Determinism, SameBitsForAnyNumberOfThreads) { expect_same_bits<float>({}); }
TEST(Determinism, SameBitsForAnyNumberOfThreadsFlip) { expect_same_bits<float>({.affine = 0, .flip = 0.95}, 20); }
TEST(Determinism, SameBitsForAnyNumberOfThreadsDouble) { expect_same_bits<double>({.form = Form::gradient}, 20); }

float with_last_bit_changed(float number) { return std::bit_cast<float>(std::bit_cast<std::uint32_t>(number) ^ 1u); }

/// Control: the hash sees the last bit of any column of any particle.
TEST(Determinism, ControlHashSeesEveryBit) {
  auto world = snow_and_jelly<float>({});
  auto& particles = world.materials[0].particles;
  const std::uint64_t before = particles.hash();
  for (const Field field : {Field::offset, Field::velocity, Field::affine, Field::strain, Field::stress}) {
    float& number = particles.real(field)[particles.size() - 1];
    const float kept = number;
    number = with_last_bit_changed(number);
    EXPECT_NE(particles.hash(), before);
    number = kept;
  }
  particles.id()[0] ^= 1u;
  EXPECT_NE(particles.hash(), before);
  particles.id()[0] ^= 1u;
  EXPECT_EQ(particles.hash(), before);
  const std::uint16_t body = particles.body(7);
  const float volume = particles.rest_volume(7);
  particles.set_origin(7, body, with_last_bit_changed(volume));
  EXPECT_NE(particles.hash(), before);
  particles.set_origin(7, static_cast<std::uint16_t>(body + 1), volume);
  EXPECT_NE(particles.hash(), before);
  particles.set_origin(7, body, volume);
  EXPECT_EQ(particles.hash(), before);
}

/// Control: the hash of a run sees one bit of one particle's volume, 60 steps later.
TEST(Determinism, ControlOneBitChangesTheRun) {
  auto world = snow_and_jelly<float>({});
  auto& particles = world.materials[0].particles;
  particles.set_origin(100, particles.body(100), with_last_bit_changed(particles.rest_volume(100)));
  for (int s = 0; s < 20; ++s) step_explicit(world, choose_time_step(world, {}).dt);
  auto untouched = snow_and_jelly<float>({});
  for (int s = 0; s < 20; ++s) step_explicit(untouched, choose_time_step(untouched, {}).dt);
  const auto &a = world.materials[1].particles, &b = untouched.materials[1].particles;
  EXPECT_NE(a.hash(), b.hash()) << "the jelly has felt it";
}

}  // namespace
}  // namespace firn::test
