#include <firn/apps/viewer/shadow_map.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace firn {
namespace {

constexpr int kSide = 2048;
/// How far along the light things may stand that cast a shadow into the ball, radii.
constexpr double kDepth = 8;

}  // namespace

Matrix4 looking_along(const Vec3d& forward, const Vec3d& up) {
  const Vec3d along = normalized(forward);
  const Vec3d hint = norm(cross(along, up)) > 1e-3 ? up : Vec3d{{up[1], up[2], up[0]}};
  const Vec3d side = normalized(cross(along, hint));
  const Vec3d rows[3] = {side, cross(side, along), -along};
  Matrix4 m = {};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) m[4 * j + i] = static_cast<float>(rows[i][static_cast<int>(j)]);
  }
  m[15] = 1;
  return m;
}

Matrix4 inverse_of_rigid(const Matrix4& m) {
  Matrix4 r = {};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      r[4 * j + i] = m[4 * i + j];
      r[12 + i] -= m[4 * i + j] * m[12 + j];
    }
  }
  r[15] = 1;
  return r;
}

Matrix4 inverse(const Matrix4& m) {
  // Gauss and Jordan, with rows swapped for the largest pivot; [i][j] is row i.
  double a[4][8] = {};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) a[i][j] = m[4 * j + i];
    a[i][4 + i] = 1;
  }
  for (std::size_t c = 0; c < 4; ++c) {
    std::size_t pivot = c;
    for (std::size_t i = c + 1; i < 4; ++i) pivot = std::abs(a[i][c]) > std::abs(a[pivot][c]) ? i : pivot;
    std::swap(a[c], a[pivot]);
    for (std::size_t j = 8; j-- > c;) a[c][j] /= a[c][c];
    for (std::size_t i = 0; i < 4; ++i) {
      if (i == c) continue;
      for (std::size_t j = 8; j-- > c;) a[i][j] -= a[i][c] * a[c][j];
    }
  }
  Matrix4 r = {};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) r[4 * j + i] = static_cast<float>(a[i][4 + j]);
  }
  return r;
}

ShadowMap::ShadowMap() {
  glBindTexture(GL_TEXTURE_2D, map_.id());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, kSide, kSide, 0, GL_DEPTH_COMPONENT, GL_FLOAT, nullptr);
  glBindFramebuffer(GL_FRAMEBUFFER, target_.id());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, map_.id(), 0);
  glDrawBuffer(GL_NONE);
  glReadBuffer(GL_NONE);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

Shadows ShadowMap::draw(const std::function<void(const CloudCamera&)>& draw_material, const Vec3d& origin,
                        const SolidDrawer& solids, const View& view, const CloudCamera& camera, const Vec3d& center,
                        double radius) const {
  GLint before[4] = {}, target = 0;
  glGetIntegerv(GL_VIEWPORT, before);
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &target);
  CloudCamera sun = camera;
  sun.view = looking_along(-view.sun_direction, view.up);
  const Vec3d at = center - origin;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j)
      sun.view[12 + i] -= sun.view[4 * j + i] * static_cast<float>(at[static_cast<int>(j)]);
  }
  sun.projection = {};
  sun.projection[0] = sun.projection[5] = static_cast<float>(1 / radius);
  sun.projection[10] = static_cast<float>(-1 / (kDepth * radius));
  sun.projection[15] = 1;
  sun.height = kSide;
  sun.shadows = {};
  glBindFramebuffer(GL_FRAMEBUFFER, target_.id());
  glViewport(0, 0, kSide, kSide);
  glClear(GL_DEPTH_BUFFER_BIT);
  glEnable(GL_DEPTH_TEST);
  draw_material(sun);
  solids.draw_casters(view, sun.view, sun.projection, origin);
  glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(target));
  glViewport(before[0], before[1], before[2], before[3]);
  // From [-1, 1] to [0, 1].
  Matrix4 half = {};
  half[0] = half[5] = half[10] = half[12] = half[13] = half[14] = 0.5F;
  half[15] = 1;
  return {map_.id(), product(half, product(sun.projection, product(sun.view, inverse_of_rigid(camera.view))))};
}

}  // namespace firn
