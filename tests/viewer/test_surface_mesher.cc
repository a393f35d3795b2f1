// The surface mode without a window: what is meshed, and what is shown meanwhile.

#include <firn/apps/viewer/simulation_player.h>
#include <firn/apps/viewer/surface_mesher.h>
#include <firn/apps/viewer/surface_view.h>
#include <firn/core/error.h>
#include <firn/render/look.h>
#include <gtest/gtest.h>

#include <cmath>
#include <mutex>
#include <set>
#include <utility>

#include "viewer/fake_simulation.h"
#include "viewer/still_source.h"

namespace firn {
namespace {

using namespace std::chrono_literals;

constexpr double kSpacing = 0.1, kRadius = 0.45;
const Vec3d kCenter = {{3, 1, -2}};

/// A ball of particles on a lattice; its columns are the place along x, and the velocity, twice that.
std::shared_ptr<const Snapshot> ball() {
  auto snapshot = std::make_shared<Snapshot>();
  std::vector<double> x;
  std::vector<float> along, velocity;
  for (int i = -5; i <= 5; ++i) {
    for (int j = -5; j <= 5; ++j) {
      for (int k = -5; k <= 5; ++k) {
        const Vec3d at = {{i * kSpacing, j * kSpacing, k * kSpacing}};
        if (norm(at) > kRadius) continue;
        for (int c = 0; c < 3; ++c) x.push_back(kCenter[c] + at[c]);
        along.push_back(static_cast<float>(at[0]));
        velocity.insert(velocity.end(), {static_cast<float>(2 * at[0]), 0, 0});
      }
    }
  }
  snapshot->particle_spacing = kSpacing;
  snapshot->materials = {{"stuff", "snow", "snow", 0, along.size()}};
  snapshot->columns.push_back({"position", "m", "", 3, std::move(x)});
  snapshot->columns.push_back({"velocity", "m/s", "", 3, std::move(velocity)});
  snapshot->columns.push_back({"along", "m", "", 1, std::move(along)});
  return snapshot;
}

SurfaceOrder order_of(std::shared_ptr<const Snapshot> snapshot, std::string color_by = "", int threads = 1) {
  SurfaceOrder order;
  order.snapshot = std::move(snapshot);
  order.color_by = std::move(color_by);
  order.threads = threads;
  return order;
}

Vec3d place(const MeshedSurface& surface, std::size_t v) {
  const Vec3f& x = surface.vertices[v].position;
  return surface.origin + Vec3d{{x[0], x[1], x[2]}};
}

TEST(MeshedSurface, IsTheBallWithNormalsOutwards) {
  const MeshedSurface surface = mesh_surface(order_of(ball()), nullptr);
  ASSERT_GT(surface.triangles.size(), 500U);
  for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
    const Vec3d from = place(surface, v) - kCenter;
    EXPECT_NEAR(norm(from), kRadius + 0.3 * kSpacing, 0.8 * kSpacing);
    const Vec3f& n = surface.vertices[v].normal;
    EXPECT_NEAR(norm(n), 1, 1e-5);
    EXPECT_GT(dot(Vec3d{{n[0], n[1], n[2]}}, (1 / norm(from)) * from), 0.7);
  }
  // Counter-clockwise seen from outside, and closed: the volume by Gauss's theorem.
  double volume = 0;
  std::set<std::pair<std::int32_t, std::int32_t>> edges;
  for (const auto& t : surface.triangles) {
    const Vec3d a = place(surface, static_cast<std::size_t>(t[0])) - kCenter,
                b = place(surface, static_cast<std::size_t>(t[1])) - kCenter,
                c = place(surface, static_cast<std::size_t>(t[2])) - kCenter;
    volume += dot(a, cross(b, c)) / 6;
    for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(edges.insert({t[i], t[(i + 1) % 3]}).second);
  }
  for (const auto& [a, b] : edges) EXPECT_TRUE(edges.contains({b, a}));
  const double particles = static_cast<double>(surface.order.snapshot->size()) * std::pow(kSpacing, 3);
  EXPECT_NEAR(volume, particles, 0.15 * particles);
}

TEST(MeshedSurface, CarriesTheColoursOfMaterialsOrAColumn) {
  const auto snapshot = ball();
  SurfaceOrder order = order_of(snapshot);
  const MeshedSurface by_look = mesh_surface(order, nullptr);
  const Look& snow = find_look(snapshot->materials[0]);
  for (const SurfaceVertex& vertex : by_look.vertices) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(vertex.carried[c], snow.color[c], (snow.jitter + 1e-5F) * snow.color[c]);
    }
  }
  order.material_colors["stuff"] = {{0.1F, 0.2F, 0.3F}};
  const MeshedSurface chosen = mesh_surface(order, nullptr);
  EXPECT_NEAR(chosen.vertices[0].carried[2] / chosen.vertices[0].carried[0], 3, 1e-4);
  const MeshedSurface by_place = mesh_surface(order_of(snapshot, "along"), nullptr);
  const MeshedSurface by_speed = mesh_surface(order_of(snapshot, "velocity"), nullptr);
  for (std::size_t v = 0; v < by_place.vertices.size(); ++v) {
    const double along = place(by_place, v)[0] - kCenter[0];
    EXPECT_NEAR(by_place.vertices[v].carried[0], along, 0.8 * kSpacing);
    EXPECT_NEAR(by_speed.vertices[v].carried[0], 2 * std::abs(along), 2.2 * kSpacing);
  }
  EXPECT_NEAR(by_place.range[0], -0.4, 1e-6);
  EXPECT_NEAR(by_place.range[1], 0.4, 1e-6);
}

TEST(MeshedSurface, OtherColoursOnTheSameFormAreAsIfAllWasMadeAnew) {
  const auto snapshot = ball();
  const MeshedSurface first = mesh_surface(order_of(snapshot), nullptr);
  const MeshedSurface again = mesh_surface(order_of(snapshot, "along"), &first);
  const MeshedSurface anew = mesh_surface(order_of(snapshot, "along"), nullptr);
  ASSERT_EQ(again.triangles, anew.triangles);
  EXPECT_EQ(again.range, anew.range);
  EXPECT_EQ(again.order.color_by, "along");
  for (std::size_t v = 0; v < anew.vertices.size(); ++v) {
    EXPECT_EQ(norm(again.vertices[v].position - anew.vertices[v].position), 0);
    EXPECT_NEAR(again.vertices[v].carried[0], anew.vertices[v].carried[0], 1e-5);
  }
  SurfaceOrder finer = order_of(snapshot, "along");
  finer.options.voxel = 0.3;
  EXPECT_GT(mesh_surface(finer, &again).triangles.size(), 2 * anew.triangles.size()) << "another form is made anew";
}

TEST(MeshedSurface, IsTheSameOnAnyNumberOfThreads) {
  const auto snapshot = ball();
  const MeshedSurface one = mesh_surface(order_of(snapshot, "along", 1), nullptr);
  const MeshedSurface two = mesh_surface(order_of(snapshot, "along", 2), nullptr);
  ASSERT_EQ(one.vertices.size(), two.vertices.size());
  for (std::size_t v = 0; v < one.vertices.size(); ++v) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(one.vertices[v].position[c], two.vertices[v].position[c]);
      EXPECT_EQ(one.vertices[v].normal[c], two.vertices[v].normal[c]);
      EXPECT_EQ(one.vertices[v].carried[c], two.vertices[v].carried[c]);
    }
  }
}

TEST(MeshedSurface, RefusesWhatHasNoneByWords) {
  const auto refused = [](const SurfaceOrder& order) -> std::string {
    try {
      mesh_surface(order, nullptr);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  auto flat = std::make_shared<Snapshot>(*ball());
  flat->dimension = 2;
  EXPECT_EQ(refused(order_of(flat)), "particles of a 2D scene have no surface");
  EXPECT_EQ(refused(order_of(ball(), "colour")), "color_by: there is no column \"colour\"");
  SurfaceOrder thin = order_of(ball());
  thin.options.radius = 0.1;
  EXPECT_EQ(refused(thin), "voxel must be at most 1.5 times the radius, got 0.5");
  EXPECT_TRUE(mesh_surface(order_of(std::make_shared<Snapshot>([] {
                             Snapshot empty = *ball();
                             empty.materials[0].end = 0;
                             for (auto& column : empty.columns) column.values = std::vector<float>();
                             return empty;
                           }())),
                           nullptr)
                  .triangles.empty());
}

/// A mesher whose surfaces are made when the test allows it, and which notes the frames.
class Meshing : public testing::Test {
 protected:
  SurfaceOrder frame(std::int64_t number) {
    SurfaceOrder order = order_of(std::make_shared<Snapshot>());
    order.frame = number;
    return order;
  }
  std::vector<std::int64_t> made() {
    const std::lock_guard lock(mutex_);
    return made_;
  }

  test::Gate gate_{false};
  std::mutex mutex_;
  std::vector<std::int64_t> made_;
  SurfaceMesher mesher_{[this](const SurfaceOrder& order, const MeshedSurface*) {
    gate_.pass();
    const std::lock_guard lock(mutex_);
    made_.push_back(order.frame);
    if (order.frame == 13) throw Error(ErrorKind::usage, "thirteen");
    MeshedSurface surface;
    surface.order = order;
    return surface;
  }};
};

TEST_F(Meshing, WhatWasWantedLastIsNext) {
  EXPECT_EQ(mesher_.latest(), nullptr);
  mesher_.want(frame(1));
  gate_.wait_until_someone_waits();
  // Nobody has waited for the surface until here, nor does anyone now.
  for (const std::int64_t number : {2, 3, 4}) mesher_.want(frame(number));
  EXPECT_TRUE(mesher_.status().busy);
  EXPECT_EQ(mesher_.latest(), nullptr);
  gate_.let_one();
  while (mesher_.status().version == 0) std::this_thread::sleep_for(1ms);
  EXPECT_EQ(mesher_.latest()->order.frame, 1) << "the last one that is ready, while the next is made";
  EXPECT_TRUE(mesher_.status().busy);
  gate_.open();
  ASSERT_TRUE(mesher_.wait(10s));
  EXPECT_EQ(mesher_.latest()->order.frame, 4);
  EXPECT_EQ(made(), (std::vector<std::int64_t>{1, 4}));
}

TEST_F(Meshing, TheSameIsMadeOnce) {
  gate_.open();
  const SurfaceOrder order = frame(1);
  mesher_.want(order);
  ASSERT_TRUE(mesher_.wait(10s));
  const auto version = mesher_.status().version;
  mesher_.want(order);
  EXPECT_FALSE(mesher_.status().busy);
  EXPECT_EQ(mesher_.status().version, version);
  SurfaceOrder other = order;
  other.options.smoothing = 3;
  mesher_.want(other);
  ASSERT_TRUE(mesher_.wait(10s));
  other.color_by = "speed";
  mesher_.want(other);
  ASSERT_TRUE(mesher_.wait(10s));
  EXPECT_EQ(made().size(), 3U);
}

TEST_F(Meshing, AFailureIsTextAndTheLastOneStays) {
  gate_.open();
  mesher_.want(frame(1));
  ASSERT_TRUE(mesher_.wait(10s));
  mesher_.want(frame(13));
  ASSERT_TRUE(mesher_.wait(10s));
  EXPECT_EQ(mesher_.status().message, "no surface: thirteen");
  EXPECT_EQ(mesher_.latest()->order.frame, 1);
  mesher_.want(frame(2));
  ASSERT_TRUE(mesher_.wait(10s));
  EXPECT_EQ(mesher_.status().message, "");
  EXPECT_EQ(mesher_.latest()->order.frame, 2);
}

TEST_F(Meshing, ClearForgetsWhatIsBeingMade) {
  mesher_.want(frame(1));
  gate_.wait_until_someone_waits();
  mesher_.clear();
  EXPECT_FALSE(mesher_.status().busy);
  mesher_.want(frame(2));
  gate_.open();
  ASSERT_TRUE(mesher_.wait(10s));
  EXPECT_EQ(mesher_.latest()->order.frame, 2);
  EXPECT_EQ(made(), (std::vector<std::int64_t>{1, 2}));
  mesher_.clear();
  EXPECT_EQ(mesher_.latest(), nullptr);
}

TEST_F(Meshing, EndsWhileSomethingIsWanted) {
  mesher_.want(frame(1));
  gate_.wait_until_someone_waits();
  mesher_.want(frame(2));
  gate_.open();
}

/// A source that has one frame.
class OneFrame final : public test::StillSource {
 public:
  explicit OneFrame(const Snapshot& snapshot) {
    snapshot_ = std::make_shared<const Snapshot>(snapshot);
    status_.published = 1;
    status_.frame.frame = 7;
    status_.state = PlayState::paused;
  }
};

TEST(SurfaceView, IsMadeWhenItIsToBeSeen) {
  OneFrame source(*ball());
  ViewControls controls(Scene(), source);
  controls.update();
  SurfaceView view;
  EXPECT_EQ(view.update(controls), nullptr);
  EXPECT_TRUE(view.settled());
  EXPECT_TRUE(controls.key('u'));
  view.update(controls);
  EXPECT_TRUE(view.notes().wanted);
  std::shared_ptr<const MeshedSurface> surface;
  for (int i = 0; i < 2000 && (surface == nullptr || !view.settled()); ++i) {
    std::this_thread::sleep_for(5ms);
    surface = view.update(controls);
  }
  ASSERT_NE(surface, nullptr);
  EXPECT_EQ(view.notes().frame, 7);
  EXPECT_EQ(view.notes().triangles, surface->triangles.size());
  EXPECT_EQ(surface->order.snapshot.get(), controls.snapshot());
  controls.key('u');
  EXPECT_EQ(view.update(controls), nullptr);
  EXPECT_FALSE(view.notes().wanted);
}

TEST(SurfaceView, ThereIsNoneOf2DNorOfTheGridAlone) {
  OneFrame source(*ball());
  Scene flat;
  flat.dimension = 2;
  ViewControls in_2d(flat, source);
  in_2d.update();
  in_2d.key('u');
  EXPECT_FALSE(in_2d.as_surface());
  EXPECT_FALSE(in_2d.wanted_surface().has_value());
  ViewControls controls(Scene(), source);
  controls.update();
  controls.key('u');
  EXPECT_TRUE(controls.wanted_surface().has_value());
  controls.key('g');
  EXPECT_TRUE(controls.wanted_surface().has_value()) << "with the grid";
  controls.key('g');
  EXPECT_FALSE(controls.wanted_surface().has_value()) << "the grid alone";
  controls.key('u');
  controls.key('u');
  EXPECT_EQ(controls.shown(), ViewControls::Shown::material) << "who asks for a surface sees it";
}

TEST(PacedPlayer, BeginsAFrameWhenTheOneBeforeWasTaken) {
  test::Gate gate(false);
  SimulationPlayer player([&] { return std::make_unique<test::FakeSimulation>(gate, -1); });
  ASSERT_TRUE(player.wait([](const SourceStatus& s) { return s.state == PlayState::paused; }, 10s));
  player.pace(true);
  player.play();
  EXPECT_FALSE(player.wait([](const SourceStatus& s) { return s.busy; }, 40ms)) << "frame 1 was not taken";
  player.taken(player.status().published);
  gate.wait_until_someone_waits();
  gate.let_one();
  ASSERT_TRUE(player.wait([](const SourceStatus& s) { return s.frame.frame == 2; }, 10s));
  EXPECT_FALSE(player.wait([](const SourceStatus& s) { return s.busy; }, 40ms));
  player.pace(false);
  gate.open();
  EXPECT_TRUE(player.wait([](const SourceStatus& s) { return s.state == PlayState::finished; }, 10s));
}

}  // namespace
}  // namespace firn
