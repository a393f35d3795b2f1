#include <firn/core/error.h>
#include <firn/state/particle_origins.h>

#include <limits>

namespace firn {

template <class Real>
std::uint16_t ParticleOrigins<Real>::number_of(std::uint16_t body, Real rest_volume) {
  if (const auto known = numbers_.find({body, rest_volume}); known != numbers_.end()) return known->second;
  if (volumes_.size() > std::numeric_limits<std::uint16_t>::max()) {
    throw Error(ErrorKind::usage, "particles of a material can have 65536 different bodies and volumes, and not more");
  }
  const auto number = static_cast<std::uint16_t>(volumes_.size());
  bodies_.push_back(body);
  volumes_.push_back(rest_volume);
  numbers_[{body, rest_volume}] = number;
  return number;
}

template class ParticleOrigins<float>;
template class ParticleOrigins<double>;

}  // namespace firn
