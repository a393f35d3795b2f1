#pragma once

#include <firn/core/linear_algebra.h>
#include <firn/state/cell_key.h>
#include <firn/state/column_store.h>
#include <firn/state/kernel.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace firn {

/// The column that a particle quantity lives in.
enum class Field : int {
  cell,         ///< Morton key of the particle's cell
  offset,       ///< position inside the cell, in cells: x = dx (cell + kernel offset + offset), offset in [0, 1]
  velocity,     ///< v_p, m/s
  affine,       ///< C_p, 1/s, row-major: row is the velocity's component
  strain,       ///< F_p (elastic part, for plastic models), row-major
  stress,       ///< Kirchhoff, Pa
  mass,         ///< m_p, kg (kg/m in 2D)
  rest_volume,  ///< V_p^0, m^3 (m^2 in 2D)
  id,           ///< stable over the whole run
  body,         ///< index into the scene's bodies
  grad_v,       ///< sum v_i grad w_ip^T, 1/s; only where it differs from C_p (the gradient form with quadratic or cubic
                ///< kernels)
  acceleration,  ///< of the body_force callback, m/s^2; only with one
};
inline constexpr int kFieldCount = 12;

/// Consecutive particles whose cells lie in one block.
struct BlockRange {
  std::uint64_t block;       ///< block key
  std::uint32_t begin, end;  ///< particles
};

/// Which axes are periodic, and their length in cells (a whole number of blocks); 0 for an axis that is not.
template <int dim>
using Period = std::array<std::int64_t, dim>;

struct HistorySpec {
  std::string name, unit, help;
  double initial_value = 0;
};

/// All particles of one material, lying by block along the Morton curve, then by cell, then by id: an order
/// that follows from the particles' states alone, and not from where the curve passes or how they got there.
///
/// Positions keep their precision at any distance from the origin, because only the place inside the cell is a Real.
template <class Real, int dim>
class Particles {
 public:
  struct Options {
    bool separate_grad_v = false;
    bool acceleration = false;
    std::vector<HistorySpec> history = {};
  };

  explicit Particles(const Options& options);

  std::size_t size() const { return store_.size(); }
  ColumnStore& store() { return store_; }
  const ColumnStore& store() const { return store_; }

  bool has(Field field) const { return columns_[static_cast<std::size_t>(field)] >= 0; }
  Real* real(Field field, int c = 0) { return store_.component<Real>(column(field), c); }
  const Real* real(Field field, int c = 0) const { return store_.component<Real>(column(field), c); }
  std::uint64_t* cell() { return store_.component<std::uint64_t>(column(Field::cell)); }
  const std::uint64_t* cell() const { return store_.component<std::uint64_t>(column(Field::cell)); }
  std::uint32_t* id() { return store_.component<std::uint32_t>(column(Field::id)); }
  const std::uint32_t* id() const { return store_.component<std::uint32_t>(column(Field::id)); }
  std::uint32_t* body() { return store_.component<std::uint32_t>(column(Field::body)); }
  const std::uint32_t* body() const { return store_.component<std::uint32_t>(column(Field::body)); }

  int history_count() const { return static_cast<int>(history_.size()); }
  const HistorySpec& history_spec(int h) const { return history_[static_cast<std::size_t>(h)]; }
  Real* history(int h) { return store_.component<Real>(first_history_ + h); }
  const Real* history(int h) const { return store_.component<Real>(first_history_ + h); }

  /// Adds particles at rest in their undeformed state (F = I, C = 0, history at its initial value).
  /// @param positions world coordinates, m
  /// Error(usage) if a position lies more than CellKey::kCellLimit cells from the origin.
  void append(std::span<const Vec<double, dim>> positions, double dx, Kernel kernel, const Period<dim>& period,
              double mass, double rest_volume, std::uint32_t first_id, std::uint32_t body);

  /// World position of particle p, m.
  Vec<double, dim> position(std::size_t p, double dx, Kernel kernel) const;

  /// Restores the order after particles have changed cell.
  /// @param movers the particles whose cell key has changed since the last call, ascending; new particles count as
  /// movers
  void sort_by_cell(std::span<const std::uint32_t> movers);

  /// One entry per block that holds particles, in order. Valid after sort_by_cell.
  std::span<const BlockRange> blocks() const { return blocks_; }

 private:
  int column(Field field) const { return columns_[static_cast<std::size_t>(field)]; }
  void find_blocks();

  ColumnStore store_;
  std::array<int, kFieldCount> columns_;
  int first_history_ = 0;
  std::vector<HistorySpec> history_;
  std::vector<BlockRange> blocks_;
  std::vector<std::uint32_t> order_;  // scratch of sort_by_cell
};

/// Cell and offset of world position x. Periodic axes are wrapped.
template <class Real, int dim>
struct CellPosition {
  Index<dim> cell;
  Vec<Real, dim> offset;
};
template <class Real, int dim>
CellPosition<Real, dim> cell_position(const Vec<double, dim>& x, double dx, Kernel kernel, const Period<dim>& period);

}  // namespace firn
