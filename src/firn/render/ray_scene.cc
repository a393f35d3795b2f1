#include <firn/core/error.h>
#include <firn/render/ray_scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace firn {

namespace {

constexpr unsigned kParticles = 0, kBoxes = 1, kSpheres = 2, kSolids = 3;  // Embree geometry ids, solids last
constexpr unsigned kLanes = 8;

/// Two triangles per face; corner bits as in RayGeometry::Box.
constexpr unsigned kBoxTriangles[12][3] = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                                           {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};

/// Distance along the ray to the plane, infinite if it is not met.
float distance_to(const RayGeometry::Plane& plane, const Ray& ray) {
  const float speed = dot(ray.direction, plane.normal);
  if (speed >= 0) return std::numeric_limits<float>::infinity();  // planes have one side: the camera is outside
  const float distance = dot(plane.point - ray.origin, plane.normal) / speed;
  return distance > 0 ? distance : std::numeric_limits<float>::infinity();
}

template <class Packet>
void load(Packet& packet, unsigned lane, const Ray& ray, float reach) {
  packet.org_x[lane] = ray.origin[0];
  packet.org_y[lane] = ray.origin[1];
  packet.org_z[lane] = ray.origin[2];
  packet.dir_x[lane] = ray.direction[0];
  packet.dir_y[lane] = ray.direction[1];
  packet.dir_z[lane] = ray.direction[2];
  packet.tnear[lane] = 0;
  packet.tfar[lane] = reach;
  packet.time[lane] = 0;
  packet.mask[lane] = ~0U;
  packet.id[lane] = 0;
  packet.flags[lane] = 0;
}

RTCIntersectContext make_context(bool coherent) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  return context;
}

/// Rejects hits on the back of a triangle.
void keep_front(const RTCFilterFunctionNArguments* args) {
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] != -1) continue;
    const Vec3f normal = {{RTCHitN_Ng_x(args->hit, args->N, i), RTCHitN_Ng_y(args->hit, args->N, i),
                           RTCHitN_Ng_z(args->hit, args->N, i)}};
    const Vec3f direction = {{RTCRayN_dir_x(args->ray, args->N, i), RTCRayN_dir_y(args->ray, args->N, i),
                              RTCRayN_dir_z(args->ray, args->N, i)}};
    if (dot(normal, direction) > 0) args->valid[i] = 0;
  }
}

void keep_none(const RTCFilterFunctionNArguments* args) { std::fill_n(args->valid, args->N, 0); }

}  // namespace

RayScene::RayScene(RayGeometry geometry) : geometry_(std::move(geometry)) {
  device_ = rtcNewDevice(nullptr);
  scene_ = device_ != nullptr ? rtcNewScene(device_) : nullptr;
  if (scene_ == nullptr) {
    const int code = rtcGetDeviceError(device_);
    if (device_ != nullptr) rtcReleaseDevice(device_);
    throw Error(ErrorKind::resources, fmt::format("cannot draw: Embree failed to start (error {})", code));
  }
  add_balls(geometry_.particles, kParticles);
  add_boxes(kBoxes);
  add_balls(geometry_.spheres, kSpheres);
  for (std::size_t i = 0; i < geometry_.solids.size(); ++i) {
    add_solid(geometry_.solids[i], kSolids + static_cast<unsigned>(i));
  }
  commit(scene_);
  if (glass_ != nullptr) commit(glass_);
  if (const RTCError code = rtcGetDeviceError(device_); code != RTC_ERROR_NONE) {
    if (glass_ != nullptr) rtcReleaseScene(glass_);
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
    throw Error(ErrorKind::resources, fmt::format("cannot draw: Embree failed (error {}) on {} particles",
                                                  static_cast<int>(code), geometry_.particles.size()));
  }
}

RayScene::~RayScene() {
  if (glass_ != nullptr) rtcReleaseScene(glass_);
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

void RayScene::commit(RTCScene scene) const {
  rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
  rtcCommitScene(scene);
}

void RayScene::add_balls(const std::vector<RayGeometry::Ball>& balls, unsigned id) {
  if (balls.empty()) return;
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_SPHERE_POINT);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, balls.data(), 0,
                             sizeof(RayGeometry::Ball), balls.size());
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene_, geometry, id);
  rtcReleaseGeometry(geometry);
}

void RayScene::add_boxes(unsigned id) {
  if (geometry_.boxes.empty()) return;
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  const std::size_t count = geometry_.boxes.size();
  auto* vertices = static_cast<float*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 8 * count));
  auto* triangles = static_cast<unsigned*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), 12 * count));
  for (std::size_t b = 0; b < count && vertices != nullptr && triangles != nullptr; ++b) {
    for (const Vec3f& corner : geometry_.boxes[b].corners) vertices = std::copy(corner.e, corner.e + 3, vertices);
    for (const auto& triangle : kBoxTriangles) {
      for (const unsigned corner : triangle) *triangles++ = static_cast<unsigned>(8 * b) + corner;
    }
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene_, geometry, id);
  rtcReleaseGeometry(geometry);
}

void RayScene::add_solid(const RayGeometry::Solid& solid, unsigned id) {
  if (solid.triangles.empty()) return;
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               3 * sizeof(float), solid.vertices.size()));
  auto* corners = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                 3 * sizeof(unsigned), solid.triangles.size()));
  if (vertices != nullptr && corners != nullptr) {
    for (const Vec3f& x : solid.vertices) vertices = std::copy(x.e, x.e + 3, vertices);
    for (const auto& triangle : solid.triangles) {
      for (const std::int32_t corner : triangle) *corners++ = static_cast<unsigned>(corner);
    }
  }
  if (solid.endless) {
    rtcSetGeometryIntersectFilterFunction(geometry, keep_front);
    rtcSetGeometryOccludedFilterFunction(geometry, keep_none);
  }
  rtcCommitGeometry(geometry);
  if (solid.glass && glass_ == nullptr) glass_ = rtcNewScene(device_);
  rtcAttachGeometryByID(solid.glass ? glass_ : scene_, geometry, id);
  rtcReleaseGeometry(geometry);
}

Hit RayScene::hit_of(const Ray& ray, const RTCRayHit8& packet, unsigned lane) const {
  Hit hit;
  const unsigned id = packet.hit.geomID[lane], primitive = packet.hit.primID[lane];
  hit.distance = id != RTC_INVALID_GEOMETRY_ID ? packet.ray.tfar[lane] : std::numeric_limits<float>::infinity();
  if (id == kBoxes) {
    hit.kind = HitKind::box;
    hit.index = primitive / 12;
    hit.normal = normalized(Vec3f{{packet.hit.Ng_x[lane], packet.hit.Ng_y[lane], packet.hit.Ng_z[lane]}});
    if (dot(hit.normal, ray.direction) > 0) hit.normal = -hit.normal;
  } else if (id != RTC_INVALID_GEOMETRY_ID && id >= kSolids) {
    hit.kind = HitKind::solid;
    hit.index = id - kSolids;
    const float u = packet.hit.u[lane], v = packet.hit.v[lane];
    const Vec3f* n = geometry_.solids[hit.index].normals.data() + 3 * std::size_t(primitive);
    hit.normal = normalized((1 - u - v) * n[0] + u * n[1] + v * n[2]);
    if (dot(hit.normal, ray.direction) > 0) hit.normal = -hit.normal;
  } else if (id != RTC_INVALID_GEOMETRY_ID) {
    hit.kind = id == kParticles ? HitKind::particle : HitKind::sphere;
    hit.index = primitive;
    const RayGeometry::Ball& ball = (id == kParticles ? geometry_.particles : geometry_.spheres)[primitive];
    hit.normal = normalized(ray.origin + hit.distance * ray.direction - Vec3f{{ball.x, ball.y, ball.z}});
  }
  return hit;
}

template <class Answer>
void RayScene::cast(RTCScene scene, std::span<const Ray> rays, std::span<Hit> hits, const Answer& answer) {
  RTCIntersectContext context = make_context(true);
  for (std::size_t begin = 0; begin < rays.size(); begin += kLanes) {
    const auto count = static_cast<unsigned>(std::min<std::size_t>(kLanes, rays.size() - begin));
    alignas(32) int valid[kLanes] = {};
    RTCRayHit8 packet;
    for (unsigned lane = 0; lane < count; ++lane) {
      valid[lane] = -1;
      load(packet.ray, lane, rays[begin + lane], hits[begin + lane].distance);
      packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
      packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect8(valid, scene, &context, &packet);
    for (unsigned lane = 0; lane < count; ++lane) hits[begin + lane] = answer(rays[begin + lane], packet, lane);
  }
}

void RayScene::intersect(std::span<const Ray> rays, std::span<Hit> hits) const {
  for (Hit& hit : hits) hit.distance = std::numeric_limits<float>::infinity();
  cast(scene_, rays, hits, [this](const Ray& ray, const RTCRayHit8& packet, unsigned lane) {
    Hit hit = hit_of(ray, packet, lane);
    for (std::size_t i = 0; i < geometry_.planes.size(); ++i) {
      const float distance = distance_to(geometry_.planes[i], ray);
      if (distance < hit.distance) {
        hit = {HitKind::plane, static_cast<std::uint32_t>(i), distance, geometry_.planes[i].normal};
      }
    }
    return hit;
  });
}

void RayScene::intersect_glass(std::span<const Ray> rays, std::span<Hit> hits) const {
  cast(glass_, rays, hits,
       [this](const Ray& ray, const RTCRayHit8& packet, unsigned lane) { return hit_of(ray, packet, lane); });
}

void RayScene::occluded(std::span<const Ray> rays, float reach, bool coherent, std::span<std::uint8_t> blocked) const {
  RTCIntersectContext context = make_context(coherent);
  for (std::size_t begin = 0; begin < rays.size(); begin += kLanes) {
    const auto count = static_cast<unsigned>(std::min<std::size_t>(kLanes, rays.size() - begin));
    alignas(32) int valid[kLanes] = {};
    RTCRay8 packet;
    for (unsigned lane = 0; lane < count; ++lane) {
      const Ray& ray = rays[begin + lane];
      bool by_plane = false;
      for (const RayGeometry::Plane& plane : geometry_.planes) by_plane |= distance_to(plane, ray) < reach;
      blocked[begin + lane] = by_plane ? 1 : 0;
      valid[lane] = by_plane ? 0 : -1;
      load(packet, lane, ray, reach);
    }
    rtcOccluded8(valid, scene_, &context, &packet);
    for (unsigned lane = 0; lane < count; ++lane) {
      if (valid[lane] != 0 && packet.tfar[lane] < 0) blocked[begin + lane] = 1;  // Embree sets -infinity
    }
  }
}

}  // namespace firn
