#pragma once

#include <firn/seeding/region.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace firn {

/// Points that stand for equal parts of a region.
template <int dim>
struct Samples {
  std::vector<Vec<double, dim>> positions;  ///< m
  double volume_per_sample = 0;             ///< m^dim: the volume of the region / positions.size()
  double radius = 0;                        ///< smallest distance between two of them, m
};

/// How densely to fill a region by Poisson-disk sampling.
struct SamplingRequest {
  std::optional<double> radius;       ///< m; see poisson_radius() for a number of samples per cell
  std::optional<std::int64_t> count;  ///< used if there is no radius; met within 2 %
  std::uint64_t seed = 0;
  std::int64_t budget = std::numeric_limits<std::int32_t>::max();  ///< more samples than this are refused beforehand
};

/// About how many samples sample_region() will make at this radius: 2 % off for regions many radii wide.
template <int dim>
double expected_count(const Region<dim>& region, double radius);

/// Fills a region. `name` stands first in messages (a file or a scene object).
/// A count is met by trying radii, at most 5 (12 for small counts); if none comes within 2 %, which only a handful of
/// samples can cause, the nearest is taken with a warning.
/// Throws Error (usage) if neither or an impossible radius or count is given, or if no sample fits; Error (resources)
/// if the budget would be exceeded.
template <int dim>
Samples<dim> sample_region(const Region<dim>& region, const SamplingRequest& request, const std::string& name);

/// The same for a mesh from prepare_mesh() and for a polygon after orient().
Samples<3> sample_mesh(const TriangleMesh& mesh, const SamplingRequest& request, const std::string& name);
Samples<2> sample_polygon(const Polygon& polygon, const SamplingRequest& request, const std::string& name);

/// A regular lattice: per_axis^dim samples in each cell of a grid whose nodes are multiples of cell_size (m), those
/// that lie in the region. `jitter` moves each by up to that share of half the spacing along each axis (0: not at all,
/// 1: anywhere in its own lattice cell), but never out of the region.
/// Throws Error as sample_region().
template <int dim>
Samples<dim> sample_lattice(const Region<dim>& region, double cell_size, int per_axis, const std::string& name,
                            double jitter = 0, std::uint64_t seed = 0);

extern template double expected_count<2>(const Region<2>&, double);
extern template double expected_count<3>(const Region<3>&, double);
extern template Samples<2> sample_region<2>(const Region<2>&, const SamplingRequest&, const std::string&);
extern template Samples<3> sample_region<3>(const Region<3>&, const SamplingRequest&, const std::string&);
extern template Samples<2> sample_lattice<2>(const Region<2>&, double, int, const std::string&, double, std::uint64_t);
extern template Samples<3> sample_lattice<3>(const Region<3>&, double, int, const std::string&, double, std::uint64_t);

}  // namespace firn
