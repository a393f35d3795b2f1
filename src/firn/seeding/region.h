#pragma once

#include <firn/geometry/bounds.h>
#include <firn/geometry/inside_grid.h>
#include <firn/geometry/mesh_inside.h>
#include <firn/geometry/polygon.h>
#include <firn/geometry/shapes.h>

namespace firn {

/// A bounded solid that can be filled with samples.
template <int dim>
class Region {
 public:
  virtual ~Region() = default;

  virtual Bounds<dim> bounds() const = 0;
  /// Area in 2D (m^2), volume in 3D (m^3).
  virtual double volume() const = 0;
  /// Length of the outline in 2D (m), area of the surface in 3D (m^2).
  virtual double surface() const = 0;
  virtual bool contains(const Vec<double, dim>& x) const = 0;
  /// False without much work for most points that are outside; true says nothing.
  virtual bool may_contain(const Vec<double, dim>& x) const { return contains(x); }
  /// False only if no point of the box is inside.
  virtual bool may_overlap(const Bounds<dim>& box) const = 0;
};

/// A box or a sphere about `center`.
template <int dim>
class BoxRegion final : public Region<dim> {
 public:
  BoxRegion(const Vec<double, dim>& half_extents, const Vec<double, dim>& center = {});

  Bounds<dim> bounds() const override;
  double volume() const override;
  double surface() const override;
  bool contains(const Vec<double, dim>& x) const override;
  bool may_overlap(const Bounds<dim>& box) const override;

 private:
  Box<dim> box_;
  Vec<double, dim> center_;
};

template <int dim>
class SphereRegion final : public Region<dim> {
 public:
  explicit SphereRegion(double radius, const Vec<double, dim>& center = {});

  Bounds<dim> bounds() const override;
  double volume() const override;
  double surface() const override;
  bool contains(const Vec<double, dim>& x) const override;
  bool may_overlap(const Bounds<dim>& box) const override;

 private:
  Sphere<dim> sphere_;
  Vec<double, dim> center_;
};

/// The inside of a mesh; see MeshInside.
class MeshRegion final : public Region<3> {
 public:
  explicit MeshRegion(const TriangleMesh& mesh) : inside_(mesh) {}

  Bounds<3> bounds() const override { return inside_.bounds(); }
  double volume() const override { return inside_.volume(); }
  double surface() const override { return inside_.area(); }
  bool contains(const Vec3d& x) const override { return inside_.contains(x); }
  bool may_contain(const Vec3d& x) const override { return inside_.may_contain(x); }
  bool may_overlap(const Bounds<3>& box) const override { return inside_.may_overlap(box); }

  const MeshInside& inside() const { return inside_; }

 private:
  MeshInside inside_;
};

/// The inside of a polygon after orient(): where its winding number is not zero.
class PolygonRegion final : public Region<2> {
 public:
  explicit PolygonRegion(Polygon polygon);

  Bounds<2> bounds() const override { return bounds_; }
  double volume() const override { return area_; }
  double surface() const override { return outline_; }
  bool contains(const Vec2d& x) const override;
  bool may_contain(const Vec2d& x) const override { return grid_.at(x) != InsideGrid<2>::Kind::outside; }
  bool may_overlap(const Bounds<2>& box) const override { return grid_.may_overlap(box); }

 private:
  Polygon polygon_;
  Bounds<2> bounds_;
  double area_ = 0, outline_ = 0;
  InsideGrid<2> grid_;
};

extern template class BoxRegion<2>;
extern template class BoxRegion<3>;
extern template class SphereRegion<2>;
extern template class SphereRegion<3>;

}  // namespace firn
