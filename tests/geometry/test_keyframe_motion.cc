#include <firn/core/error.h>
#include <firn/geometry/keyframe_motion.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

namespace firn {
namespace {

template <class Array>
void expect_near(const Array& a, const Array& b, double tolerance) {
  for (std::size_t i = 0; i < std::size(a.e); ++i) EXPECT_NEAR(a.e[i], b.e[i], tolerance) << "entry " << i;
}

KeyframeMotion<3> tour(Interpolation interpolation) {
  return KeyframeMotion<3>({{0, {{0, 0, 0}}, identity<double, 3>(), 1},
                            {0.7, {{1, 0.5, -1}}, rotation_by(Vec3d{{0.9, -1.3, 0.4}}), 1.5},
                            {1.5, {{1, 2, 0}}, rotation_by(Vec3d{{-0.2, 2.1, 1.0}}), 0.8},
                            {2.4, {{-1, 0, 1}}, rotation_by(Vec3d{{0.3, 0.1, -2.5}}), 0.9}},
                           interpolation);
}

TEST(KeyframeMotion, PassesThroughItsKeyframes) {
  for (const auto interpolation : {Interpolation::linear, Interpolation::smooth}) {
    const auto motion = tour(interpolation);
    for (const auto& key : motion.keyframes()) {
      const auto pose = motion.pose_at(key.time);
      expect_near(pose.origin, key.position, 1e-14);
      expect_near(pose.rotation, key.orientation, 1e-14);
      EXPECT_NEAR(pose.scale, key.scale, 1e-14);
    }
  }
}

TEST(KeyframeMotion, IsARotationAtEveryTime) {
  for (const auto interpolation : {Interpolation::linear, Interpolation::smooth}) {
    const auto motion = tour(interpolation);
    for (double t = -0.1; t < 2.6; t += 0.013) {
      const Mat3d r = motion.pose_at(t).rotation;
      expect_near(r * transpose(r), identity<double, 3>(), 1e-14);
      EXPECT_NEAR(determinant(r), 1, 1e-14);
    }
  }
}

template <int dim>
void expect_velocities_are_derivatives(const KeyframeMotion<dim>& motion, const Vec<double, dim>& body_point) {
  const double step = 1e-5;
  const auto position = [&](double t) {
    const auto pose = motion.pose_at(t);
    return pose.origin + pose.rotation * (pose.scale * body_point);
  };
  for (double t = -0.1; t < 2.6; t += 0.0371) {
    const auto difference = (1 / (2 * step)) * (position(t + step) - position(t - step));
    expect_near(motion.pose_at(t).velocity_at(position(t)), difference, 2e-7);
  }
}

TEST(KeyframeMotion, VelocityIsTheTimeDerivativeOfAMaterialPoint) {
  for (const auto interpolation : {Interpolation::linear, Interpolation::smooth}) {
    expect_velocities_are_derivatives<3>(tour(interpolation), {{0.4, -0.7, 0.9}});
    expect_velocities_are_derivatives<2>(
        KeyframeMotion<2>({{0, {}, 0, 1}, {0.7, {{1, 2}}, 9, 1.2}, {2.4, {{0, 1}}, -1, 0.7}}, interpolation),
        {{0.4, -0.7}});
  }
}

TEST(KeyframeMotion, LinearTurnsAtConstantSpeedAboutAFixedAxis) {
  const Vec3d axis = normalized(Vec3d{{1, 2, -2}});
  const double angle = 2.8;
  const KeyframeMotion<3> motion({{1, {}, identity<double, 3>(), 1}, {3, {}, rotation_by(angle * axis), 1}},
                                 Interpolation::linear);
  for (const double u : {0.1, 0.25, 0.5, 0.9}) {
    const auto pose = motion.pose_at(1 + 2 * u);
    expect_near(pose.rotation, rotation_by(u * angle * axis), 1e-14);
    expect_near(pose.angular_velocity, (angle / 2) * axis, 1e-14);
  }
}

TEST(KeyframeMotion, SmoothHasContinuousVelocitiesAndRestsAtTheEnds) {
  const auto motion = tour(Interpolation::smooth);
  const double step = 1e-9;
  for (const auto& key : motion.keyframes()) {
    const auto before = motion.pose_at(key.time - step), after = motion.pose_at(key.time + step);
    expect_near(before.velocity, after.velocity, 1e-6);
    expect_near(before.angular_velocity, after.angular_velocity, 1e-6);
    EXPECT_NEAR(before.growth, after.growth, 1e-6);
  }
  expect_near(motion.pose_at(0).velocity, Vec3d{}, 1e-14);
  expect_near(motion.pose_at(2.4 - step).angular_velocity, Vec3d{}, 1e-6);
  // Linear motion does jump: the check above can fail.
  const auto linear = tour(Interpolation::linear);
  EXPECT_GT(norm(linear.pose_at(0.7 - step).velocity - linear.pose_at(0.7 + step).velocity), 0.1);
}

TEST(KeyframeMotion, SmoothScaleStaysBetweenItsKeyframes) {
  const KeyframeMotion<2> motion({{0, {}, 0, 1}, {1, {}, 0, 0.01}, {1.1, {}, 0, 3}, {5, {}, 0, 3}},
                                 Interpolation::smooth);
  for (double t = 0; t < 5; t += 0.01) {
    const double scale = motion.pose_at(t).scale;
    EXPECT_GE(scale, 0.01 - 1e-12);
    EXPECT_LE(scale, 3 + 1e-12);
  }
}

TEST(KeyframeMotion, InThePlaneAnglesCountFullTurns) {
  const KeyframeMotion<2> motion({{0, {}, 0, 1}, {1, {}, 4 * std::numbers::pi, 1}}, Interpolation::linear);
  EXPECT_NEAR(motion.pose_at(0.5).angular_velocity, 4 * std::numbers::pi, 1e-12);
}

TEST(RotationVector, IsTheInverseOfTheExponential) {
  for (const double angle : {0.0, 1e-12, 1e-5, 0.3, 1.5, 3.0, 3.14159265, std::numbers::pi}) {
    for (const Vec3d& way : {Vec3d{{1, 0, 0}}, Vec3d{{0, -1, 0}}, Vec3d{{1, 2, -2}}, Vec3d{{-3, 1, 1}}}) {
      const Vec3d turn = angle * normalized(way);
      const Vec3d found = rotation_vector(rotation_by(turn));
      expect_near(rotation_by(found), rotation_by(turn), 1e-14);
      EXPECT_NEAR(norm(found), angle, 1e-14 + 1e-9 * (angle > 3.1 ? 1 : 0));
    }
  }
}

TEST(KeyframeMotion, SaysWhatIsWrong) {
  const auto message = [](std::vector<Keyframe<2>> keys) -> std::string {
    try {
      KeyframeMotion<2>(std::move(keys), Interpolation::linear);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message({}), "keyframes: at least one is needed");
  EXPECT_EQ(message({{1, {}, 0, 1}, {1, {}, 0, 1}}), "keyframe 1: times must increase, got 1 s after 1 s");
  EXPECT_EQ(message({{1, {}, 0, 0}}), "keyframe 0: scale must be positive, got 0");
}

}  // namespace
}  // namespace firn
