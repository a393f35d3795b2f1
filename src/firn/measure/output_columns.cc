#include <firn/core/error.h>
#include <firn/core/parallel.h>
#include <firn/materials/model_info.h>
#include <firn/materials/update_stress.h>
#include <firn/measure/id_order.h>
#include <firn/measure/output_columns.h>
#include <firn/measure/stress_invariants.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace firn {
namespace {

constexpr std::size_t kBlocksAtOnce = 16;

/// Columns one after the other, in the memory of those that a snapshot held before.
class ColumnList {
 public:
  ColumnList(Snapshot& snapshot, std::size_t particles) : columns_(snapshot.columns), particles_(particles) {}

  /// The values of the next column.
  template <class T>
  T* add(std::string_view name, std::string_view unit, std::string_view help, int components = 1) {
    if (used_ == columns_.size()) columns_.emplace_back();
    SnapshotColumn& column = columns_[used_++];
    column.name = name;
    column.unit = unit;
    column.help = help;
    column.components = components;
    if (!std::holds_alternative<std::vector<T>>(column.values)) column.values = std::vector<T>();
    auto& values = std::get<std::vector<T>>(column.values);
    values.resize(particles_ * static_cast<std::size_t>(components));
    return values.data();
  }

  void remove_others() { columns_.resize(used_); }

 private:
  std::vector<SnapshotColumn>& columns_;
  std::size_t particles_, used_ = 0;
};

/// A column that only some models have.
template <class Real>
struct FurtherColumn {
  std::string_view name;
  Real* values;
  Real elsewhere = 0;  ///< value for the particles of other models
};

template <class Real>
struct OutputColumns {
  Real *position, *velocity;
  std::int64_t* id;
  std::int32_t *body, *material;
  Real *J, *von_mises, *pressure;
  std::vector<FurtherColumn<Real>> history, varied;
};

/// History columns of the models that occur, each once.
template <class Real, int dim>
std::vector<HistoryColumn> history_of(std::span<const OutputMaterial<Real, dim>> materials) {
  std::vector<HistoryColumn> all;
  for (const auto& material : materials) {
    for (const HistoryColumn& h : history_columns(all_models()[static_cast<std::size_t>(material.model)], dim)) {
      if (std::none_of(all.begin(), all.end(), [&](const HistoryColumn& other) { return other.name == h.name; })) {
        all.push_back(h);
      }
    }
  }
  return all;
}

template <class Real, int dim>
OutputColumns<Real> declare_columns(ColumnList& list, std::span<const OutputMaterial<Real, dim>> materials,
                                    std::span<const Parameter> varied) {
  OutputColumns<Real> columns;
  columns.position = list.add<Real>("position", "m", "Position.", 3);
  columns.velocity = list.add<Real>("velocity", "m/s", "Velocity.", 3);
  columns.id = list.add<std::int64_t>("id", "", "Number of the particle, stable over the whole run.");
  columns.body = list.add<std::int32_t>("body", "", "Index of the body that the particle was seeded in.");
  columns.material = list.add<std::int32_t>("material", "", "Index of the particle's material.");
  columns.J = list.add<Real>("J", "", "Current volume over undeformed volume.");
  columns.von_mises = list.add<Real>("von_mises_stress", "Pa", "Von Mises equivalent of the Cauchy stress.");
  columns.pressure = list.add<Real>("pressure", "Pa", "Minus the mean Cauchy stress: positive in compression.");
  for (const HistoryColumn& h : history_of(materials)) {
    columns.history.push_back({h.name, list.add<Real>(h.name, h.unit, h.help), static_cast<Real>(h.initial_value)});
  }
  for (const Parameter& parameter : varied) {
    columns.varied.push_back({parameter.name, list.add<Real>(parameter.name, parameter.unit, parameter.help)});
  }
  list.remove_others();
  return columns;
}

/// What all particles of the model have in common; 0 if it has no such parameter.
double shared_value(std::string_view name, int model, const ModelParameters& parameters) {
  const auto list = all_models()[static_cast<std::size_t>(model)].parameters;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (list[i].name == name) return parameters.values[i];
  }
  return 0;
}

template <class Real, int dim>
IdOrder order_of(const Particles<Real, dim>& particles) {
  return {particles.size(), [&](const auto& visit) {
            for (std::size_t b = 0; b < particles.block_count(); ++b) {
              particles.for_each_chunk(b, [&](const auto& from, std::uint32_t, std::uint32_t count) {
                std::for_each_n(from.id, count, visit);
              });
            }
          }};
}

/// Writes the particles of one material to their places. They are read in the order in which they lie in memory, each
/// chunk once: the other way round nearly every number would be fetched from far away.
template <class Real, int dim>
class MaterialOutput {
 public:
  MaterialOutput(const OutputColumns<Real>& columns, const OutputMaterial<Real, dim>& material, std::int32_t number,
                 std::size_t begin, const OutputContext& context)
      : columns_(columns),
        particles_(material.particles),
        model_(material.model),
        parameters_(material.parameters),
        number_(number),
        begin_(begin),
        dx_(context.dx),
        kernel_(context.kernel),
        order_(order_of(material.particles)) {
    for (const FurtherColumn<Real>& column : columns.history) add_further(column, column.elsewhere);
    for (const FurtherColumn<Real>& column : columns.varied) {
      add_further(column, static_cast<Real>(shared_value(column.name, model_, parameters_)));
    }
  }

  void write() const {
    parallel_chunks(particles_.block_count(), kBlocksAtOnce, [&](std::size_t first, std::size_t last) {
      for (std::size_t b = first; b < last; ++b) {
        const Index<dim> origin = block_origin<dim>(particles_.block_key(b));
        particles_.for_each_chunk(b, [&](const Source& from, std::uint32_t, std::uint32_t count) {
          Places places;
          for (std::uint32_t i = 0; i < count; ++i) places[i] = begin_ + order_.rank(from.id[i]);
          write_motion(from, count, places, origin);
          write_numbers(from, count, places);
          write_stress(from, count, places);
          write_further(from, count, places);
        });
      }
    });
  }

 private:
  using Source = ParticleColumns<const Real, dim>;
  using Places = std::array<std::size_t, kChunk>;

  struct Further {
    Real* values;
    int own;  ///< number of the particles' own column; -1 if all have `shared`
    Real shared;
  };

  void add_further(const FurtherColumn<Real>& column, Real shared) {
    int own = -1;
    for (int k = 0; k < particles_.history_count(); ++k) {
      own = particles_.history_spec(k).name == column.name ? k : own;
    }
    further_.push_back({column.values, own, shared});
  }

  void write_motion(const Source& from, std::uint32_t count, const Places& places, const Index<dim>& origin) const {
    for (std::uint32_t i = 0; i < count; ++i) {
      const Index<dim> cell = cell_of_code<dim>(origin, from.cell[i]);
      Real* x = columns_.position + 3 * places[i];
      Real* v = columns_.velocity + 3 * places[i];
      x[2] = v[2] = 0;
      for (int d = 0; d < dim; ++d) {
        x[d] = static_cast<Real>(world_coordinate(cell[static_cast<std::size_t>(d)], from.offset[d][i], dx_, kernel_));
        v[d] = from.velocity[d][i];
      }
    }
  }

  void write_numbers(const Source& from, std::uint32_t count, const Places& places) const {
    for (std::uint32_t i = 0; i < count; ++i) {
      columns_.id[places[i]] = from.id[i];
      columns_.body[places[i]] = particles_.origins().body(from.origin[i]);
      columns_.material[places[i]] = number_;
    }
  }

  void write_stress(const Source& from, std::uint32_t count, const Places& places) const {
    std::array<double, kChunk> J;
    volume_ratios(from, count, J);
    for (std::uint32_t i = 0; i < count; ++i) {
      const Stress tau = stress_of<dim>([&](int c) { return static_cast<double>(from.stress[c][i]); });
      columns_.J[places[i]] = static_cast<Real>(J[i]);
      columns_.von_mises[places[i]] = static_cast<Real>(von_mises(tau) / J[i]);
      columns_.pressure[places[i]] = static_cast<Real>(pressure(tau) / J[i]);
    }
  }

  void volume_ratios(const Source& from, std::uint32_t count, std::array<double, kChunk>& J) const {
    std::array<std::array<double, kMaxHistoryColumns>, kChunk> history = {};
    const int own = particles_.history_count() - static_cast<int>(parameters_.varied.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      Mat<double, dim> F;
      for (int e = 0; e < dim * dim; ++e) F.e[e] = from.strain[e][i];
      J[i] = determinant(F);
      for (int h = 0; h < own; ++h) history[i][static_cast<std::size_t>(h)] = from.history[h][i];
    }
    firn::volume_ratios(model_, parameters_, count, history.front().data(), J.data());
  }

  void write_further(const Source& from, std::uint32_t count, const Places& places) const {
    for (const Further& column : further_) {
      const Real* own = column.own < 0 ? nullptr : from.history[column.own];
      for (std::uint32_t i = 0; i < count; ++i) column.values[places[i]] = own != nullptr ? own[i] : column.shared;
    }
  }

  const OutputColumns<Real>& columns_;
  const Particles<Real, dim>& particles_;
  const int model_;
  const ModelParameters& parameters_;
  const std::int32_t number_;
  const std::size_t begin_;
  const double dx_;
  const Kernel kernel_;
  const IdOrder order_;
  std::vector<Further> further_;
};

}  // namespace

template <class Real, int dim>
void fill_snapshot(Snapshot& snapshot, std::span<const OutputMaterial<Real, dim>> materials,
                   const OutputContext& context) {
  snapshot.materials.clear();
  std::size_t count = 0;
  for (const auto& material : materials) {
    const std::string_view model = all_models()[static_cast<std::size_t>(material.model)].name;
    const std::size_t end = count + material.particles.size();
    snapshot.materials.push_back({material.name, std::string(model), material.preset, count, end});
    count = end;
  }
  for (const auto& material : materials) {
    if (!material.particles.is_sorted()) throw Error(ErrorKind::usage, "snapshot: particles must be in their blocks");
  }
  ColumnList list(snapshot, count);
  const OutputColumns<Real> columns = declare_columns(list, materials, context.varied);
  for (std::size_t m = 0; m < materials.size(); ++m) {
    const auto number = static_cast<std::int32_t>(m);
    MaterialOutput<Real, dim>(columns, materials[m], number, snapshot.materials[m].begin, context).write();
  }
}

#define FIRN_INSTANTIATE(Real, dim) \
  template void fill_snapshot<Real, dim>(Snapshot&, std::span<const OutputMaterial<Real, dim>>, const OutputContext&);
FIRN_INSTANTIATE(float, 2)
FIRN_INSTANTIATE(float, 3)
FIRN_INSTANTIATE(double, 2)
FIRN_INSTANTIATE(double, 3)
#undef FIRN_INSTANTIATE

}  // namespace firn
