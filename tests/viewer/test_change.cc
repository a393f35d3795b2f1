#include <firn/apps/viewer/hand.h>
#include <firn/core/error.h>
#include <firn/scene/load_scene.h>
#include <firn/scene/resolved.h>
#include <firn/simulation/live_changes.h>
#include <firn/simulation/simulation.h>
#include <gtest/gtest.h>

#include <cmath>

namespace firn {
namespace {

Scene block(const std::string& root = "", const std::string& more = "") {
  return parse_scene("dimension = 2\nend_time = 1\nframe_rate = 50\nresolution.cell_size = 0.05\n" + root +
                         "[material.stuff]\npreset = \"jelly\"\n"
                         "[[body]]\nshape = \"box\"\nsize = [0.4, 0.4]\nposition = [0, 0.3]\nmaterial = \"stuff\"\n"
                         "[[collider]]\nname = \"ground\"\nshape = \"half_space\"\ncontact = \"separate\"\n" +
                         more,
                     "block.toml");
}

void advance(Simulation& simulation, int frames) {
  for (int i = 0; i < frames; ++i) simulation.advance_frame();
}

TEST(LiveChanges, AreNumbersThatNoParticleRemembers) {
  const Scene running = block();
  Scene wanted = running;
  wanted.gravity[1] = -1;
  wanted.materials[0].parameters["youngs_modulus"] = 12345;
  wanted.colliders[0].friction = 0.7;
  wanted.limits.max_dt = 1e-4;
  EXPECT_TRUE(is_all_live(running, wanted));
  EXPECT_EQ(live_differences(running, live_part(running, wanted)),
            (std::vector<std::string>{"gravity = [0, -1]", "limits.max_dt = 0.0001",
                                      "material.stuff.youngs_modulus = 12345", "collider.ground.friction = 0.7"}));
  wanted.materials[0].density = 3000;
  EXPECT_FALSE(is_all_live(running, wanted)) << "particles have their mass";
  EXPECT_EQ(live_part(running, wanted).materials[0].density, running.materials[0].density);
  wanted = running;
  wanted.bodies[0].position[1] = 2;
  EXPECT_FALSE(is_all_live(running, wanted));
  wanted = running;
  wanted.materials[0].model = "snow";
  EXPECT_FALSE(is_all_live(running, wanted));
}

TEST(Change, TakesEffectInTheNextFrame) {
  const Scene scene = block();
  const auto changed = Simulation::create(scene), other = Simulation::create(scene);
  advance(*changed, 2);
  advance(*other, 2);
  Scene heavier = scene;
  heavier.gravity[1] = -30;
  changed->change(heavier);
  const double before = changed->totals().momentum[1];
  changed->advance_frame();
  const double mass = changed->totals().mass;
  EXPECT_NEAR(changed->totals().momentum[1] - before, -30 * mass / 50, 1e-3 * mass) << "in free fall";
  other->advance_frame();
  EXPECT_GT(other->totals().momentum[1], changed->totals().momentum[1]);
}

TEST(Change, ThatSaysTheSameChangesNoBit) {
  const Scene scene = block();
  const auto changed = Simulation::create(scene), other = Simulation::create(scene);
  advance(*changed, 5);
  changed->change(scene);
  advance(*changed, 5);
  advance(*other, 10);
  EXPECT_EQ(changed->hash(), other->hash());
}

TEST(Change, StiffensTheMaterial) {
  const Scene scene = block();
  const auto simulation = Simulation::create(scene);
  advance(*simulation, 8);
  const auto steps = simulation->report().steps;
  Scene stiff = scene;
  stiff.materials[0].parameters["youngs_modulus"] *= 100;
  simulation->change(stiff);
  simulation->advance_frame();
  EXPECT_GT(simulation->report().steps, 5 * steps) << "the wave speed is known before the first step";
}

TEST(Change, RefusesWhatParticlesRememberAndGoesOn) {
  const Scene scene = block();
  const auto simulation = Simulation::create(scene), other = Simulation::create(scene);
  advance(*simulation, 2);
  Scene wanted = scene;
  wanted.materials[0].density = 3000;
  EXPECT_THROW(simulation->change(wanted), Error);
  EXPECT_EQ(resolved_toml(simulation->scene()), resolved_toml(scene));
  simulation->advance_frame();
  advance(*other, 3);
  EXPECT_EQ(simulation->hash(), other->hash());
}

/// What the mouse does is said in the words of a scene, and happens again to the same bits.
TEST(Change, AScenesOwnSourcesAndFieldsGiveTheBitsOfThoseThatCameByHand) {
  for (const int dimension : {2, 3}) {
    Scene scene = block();
    if (dimension == 3) {
      scene = parse_scene(
          "end_time = 1\nframe_rate = 50\nresolution.cell_size = 0.1\n[material.stuff]\npreset = \"snow\"\n"
          "[[body]]\nshape = \"box\"\nsize = [0.4, 0.4, 0.4]\nposition = [0, 0.3, 0]\nmaterial = \"stuff\"\n"
          "[[collider]]\nname = \"ground\"\nshape = \"half_space\"\n",
          "block.toml");
    }
    const auto by_hand = Simulation::create(scene);
    advance(*by_hand, 3);
    Scene wanted = scene;
    add_drop(wanted, {"water", {{0, 0.9, 0}}, 0.15}, by_hand->time());
    by_hand->change(wanted);
    const auto before = by_hand->particle_count();
    Vec3d at = {{0.2, 0.3, 0}};
    for (int frame = 0; frame < 4; ++frame) {
      const double t = by_hand->time(), end = by_hand->frame_time(by_hand->frame() + 1);
      wanted.fields.push_back(pull(at, {{0.6, 0.5, 0}}, 0.1, t, end - t, wanted));
      wanted.fields.back().stop = end;
      by_hand->change(wanted);
      by_hand->advance_frame();
    }
    advance(*by_hand, 3);
    EXPECT_EQ(by_hand->particle_count(), before);
    const Scene saved = parse_scene(resolved_toml(by_hand->scene()), "saved.toml");
    EXPECT_EQ(resolved_toml(saved), resolved_toml(by_hand->scene()));
    const auto again = Simulation::create(saved);
    advance(*again, 10);
    EXPECT_EQ(again->particle_count(), by_hand->particle_count()) << dimension;
    EXPECT_EQ(again->hash(), by_hand->hash()) << dimension;
    const auto untouched = Simulation::create(scene);
    advance(*untouched, 10);
    EXPECT_LT(untouched->particle_count(), by_hand->particle_count()) << "negative control";
  }
}

TEST(Change, APullMovesWhatItHolds) {
  const Scene scene = block("gravity = [0, 0]\n");
  const auto simulation = Simulation::create(scene);
  Scene wanted = scene;
  Vec3d at = {{0, 0.3, 0}};
  const Vec3d goal = {{0.5, 0.3, 0}};
  const auto centre = [&] {
    const Snapshot snapshot = simulation->snapshot();
    Vec3d sum = {};
    for (std::size_t p = 0; p < snapshot.size(); ++p) sum += snapshot.position(p);
    return (1 / static_cast<double>(snapshot.size())) * sum;
  };
  const Vec3d start = centre();
  for (int frame = 0; frame < 12; ++frame) {
    const double t = simulation->time(), end = simulation->frame_time(simulation->frame() + 1);
    wanted.fields.push_back(pull(at, goal, 0.2, t, end - t, wanted));
    wanted.fields.back().stop = end;
    simulation->change(wanted);
    simulation->advance_frame();
  }
  EXPECT_NEAR(norm(at - goal), 0, 1e-12);
  EXPECT_NEAR(centre()[0] - start[0], 0.5, 0.1);
  EXPECT_NEAR(centre()[1] - start[1], 0, 0.05);
}

TEST(Change, APlacedColliderStopsWhatFalls) {
  Scene scene = block();
  scene.colliders.clear();
  const auto simulation = Simulation::create(scene);
  advance(*simulation, 2);
  Scene wanted = scene;
  wanted.colliders.push_back(placed_collider(wanted, ShapeSettings::Shape::box, {{0, -0.5, 0}}, 0.5));
  simulation->change(wanted);
  advance(*simulation, 25);
  const Snapshot snapshot = simulation->snapshot();
  for (std::size_t p = 0; p < snapshot.size(); ++p) ASSERT_GT(snapshot.position(p)[1], -0.1);
  EXPECT_EQ(simulation->report().colliders.size(), 1U);
  EXPECT_LT(simulation->report().colliders[0].force[1], 0) << "it bears the block";
  const auto free = Simulation::create(scene);
  advance(*free, 27);
  EXPECT_LT(free->snapshot().position(0)[1], -0.5) << "negative control";
}

TEST(Grid, HoldsTheParticlesMassAndMomentum) {
  for (const char* kernel : {"linear", "quadratic", "cubic"}) {
    const Scene scene = block(std::string("method.kernel = \"") + kernel + "\"\nmethod.form = \"gradient\"\n");
    const auto simulation = Simulation::create(scene);
    advance(*simulation, 4);
    const GridValues grid = simulation->grid();
    ASSERT_EQ(grid.nodes.size(), grid.velocities.size());
    ASSERT_EQ(grid.nodes.size(), grid.mass.size());
    EXPECT_GT(grid.blocks.size(), 1U);
    double mass = 0;
    Vec3d momentum = {}, moment = {};
    for (std::size_t i = 0; i < grid.nodes.size(); ++i) {
      mass += grid.mass[i];
      momentum += grid.mass[i] * grid.velocities[i];
      moment += grid.mass[i] * grid.nodes[i];
    }
    const Totals totals = simulation->totals();
    EXPECT_NEAR(mass, totals.mass, 1e-5 * totals.mass) << kernel;
    EXPECT_NEAR(norm(momentum - totals.momentum), 0, 1e-4 * norm(totals.momentum)) << kernel;
    // Splines reproduce linear functions: the mass on the nodes has the particles' centre.
    const Snapshot snapshot = simulation->snapshot();
    Vec3d centre = {};
    for (std::size_t p = 0; p < snapshot.size(); ++p) centre += snapshot.position(p);
    EXPECT_NEAR(norm((1 / mass) * moment - (1.0 / static_cast<double>(snapshot.size())) * centre), 0, 1e-5) << kernel;
  }
}

}  // namespace
}  // namespace firn
