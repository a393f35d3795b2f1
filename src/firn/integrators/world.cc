#include <firn/integrators/world.h>
#include <firn/materials/model_info.h>

#include <utility>

namespace firn {

template <class Real, int dim>
MaterialSet<Real, dim>& World<Real, dim>::add_material(std::string name, int model, const ModelParameters& parameters) {
  typename Particles<Real, dim>::Options options;
  options.density = parameters.density;
  options.keeps_velocity = transfer.flip > 0;
  options.separate_grad_v = !affine_is_gradient(transfer.kernel, transfer.form);
  options.acceleration = static_cast<bool>(body_force);
  for (const HistoryColumn& h : history_columns(all_models()[static_cast<std::size_t>(model)], dim)) {
    options.history.push_back({std::string(h.name), std::string(h.unit), std::string(h.help), h.initial_value});
  }
  for (const int k : parameters.varied) {
    const Parameter& p = all_models()[static_cast<std::size_t>(model)].parameters[static_cast<std::size_t>(k)];
    options.history.push_back({std::string(p.name), std::string(p.unit), std::string(p.help),
                               parameters.values[static_cast<std::size_t>(k)]});
  }
  materials.push_back({std::move(name), model, parameters, Particles<Real, dim>(options)});
  return materials.back();
}

template <class Real, int dim>
std::size_t World<Real, dim>::particle_count() const {
  std::size_t count = 0;
  for (const auto& material : materials) count += material.particles.size();
  return count;
}

template struct World<float, 2>;
template struct World<float, 3>;
template struct World<double, 2>;
template struct World<double, 3>;

}  // namespace firn
