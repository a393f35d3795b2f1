#pragma once

#include <firn/apps/bench_case.h>

namespace firn {

/// Calls body.operator()<Real, dim>() for the case's precision and dimension.
template <class Body>
void with_scalar_and_dimension(const BenchCase& bench, const Body& body) {
  const bool single = bench.precision == "single";
  if (bench.dimension == 2) {
    single ? body.template operator()<float, 2>() : body.template operator()<double, 2>();
  } else {
    single ? body.template operator()<float, 3>() : body.template operator()<double, 3>();
  }
}

}  // namespace firn
