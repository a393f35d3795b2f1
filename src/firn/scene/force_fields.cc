#include <firn/core/expression.h>
#include <firn/scene/force_fields.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

namespace firn {
namespace {

/// A field with its formulas parsed, in three dimensions whatever the scene's.
class ForceField {
 public:
  /// @param tolerance of start and stop, s: steps end on them but for rounding
  ForceField(const FieldSettings& settings, double tolerance) : settings_(settings), tolerance_(tolerance) {
    const auto& given = settings.type == FieldSettings::Type::wind ? settings.velocity : settings.acceleration;
    for (std::size_t i = 0; i < 3; ++i) {
      if (!given[i].formula.empty()) formulas_[i].emplace(given[i].formula);
      numbers_[static_cast<int>(i)] = given[i].number;
    }
  }

  bool acts(const Vec3d& x, double t, int dim) const {
    if (t + tolerance_ < settings_.start || (settings_.stop && !(t + tolerance_ < *settings_.stop))) return false;
    for (int i = 0; settings_.box && i < dim; ++i) {
      if (!(x[i] >= settings_.box->lower[i] && x[i] <= settings_.box->upper[i])) return false;
    }
    return true;
  }

  Vec3d acceleration(const Vec3d& x, const Vec3d& v, double t) const {
    switch (settings_.type) {
      case FieldSettings::Type::acceleration:
        return given_vector(x, t);
      case FieldSettings::Type::attractor:
        return attraction(settings_.position - x);
      case FieldSettings::Type::vortex:
        return swirl(x - settings_.position);
      case FieldSettings::Type::wind:
        return (1 / settings_.response_time) * (given_vector(x, t) - v);
    }
    return {};
  }

 private:
  Vec3d given_vector(const Vec3d& x, double t) const {
    const double values[4] = {x[0], x[1], x[2], t};
    Vec3d result = numbers_;
    for (std::size_t i = 0; i < 3; ++i) {
      // A value that is not finite is told by the step, as the velocity of the particle that it strikes.
      if (formulas_[i]) result[static_cast<int>(i)] = formulas_[i]->unchecked(values);
    }
    return result;
  }

  Vec3d attraction(const Vec3d& to_centre) const {
    const double r = norm(to_centre), radius = settings_.radius;
    const double per_length = r < radius ? 1 / radius : radius * radius / (r * r * r);
    return (settings_.strength * per_length) * to_centre;
  }

  Vec3d swirl(const Vec3d& from_centre) const {
    const Vec3d r = from_centre - dot(from_centre, settings_.axis) * settings_.axis;
    const double square = dot(r, r), radius = settings_.radius;
    const double per_length = square < radius * radius ? 1 / radius : radius / square;
    return (settings_.strength * per_length) * cross(settings_.axis, r);
  }

  FieldSettings settings_;
  double tolerance_;
  std::optional<Expression> formulas_[3];
  Vec3d numbers_ = {};
};

template <int dim>
Vec3d padded(const Vec<double, dim>& v) {
  Vec3d result = {};
  for (int i = 0; i < dim; ++i) result[i] = v[i];
  return result;
}

}  // namespace

template <int dim>
BodyForce<dim> force_of(const Scene& scene, std::shared_ptr<const Tractions<dim>> tractions) {
  if (scene.tractions.empty()) tractions = nullptr;
  if (scene.fields.empty() && !tractions) return {};
  const auto fields = std::make_shared<std::vector<ForceField>>();
  for (const FieldSettings& settings : scene.fields) fields->emplace_back(settings, 1e-9 / scene.frame_rate);
  return BodyForce<dim>(
      [fields, tractions](const Vec<double, dim>& x, const Vec<double, dim>& v, std::uint32_t id, double t) {
        const Vec3d place = padded<dim>(x), velocity = padded<dim>(v);
        Vec3d sum = {};
        for (const ForceField& field : *fields) {
          if (field.acts(place, t, dim)) sum += field.acceleration(place, velocity, t);
        }
        Vec<double, dim> result = tractions ? tractions->acceleration(x, id, t) : Vec<double, dim>{};
        for (int i = 0; i < dim; ++i) result[i] += sum[i];
        return result;
      });
}

template BodyForce<2> force_of<2>(const Scene&, std::shared_ptr<const Tractions<2>>);
template BodyForce<3> force_of<3>(const Scene&, std::shared_ptr<const Tractions<3>>);

}  // namespace firn
