#pragma once

#include <embree3/rtcore.h>
#include <firn/core/linear_algebra.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace firn {

struct Ray {
  Vec3f origin, direction;  ///< m, unit vector
};

enum class HitKind : std::uint8_t { none, particle, plane, box, sphere, solid };

struct Hit {
  HitKind kind = HitKind::none;
  std::uint32_t index = 0;  ///< of the particle, plane, box, sphere or solid
  float distance = 0;       ///< m
  Vec3f normal = {};        ///< outward, of unit length
};

/// What rays can meet: balls for particles, half spaces, boxes, balls, meshes. In m relative to an origin of the
/// caller's choice near the picture, because rays are in single precision.
struct RayGeometry {
  struct Ball {
    float x, y, z, radius;
  };
  struct Plane {
    Vec3f point, normal;
  };
  struct Box {
    Vec3f corners[8];  ///< corner i is at (+ or -) along axis a by bit a of i
  };
  struct Solid {
    std::vector<Vec3f> vertices;
    std::vector<std::array<std::int32_t, 3>> triangles;
    std::vector<Vec3f> normals;  ///< three for each triangle
    bool endless = false;        ///< met from outside only, and by no shadow ray
    bool glass = false;          ///< met by intersect_glass alone
  };
  std::vector<Ball> particles;
  std::vector<Plane> planes;
  std::vector<Box> boxes;
  std::vector<Ball> spheres;
  std::vector<Solid> solids;
};

/// Nearest hits and visibility through Embree, by groups of rays that lie close together. Answers do not depend on the
/// number of threads.
class RayScene {
 public:
  /// Throws Error (resources) if Embree fails.
  explicit RayScene(RayGeometry geometry);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  /// hits[i] for rays[i].
  void intersect(std::span<const Ray> rays, std::span<Hit> hits) const;

  bool has_glass() const { return glass_ != nullptr; }
  /// Nearest surfaces of glass within hits[i].distance, which the answers replace: `none` where there is none.
  void intersect_glass(std::span<const Ray> rays, std::span<Hit> hits) const;

  /// blocked[i] is 1 if ray i meets anything within reach m, else 0. coherent: the rays have nearly one direction.
  void occluded(std::span<const Ray> rays, float reach, bool coherent, std::span<std::uint8_t> blocked) const;

 private:
  void add_balls(const std::vector<RayGeometry::Ball>& balls, unsigned id);
  void add_boxes(unsigned id);
  void add_solid(const RayGeometry::Solid& solid, unsigned id);
  void commit(RTCScene scene) const;
  template <class Answer>
  static void cast(RTCScene scene, std::span<const Ray> rays, std::span<Hit> hits, const Answer& answer);
  Hit hit_of(const Ray& ray, const RTCRayHit8& packet, unsigned lane) const;

  RayGeometry geometry_;
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
  RTCScene glass_ = nullptr;  ///< null without glass
};

}  // namespace firn
