#include <firn/core/error.h>
#include <firn/core/parallel.h>
#include <firn/state/particles.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace firn {
namespace {

enum class Element { real, key, number };
enum class Shape { scalar, vector, matrix, stress };

struct FieldSpec {
  const char *name, *unit, *help;
  Element element;
  Shape shape;
};

/// In the order of Field.
constexpr std::array<FieldSpec, kFieldCount> kFields = {{
    {"cell", "", "Morton key of the particle's cell.", Element::key, Shape::scalar},
    {"offset", "", "Position inside the cell, in cells.", Element::real, Shape::vector},
    {"velocity", "m/s", "Velocity.", Element::real, Shape::vector},
    {"affine", "1/s", "Affine velocity matrix C of APIC.", Element::real, Shape::matrix},
    {"strain", "", "Deformation gradient; its elastic part for plastic models.", Element::real, Shape::matrix},
    {"stress", "Pa", "Kirchhoff stress.", Element::real, Shape::stress},
    {"mass", "kg", "Mass; per metre of thickness in 2D.", Element::real, Shape::scalar},
    {"rest_volume", "m^3", "Undeformed volume; per metre of thickness in 2D.", Element::real, Shape::scalar},
    {"id", "", "Number of the particle, stable over the whole run.", Element::number, Shape::scalar},
    {"body", "", "Index of the body that the particle was seeded in.", Element::number, Shape::scalar},
    {"grad_v", "1/s", "Velocity gradient.", Element::real, Shape::matrix},
    {"acceleration", "m/s^2", "Acceleration by the body force.", Element::real, Shape::vector},
}};

template <int dim>
constexpr int component_count(Shape shape) {
  switch (shape) {
    case Shape::scalar:
      return 1;
    case Shape::vector:
      return dim;
    case Shape::matrix:
      return dim * dim;
    case Shape::stress:
      return dim == 3 ? 6 : 4;
  }
  return 0;
}

constexpr std::size_t kGrain = 1 << 14;

struct Mover {
  std::uint64_t key;
  std::uint32_t id, particle;
  // By id, not by previous place: which of two particles from different blocks came first along the curve depends on
  // where the scene lies.
  bool operator<(const Mover& other) const { return key != other.key ? key < other.key : id < other.id; }
};

/// The order that merges the particles which stayed (already sorted) with the movers, by (key, id). Chunks of stayers
/// are independent: where a chunk's output begins follows from counting movers before it.
void merge_order(const std::uint64_t* keys, const std::uint32_t* ids, std::size_t count,
                 std::span<const std::uint32_t> movers, const std::vector<Mover>& sorted_movers,
                 std::vector<std::uint32_t>& order) {
  order.resize(count);
  const auto first_stayer = [&](std::size_t from) {
    auto mover = std::lower_bound(movers.begin(), movers.end(), from);
    std::size_t p = from;
    while (mover != movers.end() && *mover == p) ++mover, ++p;
    return p;
  };
  const auto mover_position = [&](std::size_t p) {  // movers that go before stayer p
    if (p >= count) return sorted_movers.size();
    const Mover stayer = {keys[p], ids[p], static_cast<std::uint32_t>(p)};
    return static_cast<std::size_t>(std::lower_bound(sorted_movers.begin(), sorted_movers.end(), stayer) -
                                    sorted_movers.begin());
  };
  parallel_chunks(count, kGrain, [&](std::size_t begin, std::size_t end) {
    auto skip = std::lower_bound(movers.begin(), movers.end(), begin);
    const std::size_t stayers_before = begin - static_cast<std::size_t>(skip - movers.begin());
    std::size_t m = begin == 0 ? 0 : mover_position(first_stayer(begin));
    const std::size_t m_end = mover_position(first_stayer(end));
    std::size_t out = stayers_before + m;
    for (std::size_t p = begin; p < end; ++p) {
      if (skip != movers.end() && *skip == p) {
        ++skip;
        continue;
      }
      const Mover stayer = {keys[p], ids[p], static_cast<std::uint32_t>(p)};
      while (m < sorted_movers.size() && sorted_movers[m] < stayer) order[out++] = sorted_movers[m++].particle;
      order[out++] = static_cast<std::uint32_t>(p);
    }
    while (m < m_end) order[out++] = sorted_movers[m++].particle;
  });
}

}  // namespace

template <class Real, int dim>
Particles<Real, dim>::Particles(const Options& options) : history_(options.history) {
  for (int f = 0; f < kFieldCount; ++f) {
    const FieldSpec& field = kFields[static_cast<std::size_t>(f)];
    const bool wanted = static_cast<Field>(f) == Field::grad_v         ? options.separate_grad_v
                        : static_cast<Field>(f) == Field::acceleration ? options.acceleration
                                                                       : true;
    const int bytes = field.element == Element::real  ? static_cast<int>(sizeof(Real))
                      : field.element == Element::key ? 8
                                                      : 4;
    columns_[static_cast<std::size_t>(f)] =
        wanted ? store_.add({field.name, field.unit, field.help, component_count<dim>(field.shape), bytes}) : -1;
  }
  first_history_ = store_.column_count();
  for (const HistorySpec& h : history_) store_.add({h.name, h.unit, h.help, 1, static_cast<int>(sizeof(Real))});
}

template <class Real, int dim>
CellPosition<Real, dim> cell_position(const Vec<double, dim>& x, double dx, Kernel kernel, const Period<dim>& period) {
  CellPosition<Real, dim> result;
  for (int d = 0; d < dim; ++d) {
    const double cells = x[d] / dx - cell_offset(kernel);
    const double cell = std::floor(cells);
    result.cell[static_cast<std::size_t>(d)] = std::abs(cell) < 1e15 ? static_cast<std::int64_t>(cell) : INT64_MAX / 2;
    result.offset[d] = static_cast<Real>(cells - cell);
    if (const std::int64_t length = period[static_cast<std::size_t>(d)]; length > 0) {
      std::int64_t& c = result.cell[static_cast<std::size_t>(d)];
      c = ((c % length) + length) % length;
    }
  }
  return result;
}

template <class Real, int dim>
void Particles<Real, dim>::append(std::span<const Vec<double, dim>> positions, double dx, Kernel kernel,
                                  const Period<dim>& period, double mass, double rest_volume, std::uint32_t first_id,
                                  std::uint32_t body_index) {
  const std::size_t first = size();
  store_.resize(first + positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const std::size_t p = first + i;
    const auto place = cell_position<Real, dim>(positions[i], dx, kernel, period);
    if (!fits_key<dim>(place.cell)) {
      throw Error(
          ErrorKind::usage,
          fmt::format("particle {} lies more than {} cells from the origin; move the scene closer or use larger cells",
                      first_id + i, CellKey<dim>::kCellLimit));
    }
    cell()[p] = cell_key<dim>(place.cell);
    for (int d = 0; d < dim; ++d) real(Field::offset, d)[p] = place.offset[d];
    for (int d = 0; d < dim; ++d) real(Field::strain, d * dim + d)[p] = Real(1);
    real(Field::mass)[p] = static_cast<Real>(mass);
    real(Field::rest_volume)[p] = static_cast<Real>(rest_volume);
    id()[p] = first_id + static_cast<std::uint32_t>(i);
    body()[p] = body_index;
    for (int h = 0; h < history_count(); ++h) history(h)[p] = static_cast<Real>(history_spec(h).initial_value);
  }
}

template <class Real, int dim>
Vec<double, dim> Particles<Real, dim>::position(std::size_t p, double dx, Kernel kernel) const {
  const Index<dim> at = cell_of_key<dim>(cell()[p]);
  Vec<double, dim> x;
  for (int d = 0; d < dim; ++d) {
    x[d] = dx * (static_cast<double>(at[static_cast<std::size_t>(d)]) + cell_offset(kernel) +
                 static_cast<double>(real(Field::offset, d)[p]));
  }
  return x;
}

template <class Real, int dim>
void Particles<Real, dim>::sort_by_cell(std::span<const std::uint32_t> movers) {
  if (size() == 0) blocks_.clear();  // all of them may have been removed
  if (movers.empty()) return;
  std::vector<Mover> sorted(movers.size());
  for (std::size_t m = 0; m < movers.size(); ++m) sorted[m] = {cell()[movers[m]], id()[movers[m]], movers[m]};
  // A total order, so the parallel sort has one result.
  tbb::parallel_sort(sorted.begin(), sorted.end());
  merge_order(cell(), id(), size(), movers, sorted, order_);
  store_.reorder(order_);
  find_blocks();
}

template <class Real, int dim>
void Particles<Real, dim>::find_blocks() {
  blocks_.clear();
  const std::uint64_t* keys = cell();
  for (std::size_t p = 0; p < size();) {
    const std::uint64_t block = block_of_cell<dim>(keys[p]);
    // Gallop to the end of the block: most hold hundreds of particles.
    std::size_t step = 64, end = p + 1;
    while (end + step < size() && block_of_cell<dim>(keys[end + step]) == block) end += step;
    while (end < size() && block_of_cell<dim>(keys[end]) == block) ++end;
    blocks_.push_back({block, static_cast<std::uint32_t>(p), static_cast<std::uint32_t>(end)});
    p = end;
  }
}

#define FIRN_INSTANTIATE(Real, dim)                                                                  \
  template class Particles<Real, dim>;                                                               \
  template CellPosition<Real, dim> cell_position<Real, dim>(const Vec<double, dim>&, double, Kernel, \
                                                            const Period<dim>&);
FIRN_INSTANTIATE(float, 2)
FIRN_INSTANTIATE(float, 3)
FIRN_INSTANTIATE(double, 2)
FIRN_INSTANTIATE(double, 3)
#undef FIRN_INSTANTIATE

}  // namespace firn
