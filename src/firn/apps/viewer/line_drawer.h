#pragma once

#include <firn/apps/viewer/gl_object.h>
#include <firn/apps/viewer/grid_lines.h>
#include <firn/apps/viewer/particle_cloud.h>

#include <vector>

namespace firn {

/// Coloured lines without light.
class LineDrawer {
 public:
  LineDrawer();

  /// @param origin from which the points count, m
  void upload(const std::vector<LinePoint>& points, const Vec3d& origin);
  /// The camera's view must count from that origin too.
  void draw(const CloudCamera& camera) const;
  std::size_t count() const { return static_cast<std::size_t>(count_); }
  const Vec3d& origin() const { return origin_; }

 private:
  GlProgram program_;
  GlVertexArray array_;
  GlBuffer points_;
  int count_ = 0;
  Vec3d origin_ = {};
};

}  // namespace firn
