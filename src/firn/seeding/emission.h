#pragma once

#include <firn/geometry/pose.h>
#include <firn/seeding/region.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

/// Where and when new particles begin. Both ways are functions of what was asked for, the time and a count alone, so
/// that neither frames nor time steps leave a trace in the stream, and a run can go on from that count.
namespace firn {

/// A particle on its way.
template <int dim>
struct Emitted {
  Vec<double, dim> x;  ///< m
  Vec<double, dim> v;  ///< m/s
};

/// Where the frame of an emitter is at a time after its start, s.
template <int dim>
using PoseAt = std::function<Pose<dim>(double time)>;

/// Particles that come at a given rate out of the section of a region across the velocity, through the middle of the
/// region's bounds. The k-th (from 0) comes at (k + 1/2) / rate. Its place follows a Kronecker sequence over the
/// section (with the golden ratio in 2D and Roberts' R2 sequence in 3D), so that with time as the third direction the
/// stream is a lattice of low discrepancy: neither rows nor clumps at any rate. Random places would clump: particles
/// begin unstressed however close they are.
template <int dim>
class SectionStream {
 public:
  /// @param velocity m/s, not zero; @param rate particles/s
  /// Error(usage), which begins with `name`, if the section is empty.
  SectionStream(std::shared_ptr<const Region<dim>> region, const Vec<double, dim>& velocity, double rate,
                const std::string& name);

  /// Of the section, m^2 (m in 2D); 0.2 % exact for a region that is not a box.
  double area() const { return area_; }

  /// How many have come after this time, s. At most a half of a particle off rate times time.
  std::int64_t count_at(double time) const;

  /// Number `from` to before `to`, at `time` (s) after the first could come, in free fall since each came. With a
  /// frame, region and velocity are in that, and each particle leaves it from where it was when the particle came.
  std::vector<Emitted<dim>> between(std::int64_t from, std::int64_t to, double time, const Vec<double, dim>& gravity,
                                    const PoseAt<dim>& frame = {});

 private:
  Vec<double, dim> candidate(std::int64_t j) const;
  Vec<double, dim> place(std::int64_t k);

  std::shared_ptr<const Region<dim>> region_;
  Vec<double, dim> velocity_, centre_;
  std::vector<Vec<double, dim>> across_;  ///< directions times half the section's width, m
  double rate_, area_ = 0;
  std::int64_t count_ = 0, candidate_ = 0;  ///< the place of number count_ is found from this candidate on
};

/// Distance between neighbours that particles of this volume (m^dim) have in a lattice, m.
template <int dim>
double lattice_spacing(double volume);

/// The points of a cubic lattice that moves with the velocity, those inside the region at `time` (s) after it lay
/// evenly about the middle of the region's bounds. In ascending order of x, then y, then z. Every point keeps its place
/// in the moving frame, so that material that moves on makes room for exactly the next layer.
template <int dim>
std::vector<Vec<double, dim>> moving_lattice(const Region<dim>& region, double spacing,
                                             const Vec<double, dim>& velocity, double time);

/// Those of the points that have no occupied place nearer than `distance` (m).
template <int dim>
std::vector<Vec<double, dim>> with_room(std::span<const Vec<double, dim>> points,
                                        std::span<const Vec<double, dim>> occupied, double distance);

extern template class SectionStream<2>;
extern template class SectionStream<3>;

}  // namespace firn
