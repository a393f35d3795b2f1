#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "firn/apps/fma_rate.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <firn/core/lanes-inl.h>

HWY_BEFORE_NAMESPACE();
namespace firn {
namespace HWY_NAMESPACE {

/// Runs `rounds` of multiply-adds on independent registers. Returns their sum, so that nothing is optimised away, and
/// the number of floating point operations in `operations`.
float multiply_add_rounds(long rounds, double* operations) {
  using L = Lanes<float>;
  constexpr int kChains = 12;  // more than latency times throughput of any target
  L chains[kChains];
  for (int c = 0; c < kChains; ++c) chains[c] = L(1.0F + 0.001F * static_cast<float>(c));
  const L factor = L(0.999F), term = L(0.001F);
  for (long r = 0; r < rounds; ++r) {
    for (L& chain : chains) chain = mul_add(chain, factor, term);
  }
  L sum = chains[0];
  for (int c = 1; c < kChains; ++c) sum = sum + chains[c];
  HWY_ALIGN float values[L::kCount];
  store_lanes(sum, values, L::kCount);
  *operations = 2.0 * static_cast<double>(rounds) * kChains * static_cast<double>(L::kCount);
  float total = 0;
  for (const float value : values) total += value;
  return total;
}

}  // namespace HWY_NAMESPACE
}  // namespace firn
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <firn/apps/bench_rates.h>
#include <firn/core/simd.h>

#include <chrono>

namespace firn {

HWY_EXPORT(multiply_add_rounds);

double fma_rate_once() {
  constexpr long kRounds = 4000000;
  const auto start = std::chrono::steady_clock::now();
  double operations = 0;
  const volatile float sink = FIRN_DISPATCH(multiply_add_rounds)(kRounds, &operations);
  (void)sink;
  return operations / std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace firn
#endif  // HWY_ONCE
