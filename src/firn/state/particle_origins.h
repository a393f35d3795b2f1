#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace firn {

/// Bodies and undeformed volumes of a material's particles. Few of them differ, since all particles of a body have the
/// same volume: so particles hold the number of such a pair, 2 bytes instead of 6.
template <class Real>
class ParticleOrigins {
 public:
  /// The number of a body and a volume, m^3 (m^2 in 2D); of a new pair the next one. Error(usage) if that is above
  /// 65535.
  std::uint16_t number_of(std::uint16_t body, Real rest_volume);

  std::uint16_t body(std::uint16_t number) const { return bodies_[number]; }
  Real rest_volume(std::uint16_t number) const { return volumes_[number]; }
  std::span<const Real> rest_volumes() const { return volumes_; }

 private:
  std::vector<std::uint16_t> bodies_;
  std::vector<Real> volumes_;
  std::map<std::pair<std::uint16_t, Real>, std::uint16_t> numbers_;
};

}  // namespace firn
