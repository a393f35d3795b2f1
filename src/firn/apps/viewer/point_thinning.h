#pragma once

#include <cstddef>

namespace firn {

/// Which part of the particles is drawn.
struct Thinning {
  std::size_t every = 1;  ///< every so-many-th particle
  double radius = 1;      ///< of those drawn / of all: they fill the same volume, or area in 2D
};

/// At most about `budget` of `count` particles; 0 is no limit. `every` is 1 or a prime of at least 3, because every
/// 2nd, 4th or 8th particle of a lattice, whose ids run along rows, would be a pattern of planes.
Thinning thin(std::size_t count, std::size_t budget, int dimension);

}  // namespace firn
