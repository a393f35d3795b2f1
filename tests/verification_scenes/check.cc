#include "verification_scenes/check.h"

#include <algorithm>
#include <cmath>

namespace firn::test {
namespace {

std::vector<Check>& registry() {
  static std::vector<Check> checks;
  return checks;
}

}  // namespace

const std::vector<Check>& all_checks() { return registry(); }

Registration::Registration(Check check) {
  // Sorted, because the order in which the files' variables are set up is the linker's.
  const auto place = std::ranges::lower_bound(registry(), check.name, {}, &Check::name);
  registry().insert(place, std::move(check));
}

double order_of(double coarse, double fine) { return std::log2(coarse / fine); }

}  // namespace firn::test
