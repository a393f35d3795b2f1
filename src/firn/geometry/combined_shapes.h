#pragma once

#include <firn/geometry/shape.h>

#include <utility>
#include <vector>

namespace firn {

/// A shape that was turned about its origin and then moved.
template <int dim>
class Placed final : public Shape<dim> {
 public:
  Placed(ShapePointer<dim> shape, const Mat<double, dim>& rotation, const Vec<double, dim>& position)
      : shape_(std::move(shape)), rotation_(rotation), inverse_(transpose(rotation)), position_(position) {}

  double distance(const Vec<double, dim>& x) const override { return shape_->distance(inverse_ * (x - position_)); }
  Vec<double, dim> normal(const Vec<double, dim>& x) const override {
    return rotation_ * shape_->normal(inverse_ * (x - position_));
  }
  Bounds<dim> bounds() const override;
  bool is_bounded() const override { return shape_->is_bounded(); }

 private:
  ShapePointer<dim> shape_;
  Mat<double, dim> rotation_, inverse_;
  Vec<double, dim> position_;
};

/// Everything outside a shape: the solid around a cavity.
template <int dim>
class Inverse final : public Shape<dim> {
 public:
  explicit Inverse(ShapePointer<dim> shape) : shape_(std::move(shape)) {}

  double distance(const Vec<double, dim>& x) const override { return -shape_->distance(x); }
  Vec<double, dim> normal(const Vec<double, dim>& x) const override { return -shape_->normal(x); }
  Bounds<dim> bounds() const override { return shape_->bounds(); }
  bool is_bounded() const override { return false; }

 private:
  ShapePointer<dim> shape_;
};

/// All points of all parts. Outside, the distance is exact if those of the parts are; inside it is a bound.
template <int dim>
class Union final : public Shape<dim> {
 public:
  /// Throws Error (usage) without parts.
  explicit Union(std::vector<ShapePointer<dim>> parts);

  double distance(const Vec<double, dim>& x) const override;
  Vec<double, dim> normal(const Vec<double, dim>& x) const override;
  Bounds<dim> bounds() const override;
  bool is_bounded() const override;

 private:
  std::vector<ShapePointer<dim>> parts_;
};

/// What all parts have in common. Inside, the distance is exact if those of the parts are; outside it is a bound.
template <int dim>
class Intersection final : public Shape<dim> {
 public:
  /// Throws Error (usage) without parts.
  explicit Intersection(std::vector<ShapePointer<dim>> parts);

  double distance(const Vec<double, dim>& x) const override;
  Vec<double, dim> normal(const Vec<double, dim>& x) const override;
  Bounds<dim> bounds() const override;
  bool is_bounded() const override;

 private:
  std::vector<ShapePointer<dim>> parts_;
};

/// The first part without the others: the intersection with their inverses. Throws Error (usage) without parts.
template <int dim>
ShapePointer<dim> make_difference(std::vector<ShapePointer<dim>> parts);

}  // namespace firn
