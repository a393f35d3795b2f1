#pragma once

#include <firn/scene/document.h>
#include <firn/scene/schema.h>

namespace firn {

/// The node as a value of the key. On a wrong type or a value out of range throws Error(usage) whose message lacks the
/// place: "density must be > 0 kg/m^3, got -400".
Value read_value(const Key& key, const Node& node, int dimension);

}  // namespace firn
