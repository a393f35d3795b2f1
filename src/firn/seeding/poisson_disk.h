#pragma once

#include <firn/seeding/region.h>

#include <cstdint>
#include <vector>

namespace firn {

/// Samples per radius^dim of a large region that sample_poisson_disk() reaches.
constexpr double kPoissonDensity2 = 0.617;
constexpr double kPoissonDensity3 = 0.578;

template <int dim>
constexpr double poisson_density() {
  return dim == 2 ? kPoissonDensity2 : kPoissonDensity3;
}

/// Radius (m) that puts this many samples into each cell of a grid, on average.
template <int dim>
double poisson_radius(double samples_per_cell, double cell_size);

/// Fills the region with points that are at least `radius` (m) apart, so densely that no ball of about 1.2 radius fits
/// between them: Bridson 2007, "Fast Poisson disk sampling in arbitrary dimensions", with 30 candidates a point drawn
/// uniformly by volume from the shell between one and two radii. Where the front dies out it starts again in every part
/// that is still empty, so that separate pieces are all filled. The same bits for the same seed, whatever the number of
/// threads (it uses one). Memory: about 60 bytes a sample in 3D.
/// Throws Error (resources) if more than `budget` samples would be needed.
template <int dim>
std::vector<Vec<double, dim>> sample_poisson_disk(const Region<dim>& region, double radius, std::uint64_t seed,
                                                  std::int64_t budget);

extern template double poisson_radius<2>(double, double);
extern template double poisson_radius<3>(double, double);
extern template std::vector<Vec2d> sample_poisson_disk<2>(const Region<2>&, double, std::uint64_t, std::int64_t);
extern template std::vector<Vec3d> sample_poisson_disk<3>(const Region<3>&, double, std::uint64_t, std::int64_t);

}  // namespace firn
