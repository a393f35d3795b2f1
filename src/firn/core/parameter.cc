#include <firn/core/parameter.h>

#include <cmath>

namespace firn {

bool in_range(const Parameter& p, double value) {
  if (!std::isfinite(value)) return false;
  const bool above = p.minimum_allowed ? value >= p.minimum : value > p.minimum;
  const bool below = p.maximum_allowed ? value <= p.maximum : value < p.maximum;
  return above && below;
}

}  // namespace firn
