#include <firn/apps/viewer/picker.h>
#include <firn/render/color_map.h>
#include <firn/scene/schema.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace firn {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

/// Where the ray enters a ball; infinite if it passes by.
double enter_ball(const Ray& ray, const Vec3d& center, double radius) {
  const Vec3d to = center - ray.origin;
  const double along = dot(to, ray.direction), square = radius * radius - (dot(to, to) - along * along);
  if (square < 0) return kNone;
  const double at = along - std::sqrt(square);
  return at > 0 ? at : kNone;
}

double enter_box(const Ray& ray, const DrawnBox& box) {
  double in = 0, out = kNone;
  const Vec3d to = transpose(box.rotation) * (ray.origin - box.center), along = transpose(box.rotation) * ray.direction;
  for (int i = 0; i < 3; ++i) {
    const double half = std::max(box.half_size[i], 1e-9);
    if (std::abs(along[i]) < 1e-12) {
      if (std::abs(to[i]) > half) return kNone;
      continue;
    }
    const double a = (-half - to[i]) / along[i], b = (half - to[i]) / along[i];
    in = std::max(in, std::min(a, b));
    out = std::min(out, std::max(a, b));
  }
  return in < out && in > 0 ? in : kNone;
}

double enter_half_space(const Ray& ray, const DrawnHalfSpace& solid) {
  const double height = dot(ray.origin - solid.point, solid.normal), rate = dot(ray.direction, solid.normal);
  // Seen along its edge, as in 2D, the solid itself is what one sees.
  if (height <= 0) return std::abs(rate) < 1e-9 ? norm(ray.origin) : kNone;
  return rate < 0 ? -height / rate : kNone;
}

/// Moeller and Trumbore's test of each triangle.
double enter_surface(const Ray& ray, const DrawnSolid& solid) {
  double first = kNone;
  const TriangleMesh& mesh = solid.surface->mesh;
  const Vec3d o = (1 / solid.scale) * (transpose(solid.rotation) * (ray.origin - solid.origin));
  const Vec3d d = (1 / solid.scale) * (transpose(solid.rotation) * ray.direction);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3d a = mesh.corner(t, 0), u = mesh.corner(t, 1) - a, v = mesh.corner(t, 2) - a;
    const Vec3d p = cross(d, v);
    const double det = dot(u, p);
    if (det == 0) continue;
    const Vec3d s = o - a, q = cross(s, u);
    const double x = dot(s, p) / det, y = dot(d, q) / det, at = dot(v, q) / det;
    if (x >= 0 && y >= 0 && x + y <= 1 && at > 0) first = std::min(first, at);
  }
  return first;
}

std::string value_text(const SnapshotColumn& column, std::size_t p) {
  if (column.components == 1) return fmt::format("{:.6g} {}", value(column, p), column.unit);
  if (column.components > 3) return fmt::format("|.| = {:.6g} {}", color_value(column, p), column.unit);
  return fmt::format("({:.4g}, {:.4g}, {:.4g}) {}", value(column, p, 0), value(column, p, 1), value(column, p, 2),
                     column.unit);
}

}  // namespace

Picked pick(const Snapshot& snapshot, const View& view, const Ray& ray, const std::pair<Vec3d, double>& hidden) {
  Picked picked;
  double first = kNone;
  const auto meet = [&](double at, int collider) {
    if (!(at < first)) return;
    first = at;
    picked = {Picked::Kind::collider, 0, collider, ray.origin + at * ray.direction};
  };
  for (const DrawnHalfSpace& solid : view.half_spaces) meet(enter_half_space(ray, solid), solid.collider);
  for (const DrawnBox& box : view.boxes) meet(enter_box(ray, box), box.collider);
  for (const DrawnSphere& sphere : view.spheres) meet(enter_ball(ray, sphere.center, sphere.radius), sphere.collider);
  for (const DrawnSolid& solid : view.solids) {
    if (!solid.glass && solid.surface) meet(enter_surface(ray, solid), solid.collider);
  }
  // Of 2D, particles lie in front of everything else.
  if (snapshot.dimension == 2) first = kNone;
  const double radius = view.radius_per_spacing * snapshot.particle_spacing;
  std::optional<std::size_t> nearest;
  for (std::size_t p = 0; p < snapshot.size(); ++p) {
    const Vec3d x = snapshot.position(p);
    const double at = enter_ball(ray, x, radius);
    if (!(at < first) || dot(hidden.first, x) > hidden.second) continue;
    first = at;
    nearest = p;
  }
  if (!nearest) return picked;
  const SnapshotColumn* id = snapshot.find("id");
  picked = {Picked::Kind::particle, id != nullptr ? static_cast<std::int64_t>(value(*id, *nearest)) : 0, -1,
            snapshot.position(*nearest)};
  return picked;
}

std::optional<std::size_t> find_particle(const Snapshot& snapshot, std::int64_t id) {
  const SnapshotColumn* ids = snapshot.find("id");
  if (ids == nullptr) return std::nullopt;
  for (std::size_t p = 0; p < snapshot.size(); ++p) {
    if (static_cast<std::int64_t>(value(*ids, p)) == id) return p;
  }
  return std::nullopt;
}

std::vector<Reading> read_particle(const Snapshot& snapshot, std::size_t particle) {
  std::vector<Reading> readings;
  for (const SnapshotColumn& column : snapshot.columns) {
    std::string text = value_text(column, particle);
    const auto named = [&](const auto& names, const auto& name_of) {
      const auto i = static_cast<std::size_t>(value(column, particle));
      if (i < names.size()) text = name_of(names[i]);
    };
    if (column.name == "body") named(snapshot.bodies, [](const std::string& name) { return name; });
    if (column.name == "material") named(snapshot.materials, [](const SnapshotMaterial& m) { return m.name; });
    readings.push_back({column.name, text});
    if (column.name == "velocity") {
      readings.push_back({"speed", fmt::format("{:.6g} {}", color_value(column, particle), column.unit)});
    }
  }
  return readings;
}

std::vector<Reading> read_cell(const Snapshot& snapshot, const Vec3d& point) {
  const double dx = snapshot.cell_size;
  if (!(dx > 0)) return {};
  const auto cell_of = [&](const Vec3d& x, int d) { return static_cast<std::int64_t>(std::floor(x[d] / dx)); };
  const int dim = snapshot.dimension;
  std::vector<std::size_t> inside;
  for (std::size_t p = 0; p < snapshot.size(); ++p) {
    const Vec3d x = snapshot.position(p);
    bool same = true;
    for (int d = 0; d < dim; ++d) same = same && cell_of(x, d) == cell_of(point, d);
    if (same) inside.push_back(p);
  }
  std::vector<Reading> readings;
  std::string place = fmt::format("{}, {}", cell_of(point, 0), cell_of(point, 1));
  if (dim == 3) place += fmt::format(", {}", cell_of(point, 2));
  readings.push_back({"cell", fmt::format("({}), {:.4g} m wide", place, dx)});
  readings.push_back({"particles in it", std::to_string(inside.size())});
  for (const SnapshotColumn& column : snapshot.columns) {
    if (inside.empty() || column.name == "id" || column.name == "body" || column.name == "material") continue;
    if (column.name == "position" || column.components > 3) continue;
    Vec3d mean = {};
    for (const std::size_t p : inside) {
      for (int c = 0; c < column.components; ++c) mean[c] += value(column, p, c) / static_cast<double>(inside.size());
    }
    readings.push_back({"mean " + column.name,
                        column.components == 1
                            ? fmt::format("{:.6g} {}", mean[0], column.unit)
                            : fmt::format("({:.4g}, {:.4g}, {:.4g}) {}", mean[0], mean[1], mean[2], column.unit)});
  }
  return readings;
}

std::vector<Reading> read_collider(const Scene& scene, int collider, const FrameReport& report) {
  if (collider < 0 || static_cast<std::size_t>(collider) >= scene.colliders.size()) return {};
  const auto i = static_cast<std::size_t>(collider);
  const ColliderSettings& settings = scene.colliders[i];
  std::vector<Reading> readings = {{"collider", settings.name}};
  const Section& section = *find_section("collider");
  for (const char* name : {"shape", "contact"}) {
    if (const auto value = section.find(name)->get(&settings))
      readings.push_back({name, std::get<std::string>(*value)});
  }
  readings.push_back({"friction", fmt::format("{:.4g}", settings.friction)});
  if (i >= report.colliders.size()) return readings;
  const ColliderReport& load = report.colliders[i];
  const auto vector = [](const Vec3d& v) { return fmt::format("({:.4g}, {:.4g}, {:.4g})", v[0], v[1], v[2]); };
  readings.push_back({"force on it", vector(load.force) + (scene.dimension == 2 ? " N/m" : " N")});
  readings.push_back({"torque on it", vector(load.torque) + (scene.dimension == 2 ? " N" : " N m")});
  readings.push_back({"particles inside", std::to_string(load.inside.particles)});
  return readings;
}

}  // namespace firn
