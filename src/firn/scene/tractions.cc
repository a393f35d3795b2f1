#include <firn/core/error.h>
#include <firn/core/expression.h>
#include <firn/scene/body_region.h>
#include <firn/scene/tractions.h>
#include <firn/seeding/nearest_point.h>
#include <firn/seeding/surface_lines.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

namespace firn {
namespace {

/// A number or a formula, ready to be evaluated.
class Component {
 public:
  explicit Component(const NumberOrFormula& given) : number_(given.number) {
    if (!given.formula.empty()) formula_.emplace(given.formula);
  }
  double at(const double (&place_and_time)[4]) const {
    // A value that is not finite is told by the step, as the velocity of the particle that it strikes.
    return formula_ ? formula_->unchecked(place_and_time) : number_;
  }

 private:
  double number_;
  std::optional<Expression> formula_;
};

template <int dim>
Vec<double, dim> cut(const Vec3d& v) {
  Vec<double, dim> result;
  for (int i = 0; i < dim; ++i) result[i] = v[i];
  return result;
}

constexpr std::int32_t kFree = -1;

}  // namespace

template <int dim>
class Tractions<dim>::One {
 public:
  One(const Scene& scene, const TractionSettings& settings)
      : settings_(settings), tolerance_(1e-9 / scene.frame_rate), region_(region_of<dim>(scene, settings)) {
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
      if (settings.body.empty() || scene.bodies[b].name == settings.body) bodies_.push_back(b);
    }
    if (settings.pressure) components_.emplace_back(*settings.pressure);
    for (int i = 0; settings.stress && i < dim; ++i) {
      components_.emplace_back((*settings.stress)[static_cast<std::size_t>(i)]);
    }
  }

  const TractionSettings& settings() const { return settings_; }
  double area() const { return area_; }

  void attach(const FilledBody<dim>& body) {
    if (std::find(bodies_.begin(), bodies_.end(), body.number) == bodies_.end()) return;
    const double spacing = std::pow(body.particle_volume, 1.0 / dim);
    const NearestPoint<dim> nearest(body.positions, spacing);
    const auto load = [&](const Vec<double, dim>& direction) {
      for (const SurfaceSample<dim>& sample : surface_along<dim>(body.region, *region_, direction, 0.25 * spacing)) {
        const auto id = body.first_id + static_cast<std::uint32_t>(nearest.to(sample.x));
        // Of a pressure, the vector area; of a stress, its amount along the normal.
        add(id, (sample.area / body.particle_mass) * direction);
        area_ += sample.area;
      }
    };
    if (settings_.stress) {
      load(cut<dim>(settings_.normal));
      return;
    }
    for (int axis = 0; axis < dim; ++axis) {
      Vec<double, dim> direction = {};
      for (const double sign : {1.0, -1.0}) {
        direction[axis] = sign;
        load(direction);
      }
    }
  }

  Vec<double, dim> acceleration(const Vec<double, dim>& x, std::uint32_t id, double t) const {
    if (id >= slots_.size() || slots_[id] == kFree || !acts(t)) return {};
    const Vec<double, dim>& area_by_mass = area_by_mass_[static_cast<std::size_t>(slots_[id])];
    double place_and_time[4] = {0, 0, 0, t};
    for (int i = 0; i < dim; ++i) place_and_time[i] = x[i];
    if (settings_.pressure) return -components_[0].at(place_and_time) * area_by_mass;
    const double amount = dot(area_by_mass, cut<dim>(settings_.normal));
    Vec<double, dim> result;
    for (int i = 0; i < dim; ++i) result[i] = amount * components_[static_cast<std::size_t>(i)].at(place_and_time);
    return result;
  }

 private:
  bool acts(double t) const {
    return t + tolerance_ >= settings_.start && (!settings_.stop || t + tolerance_ < *settings_.stop);
  }

  void add(std::uint32_t id, const Vec<double, dim>& area_by_mass) {
    if (id >= slots_.size()) slots_.resize(id + std::size_t(1), kFree);
    if (slots_[id] == kFree) {
      slots_[id] = static_cast<std::int32_t>(area_by_mass_.size());
      area_by_mass_.emplace_back();
    }
    area_by_mass_[static_cast<std::size_t>(slots_[id])] += area_by_mass;
  }

  TractionSettings settings_;
  double tolerance_;  ///< of start and stop, s: steps end on them but for rounding
  std::unique_ptr<Region<dim>> region_;
  std::vector<std::size_t> bodies_;  ///< in Scene::bodies
  std::vector<Component> components_;
  std::vector<std::int32_t> slots_;             ///< by id: where its area is
  std::vector<Vec<double, dim>> area_by_mass_;  ///< m^2/kg
  double area_ = 0;
};

template <int dim>
Tractions<dim>::Tractions(const Scene& scene) {
  for (const TractionSettings& settings : scene.tractions) {
    tractions_.push_back(std::make_unique<One>(scene, settings));
  }
}

template <int dim>
Tractions<dim>::~Tractions() = default;

template <int dim>
void Tractions<dim>::attach(const FilledBody<dim>& body) {
  for (const auto& traction : tractions_) traction->attach(body);
}

template <int dim>
void Tractions<dim>::check() const {
  for (const auto& traction : tractions_) {
    if (traction->area() > 0) continue;
    const TractionSettings& settings = traction->settings();
    throw Error(ErrorKind::usage,
                fmt::format("traction \"{}\": at t = 0 its shape holds no surface of {}{}; move it, or make it larger, "
                            "so that the surface lies inside",
                            settings.name, settings.body.empty() ? "a body" : fmt::format("body \"{}\"", settings.body),
                            settings.stress ? " that faces normal" : ""));
  }
}

template <int dim>
double Tractions<dim>::area(std::size_t i) const {
  return tractions_[i]->area();
}

template <int dim>
Vec<double, dim> Tractions<dim>::acceleration(const Vec<double, dim>& x, std::uint32_t id, double t) const {
  Vec<double, dim> sum = {};
  for (const auto& traction : tractions_) sum += traction->acceleration(x, id, t);
  return sum;
}

template class Tractions<2>;
template class Tractions<3>;

}  // namespace firn
