#include <firn/apps/viewer/gl_object.h>
#include <firn/core/error.h>
#include <firn/render/daylight.h>
#include <fmt/format.h>

#include <vector>

namespace firn {
namespace {

constexpr int kShadowUnit = 4;

GLuint compile(const char* name, GLenum kind, const std::string& text) {
  const std::string full = "#version 330 core\n" + text;
  const char* source = full.c_str();
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  GLint good = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (good != 0) return shader;
  std::vector<char> log(2000);
  glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
  glDeleteShader(shader);
  std::string line(log.data());
  for (char& c : line) c = c == '\n' ? ' ' : c;
  throw Error(ErrorKind::resources, fmt::format("the OpenGL driver does not compile the {} shader: {}", name, line));
}

Vec3f direction_in_view(const Vec3d& world, const Matrix4& view) {
  const Vec3d d = normalized(world);
  Vec3f r;
  for (int i = 0; i < 3; ++i) {
    r[i] = 0;
    for (int j = 0; j < 3; ++j) r[i] += view[static_cast<std::size_t>(4 * j + i)] * static_cast<float>(d[j]);
  }
  return r;
}

}  // namespace

GlProgram::GlProgram(const char* name, const std::string& vertex, const std::string& fragment)
    : id_(glCreateProgram()) {
  const GLuint vertex_shader = compile(name, GL_VERTEX_SHADER, vertex);
  const GLuint fragment_shader = compile(name, GL_FRAGMENT_SHADER, fragment);
  glAttachShader(id_, vertex_shader);
  glAttachShader(id_, fragment_shader);
  glLinkProgram(id_);
  glDeleteShader(vertex_shader);
  glDeleteShader(fragment_shader);
  GLint good = 0;
  glGetProgramiv(id_, GL_LINK_STATUS, &good);
  if (good == 0) {
    throw Error(ErrorKind::resources, fmt::format("the OpenGL driver does not link the {} shaders", name));
  }
}

GlProgram::~GlProgram() {
  // Whoever restores the state later must not come back to a program that is gone.
  GLint current = 0;
  glGetIntegerv(GL_CURRENT_PROGRAM, &current);
  if (static_cast<GLuint>(current) == id_) glUseProgram(0);
  glDeleteProgram(id_);
}

void upload_row(GLuint texture, int width, GLenum format, GLenum type, const void* texels, GLint internal) {
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, internal, width, 1, 0, format, type, texels);
}

const char* const kDaylightGlsl = R"(
uniform vec3 sun_direction, up, sun_light, sky_light, ground_light;
uniform int shadows;
uniform sampler2DShadow shadow_map;
uniform mat4 shadow_from_view;
// The mean of sixteen places around the point: the edge of a shadow is as soft as the sun is wide, about.
float sunlit(vec3 position, vec3 normal) {
  if (shadows == 0) return 1.0;
  vec3 at = (shadow_from_view * vec4(position, 1.0)).xyz;
  if (any(lessThan(at, vec3(0.0))) || any(greaterThan(at, vec3(1.0)))) return 1.0;
  float texel = 1.0 / float(textureSize(shadow_map, 0).x);
  float slope = 1.0 - max(dot(normal, sun_direction), 0.0);
  float depth = at.z - texel * (1.5 + 4.0 * slope), sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      sum += texture(shadow_map, vec3(at.xy + 1.3 * texel * (vec2(i, j) - 1.5), depth));
    }
  }
  return sum / 16.0;
}
vec3 lit(vec3 color, vec3 normal, float wrap, vec3 position) {
  float direct = max((dot(normal, sun_direction) + wrap) / (1.0 + wrap), 0.0) * sunlit(position, normal);
  return color * (direct * sun_light + mix(ground_light, sky_light, 0.5 + 0.5 * dot(normal, up)));
}
vec3 displayed(vec3 light) {
  vec3 y = mix(light, 0.6 + 0.4 * (1.0 - exp(-(light - 0.6) / 0.4)), greaterThan(light, vec3(0.6)));
  return mix(12.92 * y, 1.055 * pow(max(y, 0.0), vec3(1.0 / 2.4)) - 0.055, greaterThan(y, vec3(0.0031308)));
}
)";

const char* const kClipGlsl = R"(
uniform vec4 clip_plane;
void cut(vec3 world) { gl_ClipDistance[0] = clip_plane.w - dot(clip_plane.xyz, world); }
)";

void set_clip(const GlProgram& program, const Vec3d& normal, double offset, const Vec3d& origin) {
  const bool none = norm(normal) == 0;
  program.set("clip_plane", static_cast<float>(normal[0]), static_cast<float>(normal[1]), static_cast<float>(normal[2]),
              none ? 1.0F : static_cast<float>(offset - dot(normal, origin)));
}

void set_daylight(const GlProgram& program, const View& scene, const Matrix4& view, const Shadows& shadows) {
  // A sampler must have a unit of its own kind even where it is not read.
  program.set("shadow_map", kShadowUnit);
  program.set("shadows", shadows.map != 0 ? 1 : 0);
  program.set("shadow_from_view", shadows.from_view);
  glActiveTexture(GL_TEXTURE0 + kShadowUnit);
  glBindTexture(GL_TEXTURE_2D, shadows.map);
  glActiveTexture(GL_TEXTURE0);
  const Daylight day{.sun_direction = {}, .up = {{0, 1, 0}}};
  program.set("sun_direction", direction_in_view(scene.sun_direction, view));
  program.set("up", direction_in_view(scene.up, view));
  program.set("sun_light", day.sun);
  program.set("sky_light", day.ambient({{0, 1, 0}}));
  program.set("ground_light", day.ambient({{0, -1, 0}}));
}

}  // namespace firn
