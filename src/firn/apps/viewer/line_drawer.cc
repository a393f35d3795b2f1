#include <firn/apps/viewer/line_drawer.h>

#include <cstddef>

namespace firn {
namespace {

const char* const kVertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 ink;
uniform mat4 view, projection;
out vec3 color;
void main() {
  cut(position);
  color = ink;
  gl_Position = projection * (view * vec4(position, 1.0));
}
)";

const char* const kFragment = R"(
in vec3 color;
out vec4 pixel;
void main() { pixel = vec4(color, 1.0); }
)";

}  // namespace

LineDrawer::LineDrawer() : program_("line", std::string(kClipGlsl) + kVertex, kFragment) {}

void LineDrawer::upload(const std::vector<LinePoint>& points, const Vec3d& origin) {
  origin_ = origin;
  count_ = static_cast<int>(points.size());
  glBindVertexArray(array_.id());
  glBindBuffer(GL_ARRAY_BUFFER, points_.id());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(points.size() * sizeof(LinePoint)), points.data(),
               GL_STREAM_DRAW);
  for (GLuint i = 0; i < 2; ++i) {
    const std::size_t offset = i == 0 ? offsetof(LinePoint, x) : offsetof(LinePoint, color);
    glVertexAttribPointer(i, 3, GL_FLOAT, GL_FALSE, sizeof(LinePoint), reinterpret_cast<const void*>(offset));
    glEnableVertexAttribArray(i);
  }
  glBindVertexArray(0);
}

void LineDrawer::draw(const CloudCamera& camera) const {
  if (count_ == 0) return;
  program_.use();
  program_.set("view", camera.view);
  program_.set("projection", camera.projection);
  set_clip(program_, camera.clip_normal, camera.clip_offset, origin_);
  glEnable(GL_CLIP_DISTANCE0);
  glBindVertexArray(array_.id());
  glDrawArrays(GL_LINES, 0, count_);
  glBindVertexArray(0);
  glDisable(GL_CLIP_DISTANCE0);
}

}  // namespace firn
