#pragma once

#include <firn/scene/build_world.h>
#include <firn/scene/settings.h>

#include <string>

namespace firn {

/// What to do about a body that is too small for the cells: files may be in another unit.
std::string too_small_hint(const BodySettings& body);

/// What to do about a body that is too large: the same, and larger cells.
std::string too_large_hint(const BodySettings& body);

/// Warns of a body narrower than a cell, and of one from a file that is so many cells wide that its unit is likely to
/// be another one, with how wide it is. `plan` is that of this body.
void warn_of_size(const BodySettings& body, const WorldPlan::Body& plan, double cell_size);

}  // namespace firn
