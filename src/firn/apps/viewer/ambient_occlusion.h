#pragma once

#include <firn/apps/viewer/gl_object.h>

namespace firn {

/// Darkens corners and cracks, where less of the sky is seen, from the depths of a finished picture (Bunnell's idea in
/// the form of McGuire et al. 2011, "The alchemy screen-space ambient obscurance algorithm").
class AmbientOcclusion {
 public:
  AmbientOcclusion();

  /// What is drawn until end() goes to a picture of this size.
  void begin(int width, int height);
  /// Puts the picture into the framebuffer that was bound at begin(). @param radius m, within which things darken each
  /// other
  void end(const Matrix4& projection, double radius);

 private:
  void resize(int width, int height);

  GlProgram occlusion_, composition_;
  GlVertexArray array_;
  GlTexture color_, depth_, shade_;
  GlFramebuffer scene_, shading_;
  int width_ = 0, height_ = 0;
  GLint target_ = 0;
};

}  // namespace firn
