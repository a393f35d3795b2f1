#include <firn/core/error.h>
#include <firn/core/expression.h>
#include <firn/core/parallel.h>
#include <firn/materials/model_info.h>
#include <firn/scene/painted_field.h>
#include <firn/scene/schema.h>
#include <firn/scene/value_text.h>
#include <firn/scene/vary_parameters.h>
#include <firn/seeding/random.h>
#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <string_view>

namespace firn {
namespace {

constexpr std::size_t kGrain = 1 << 10;

/// Value at a position (m) for a particle's id.
using ValueAt = std::function<double(const Vec3d& x, std::uint32_t id)>;

/// Standard normal, by Box and Muller 1958.
double normal_number(Random& random) {
  const double u = random.uniform(), v = random.uniform();
  return std::sqrt(-2 * std::log1p(-u)) * std::cos(2 * std::numbers::pi * v);
}

double random_value(const ParameterVariation& v, Random random) {
  if (v.kind == ParameterVariation::Kind::range) return v.from + (v.to - v.from) * random.uniform();
  if (v.distribution == ParameterVariation::Distribution::normal) {
    return v.value * (1 + v.spread * normal_number(random));
  }
  // The logarithm's moments that give the mean and the relative deviation asked for.
  const double variance = std::log1p(v.spread * v.spread);
  return v.value * std::exp(std::sqrt(variance) * normal_number(random) - 0.5 * variance);
}

ValueAt value_of(const Scene& scene, const BodySettings& body, std::string_view name, const ParameterVariation& v) {
  switch (v.kind) {
    case ParameterVariation::Kind::formula:
      return [formula = Expression(v.text)](const Vec3d& x, std::uint32_t) {
        const double values[] = {x[0], x[1], x[2], 0};
        return formula.unchecked(values);
      };
    case ParameterVariation::Kind::attribute:
      return [painted = std::make_shared<PaintedField>(scene, body, v.text), scale = v.scale](
                 const Vec3d& x, std::uint32_t) { return scale * painted->at(x); };
    default:
      // With the name, so that parameters with one seed get numbers of their own.
      return [v, stream = XXH64(name.data(), name.size(), v.seed.value_or(scene.seed))](
                 const Vec3d&, std::uint32_t id) { return random_value(v, Random(stream ^ Random(id).bits())); };
  }
}

template <int dim>
Vec3d padded(const Vec<double, dim>& x) {
  Vec3d r = {};
  for (int i = 0; i < dim; ++i) r[i] = x[i];
  return r;
}

/// Throws what is wrong with a value.
[[noreturn]] void refuse(const MaterialSettings& material, const BodySettings& body, const Parameter& parameter,
                         double value, const Vec3d& x) {
  const Key& key = *find_section("material")->find(parameter.name);
  const std::string range = range_text(key), unit = parameter.unit.empty() ? "" : fmt::format(" {}", parameter.unit);
  throw Error(
      ErrorKind::usage,
      fmt::format("material \"{}\": {} must be {}{}, got {:.6g} for the particle of body \"{}\" at ({:.6g}, "
                  "{:.6g}, {:.6g}) m{}{}",
                  material.name, parameter.name, range.empty() ? "a finite number" : range, range.empty() ? "" : unit,
                  value, body.name, x[0], x[1], x[2], parameter.hint.empty() ? "" : "; ", parameter.hint));
}

}  // namespace

ModelParameters model_parameters(const MaterialSettings& settings, double cell_size) {
  ModelParameters parameters;
  parameters.density = settings.density;
  parameters.cell_size = cell_size;
  for (const Parameter& parameter : find_model(settings.model)->parameters) {
    const std::string name(parameter.name);
    if (settings.varied.count(name) > 0) parameters.varied.push_back(static_cast<int>(parameters.values.size()));
    parameters.values.push_back(settings.parameters.at(name));
  }
  return parameters;
}

std::vector<Parameter> varied_parameters(const Scene& scene) {
  std::vector<Parameter> all;
  for (const MaterialSettings& material : scene.materials) {
    for (const Parameter& parameter : find_model(material.model)->parameters) {
      const auto is_same = [&](const Parameter& other) { return other.name == parameter.name; };
      if (material.varied.count(std::string(parameter.name)) == 0 || std::ranges::any_of(all, is_same)) continue;
      all.push_back(parameter);
    }
  }
  return all;
}

std::string material_refusal(const MaterialSettings& settings, double cell_size) {
  // Parameters that vary are judged particle by particle.
  const ModelInfo& model = *find_model(settings.model);
  if (model.refusal == nullptr || !settings.varied.empty()) return "";
  return model.refusal(model_parameters(settings, cell_size));
}

template <class Real, int dim>
void vary_parameters(const Scene& scene, const MaterialSettings& settings, const BodySettings& body,
                     const VariedParticles<Real, dim>& to) {
  auto& [material, first, first_id, positions] = to;
  const ModelInfo& model = all_models()[static_cast<std::size_t>(material.model)];
  const std::vector<int>& varied = material.parameters.varied;
  if (varied.empty()) return;
  const int own_columns = material.particles.history_count() - static_cast<int>(varied.size());
  std::vector<double> values(positions.size());
  for (std::size_t k = 0; k < varied.size(); ++k) {
    const Parameter& parameter = model.parameters[static_cast<std::size_t>(varied[k])];
    const ValueAt value_at = value_of(scene, body, parameter.name, settings.varied.at(std::string(parameter.name)));
    parallel_chunks(positions.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        values[i] = value_at(padded(positions[i]), first_id + static_cast<std::uint32_t>(i));
      }
    });
    // One by one, so that the first particle is named whatever the number of threads.
    const auto column = material.particles.history(own_columns + static_cast<int>(k));
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const Real stored = static_cast<Real>(values[i]);
      // Also what is stored: 0.49999999999 is 0.5 in single precision.
      if (!in_range(parameter, values[i]) || !in_range(parameter, static_cast<double>(stored))) {
        refuse(settings, body, parameter, values[i], padded(positions[i]));
      }
      column[first + i] = stored;
    }
  }
  if (model.refusal == nullptr) return;
  ParametersOfOne own(material.parameters);
  std::vector<double> of_one(varied.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    for (std::size_t k = 0; k < varied.size(); ++k) {
      of_one[k] = static_cast<double>(material.particles.history(own_columns + static_cast<int>(k))[first + i]);
    }
    const std::string why = model.refusal(own.with(of_one.data()));
    if (why.empty()) continue;
    const Vec3d x = padded(positions[i]);
    throw Error(ErrorKind::usage,
                fmt::format("material \"{}\": the particle of body \"{}\" at ({:.6g}, {:.6g}, {:.6g}) m: {}",
                            settings.name, body.name, x[0], x[1], x[2], why));
  }
}

#define FIRN_INSTANTIATE(Real, dim)                                                                    \
  template void vary_parameters<Real, dim>(const Scene&, const MaterialSettings&, const BodySettings&, \
                                           const VariedParticles<Real, dim>&);
FIRN_INSTANTIATE(float, 2)
FIRN_INSTANTIATE(float, 3)
FIRN_INSTANTIATE(double, 2)
FIRN_INSTANTIATE(double, 3)
#undef FIRN_INSTANTIATE

}  // namespace firn
