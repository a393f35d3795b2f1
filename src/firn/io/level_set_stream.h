#pragma once

#include <firn/geometry/level_set.h>
#include <firn/geometry/vector_grid.h>

#include <optional>
#include <string>
#include <string_view>

namespace firn {

/// A level set and, if there is one, its velocity, as firn-reader hands them over.
struct LevelSetParts {
  LevelSet::Data distance;
  std::optional<VectorGrid::Data> velocity;
};

/// For a program on the same machine: numbers lie in the bytes as in memory.
std::string level_set_bytes(const LevelSetParts& parts);

/// The parts of level_set_bytes(). Throws Error (files) unless the bytes are complete, every index and size fits and
/// every number is finite: who made them may be damaged. `name` stands first in messages.
LevelSetParts parse_level_set(std::string_view bytes, const std::string& name);

}  // namespace firn
