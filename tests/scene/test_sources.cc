#include "scene/scene_text.h"

#include <firn/scene/carried.h>
#include <firn/scene/explain.h>
#include <firn/scene/force_fields.h>
#include <firn/scene/pin_collider.h>
#include <firn/scene/probe_points.h>
#include <firn/scene/resolved.h>

#include <cmath>
#include <tuple>
#include <vector>

namespace firn::test {
namespace {

/// A 3D scene; the first added line is line 5.
std::string with(const std::string& more) {
  return "end_time = 1\nresolution.cell_size = 0.1\n[material.snow]\npreset = \"snow\"\n" + more;
}

const std::string kTap = "[[emitter]]\nname = \"tap\"\nshape = \"box\"\nsize = [1, 1, 1]\nmaterial = \"snow\"\n";
const std::string kBall = "[[body]]\nname = \"ball\"\nshape = \"sphere\"\nradius = 1\nmaterial = \"snow\"\n";

TEST(SourcesScene, AnEmitterIsEnough) {
  const Scene scene = parse(with(kTap + "velocity = [0, -1, 0]\nmass_rate = 3\nstop = 2\n"));
  ASSERT_EQ(scene.emitters.size(), 1u);
  EXPECT_EQ(scene.emitters[0].mass_rate, 3);
  EXPECT_FALSE(scene.emitters[0].volume_rate || scene.emitters[0].keep_full);
  EXPECT_EQ(scene.emitters[0].stop, 2);
  EXPECT_TRUE(contains(error_of(with("")), "a [[body]] or [[emitter]]"));
}

TEST(SourcesScene, EmitterErrorsAreLocated) {
  const std::string moving = kTap + "velocity = [0, -1, 0]\n";
  EXPECT_TRUE(matches(
      error_of(with(moving)),
      R"re(scene\.toml:5:\d+: required and not given: emitter "tap": mass_rate or volume_rate or keep_full)re"));
  EXPECT_TRUE(contains(error_of(with(moving + "mass_rate = 3\nkeep_full = true\n")), "exclude each other; keep one"));
  EXPECT_TRUE(matches(error_of(with(moving + "mass_rate = -3\n")),
                      R"re(scene\.toml:11:\d+: emitter "tap": mass_rate must be > 0 kg/s, got -3)re"));
  EXPECT_TRUE(matches(
      error_of(with(kTap + "mass_rate = 3\n")),
      R"re(scene\.toml:5:\d+: emitter "tap": a rate needs a velocity that carries the material away; give velocity, or keep_full = true)re"));
  EXPECT_TRUE(contains(error_of(with(kTap + "keep_full = false\n")),
                       "emitter \"tap\": keep_full can only be true; for a rate give mass_rate or volume_rate"));
  EXPECT_TRUE(matches(error_of(with(kTap + "keep_full = true\nstart = 2\nstop = 1\n")),
                      R"re(scene\.toml:12:\d+: emitter "tap": stop must be after start, got 1 s and 2 s)re"));
  EXPECT_TRUE(contains(error_of(with(kTap + "keep_full = true\n"), {"emitter.tap.material=sno"}),
                       "emitter \"tap\": no [material.sno]; did you mean \"snow\"?"));
  EXPECT_TRUE(contains(error_of(with(kBall + kTap + "keep_full = true\n"), {"emitter.tap.name=ball"}),
                       "emitter \"ball\": a body has the same name; names must differ"));
  EXPECT_TRUE(contains(error_of(with(kTap + "keep_full = true\n"), {"resolution.particles=100"}),
                       "particles are counted in bodies, and the scene has none; give resolution.cell_size instead"));
  EXPECT_TRUE(
      contains(error_of(with("[[emitter]]\nshape = \"disk\"\nradius = 1\nmaterial = \"snow\"\nkeep_full = true\n")),
               "needs dimension = 2"));
}

TEST(SourcesScene, OtherErrorsAreLocated) {
  EXPECT_TRUE(contains(error_of(with(kBall + "[[sink]]\nmesh = \"none.obj\"\n")),
                       "sink \"sink0\": mesh \"none.obj\" is not a file"));
  const std::string field = "[[field]]\nname = \"f\"\n";
  EXPECT_TRUE(contains(error_of(with(kBall + field + "type = \"wind\"\nradius = 1\n")),
                       "field \"f\": radius applies only with type = \"attractor\", \"vortex\""));
  EXPECT_TRUE(contains(error_of(with(kBall + field + "type = \"wind\"\n")), "field \"f\": velocity, response_time"));
  EXPECT_TRUE(contains(error_of(with(kBall + field + "type = \"acceleration\"\nacceleration = [\"u\", 0, 0]\n")),
                       "unknown name \"u\"; known are x, y, z, t"));
  EXPECT_TRUE(
      contains(error_of(with(kBall + field + "type = \"vortex\"\nradius = 1\nstrength = 1\naxis = [0, 0, 0]\n")),
               "field \"f\": axis must not be zero"));
  EXPECT_TRUE(contains(
      error_of(
          with(kBall + field + "type = \"acceleration\"\nacceleration = [0, 0, 0]\nbox = [[0, 1, 0], [1, 1, 1]]\n")),
      "box must have its lowest corner first; on axis y got 1 and 1"));
  EXPECT_TRUE(contains(error_of(with(kBall + "[[pin]]\nshape = \"box\"\n")), "pin \"0\": size"));
  EXPECT_TRUE(contains(error_of(with(kBall + "[[probe]]\nname = \"a/b\"\n")),
                       "probe \"a/b\": name becomes the name of a file and may have letters, digits, _ and -"));
  EXPECT_TRUE(contains(error_of(with(kBall + "[[probe]]\nshape = \"line\"\nend = [1, 0, 0]\n")), "count"));
}

TEST(SourcesScene, MotionErrorsAreLocated) {
  const std::string sink = "[[sink]]\nname = \"drain\"\nshape = \"sphere\"\nradius = 1\n";
  const std::string arm = "[[collider]]\nname = \"arm\"\nshape = \"sphere\"\nradius = 1\n";
  EXPECT_TRUE(
      matches(error_of(with(kBall + arm + sink + "moves_with = \"amr\"\n")),
              R"re(scene\.toml:18:\d+: sink "drain": no \[\[collider\]\] has the name "amr"; did you mean "arm"\?)re"));
  EXPECT_TRUE(contains(error_of(with(kBall + sink + "moves_with = \"arm\"\n")),
                       "sink \"drain\": no [[collider]] has the name \"arm\""));
  const std::string frames = "keyframes = [{ time = 0 }, { time = 1, position = [1, 0, 0] }]\n";
  EXPECT_TRUE(contains(error_of(with(kBall + arm + sink + frames + "moves_with = \"arm\"\n")),
                       "sink \"drain\": moves_with excludes a motion of its own; keep one"));
  EXPECT_TRUE(contains(error_of(with(kTap + "keep_full = true\nkeyframes = [{ time = 1 }, { time = 1 }]\n")),
                       "emitter \"tap\": keyframes: entry 2: times must increase, got 1 s after 1 s"));
  const std::string pin = "[[pin]]\nname = \"grip\"\nshape = \"sphere\"\nradius = 1\n";
  EXPECT_TRUE(contains(error_of(with(kBall + arm + pin + "velocity = [1, 0, 0]\nmoves_with = \"arm\"\n")),
                       "pin \"grip\": moves_with excludes a motion of its own; keep one"));
  const std::string painted = with("youngs_modulus = { attribute = \"stiffness\" }\n" + kTap + "keep_full = true\n");
  EXPECT_TRUE(contains(error_of(painted),
                       "emitter \"tap\": material \"snow\" has its youngs_modulus painted on the mesh of a body"));
}

TEST(SourcesScene, TractionErrorsAreLocated) {
  const std::string traction = "[[traction]]\nname = \"push\"\nshape = \"sphere\"\nradius = 1\n";
  EXPECT_TRUE(contains(error_of(with(kBall + traction)), "traction \"push\": pressure or stress"));
  EXPECT_TRUE(contains(error_of(with(kBall + traction + "pressure = 1\nstress = [1, 0, 0]\n")),
                       "exclude each other; keep one"));
  EXPECT_TRUE(contains(error_of(with(kBall + traction + "pressure = 1\nnormal = [1, 0, 0]\n")),
                       "normal goes with stress; a pressure acts along the surface's own"));
  EXPECT_TRUE(contains(error_of(with(kBall + traction + "stress = [\"t\", 0, 0]\n")),
                       "a stress with a formula needs normal, the direction of the face it acts on"));
  EXPECT_TRUE(contains(error_of(with(kBall + traction + "stress = [0, 0, 0]\n")), "normal must not be zero"));
  EXPECT_TRUE(
      contains(error_of(with(kBall + traction + "pressure = \"u\"\n")), "unknown name \"u\"; known are x, y, z, t"));
  EXPECT_TRUE(contains(error_of(with(kBall + traction + "pressure = 1\nbody = \"bal\"\n")),
                       "traction \"push\": no [[body]] has the name \"bal\"; did you mean \"ball\"?"));
  const Scene scene = parse(with(kBall + traction + "stress = [0, 3, 4]\n"));
  EXPECT_DOUBLE_EQ(scene.tractions[0].normal[1], 0.6);
  EXPECT_DOUBLE_EQ(scene.tractions[0].normal[2], 0.8);
}

TEST(SourcesScene, ResolvedSceneReadsBack) {
  const std::string text = with(
      kTap +
      "velocity = [0, -1, 0]\nvolume_rate = 3\n[[emitter]]\nshape = \"sphere\"\nradius = 1\nmaterial = \"snow\"\n" +
      "keep_full = true\n[[sink]]\nshape = \"sphere\"\nradius = 2\n" +
      "[[field]]\ntype = \"vortex\"\nradius = 1\nstrength = -2\naxis = [1, 1, 0]\n" +
      "[[field]]\ntype = \"acceleration\"\nacceleration = [\"sin(t)\", 0, \"x\"]\nbox = [[0, 0, 0], [1, 1, 1]]\n" +
      "[[collider]]\nname = \"arm\"\nshape = \"sphere\"\nradius = 1\nvelocity = [1, 0, 0]\n" +
      "[[sink]]\nshape = \"sphere\"\nradius = 2\nmoves_with = \"arm\"\n" +
      "[[emitter]]\nshape = \"sphere\"\nradius = 1\nmaterial = \"snow\"\nkeep_full = true\n" +
      "interpolation = \"smooth\"\nkeyframes = [{ time = 0 }, { time = 1, rotation = [0, 90, 0] }]\n" +
      "[[pin]]\nshape = \"capsule\"\nradius = 0.5\nlength = 2\nmoves_with = \"arm\"\n" +
      "[[traction]]\nshape = \"sphere\"\nradius = 1\nstress = [\"sin(t)\", 1, 0]\nnormal = [0, 2, 0]\n" +
      "[[traction]]\nshape = \"sphere\"\nradius = 1\npressure = \"x * t\"\n" +
      "[[pin]]\nshape = \"sphere\"\nradius = 0.5\n[[probe]]\nshape = \"line\"\nend = [1, 0, 0]\ncount = 3\n");
  const std::string resolved = resolved_toml(parse(text));
  EXPECT_EQ(resolved_toml(parse(resolved)), resolved);
  EXPECT_TRUE(contains(resolved, "[[emitter]]\nname = \"emitter1\""));
  EXPECT_TRUE(contains(resolved, "acceleration = [\"sin(t)\", 0, \"x\"]"));
  EXPECT_EQ(scene_hash(parse(text)), scene_hash(parse(text, {"probe.0.count=5"})));
  EXPECT_NE(scene_hash(parse(text)), scene_hash(parse(text, {"sink.0.radius=1"})));
  EXPECT_TRUE(contains(explain("emitter.mass_rate"), "kg/s"));
}

Vec3d force(const std::string& field, const Vec3d& x, const Vec3d& v = {}, double t = 0) {
  return force_of<3>(parse(with(kBall + "[[field]]\n" + field)))(x, v, 0, t);
}

void expect_vector(const Vec3d& a, const Vec3d& b) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], 1e-14);
}

TEST(ForceFields, HaveTheirFormulas) {
  const std::string attractor = "type = \"attractor\"\nposition = [1, 0, 0]\nradius = 2\nstrength = 3\n";
  expect_vector(force(attractor, {{2, 0, 0}}), {{-1.5, 0, 0}});
  expect_vector(force(attractor, {{1, 4, 0}}), {{0, -0.75, 0}});
  expect_vector(force(attractor, {{1, 0, 0}}), {});
  const std::string vortex = "type = \"vortex\"\nposition = [0, 0, 5]\nradius = 2\nstrength = 3\naxis = [0, 0, 2]\n";
  expect_vector(force(vortex, {{1, 0, 0}}), {{0, 1.5, 0}});
  expect_vector(force(vortex, {{0, 4, 9}}), {{-1.5, 0, 0}});
  const std::string wind = "type = \"wind\"\nvelocity = [\"y\", \"t\", 0]\nresponse_time = 0.5\n";
  expect_vector(force(wind, {{0, 3, 0}}, {{1, 0, -1}}, 2), {{4, 4, 2}});
  const std::string formula = "type = \"acceleration\"\nacceleration = [\"x * z\", 0, \"t\"]\n";
  expect_vector(force(formula, {{2, 0, 3}}, {}, 7), {{6, 0, 7}});
  expect_vector(force(formula + "start = 8\n", {{2, 0, 3}}, {}, 7), {});
  expect_vector(force(formula + "stop = 7\n", {{2, 0, 3}}, {}, 7), {});
  expect_vector(force(formula + "box = [[0, 0, 0], [1, 1, 1]]\n", {{2, 0, 3}}, {}, 7), {});
  EXPECT_FALSE(force_of<3>(parse(with(kBall))));
}

TEST(Pins, MoveFromTheirStartOn) {
  const Scene scene =
      parse(with(kBall + "[[pin]]\nshape = \"box\"\nsize = [2, 1, 1]\nposition = [1, 2, 3]\nrotation = [0, 0, 30]\n"
                         "velocity = [1, 0, 0]\nangular_velocity = [0, 0, 2]\nstart = 0.5\n"));
  const Collider<3> collider = pin_collider<3>(scene, scene.pins[0], 0.1);
  expect_vector(collider.motion.origin_at(0.5), {{1, 2, 3}});
  expect_vector(collider.motion.origin_at(1), {{1.5, 2, 3}});
  expect_vector(collider.motion.rotation_at(0.5) * Vec3d{{1, 0, 0}}, {{std::cos(M_PI / 6), 0.5, 0}});
  EXPECT_EQ(collider.contact, Contact::sticky);
}

TEST(Pins, RideOnTheirCollider) {
  const Scene scene =
      parse(with(kBall + "[[collider]]\nname = \"arm\"\nshape = \"sphere\"\nradius = 1\nposition = [1, 0, 0]\n"
                         "rotation = [0, 30, 0]\nvelocity = [0, 1, 0]\nangular_velocity = [0, 0, 2]\n"
                         "[[pin]]\nshape = \"box\"\nsize = [2, 1, 1]\nposition = [3, 0, 0]\nrotation = [0, 0, 45]\n"
                         "moves_with = \"arm\"\n"));
  const Collider<3> pin = pin_collider<3>(scene, scene.pins[0], 0.1);
  EXPECT_TRUE(pin.is_filled);
  const double t = 0.7, c = std::cos(2 * t), s = std::sin(2 * t);
  const PosedCollider<3> now(pin, t);
  // Its centre is half a metre inside, and goes around the arm's.
  const Vec3d centre = {{1 + 2 * c, t + 2 * s, 0}};
  EXPECT_NEAR(now.distance(centre), -0.5, 1e-12);
  expect_vector(now.velocity(centre), {{-4 * s, 1 + 4 * c, 0}});
  const double q = 2 * t + M_PI / 4;
  EXPECT_NEAR(now.distance(centre + Vec3d{{1.5 * std::cos(q), 1.5 * std::sin(q), 0}}), 0.5, 1e-12) << "its long way";
}

TEST(Carried, IsWhereItsCarrierTakesIt) {
  const std::string arm =
      "[[collider]]\nname = \"arm\"\nshape = \"sphere\"\nradius = 1\nposition = [1, 2, 0]\nrotation = [20, 30, 40]\n"
      "interpolation = \"smooth\"\nkeyframes = [{ time = -1, position = [0, 0, 0], rotation = [0, 10, 50] }, "
      "{ time = 0.5 }, { time = 2, position = [3, 0, 1], rotation = [90, 30, 0], scale = 2 }]\n";
  const Scene scene =
      parse(with(kBall + arm + "[[sink]]\nshape = \"sphere\"\nradius = 1\nposition = [4, 0, 1]\n" +
                 "moves_with = \"arm\"\n[[sink]]\nshape = \"sphere\"\nradius = 1\n" + "position = [4, 0, 1]\n"));
  const Carried<3> carried(scene, scene.sinks[0]), still(scene, scene.sinks[1]);
  EXPECT_TRUE(carried.moves());
  EXPECT_FALSE(still.moves());
  const Vec3d x = {{0.3, -0.7, 2}};
  expect_vector(to_world<3>(carried.pose_at(0), x), x);
  expect_vector(to_world<3>(still.pose_at(9), x), x);
  // A point of the collider's own frame stays that point.
  const KeyframeMotion<3> motion(
      [] {
        std::vector<Keyframe<3>> frames;
        for (const auto& [t, p, d, s] : {std::tuple(-1.0, Vec3d{{0, 0, 0}}, Vec3d{{0, 10, 50}}, 1.0),
                                         std::tuple(0.5, Vec3d{{1, 2, 0}}, Vec3d{{20, 30, 40}}, 1.0),
                                         std::tuple(2.0, Vec3d{{3, 0, 1}}, Vec3d{{90, 30, 0}}, 2.0)}) {
          frames.push_back({t, p, rotation_from_degrees(d), s});
        }
        return frames;
      }(),
      Interpolation::smooth);
  const Vec3d own = to_frame<3>(motion.pose_at(0), x);
  for (const double t : {-2.0, -0.5, 0.9, 1.7, 3.0}) {
    const Vec3d there = to_world<3>(motion.pose_at(t), own);
    const Pose<3> pose = carried.pose_at(t);
    EXPECT_NEAR(norm(to_world<3>(pose, x) - there), 0, 1e-12) << t;
    EXPECT_NEAR(norm(pose.velocity_at(there) - motion.pose_at(t).velocity_at(there)), 0, 1e-12) << t;
    EXPECT_NEAR(norm(to_frame<3>(pose, there) - x), 0, 1e-12) << t;
    constexpr double h = 1e-6;
    const Vec3d slope = (0.5 / h) * (to_world<3>(carried.pose_at(t + h), x) - to_world<3>(carried.pose_at(t - h), x));
    EXPECT_NEAR(norm(pose.velocity_at(there) - slope), 0, 1e-6) << t;
  }
  const auto region = still.region(scene);
  EXPECT_NEAR(carried.fastest(region->bounds(), 3, 9), 0, 0) << "at rest after the last keyframe";
  EXPECT_GT(carried.fastest(region->bounds(), 0.5, 2), 1);
}

TEST(Probes, HaveTheirPoints) {
  ProbeSettings probe;
  probe.position = {{1, 2, 0}};
  EXPECT_EQ(probe_points(probe).size(), 1u);
  probe.shape = ProbeSettings::Shape::line;
  probe.end = {{2, 4, 0}};
  probe.count = 5;
  const auto line = probe_points(probe);
  ASSERT_EQ(line.size(), 5u);
  expect_vector(line[1], {{1.25, 2.5, 0}});
  expect_vector(line[4], {{2, 4, 0}});
  probe.shape = ProbeSettings::Shape::plane;
  probe.corner = {{1, 2, 4}};
  const auto plane = probe_points(probe);
  ASSERT_EQ(plane.size(), 25u);
  expect_vector(plane[7], {{1.5, 3, 1}});
  expect_vector(plane[24], {{2, 4, 4}});
}

}  // namespace
}  // namespace firn::test
