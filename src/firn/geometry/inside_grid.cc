#include <firn/geometry/inside_grid.h>

#include <cmath>

namespace firn {
namespace {

/// Seen from a cell that the surface does not touch, the rim of a hole turns by at most a quarter of a circle across
/// the cell, which is a quarter in the winding number; with it the answer at the centre holds for the whole cell.
constexpr double kClearMargin = 0.25;

/// In cells. Blocks are made this much larger before they are tested, so that rounding cannot hide a boundary.
constexpr double kSlack = 1e-6;

}  // namespace

template <int dim>
InsideGrid<dim>::InsideGrid(const Bounds<dim>& bounds, int cells) {
  const Vec<double, dim> size = bounds.size();
  cell_ = bounds.largest_side() / cells;
  std::size_t total = 1;
  for (int d = 0; d < dim; ++d) {
    // More than a cell of margin: the outermost cells touch nothing. Not a multiple of half a cell, so that faces along
    // the grid go neither between cells nor through their centres.
    lower_[d] = bounds.lower[d] - 1.37 * cell_;
    count_[d] = static_cast<int>(std::ceil(size[d] / cell_)) + 3;
    total *= static_cast<std::size_t>(count_[d]);
  }
  kinds_.assign(total, Kind::unknown);
}

template <int dim>
typename InsideGrid<dim>::Index InsideGrid<dim>::index_of(const Vec<double, dim>& x) const {
  Index i;
  for (int d = 0; d < dim; ++d) {
    const double cell = std::floor((x[d] - lower_[d]) / cell_);
    i[d] = static_cast<int>(std::min(std::max(cell, 0.0), static_cast<double>(count_[d] - 1)));
  }
  return i;
}

template <int dim>
std::size_t InsideGrid<dim>::flat(const Index& i) const {
  std::size_t cell = 0;
  for (int d = dim; d-- > 0;) cell = cell * static_cast<std::size_t>(count_[d]) + static_cast<std::size_t>(i[d]);
  return cell;
}

template <int dim>
typename InsideGrid<dim>::Index InsideGrid<dim>::unflat(std::size_t cell) const {
  Index i;
  for (int d = 0; d < dim; ++d) {
    const auto count = static_cast<std::size_t>(count_[d]);
    i[d] = static_cast<int>(cell % count);
    cell /= count;
  }
  return i;
}

template <int dim>
Vec<double, dim> InsideGrid<dim>::center_of(std::size_t cell) const {
  const Index i = unflat(cell);
  Vec<double, dim> x;
  for (int d = 0; d < dim; ++d) x[d] = lower_[d] + (i[d] + 0.5) * cell_;
  return x;
}

template <int dim>
template <class Visit>
void InsideGrid<dim>::for_each_cell(const Bounds<dim>& range, const Visit& visit) const {
  const Index first = index_of(range.lower), last = index_of(range.upper);
  Index i = first;
  while (true) {
    visit(flat(i));
    int d = 0;
    while (d < dim && i[d] == last[d]) {
      i[d] = first[d];
      ++d;
    }
    if (d == dim) return;
    ++i[d];
  }
}

template <int dim>
void InsideGrid<dim>::mark_boundary(const Bounds<dim>& range, const Touches& touches, const Found& found) {
  const auto slack = constant_vector<double, dim>(kSlack * cell_);
  mark_block(index_of(range.lower - slack), index_of(range.upper + slack), touches, found);
}

template <int dim>
void InsideGrid<dim>::mark_block(const Index& first, const Index& last, const Touches& touches, const Found& found) {
  Bounds<dim> box;
  int longest = 0;
  for (int d = 0; d < dim; ++d) {
    box.lower[d] = lower_[d] + (first[d] - kSlack) * cell_;
    box.upper[d] = lower_[d] + (last[d] + 1 + kSlack) * cell_;
    if (last[d] - first[d] > last[longest] - first[longest]) longest = d;
  }
  if (!touches(box)) return;
  if (first[longest] == last[longest]) {
    kinds_[flat(first)] = Kind::boundary;
    if (found) found(flat(first));
    return;
  }
  // Halving blocks makes the work proportional to the cells on the surface, not to those in the range: one large
  // slanted triangle would otherwise be tested against half of the grid.
  Index lower_last = last, upper_first = first;
  lower_last[longest] = first[longest] + (last[longest] - first[longest]) / 2;
  upper_first[longest] = lower_last[longest] + 1;
  mark_block(first, lower_last, touches, found);
  mark_block(upper_first, last, touches, found);
}

template <int dim>
void InsideGrid<dim>::fill_connected(std::size_t start, Kind kind) {
  std::vector<std::size_t> front = {start};
  kinds_[start] = kind;
  while (!front.empty()) {
    const std::size_t cell = front.back();
    front.pop_back();
    for (int side = 0; side < 2 * dim; ++side) {
      const std::size_t next = neighbour(cell, side);
      if (next == kNoCell || kinds_[next] != Kind::unknown) continue;
      kinds_[next] = kind;
      front.push_back(next);
    }
  }
}

template <int dim>
void InsideGrid<dim>::decide(const std::function<double(const Vec<double, dim>&)>& winding, bool closed) {
  for (std::size_t cell = 0; cell < kinds_.size(); ++cell) {
    if (kinds_[cell] != Kind::unknown) continue;
    const double w = winding(center_of(cell));
    const Kind kind = w > 0.5 ? Kind::inside : Kind::outside;
    if (closed) {
      fill_connected(cell, kind);
    } else {
      kinds_[cell] = std::abs(w - 0.5) < kClearMargin ? Kind::boundary : kind;
    }
  }
}

template <int dim>
std::size_t InsideGrid<dim>::cell_of(const Vec<double, dim>& x) const {
  Index i;
  for (int d = 0; d < dim; ++d) {
    const double cell = (x[d] - lower_[d]) / cell_;
    if (!(cell >= 0) || !(cell < count_[d])) return kNoCell;
    i[d] = static_cast<int>(cell);
  }
  return flat(i);
}

template <int dim>
std::size_t InsideGrid<dim>::neighbour(std::size_t cell, int side) const {
  Index i = unflat(cell);
  const int axis = side / 2;
  i[axis] += side % 2 == 0 ? -1 : 1;
  return i[axis] < 0 || i[axis] >= count_[axis] ? kNoCell : flat(i);
}

template <int dim>
bool InsideGrid<dim>::may_overlap(const Bounds<dim>& box) const {
  bool found = false;
  for_each_cell(box, [&](std::size_t cell) { found = found || kinds_[cell] != Kind::outside; });
  return found;
}

template <int dim>
double InsideGrid<dim>::measure(const std::function<bool(const Vec<double, dim>&)>& contains, int samples) const {
  std::size_t points_inside = 0, points_in_cell = 1;
  for (int d = 0; d < dim; ++d) points_in_cell *= static_cast<std::size_t>(samples);
  for (std::size_t cell = 0; cell < kinds_.size(); ++cell) {
    if (kinds_[cell] == Kind::inside) points_inside += points_in_cell;
    if (kinds_[cell] != Kind::boundary) continue;
    const Vec<double, dim> center = center_of(cell);
    for (std::size_t point = 0; point < points_in_cell; ++point) {
      Vec<double, dim> x = center;
      std::size_t rest = point;
      for (int d = 0; d < dim; ++d) {
        const auto k = static_cast<double>(rest % static_cast<std::size_t>(samples));
        x[d] += cell_ * ((k + 0.5) / samples - 0.5);
        rest /= static_cast<std::size_t>(samples);
      }
      if (contains(x)) ++points_inside;
    }
  }
  return static_cast<double>(points_inside) / static_cast<double>(points_in_cell) * std::pow(cell_, dim);
}

template class InsideGrid<2>;
template class InsideGrid<3>;

}  // namespace firn
