#pragma once

#include <firn/apps/viewer/gl_object.h>
#include <firn/apps/viewer/point_thinning.h>
#include <firn/render/color_map.h>
#include <firn/render/scene_view.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace firn {

/// From where a cloud is drawn.
struct CloudCamera {
  Matrix4 view, projection;
  int height = 1;  ///< of the picture, pixels
  Thinning thinning = {};
  Vec3d clip_normal = {};  ///< hides what is beyond; zero: nothing
  double clip_offset = 0;  ///< m
  Shadows shadows = {};
};

/// The particles of a snapshot as lit balls. A snapshot is copied to the graphics memory once, positions and the one
/// column that is coloured by; sizes, colours and light are computed there.
class ParticleCloud {
 public:
  explicit ParticleCloud(bool software);

  /// Positions count from `origin()`.
  void upload(const Snapshot& snapshot);
  /// The column that view.color_by names, or the bodies if none. Call after upload. Throws Error (usage) for a column
  /// or map that there is not.
  void color(const Snapshot& snapshot, const View& view);
  void draw(const View& view, const CloudCamera& camera) const;

  std::size_t size() const { return size_; }
  const Vec3d& origin() const { return origin_; }
  /// Ends of the colour map.
  const std::array<double, 2>& range() const { return range_; }

 private:
  struct Part {
    std::size_t begin, end;
    Vec3f color;
    float wrap, jitter;
  };
  void bind_attributes(std::size_t begin, std::size_t every) const;
  void set_palette(const Snapshot& snapshot, const View& view);
  void set_color_map(const ColorMap& map);

  GlProgram program_;
  GlVertexArray array_;
  GlBuffer positions_, values_;
  GlTexture map_, palette_;
  std::vector<Part> parts_;
  std::size_t size_ = 0;
  Vec3d origin_ = {};
  float spacing_ = 0;
  int dimension_ = 3;
  bool has_values_ = false;
  bool by_column_ = false;
  std::array<double, 2> range_ = {0, 1};
};

}  // namespace firn
