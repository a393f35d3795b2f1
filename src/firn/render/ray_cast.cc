#include <firn/core/parallel.h>
#include <firn/render/camera_rays.h>
#include <firn/render/daylight.h>
#include <firn/render/density_field.h>
#include <firn/render/light_buffer.h>
#include <firn/render/ray_cast.h>
#include <firn/render/ray_scene.h>

#include <cmath>
#include <numbers>

namespace firn {

namespace {

/// The sun's radius as seen from the ground, rad: larger than the true 0.0047, for shadows with visibly soft edges.
constexpr float kSunRadius = 0.02F;
/// How far a surface looks for what hides the sky, in particle spacings.
constexpr float kAmbientReach = 40;

struct Point2 {
  float x, y;
};

/// Point i of a set that fills the unit square evenly at any length (additive recurrence on the plastic number, Roberts
/// 2018).
Point2 spread_point(std::uint32_t i) {
  return {static_cast<float>(i * 0xC13FA9A9U + 0x80000000U) * 0x1p-32F,
          static_cast<float>(i * 0x91E10DA5U + 0x80000000U) * 0x1p-32F};
}

/// A number of 0 to 15 for the place in a tile of 4 x 4 pixels, in an order that keeps consecutive numbers apart.
std::uint32_t tile_number(int x, int y) {
  const auto a = static_cast<std::uint32_t>(x ^ y), b = static_cast<std::uint32_t>(y);
  return (a & 1U) << 3 | (b & 1U) << 2 | (a & 2U) | (b & 2U) >> 1;
}

/// A right-handed orthonormal frame whose third axis is n (Duff et al. 2017).
struct Frame {
  Vec3f t, b, n;
  explicit Frame(const Vec3f& axis) : n(axis) {
    const float sign = std::copysign(1.0F, n[2]);
    const float a = -1 / (sign + n[2]), c = n[0] * n[1] * a;
    t = {{1 + sign * n[0] * n[0] * a, sign * c, -sign * n[0]}};
    b = {{c, sign + n[1] * n[1] * a, -n[1]}};
  }
  Vec3f world(const Vec3f& local) const { return local[0] * t + local[1] * b + local[2] * n; }
};

RayGeometry::Ball ball_at(const Vec3f& center, float radius) { return {center[0], center[1], center[2], radius}; }

/// One sample of a pixel on its way from hit to light.
struct Surface {
  int x;
  HitKind kind;
  std::uint32_t index;
  float distance;
  Vec3f view;    ///< direction of the camera's ray
  Vec3f origin;  ///< where rays to the lights start
  Vec3f normal;  ///< for shading
  Vec3f color;
  const Look* look;
  float clear = 1;                 ///< part of its light that reaches the camera through glass
  float body = 0;                  ///< 1: part of a dense body, 0: a loose particle
  int sun_ray = -1, sky_ray = -1;  ///< indices of its rays; -1: none was sent
};

constexpr Look kSolidLook = {.name = "", .color = {}};

class Caster {
 public:
  Caster(const Snapshot& snapshot, const View& view, const Camera& camera, const ParticleLooks& looks);
  Image draw() const;

 private:
  struct Scratch {
    std::vector<Ray> rays, glass_rays, sun_rays, sky_rays;
    std::vector<Hit> hits, glass_hits;
    std::vector<float> clear;  ///< part of the light that glass lets pass, for each ray
    std::vector<Surface> surfaces;
    std::vector<std::uint8_t> sun_blocked, sky_blocked;
  };

  void choose_directions();
  static std::vector<Vec3f> local_centers(const Snapshot& snapshot, const CameraRays& rays);
  RayGeometry geometry(const View& view, const Camera& camera) const;
  void draw_row(int y, Scratch* scratch, PixelLight* row) const;
  void look_through_glass(Scratch* scratch, PixelLight* row) const;
  Surface surface_at(int x, const Ray& ray, const Hit& hit) const;
  void shape_particle(const Vec3f& place, Surface* surface) const;
  void send_rays(int sample, int y, Surface* surface, Scratch* scratch) const;
  void light(const Surface& surface, const Scratch& scratch, PixelLight* pixel) const;
  Vec3f sunlit_particle(const Surface& surface, float visible) const;
  float haze(const Surface& surface) const;

  const View& view_;
  const ParticleLooks& looks_;
  const SnapshotColumn* ids_;
  CameraRays rays_;
  Daylight day_;
  float spacing_;
  std::vector<Vec3f> centers_;
  DensityField field_;
  RayScene scene_;
  std::vector<Vec3f> plane_colors_;
  std::vector<Vec3f> sun_directions_;  ///< 16 * samples, over the disk of the sun
  std::vector<Vec3f> sky_directions_;  ///< as many, about the third axis with density cos / pi
};

/// True if the camera looks at the plane from outside.
bool is_drawn(const DrawnHalfSpace& plane, const Camera& camera) {
  return dot(camera.position - plane.point, plane.normal) > 0;
}

Vec3f color_or(const Vec3f& color, const Vec3f& other) { return color[0] < 0 ? other : color; }

Vec3f turned(const Mat3d& rotation, const Vec3f& n) {
  Vec3d wide;
  for (int i = 0; i < 3; ++i) wide[i] = n[i];
  wide = rotation * wide;
  return {{static_cast<float>(wide[0]), static_cast<float>(wide[1]), static_cast<float>(wide[2])}};
}

Caster::Caster(const Snapshot& snapshot, const View& view, const Camera& camera, const ParticleLooks& looks)
    : view_(view),
      looks_(looks),
      ids_(snapshot.find("id")),
      rays_(camera, view.width, view.height),
      // A snapshot without particles has no spacing, but its colliders still want a length to look around by.
      spacing_(snapshot.particle_spacing > 0 ? static_cast<float>(snapshot.particle_spacing)
                                             : 0.02F * rays_.target_distance()),
      centers_(local_centers(snapshot, rays_)),
      field_(centers_, spacing_),
      scene_(geometry(view, camera)) {
  for (int a = 0; a < 3; ++a) {
    day_.sun_direction[a] = static_cast<float>(normalized(view.sun_direction)[a]);
    day_.up[a] = static_cast<float>(normalized(view.up)[a]);
  }
  for (const DrawnHalfSpace& plane : view.half_spaces) {
    if (is_drawn(plane, camera)) plane_colors_.push_back(color_or(plane.color, kGroundColor));
  }
  choose_directions();
}

void Caster::choose_directions() {
  const Frame sun(day_.sun_direction);
  for (std::uint32_t i = 0; i < 16 * static_cast<std::uint32_t>(view_.samples); ++i) {
    const Point2 u = spread_point(i);
    const float angle = 2 * std::numbers::pi_v<float> * u.y, radius = std::sqrt(u.x);
    const Vec3f disk = {{radius * std::cos(angle), radius * std::sin(angle), 0}};
    sun_directions_.push_back(normalized(sun.world(kSunRadius * disk) + day_.sun_direction));
    sky_directions_.push_back({{disk[0], disk[1], std::sqrt(std::max(1 - u.x, 0.0F))}});
  }
}

std::vector<Vec3f> Caster::local_centers(const Snapshot& snapshot, const CameraRays& rays) {
  std::vector<Vec3f> centers(snapshot.size());
  parallel_chunks(centers.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) centers[p] = rays.local(snapshot.position(p));
  });
  return centers;
}

RayGeometry Caster::geometry(const View& view, const Camera& camera) const {
  RayGeometry geometry;
  geometry.particles.resize(centers_.size());
  const float radius = static_cast<float>(view.radius_per_spacing) * spacing_;
  parallel_chunks(centers_.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      // Crumbs off the body are small and of all sizes; inside it balls must overlap to close the surface.
      const float packed = smooth_step(0.1F, 0.5F, field_.sample(centers_[p]).density);
      const auto id = ids_ != nullptr ? static_cast<std::uint64_t>(value(*ids_, p)) : p;
      const float loose = 0.55F + 0.35F * mixed_unit(id, 4);
      geometry.particles[p] = ball_at(centers_[p], radius * (loose + (1.15F - loose) * packed));
    }
  });
  for (const DrawnHalfSpace& plane : view.half_spaces) {
    if (!is_drawn(plane, camera)) continue;
    const Vec3d normal = normalized(plane.normal);
    geometry.planes.push_back({rays_.local(plane.point), rays_.local(camera.target + normal)});
  }
  for (const DrawnBox& box : view.boxes) {
    RayGeometry::Box& drawn = geometry.boxes.emplace_back();
    for (int corner = 0; corner < 8; ++corner) {
      Vec3d offset;
      for (int a = 0; a < 3; ++a) offset[a] = (corner >> a & 1) != 0 ? box.half_size[a] : -box.half_size[a];
      drawn.corners[corner] = rays_.local(box.center + box.rotation * offset);
    }
  }
  for (const DrawnSphere& sphere : view.spheres) {
    geometry.spheres.push_back(ball_at(rays_.local(sphere.center), static_cast<float>(sphere.radius)));
  }
  for (const DrawnSolid& solid : view.solids) {
    RayGeometry::Solid& drawn = geometry.solids.emplace_back();
    for (const Vec3d& x : solid.surface->mesh.vertices) drawn.vertices.push_back(rays_.local(solid.at(x)));
    for (const auto& normals : solid.surface->normals) {
      for (const Vec3f& n : normals) drawn.normals.push_back(turned(solid.rotation, n));
    }
    drawn.triangles = solid.surface->mesh.triangles;
    drawn.endless = solid.endless;
    drawn.glass = solid.glass;
  }
  return geometry;
}

/// Fades what is far away into the horizon.
float Caster::haze(const Surface& surface) const {
  const float far = surface.distance / (9 * rays_.target_distance());
  return 1 - std::exp(-far * far);
}

void Caster::shape_particle(const Vec3f& place, Surface* surface) const {
  const DensityField::Sample field = field_.sample(place);
  const float steepness = norm(field.gradient) * spacing_;
  surface->body = smooth_step(0.12F, 0.45F, field.density) * smooth_step(0.01F, 0.06F, steepness);
  const float smooth = surface->look->smooth * surface->body;
  surface->normal = normalized(mix(surface->normal, normalized(-field.gradient), smooth));
  // Light is looked for from above the gaps between balls: a body of powder has no pores as wide as its particles.
  surface->origin =
      place + (spacing_ * static_cast<float>(view_.radius_per_spacing) * (0.1F + 1.4F * smooth)) * surface->normal;
}

Surface Caster::surface_at(int x, const Ray& ray, const Hit& hit) const {
  const Vec3f place = ray.origin + hit.distance * ray.direction;
  Surface s{x, hit.kind, hit.index, hit.distance, ray.direction, place, hit.normal, kColliderColor, &kSolidLook};
  if (hit.kind == HitKind::particle) {
    s.look = &looks_.looks[looks_.look_of[hit.index]];
    s.color = looks_.color[hit.index];
    shape_particle(place, &s);
    return s;
  }
  if (hit.kind == HitKind::plane) s.color = plane_colors_[hit.index];
  if (hit.kind == HitKind::box) s.color = color_or(view_.boxes[hit.index].color, kColliderColor);
  if (hit.kind == HitKind::sphere) s.color = color_or(view_.spheres[hit.index].color, kColliderColor);
  if (hit.kind == HitKind::solid) s.color = color_or(view_.solids[hit.index].color, kColliderColor);
  // Clear of the surface itself by more than the rounding of single precision at this distance.
  s.origin = place + (1e-4F * hit.distance) * hit.normal;
  return s;
}

Vec3f Caster::sunlit_particle(const Surface& s, float visible) const {
  const Look& look = *s.look;
  const float cosine = dot(s.normal, day_.sun_direction);
  // A loose particle is a crystal or a flake that light passes through, not an opaque ball.
  const float wrap = look.wrap * (2 - s.body);
  const float diffuse = std::max((cosine + wrap) / (1 + wrap), 0.0F);
  Vec3f light = visible * diffuse * product(s.color, day_.sun);
  light += (0.6F - 0.4F * cosine) * product(look.glow, day_.sun);
  const Vec3f half = normalized(day_.sun_direction - s.view);
  if (look.gloss > 0) {
    const float grazing = std::pow(1 + std::min(dot(s.normal, s.view), 0.0F), 5.0F);
    const Vec3f mirrored = s.view - (2 * dot(s.view, s.normal)) * s.normal;
    light += (look.gloss * (0.04F + 0.5F * grazing)) * day_.sky(mirrored);
    light += (visible * look.gloss * 0.8F * std::pow(std::max(dot(s.normal, half), 0.0F), 70.0F)) * day_.sun;
  }
  if (look.sparkle > 0 && visible > 0) {
    const auto id = ids_ != nullptr ? static_cast<std::uint64_t>(value(*ids_, s.index)) : s.index;
    const auto choice = static_cast<std::size_t>(mixed_bits(id, 2)) % sky_directions_.size();
    const Vec3f facet = Frame(s.normal).world(sky_directions_[choice]);
    light += (look.sparkle * smooth_step(0.985F, 0.999F, dot(facet, half))) * day_.sun;
  }
  return light;
}

void Caster::light(const Surface& s, const Scratch& t, PixelLight* pixel) const {
  const float fog = s.clear * haze(s), clear = s.clear - fog;
  const float sun_visible = s.sun_ray >= 0 && t.sun_blocked[static_cast<std::size_t>(s.sun_ray)] == 0 ? 1 : 0;
  pixel->surface += 1;
  if (s.sky_ray >= 0) {
    pixel->sky_rays += 1;
    pixel->sky_visible += t.sky_blocked[static_cast<std::size_t>(s.sky_ray)] == 0 ? 1.0F : 0.0F;
  }
  pixel->normal += s.normal;
  pixel->depth += s.distance;
  pixel->albedo += s.color;
  pixel->ambient += clear * product(s.color, day_.ambient(s.normal));
  pixel->direct += fog * day_.horizon();
  if (s.kind == HitKind::particle) {
    pixel->direct += clear * sunlit_particle(s, sun_visible);
  } else {
    pixel->flat += 1;
    pixel->sun_visible += sun_visible;
    pixel->sun += (clear * std::max(dot(s.normal, day_.sun_direction), 0.0F)) * product(s.color, day_.sun);
  }
}

void Caster::send_rays(int sample, int y, Surface* s, Scratch* t) const {
  const std::uint32_t tile = tile_number(s->x, y);
  const float wrap = s->look->wrap * (2 - s->body);
  if (dot(s->normal, day_.sun_direction) > -wrap) {  // else the sun adds nothing
    s->sun_ray = static_cast<int>(t->sun_rays.size());
    t->sun_rays.push_back({s->origin, sun_directions_[16 * static_cast<std::size_t>(sample) + tile]});
  }
  if (sample % 2 == 0) {
    s->sky_ray = static_cast<int>(t->sky_rays.size());
    const Vec3f& local = sky_directions_[8 * static_cast<std::size_t>(sample) + tile];
    t->sky_rays.push_back({s->origin, Frame(s->normal).world(local)});
  }
}

/// Thin panes: each surface mirrors the sky by Schlick's formula (1994) and lets the rest pass without bending it.
void Caster::look_through_glass(Scratch* t, PixelLight* row) const {
  constexpr int kMostSurfaces = 6;
  t->glass_rays = t->rays;
  t->glass_hits = t->hits;
  std::vector<float> left(t->hits.size());
  for (std::size_t i = 0; i < left.size(); ++i) left[i] = t->hits[i].distance;
  for (int layer = 0; layer < kMostSurfaces; ++layer) {
    scene_.intersect_glass(t->glass_rays, t->glass_hits);
    for (std::size_t i = 0; i < left.size(); ++i) {
      Hit& hit = t->glass_hits[i];
      if (hit.kind == HitKind::none) {
        left[i] = hit.distance = 0;
        continue;
      }
      Ray& ray = t->glass_rays[i];
      const float grazing = 1 + std::min(dot(hit.normal, ray.direction), 0.0F);
      const float mirrored = 0.04F + 0.96F * std::pow(grazing, 5.0F);
      const Vec3f away = ray.direction - (2 * dot(ray.direction, hit.normal)) * hit.normal;
      row[i / static_cast<std::size_t>(view_.samples)].direct += (t->clear[i] * mirrored) * day_.sky(away);
      t->clear[i] *= 1 - mirrored;
      // On by a little more than the distance, or the same surface would be met again.
      const float step = hit.distance + 1e-4F * rays_.target_distance();
      ray.origin += step * ray.direction;
      hit.distance = left[i] = std::max(left[i] - step, 0.0F);
    }
  }
}

void Caster::draw_row(int y, Scratch* t, PixelLight* row) const {
  const int samples = view_.samples, count = view_.width * samples;
  t->rays.resize(static_cast<std::size_t>(count));
  t->hits.resize(t->rays.size());
  for (int i = 0; i < count; ++i) {
    const Point2 inside = spread_point(static_cast<std::uint32_t>(i % samples));
    t->rays[static_cast<std::size_t>(i)] =
        rays_.at(static_cast<float>(i / samples) + inside.x, static_cast<float>(y) + inside.y);
  }
  scene_.intersect(t->rays, t->hits);
  t->clear.assign(t->rays.size(), 1);
  if (scene_.has_glass()) look_through_glass(t, row);

  t->surfaces.clear();
  t->sun_rays.clear();
  t->sky_rays.clear();
  for (int i = 0; i < count; ++i) {
    const Ray& ray = t->rays[static_cast<std::size_t>(i)];
    const Hit& hit = t->hits[static_cast<std::size_t>(i)];
    if (hit.kind == HitKind::none) {
      row[i / samples].direct += t->clear[static_cast<std::size_t>(i)] * day_.sky(ray.direction);
    } else {
      t->surfaces.push_back(surface_at(i / samples, ray, hit));
      t->surfaces.back().clear = t->clear[static_cast<std::size_t>(i)];
      send_rays(i % samples, y, &t->surfaces.back(), t);
    }
  }
  t->sun_blocked.resize(t->sun_rays.size());
  t->sky_blocked.resize(t->sky_rays.size());
  scene_.occluded(t->sun_rays, std::numeric_limits<float>::infinity(), true, t->sun_blocked);
  scene_.occluded(t->sky_rays, kAmbientReach * spacing_, false, t->sky_blocked);
  for (const Surface& surface : t->surfaces) light(surface, *t, &row[surface.x]);
}

Image Caster::draw() const {
  LightBuffer buffer{view_.width, view_.height, static_cast<float>(view_.samples), 4 * spacing_, {}};
  buffer.pixels.resize(static_cast<std::size_t>(view_.width) * static_cast<std::size_t>(view_.height));
  parallel_chunks(static_cast<std::size_t>(view_.height), 4, [&](std::size_t begin, std::size_t end) {
    Scratch scratch;
    for (std::size_t y = begin; y < end; ++y) {
      draw_row(static_cast<int>(y), &scratch, &buffer.pixels[y * static_cast<std::size_t>(view_.width)]);
    }
  });
  return buffer.resolve();
}

}  // namespace

Image cast_picture(const Snapshot& snapshot, const View& view, const Camera& camera, const ParticleLooks& looks) {
  return Caster(snapshot, view, camera, looks).draw();
}

}  // namespace firn
