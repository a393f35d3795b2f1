#include <firn/apps/viewer/point_thinning.h>

#include <cmath>

namespace firn {
namespace {

bool is_prime(std::size_t n) {
  for (std::size_t d = 2; d * d <= n; ++d) {
    if (n % d == 0) return false;
  }
  return n > 1;
}

}  // namespace

Thinning thin(std::size_t count, std::size_t budget, int dimension) {
  if (budget == 0 || count <= budget) return {};
  std::size_t every = (count + budget - 1) / budget;
  if (every < 3) every = 3;
  while (!is_prime(every)) ++every;
  return {every, std::pow(static_cast<double>(every), 1.0 / dimension)};
}

}  // namespace firn
