#pragma once

#include <epoxy/gl.h>
#include <firn/apps/viewer/orbit_camera.h>

#include <string>
#include <utility>

namespace firn {

/// A linked program of OpenGL 3.3, with its uniforms by name. All of gl_*.h, particle_cloud.h and solid_drawer.h need a
/// current context.
class GlProgram {
 public:
  /// Throws Error (resources) with the compiler's words. `name` is for that message.
  GlProgram(const char* name, const std::string& vertex, const std::string& fragment);
  ~GlProgram();
  GlProgram(const GlProgram&) = delete;
  GlProgram& operator=(const GlProgram&) = delete;

  void use() const { glUseProgram(id_); }
  void set(const char* uniform, float x) const { glUniform1f(at(uniform), x); }
  void set(const char* uniform, int x) const { glUniform1i(at(uniform), x); }
  void set(const char* uniform, const Vec3f& x) const { glUniform3fv(at(uniform), 1, x.e); }
  void set(const char* uniform, float x, float y) const { glUniform2f(at(uniform), x, y); }
  void set(const char* uniform, float x, float y, float z, float w) const { glUniform4f(at(uniform), x, y, z, w); }
  void set(const char* uniform, const Matrix4& m) const { glUniformMatrix4fv(at(uniform), 1, GL_FALSE, m.data()); }

 private:
  GLint at(const char* uniform) const { return glGetUniformLocation(id_, uniform); }
  GLuint id_ = 0;
};

/// A name from glGen..., given back by glDelete....
template <auto generate, auto remove>
class GlName {
 public:
  GlName() { (*generate)(1, &id_); }
  ~GlName() { (*remove)(1, &id_); }
  GlName(const GlName&) = delete;
  GlName& operator=(const GlName&) = delete;
  GLuint id() const { return id_; }

 private:
  GLuint id_ = 0;
};

// epoxy's functions are pointers that change when they are first called: the address of the pointer is what is
// constant.
using GlBuffer = GlName<&epoxy_glGenBuffers, &epoxy_glDeleteBuffers>;
using GlVertexArray = GlName<&epoxy_glGenVertexArrays, &epoxy_glDeleteVertexArrays>;
using GlTexture = GlName<&epoxy_glGenTextures, &epoxy_glDeleteTextures>;
using GlFramebuffer = GlName<&epoxy_glGenFramebuffers, &epoxy_glDeleteFramebuffers>;

/// A texture of one row, as colour maps and palettes are.
void upload_row(GLuint texture, int width, GLenum format, GLenum type, const void* texels, GLint internal);

/// The sun's shadows: what is nearest to it, and where a point of view space is in that picture.
struct Shadows {
  GLuint map = 0;          ///< texture of depths; 0: there are none
  Matrix4 from_view = {};  ///< to [0, 1] in all directions
};

/// Light of the day as GLSL: `vec3 lit(vec3 color, vec3 normal, float wrap, vec3 position)` with uniforms
/// sun_direction, up (in view space, as normal and position), and `vec3 displayed(vec3 light)`, the tone of the
/// ray-cast pictures (render/tone.h).
extern const char* const kDaylightGlsl;
/// Sets these uniforms; the directions are of world space, `view` turns them.
void set_daylight(const GlProgram& program, const View& scene, const Matrix4& view, const Shadows& shadows = {});

/// A plane that hides what lies beyond it, for vertex shaders: `void cut(vec3 world)`.
extern const char* const kClipGlsl;
/// Where `normal` . x > `offset`, x counting from `origin`; a zero normal hides nothing.
void set_clip(const GlProgram& program, const Vec3d& normal, double offset, const Vec3d& origin);

}  // namespace firn
