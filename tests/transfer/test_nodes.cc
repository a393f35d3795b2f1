#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transfer/test_nodes.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <firn/transfer/nodes-inl.h>

#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace firn {
namespace HWY_NAMESPACE {

/// Reads a pair of nodes in each lane: number i of node c of lane l is written to out[(l * 2 + c) * dim + i]. First by
/// load_node_pair, then one by one.
template <class Real, int dim>
void read_pairs(const Real* nodes, const std::int32_t* first, Real* by_pair, Real* one_by_one) {
  using L = Lanes<Real>;
  Vec<L, dim> pair[2];
  load_node_pair<dim>(nodes, first, pair);
  HWY_ALIGN Real values[L::kCount];
  for (std::size_t c = 0; c < 2; ++c) {
    const Vec<L, dim> single = load_nodes<dim>(nodes + c * kNodeWidth, first);
    for (int i = 0; i < dim; ++i) {
      const auto write = [&](const L& lanes, Real* out) HWY_ATTR {
        store_lanes(lanes, values, L::kCount);
        for (std::size_t l = 0; l < L::kCount; ++l) out[(l * 2 + c) * dim + static_cast<std::size_t>(i)] = values[l];
      };
      write(pair[c][i], by_pair);
      write(single[i], one_by_one);
    }
  }
}

void read_float(int dim, const float* nodes, const std::int32_t* first, float* by_pair, float* one_by_one) {
  (dim == 2 ? read_pairs<float, 2> : read_pairs<float, 3>)(nodes, first, by_pair, one_by_one);
}
void read_double(int dim, const double* nodes, const std::int32_t* first, double* by_pair, double* one_by_one) {
  (dim == 2 ? read_pairs<double, 2> : read_pairs<double, 3>)(nodes, first, by_pair, one_by_one);
}
std::size_t lanes(std::size_t bytes) { return bytes == 4 ? Lanes<float>::kCount : Lanes<double>::kCount; }

}  // namespace HWY_NAMESPACE
}  // namespace firn
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <firn/core/simd.h>
#include <firn/state/aligned.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace firn {
namespace {

HWY_EXPORT(read_float);
HWY_EXPORT(read_double);
HWY_EXPORT(lanes);

void read(int dim, const float* nodes, const std::int32_t* first, float* by_pair, float* one_by_one) {
  FIRN_DISPATCH(read_float)(dim, nodes, first, by_pair, one_by_one);
}
void read(int dim, const double* nodes, const std::int32_t* first, double* by_pair, double* one_by_one) {
  FIRN_DISPATCH(read_double)(dim, nodes, first, by_pair, one_by_one);
}

template <class Real>
void expect_nodes_in_their_lanes(int dim) {
  constexpr std::int32_t kNodes = 60;
  AlignedVector<Real> nodes(kNodes * kNodeWidth);
  for (std::size_t n = 0; n < nodes.size(); ++n) nodes[n] = static_cast<Real>(n);
  const std::size_t count = FIRN_DISPATCH(lanes)(sizeof(Real));
  std::vector<std::int32_t> first(count);
  for (std::size_t l = 0; l < count; ++l) first[l] = static_cast<std::int32_t>((7 * l + 3) % (kNodes - 1)) * kNodeWidth;
  const auto width = static_cast<std::size_t>(dim);
  std::vector<Real> by_pair(count * 2 * width), one_by_one(by_pair.size());
  read(dim, nodes.data(), first.data(), by_pair.data(), one_by_one.data());
  for (std::size_t l = 0; l < count; ++l) {
    for (std::size_t c = 0; c < 2; ++c) {
      for (std::size_t i = 0; i < width; ++i) {
        const Real expected = nodes[static_cast<std::size_t>(first[l]) + c * kNodeWidth + i];
        EXPECT_EQ(by_pair[(l * 2 + c) * width + i], expected) << l << " " << c << " " << i;
        EXPECT_EQ(one_by_one[(l * 2 + c) * width + i], expected) << l << " " << c << " " << i;
      }
    }
  }
}

TEST(LoadNodes, BringsEachParticlesNodesToItsLane) {
  for (const std::string& target : available_simd_targets()) {
    SCOPED_TRACE(target);
    select_simd_target(target);
    for (const int dim : {2, 3}) {
      expect_nodes_in_their_lanes<float>(dim);
      expect_nodes_in_their_lanes<double>(dim);
    }
  }
  select_simd_target(available_simd_targets().back());
}

}  // namespace
}  // namespace firn
#endif  // HWY_ONCE
