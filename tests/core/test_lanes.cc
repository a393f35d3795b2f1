#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/test_lanes.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <firn/core/lanes-inl.h>

#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace firn {
namespace HWY_NAMESPACE {

template <class Real>
Real largest_of(const Real* values) {
  return largest_lane(load_lanes(values));
}
/// Of the lanes that are above zero.
template <class Real>
std::uint64_t positive_bits(const Real* values) {
  return bits_of(load_lanes(values) > Lanes<Real>(Real(0)));
}

float largest_float(const float* values) { return largest_of(values); }
double largest_double(const double* values) { return largest_of(values); }
std::uint64_t bits_float(const float* values) { return positive_bits(values); }
std::uint64_t bits_double(const double* values) { return positive_bits(values); }
std::size_t lanes(std::size_t bytes) { return bytes == 4 ? Lanes<float>::kCount : Lanes<double>::kCount; }

}  // namespace HWY_NAMESPACE
}  // namespace firn
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <firn/core/simd.h>
#include <gtest/gtest.h>

#include <array>
#include <string>

namespace firn {
namespace {

HWY_EXPORT(largest_float);
HWY_EXPORT(largest_double);
HWY_EXPORT(bits_float);
HWY_EXPORT(bits_double);
HWY_EXPORT(lanes);

float largest(const float* values) { return FIRN_DISPATCH(largest_float)(values); }
double largest(const double* values) { return FIRN_DISPATCH(largest_double)(values); }
std::uint64_t bits(const float* values) { return FIRN_DISPATCH(bits_float)(values); }
std::uint64_t bits(const double* values) { return FIRN_DISPATCH(bits_double)(values); }

template <class Real>
void expect_each_lane_counts() {
  const std::size_t count = FIRN_DISPATCH(lanes)(sizeof(Real));
  for (std::size_t lane = 0; lane < count; ++lane) {
    std::array<Real, 16> values;
    values.fill(Real(-2));
    values[lane] = Real(3);
    EXPECT_EQ(largest(values.data()), Real(3)) << lane;
    EXPECT_EQ(bits(values.data()), std::uint64_t(1) << lane);
    values[lane] = Real(-1);
    EXPECT_EQ(largest(values.data()), Real(-1)) << lane;
    EXPECT_EQ(bits(values.data()), 0u);
  }
}

TEST(Lanes, EachCountsInTheLargestAndInTheBits) {
  for (const std::string& target : available_simd_targets()) {
    SCOPED_TRACE(target);
    select_simd_target(target);
    expect_each_lane_counts<float>();
    expect_each_lane_counts<double>();
  }
  select_simd_target(available_simd_targets().back());
}

}  // namespace
}  // namespace firn
#endif  // HWY_ONCE
