#include <firn/core/log.h>
#include <firn/geometry/prepare_mesh.h>
#include <firn/io/mesh_reader.h>
#include <firn/scene/body_region.h>
#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace firn {
namespace {

double metres_per_unit(BodySettings::Units units) {
  switch (units) {
    case BodySettings::Units::m:
      return 1;
    case BodySettings::Units::cm:
      return 1e-2;
    case BodySettings::Units::mm:
      return 1e-3;
  }
  return 1;
}

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

/// A region that was turned about its centre, for the analytic shapes, whose own regions stand upright.
template <int dim>
class TurnedRegion final : public Region<dim> {
 public:
  TurnedRegion(std::unique_ptr<Region<dim>> upright, const Mat<double, dim>& rotation, const Vec<double, dim>& position)
      : upright_(std::move(upright)), rotation_(rotation), inverse_(transpose(rotation)), position_(position) {}

  Bounds<dim> bounds() const override { return turned(upright_->bounds(), rotation_, Vec<double, dim>{}, position_); }
  double volume() const override { return upright_->volume(); }
  double surface() const override { return upright_->surface(); }
  bool contains(const Vec<double, dim>& x) const override { return upright_->contains(inverse_ * (x - position_)); }
  bool may_overlap(const Bounds<dim>& box) const override {
    return upright_->may_overlap(turned(box, inverse_, position_, Vec<double, dim>{}));
  }

 private:
  /// Bounds of what lies in `box`, after x -> rotation (x - before) + after.
  static Bounds<dim> turned(const Bounds<dim>& box, const Mat<double, dim>& rotation, const Vec<double, dim>& before,
                            const Vec<double, dim>& after) {
    const Vec<double, dim> centre = rotation * (box.center() - before) + after;
    const Vec<double, dim> half = 0.5 * box.size();
    Vec<double, dim> reach = {};
    for (int i = 0; i < dim; ++i) {
      for (int j = 0; j < dim; ++j) reach[i] += std::abs(rotation(i, j)) * half[j];
    }
    return {centre - reach, centre + reach};
  }

  std::unique_ptr<Region<dim>> upright_;
  Mat<double, dim> rotation_, inverse_;
  Vec<double, dim> position_;
};

std::unique_ptr<Region<3>> mesh_region(const Scene& scene, const BodySettings& body) {
  PreparedMesh prepared =
      prepare_mesh(read_mesh(scene.locate(body.mesh)), scene.locate(body.mesh).string(), scene.strict_mesh);
  apply(placement_of(body), prepared.mesh);
  auto region = std::make_unique<MeshRegion>(prepared.mesh);
  if (region->inside().has_overlaps()) {
    log_warning(fmt::format("{}: parts of the surface overlap; what lies inside several of them is filled once",
                            scene.locate(body.mesh).string()));
  }
  return region;
}

std::unique_ptr<Region<2>> polygon_region(const Scene& scene, const BodySettings& body) {
  Polygon polygon = read_polygon(scene.locate(body.polygon));
  const Mat<double, 2> rotation = plane_rotation_from_degrees(body.rotation);
  const double scale = body.scale * metres_per_unit(body.units);
  for (auto& loop : polygon.loops) {
    for (Vec2d& point : loop) point = rotation * (scale * point) + in_plane(body.position);
  }
  return std::make_unique<PolygonRegion>(std::move(polygon));
}

}  // namespace

Placement placement_of(const BodySettings& body) {
  return {body.scale * metres_per_unit(body.units), rotation_from_degrees(body.rotation), body.position};
}

Mat3d rotation_from_degrees(const Vec3d& degrees) {
  Mat3d rotation = identity<double, 3>();
  for (int axis = 0; axis < 3; ++axis) {
    const double c = std::cos(radians(degrees[axis])), s = std::sin(radians(degrees[axis]));
    const int i = (axis + 1) % 3, j = (axis + 2) % 3;
    Mat3d turn = identity<double, 3>();
    turn(i, i) = turn(j, j) = c;
    turn(i, j) = -s;
    turn(j, i) = s;
    rotation = turn * rotation;
  }
  return rotation;
}

Mat<double, 2> plane_rotation_from_degrees(const Vec3d& degrees) {
  const double c = std::cos(radians(degrees[2])), s = std::sin(radians(degrees[2]));
  return {{c, -s, s, c}};
}

template <>
std::unique_ptr<Region<3>> body_region<3>(const Scene& scene, const BodySettings& body) {
  if (!body.mesh.empty()) return mesh_region(scene, body);
  std::unique_ptr<Region<3>> upright;
  if (body.shape == BodySettings::Shape::box) {
    upright = std::make_unique<BoxRegion<3>>(0.5 * body.scale * body.size);
  } else {
    upright = std::make_unique<SphereRegion<3>>(body.scale * body.radius);
  }
  return std::make_unique<TurnedRegion<3>>(std::move(upright), rotation_from_degrees(body.rotation), body.position);
}

template <>
std::unique_ptr<Region<2>> body_region<2>(const Scene& scene, const BodySettings& body) {
  if (!body.polygon.empty()) return polygon_region(scene, body);
  std::unique_ptr<Region<2>> upright;
  if (body.shape == BodySettings::Shape::box) {
    upright = std::make_unique<BoxRegion<2>>(0.5 * body.scale * in_plane(body.size));
  } else {
    upright = std::make_unique<SphereRegion<2>>(body.scale * body.radius);
  }
  return std::make_unique<TurnedRegion<2>>(std::move(upright), plane_rotation_from_degrees(body.rotation),
                                           in_plane(body.position));
}

}  // namespace firn
