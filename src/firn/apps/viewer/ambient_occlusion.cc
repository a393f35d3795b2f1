#include <firn/apps/viewer/ambient_occlusion.h>
#include <firn/apps/viewer/shadow_map.h>

namespace firn {
namespace {

constexpr int kColorUnit = 0, kDepthUnit = 1, kShadeUnit = 2;

const char* const kVertex = R"(
void main() {
  vec2 at = vec2((gl_VertexID & 1) * 4 - 1, (gl_VertexID & 2) * 2 - 1);
  gl_Position = vec4(at, 0.0, 1.0);
}
)";

const char* const kOcclusion = R"(
uniform sampler2D depths;
uniform mat4 from_clip, projection;
uniform float radius;
out float shade;
vec3 place(ivec2 pixel) {
  pixel = clamp(pixel, ivec2(0), textureSize(depths, 0) - 1);
  vec2 at = (vec2(pixel) + 0.5) / vec2(textureSize(depths, 0));
  vec4 x = from_clip * vec4(2.0 * vec3(at, texelFetch(depths, pixel, 0).r) - 1.0, 1.0);
  return x.xyz / x.w;
}
// Of both neighbours the one that lies on the same surface.
vec3 along(vec3 x, ivec2 pixel, ivec2 way) {
  vec3 a = place(pixel + way) - x, b = x - place(pixel - way);
  return abs(a.z) < abs(b.z) ? a : b;
}
void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  shade = 1.0;
  if (texelFetch(depths, pixel, 0).r >= 1.0) return;
  vec3 x = place(pixel);
  vec3 normal = normalize(cross(along(x, pixel, ivec2(1, 0)), along(x, pixel, ivec2(0, 1))));
  float w = (projection * vec4(x, 1.0)).w;
  float reach = 0.5 * float(textureSize(depths, 0).y) * projection[1][1] * radius / w;
  if (reach < 1.5) return;
  float turn = 6.2831853 * fract(52.9829189 * fract(dot(vec2(pixel & 3), vec2(0.06711056, 0.00583715) * 64.0)));
  float sum = 0.0;
  const int samples = 14;
  for (int i = 0; i < samples; ++i) {
    float part = (float(i) + 0.5) / float(samples), angle = turn + float(i) * 2.3999632;
    vec3 v = place(pixel + ivec2(reach * part * vec2(cos(angle), sin(angle)))) - x;
    float square = dot(v, v);
    if (square > radius * radius) continue;
    sum += max(dot(v, normal) - 0.03 * radius, 0.0) / (square + 0.01 * radius * radius);
  }
  shade = clamp(1.0 - 0.9 * radius * sum / float(samples), 0.25, 1.0);
}
)";

const char* const kComposition = R"(
uniform sampler2D colors, shades;
out vec4 pixel;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  float sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) sum += texelFetch(shades, clamp(at + ivec2(i, j) - 2, ivec2(0), textureSize(shades, 0) - 1), 0).r;
  }
  pixel = vec4(texelFetch(colors, at, 0).rgb * sum / 16.0, 1.0);
}
)";

void make_texture(GLuint id, GLint internal, GLenum format, GLenum type, int width, int height) {
  glBindTexture(GL_TEXTURE_2D, id);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTexImage2D(GL_TEXTURE_2D, 0, internal, width, height, 0, format, type, nullptr);
}

void attach(GLuint framebuffer, GLenum place, GLuint texture) {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glFramebufferTexture2D(GL_FRAMEBUFFER, place, GL_TEXTURE_2D, texture, 0);
}

void bind(int unit, GLuint texture) {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_2D, texture);
}

}  // namespace

AmbientOcclusion::AmbientOcclusion()
    : occlusion_("occlusion", kVertex, kOcclusion), composition_("composition", kVertex, kComposition) {}

void AmbientOcclusion::resize(int width, int height) {
  if (width == width_ && height == height_) return;
  width_ = width;
  height_ = height;
  make_texture(color_.id(), GL_RGB8, GL_RGB, GL_UNSIGNED_BYTE, width, height);
  make_texture(depth_.id(), GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_FLOAT, width, height);
  make_texture(shade_.id(), GL_R8, GL_RED, GL_UNSIGNED_BYTE, width, height);
  attach(scene_.id(), GL_COLOR_ATTACHMENT0, color_.id());
  attach(scene_.id(), GL_DEPTH_ATTACHMENT, depth_.id());
  attach(shading_.id(), GL_COLOR_ATTACHMENT0, shade_.id());
}

void AmbientOcclusion::begin(int width, int height) {
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &target_);
  resize(width, height);
  glBindFramebuffer(GL_FRAMEBUFFER, scene_.id());
}

void AmbientOcclusion::end(const Matrix4& projection, double radius) {
  glDisable(GL_DEPTH_TEST);
  glBindVertexArray(array_.id());
  glBindFramebuffer(GL_FRAMEBUFFER, shading_.id());
  occlusion_.use();
  occlusion_.set("depths", kDepthUnit);
  occlusion_.set("from_clip", inverse(projection));
  occlusion_.set("projection", projection);
  occlusion_.set("radius", static_cast<float>(radius));
  bind(kDepthUnit, depth_.id());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(target_));
  composition_.use();
  composition_.set("colors", kColorUnit);
  composition_.set("shades", kShadeUnit);
  bind(kColorUnit, color_.id());
  bind(kShadeUnit, shade_.id());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glBindVertexArray(0);
  glActiveTexture(GL_TEXTURE0);
}

}  // namespace firn
