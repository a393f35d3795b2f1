#include <firn/apps/viewer/solid_drawer.h>
#include <firn/render/daylight.h>
#include <firn/render/look.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace firn {
namespace {

constexpr int kBoxVertices = 36, kPlaneVertices = 6;
constexpr int kRings = 24, kSectors = 48;
/// Half the side of the square that stands for an endless plane, in distances from camera to target.
constexpr double kPlaneExtent = 100;

const char* const kSkyVertex = R"(
out vec2 at;
void main() {
  at = vec2((gl_VertexID & 1) * 4 - 1, (gl_VertexID & 2) * 2 - 1);
  gl_Position = vec4(at, 1.0, 1.0);
}
)";

const char* const kSkyFragment = R"(
uniform vec3 right, above, ahead, zenith_axis, horizon, zenith, below;
in vec2 at;
out vec4 pixel;
void main() {
  vec3 d = normalize(ahead + at.x * right + at.y * above);
  float h = dot(d, zenith_axis);
  vec3 light = mix(horizon, zenith, 1.0 - exp(-3.2 * max(h, 0.0)));
  pixel = vec4(displayed(mix(light, below, smoothstep(0.0, 0.15, -h))), 1.0);
}
)";

const char* const kSolidVertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 direction;
uniform mat4 view, projection;
uniform vec3 center, axis0, axis1, axis2;
out vec3 normal, in_view;
void main() {
  vec3 x = center + position.x * axis0 + position.y * axis1 + position.z * axis2;
  // The axes are orthogonal: a normal scales by the inverse of their squared lengths.
  vec3 n = direction.x * axis0 / dot(axis0, axis0) + direction.y * axis1 / dot(axis1, axis1) +
           direction.z * axis2 / dot(axis2, axis2);
  vec4 at = view * vec4(x, 1.0);
  in_view = at.xyz;
  normal = mat3(view) * n;
  gl_Position = projection * at;
}
)";

const char* const kSolidFragment = R"(
uniform vec3 color, horizon;
uniform float fade_from, opacity;
in vec3 normal, in_view;
out vec4 pixel;
void main() {
  vec3 light = lit(color, normalize(normal), 0.0, in_view);
  float far = 1.0 - exp(-max(length(in_view) / fade_from - 1.0, 0.0));
  pixel = vec4(displayed(mix(light, horizon, far)), opacity);
}
)";

using Vertices = std::vector<float>;

void add(Vertices* vertices, const Vec3d& x, const Vec3d& n) {
  for (int i = 0; i < 3; ++i) vertices->push_back(static_cast<float>(x[i]));
  for (int i = 0; i < 3; ++i) vertices->push_back(static_cast<float>(n[i]));
}

/// The cube [-1, 1]^3.
void add_box(Vertices* vertices) {
  constexpr int kCorner[6][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, -1}, {1, 1}, {-1, 1}};
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {-1, 1}) {
      for (const auto& corner : kCorner) {
        Vec3d x, n = {};
        n[axis] = x[axis] = side;
        x[(axis + 1) % 3] = corner[0];
        x[(axis + 2) % 3] = corner[1];
        add(vertices, x, n);
      }
    }
  }
}

void add_sphere(Vertices* vertices) {
  const auto point = [](int ring, int sector) {
    const double a = std::numbers::pi * ring / kRings, b = 2 * std::numbers::pi * sector / kSectors;
    return Vec3d{{std::sin(a) * std::cos(b), std::cos(a), std::sin(a) * std::sin(b)}};
  };
  for (int r = 0; r < kRings; ++r) {
    for (int s = 0; s < kSectors; ++s) {
      for (const auto& [i, j] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}}) {
        const Vec3d x = point(r + i, s + j);
        add(vertices, x, x);
      }
    }
  }
}

/// [-1, 1]^2 in the plane of the first two axes, facing the third.
void add_plane(Vertices* vertices) {
  constexpr int kCorner[6][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, -1}, {1, 1}, {-1, 1}};
  for (const auto& corner : kCorner) {
    add(vertices, {{static_cast<double>(corner[0]), static_cast<double>(corner[1]), 0}}, {{0, 0, 1}});
  }
}

Vec3f single(const Vec3d& x) {
  return {{static_cast<float>(x[0]), static_cast<float>(x[1]), static_cast<float>(x[2])}};
}

Vec3d column(const Mat3d& m, int j) { return {{m(0, j), m(1, j), m(2, j)}}; }

Mat3d from_columns(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  Mat3d m;
  for (int i = 0; i < 3; ++i) {
    m(i, 0) = a[i];
    m(i, 1) = b[i];
    m(i, 2) = c[i];
  }
  return m;
}

Vec3f drawn(const Vec3f& color, const Vec3f& otherwise) { return color[0] < 0 ? otherwise : color; }

void fill(const GlVertexArray& array, const GlBuffer& buffer, const Vertices& vertices) {
  glBindVertexArray(array.id());
  glBindBuffer(GL_ARRAY_BUFFER, buffer.id());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(float)), vertices.data(),
               GL_STATIC_DRAW);
  for (GLuint i = 0; i < 2; ++i) {
    glVertexAttribPointer(i, 3, GL_FLOAT, GL_FALSE, 6 * sizeof(float), reinterpret_cast<const void*>(i * 12UL));
    glEnableVertexAttribArray(i);
  }
  glBindVertexArray(0);
}

}  // namespace

SolidDrawer::SolidDrawer()
    : sky_("sky", kSkyVertex, std::string(kDaylightGlsl) + kSkyFragment),
      solid_("solid", kSolidVertex, std::string(kDaylightGlsl) + kSolidFragment) {
  Vertices vertices;
  add_box(&vertices);
  sphere_first_ = kBoxVertices;
  add_sphere(&vertices);
  sphere_count_ = 6 * kRings * kSectors;
  plane_first_ = sphere_first_ + sphere_count_;
  add_plane(&vertices);
  fill(array_, vertices_, vertices);
}

const SolidDrawer::Uploaded& SolidDrawer::upload(const std::shared_ptr<const ShapeSurface>& surface) const {
  const auto [entry, is_new] = uploaded_.try_emplace(surface.get());
  if (!is_new) return entry->second;
  Vertices vertices;
  const TriangleMesh& mesh = surface->mesh;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int c = 0; c < 3; ++c) {
      const Vec3f& n = surface->normals[t][static_cast<std::size_t>(c)];
      add(&vertices, mesh.corner(t, c), {{n[0], n[1], n[2]}});
    }
  }
  entry->second.surface = surface;
  entry->second.count = static_cast<int>(3 * mesh.triangles.size());
  fill(entry->second.array, entry->second.vertices, vertices);
  return entry->second;
}

void SolidDrawer::draw_solids(const View& view, const Vec3d& origin, bool glass) const {
  // A solid that changes its form has a new surface in each frame; those that nobody else holds will not come again.
  std::erase_if(uploaded_, [](const auto& entry) { return entry.second.surface.use_count() == 1; });
  for (const DrawnSolid& solid : view.solids) {
    if (solid.glass != glass) continue;
    const Uploaded& uploaded = upload(solid.surface);
    glBindVertexArray(uploaded.array.id());
    if (solid.endless) glEnable(GL_CULL_FACE);
    draw_mesh(0, uploaded.count, solid.origin - origin, solid.scale * solid.rotation,
              drawn(solid.color, kColliderColor));
    glDisable(GL_CULL_FACE);
  }
}

void SolidDrawer::draw_glass(const View& view, const Vec3d& origin) const {
  solid_.set("opacity", 0.2F);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  draw_solids(view, origin, true);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

void SolidDrawer::draw_sky(const View& view, const OrbitCamera& camera, double aspect) const {
  const Camera& c = camera.camera();
  const Vec3d ahead = normalized(c.target - c.position), right = normalized(cross(ahead, c.up));
  const double half = std::tan(c.field_of_view * std::numbers::pi / 360);
  const Daylight day{.sun_direction = {}, .up = {{0, 1, 0}}};
  sky_.use();
  if (camera.flat()) {
    // Looking level, the horizon would cross the picture: 2D has a plain sky.
    sky_.set("ahead", single(view.up));
    sky_.set("right", Vec3f{});
    sky_.set("above", Vec3f{});
    sky_.set("zenith", day.horizon());
  } else {
    sky_.set("ahead", single(ahead));
    sky_.set("right", single((half * aspect) * right));
    sky_.set("above", single(half * cross(right, ahead)));
    sky_.set("zenith", day.sky({{0, 1, 0}}));
  }
  sky_.set("zenith_axis", single(normalized(view.up)));
  sky_.set("horizon", day.horizon());
  sky_.set("below", 0.7F * day.horizon());
  glDepthMask(GL_FALSE);
  glDisable(GL_DEPTH_TEST);
  glBindVertexArray(array_.id());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glBindVertexArray(0);
  glDepthMask(GL_TRUE);
}

void SolidDrawer::draw_mesh(int first, int count, const Vec3d& center, const Mat3d& axes, const Vec3f& color) const {
  solid_.set("center", single(center));
  solid_.set("axis0", single(column(axes, 0)));
  solid_.set("axis1", single(column(axes, 1)));
  solid_.set("axis2", single(column(axes, 2)));
  solid_.set("color", color);
  glDrawArrays(GL_TRIANGLES, first, count);
}

void SolidDrawer::draw_boxes_and_spheres(const View& view, const Vec3d& origin, double thinnest) const {
  glBindVertexArray(array_.id());
  for (const DrawnBox& box : view.boxes) {
    Vec3d half = box.half_size;
    // A box of 2D may be without depth, which would leave its sides without a normal.
    for (int i = 0; i < 3; ++i) half[i] = std::max(half[i], thinnest);
    const Mat3d axes = box.rotation * diagonal(half);
    draw_mesh(0, kBoxVertices, box.center - origin, axes, drawn(box.color, kColliderColor));
  }
  for (const DrawnSphere& sphere : view.spheres) {
    const Mat3d axes = diagonal(constant_vector<double, 3>(sphere.radius));
    draw_mesh(sphere_first_, sphere_count_, sphere.center - origin, axes, drawn(sphere.color, kColliderColor));
  }
}

void SolidDrawer::draw_casters(const View& view, const Matrix4& view_matrix, const Matrix4& projection,
                               const Vec3d& origin) const {
  solid_.use();
  solid_.set("view", view_matrix);
  solid_.set("projection", projection);
  solid_.set("opacity", 1.0F);
  set_daylight(solid_, view, view_matrix);
  draw_boxes_and_spheres(view, origin, 1e-6);
  View casting;
  for (const DrawnSolid& solid : view.solids) {
    if (!solid.endless && !solid.glass) casting.solids.push_back(solid);
  }
  draw_solids(casting, origin, false);
  glBindVertexArray(0);
}

void SolidDrawer::draw(const View& view, const OrbitCamera& camera, double aspect, const Vec3d& origin,
                       const Shadows& shadows) const {
  const double far = kPlaneExtent * camera.distance();
  const Matrix4 matrix = camera.view_matrix(origin);
  solid_.use();
  solid_.set("view", matrix);
  solid_.set("projection", camera.projection_matrix(aspect));
  solid_.set("horizon", Daylight{}.horizon());
  solid_.set("fade_from", static_cast<float>(camera.flat() ? 1e6 * far : 0.08 * far));
  solid_.set("opacity", 1.0F);
  set_daylight(solid_, view, matrix, shadows);
  glEnable(GL_DEPTH_TEST);
  draw_boxes_and_spheres(view, origin, 1e-4 * camera.distance());
  draw_solids(view, origin, false);
  glBindVertexArray(array_.id());
  const Camera& c = camera.camera();
  for (const DrawnHalfSpace& solid : view.half_spaces) {
    const Vec3d n = normalized(solid.normal);
    const double height = dot(c.position - solid.point, n);
    const Vec3f color = drawn(solid.color, kGroundColor);
    if (camera.flat()) {
      // Seen from its edge: the solid itself, a square whose upper side is the boundary, behind the particles.
      const Vec3d along = cross(n, Vec3d{{0, 0, 1}});
      const Vec3d behind = {{0, 0, -0.01 * camera.distance()}};
      const Vec3d foot = c.target - dot(c.target - solid.point, n) * n + behind;
      draw_mesh(plane_first_, kPlaneVertices, foot - far * n - origin, from_columns(far * along, far * n, {{0, 0, 1}}),
                color);
    } else if (height > 0) {
      const Vec3d along = normalized(std::abs(n[0]) < 0.6 ? cross(n, Vec3d{{1, 0, 0}}) : cross(n, Vec3d{{0, 1, 0}}));
      draw_mesh(plane_first_, kPlaneVertices, c.position - height * n - origin,
                from_columns(far * along, far * cross(n, along), n), color);
    }
  }
  draw_glass(view, origin);
  glBindVertexArray(0);
}

}  // namespace firn
