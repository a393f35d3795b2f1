#include <firn/apps/viewer/surface_drawer.h>
#include <firn/render/color_map.h>

#include <cstddef>

namespace firn {
namespace {

constexpr int kMapUnit = 0;
/// Light that scatters past the terminator, as on particles that are coloured by a column.
constexpr float kWrap = 0.25F;

const char* const kVertexShader = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 direction;
layout(location = 2) in vec3 given;
uniform mat4 view, projection;
out vec3 normal, in_view, carried;
void main() {
  vec4 at = view * vec4(position, 1.0);
  cut(position);
  in_view = at.xyz;
  normal = mat3(view) * direction;
  carried = given;
  gl_Position = projection * at;
}
)";

// What the clip plane has opened is hollow: its inside is darker, so that one sees where one looks.
const char* const kFragmentShader = R"(
uniform int by_column, has_colors;
uniform vec2 range;
uniform float wrap;
uniform sampler2D map;
in vec3 normal, in_view, carried;
out vec4 pixel;
vec3 linear(vec3 c) { return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045))); }
void main() {
  vec3 color = vec3(0.35);
  if (has_colors == 1 && by_column == 1) {
    float t = clamp((carried.x - range.x) / (range.y - range.x), 0.0, 1.0);
    color = isnan(carried.x) ? vec3(0.2) : linear(textureLod(map, vec2((t * 8.0 + 0.5) / 9.0, 0.5), 0.0).rgb);
  } else if (has_colors == 1) {
    color = carried;
  }
  vec3 n = normalize(normal);
  if (!gl_FrontFacing) {
    n = -n;
    color *= 0.5;
  }
  pixel = vec4(displayed(lit(color, n, wrap, in_view)), 1.0);
}
)";

}  // namespace

SurfaceDrawer::SurfaceDrawer()
    : program_("surface", std::string(kClipGlsl) + kVertexShader, std::string(kDaylightGlsl) + kFragmentShader) {}

void SurfaceDrawer::upload(const std::shared_ptr<const MeshedSurface>& surface) {
  if (surface == surface_) return;
  surface_ = surface;
  if (!surface) return;
  const auto bytes = [](const auto& values) { return static_cast<GLsizeiptr>(values.size() * sizeof(values[0])); };
  glBindVertexArray(array_.id());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.id());
  glBufferData(GL_ARRAY_BUFFER, bytes(surface->vertices), surface->vertices.data(), GL_STREAM_DRAW);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, triangles_.id());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, bytes(surface->triangles), surface->triangles.data(), GL_STREAM_DRAW);
  const std::size_t offsets[] = {offsetof(SurfaceVertex, position), offsetof(SurfaceVertex, normal),
                                 offsetof(SurfaceVertex, carried)};
  for (GLuint i = 0; i < 3; ++i) {
    glVertexAttribPointer(i, 3, GL_FLOAT, GL_FALSE, sizeof(SurfaceVertex), reinterpret_cast<const void*>(offsets[i]));
    glEnableVertexAttribArray(i);
  }
  glBindVertexArray(0);
}

std::array<double, 2> SurfaceDrawer::range(const View& view) const {
  return view.color_range || !surface_ ? view.color_range.value_or(std::array<double, 2>{0, 1}) : surface_->range;
}

void SurfaceDrawer::draw(const View& view, const CloudCamera& camera, const Vec3d& camera_origin) const {
  if (!surface_ || surface_->triangles.empty()) return;
  CloudCamera own = camera;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const int c = static_cast<int>(j);
      own.view[12 + i] += own.view[4 * j + i] * static_cast<float>(surface_->origin[c] - camera_origin[c]);
    }
  }
  const bool by_column = !view.color_by.empty();
  const std::array<double, 2> ends = range(view);
  program_.use();
  program_.set("view", own.view);
  program_.set("projection", own.projection);
  program_.set("by_column", by_column ? 1 : 0);
  program_.set("has_colors", surface_->order.color_by == view.color_by ? 1 : 0);
  program_.set("range", static_cast<float>(ends[0]), static_cast<float>(ends[1]));
  program_.set("wrap", kWrap);
  program_.set("map", kMapUnit);
  set_clip(program_, camera.clip_normal, camera.clip_offset, surface_->origin);
  set_daylight(program_, view, own.view, camera.shadows);
  glActiveTexture(GL_TEXTURE0 + kMapUnit);
  if (by_column) {
    const ColorMap& map = find_color_map(view.color_map);
    upload_row(map_.id(), static_cast<int>(map.srgb.size()), GL_RGB, GL_UNSIGNED_BYTE, map.srgb.data(), GL_RGB8);
  }
  glBindTexture(GL_TEXTURE_2D, map_.id());
  glBindVertexArray(array_.id());
  glEnable(GL_CLIP_DISTANCE0);
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * surface_->triangles.size()), GL_UNSIGNED_INT, nullptr);
  glDisable(GL_CLIP_DISTANCE0);
  glBindVertexArray(0);
}

}  // namespace firn
