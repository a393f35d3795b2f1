#include <firn/core/error.h>
#include <firn/geometry/closest_point.h>
#include <firn/io/painted_mesh.h>
#include <firn/scene/body_region.h>
#include <firn/scene/painted_field.h>
#include <fmt/format.h>

#include <utility>

namespace firn {
namespace {

PaintedMesh placed_mesh(const Scene& scene, const BodySettings& body, const std::string& attribute) {
  if (body.mesh.empty()) {
    throw Error(ErrorKind::usage,
                fmt::format("body \"{}\": the attribute \"{}\" of its material {} can only be painted on a mesh; give "
                            "mesh = \"...ply\", or a formula instead of the attribute",
                            body.name, attribute, body.material));
  }
  PaintedMesh painted = read_painted_mesh(scene.locate(body.mesh), attribute);
  apply(placement_of(body), painted.mesh);
  return painted;
}

}  // namespace

PaintedField::PaintedField(const Scene& scene, const BodySettings& body, const std::string& attribute)
    : PaintedField(placed_mesh(scene, body, attribute)) {}

PaintedField::PaintedField(PaintedMesh painted)
    : mesh_(std::move(painted.mesh)), values_(std::move(painted.values)), tree_(mesh_) {}

double PaintedField::at(const Vec3d& x) const {
  const ClosestPoint nearest = closest_point(tree_, x);
  const Vec3d &a = mesh_.corner(nearest.triangle, 0), &b = mesh_.corner(nearest.triangle, 1),
              &c = mesh_.corner(nearest.triangle, 2);
  const Vec3d normal = cross(b - a, c - a);
  const double area = dot(normal, normal);
  const auto& corners = mesh_.triangles[nearest.triangle];
  const auto value = [&](std::size_t i) { return values_[static_cast<std::size_t>(corners[i])]; };
  if (!(area > 0)) return value(0);
  const double of_a = dot(cross(c - b, nearest.point - b), normal) / area;
  const double of_b = dot(cross(a - c, nearest.point - c), normal) / area;
  return of_a * value(0) + of_b * value(1) + (1 - of_a - of_b) * value(2);
}

}  // namespace firn
