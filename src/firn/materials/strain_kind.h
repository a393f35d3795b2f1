#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace firn {

/// What a model keeps of a particle's deformation, in the place of the strain matrix.
enum class StrainKind {
  deformation_gradient,  ///< F, or its elastic part: all entries
  volume_ratio,          ///< J alone, in entry (0, 0): fluids, which forget their shape
  conformation,          ///< symmetric b: entries on and above the diagonal
};

/// One stored entry of the strain matrix.
struct StrainEntry {
  int entry;             ///< row-major place, row * dim + column
  double initial_value;  ///< of undeformed material
};

namespace detail {

template <StrainKind kind, int dim>
consteval auto strain_entries() {
  constexpr std::size_t kCount = kind == StrainKind::deformation_gradient ? dim * dim
                                 : kind == StrainKind::volume_ratio       ? 1
                                                                          : dim * (dim + 1) / 2;
  std::array<StrainEntry, kCount> entries = {};
  std::size_t n = 0;
  for (int i = 0; i < dim; ++i) {
    for (int j = 0; j < dim; ++j) {
      if (kind == StrainKind::conformation && j < i) continue;
      if (n < kCount) entries[n++] = {i * dim + j, i == j ? 1.0 : 0.0};
    }
  }
  return entries;
}

template <StrainKind kind, int dim>
inline constexpr auto kStrainEntries = strain_entries<kind, dim>();

}  // namespace detail

/// The entries that a model of this kind stores in dim dimensions, ascending. The others have no column, and no model
/// reads them.
constexpr std::span<const StrainEntry> strain_entries(StrainKind kind, int dim) {
  const auto in_dim = [dim](const auto& plane, const auto& space) {
    return dim == 2 ? std::span<const StrainEntry>(plane) : std::span<const StrainEntry>(space);
  };
  switch (kind) {
    case StrainKind::volume_ratio:
      return in_dim(detail::kStrainEntries<StrainKind::volume_ratio, 2>,
                    detail::kStrainEntries<StrainKind::volume_ratio, 3>);
    case StrainKind::conformation:
      return in_dim(detail::kStrainEntries<StrainKind::conformation, 2>,
                    detail::kStrainEntries<StrainKind::conformation, 3>);
    case StrainKind::deformation_gradient:
      break;
  }
  return in_dim(detail::kStrainEntries<StrainKind::deformation_gradient, 2>,
                detail::kStrainEntries<StrainKind::deformation_gradient, 3>);
}

}  // namespace firn
