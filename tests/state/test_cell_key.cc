#include <firn/state/cell_key.h>
#include <firn/state/grid.h>
#include <gtest/gtest.h>

#include <type_traits>

#include "support/random.h"

namespace firn {
namespace {

template <class Dim>
class CellKeys : public testing::Test {
 protected:
  static constexpr int kDim = Dim::value;

  Index<kDim> random_cell(std::int64_t reach) {
    Index<kDim> cell;
    for (auto& c : cell) c = static_cast<std::int64_t>(random.next() % static_cast<std::uint64_t>(2 * reach)) - reach;
    return cell;
  }

  test::Random random{1};
};
using Dims = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(CellKeys, Dims);

/// Place on the Morton curve by its definition: one bit of every axis at a time, the first axis first.
template <int dim>
bool morton_less(const Index<dim>& a, const Index<dim>& b) {
  for (int bit = 40; bit >= 0; --bit) {
    for (std::size_t d = 0; d < dim; ++d) {
      const auto x = (a[d] + CellKey<dim>::kCellLimit) >> bit & 1, y = (b[d] + CellKey<dim>::kCellLimit) >> bit & 1;
      if (x != y) return x < y;
    }
  }
  return false;
}

TYPED_TEST(CellKeys, LeadBackToTheirCell) {
  constexpr int dim = TypeParam::value;
  for (const std::int64_t reach : {std::int64_t(4), std::int64_t(1000), CellKey<dim>::kCellLimit}) {
    for (int n = 0; n < 10000; ++n) {
      const auto cell = this->random_cell(reach);
      EXPECT_EQ(cell_of_key<dim>(cell_key<dim>(cell)), cell);
    }
  }
}

TYPED_TEST(CellKeys, ReachTheirLimitsAndNoFurther) {
  constexpr int dim = TypeParam::value;
  constexpr std::int64_t kLimit = CellKey<dim>::kCellLimit;
  EXPECT_GE(kLimit, 1 << 20);
  for (std::size_t d = 0; d < dim; ++d) {
    for (const std::int64_t c : {-kLimit, kLimit - 1}) {
      Index<dim> cell = {};
      cell[d] = c;
      EXPECT_TRUE(fits_key<dim>(cell));
      EXPECT_EQ(cell_of_key<dim>(cell_key<dim>(cell)), cell);
    }
    for (const std::int64_t c : {-kLimit - 1, kLimit}) {
      Index<dim> cell = {};
      cell[d] = c;
      EXPECT_FALSE(fits_key<dim>(cell));
    }
  }
}

TYPED_TEST(CellKeys, SortAlongTheMortonCurve) {
  constexpr int dim = TypeParam::value;
  for (const std::int64_t reach : {std::int64_t(8), CellKey<dim>::kCellLimit}) {
    for (int n = 0; n < 10000; ++n) {
      const auto a = this->random_cell(reach), b = this->random_cell(reach);
      EXPECT_EQ(cell_key<dim>(a) < cell_key<dim>(b), morton_less<dim>(a, b));
    }
  }
}

TYPED_TEST(CellKeys, GroupTheCellsOfABlock) {
  constexpr int dim = TypeParam::value;
  for (int n = 0; n < 10000; ++n) {
    const auto cell = this->random_cell(1000);
    const auto origin = block_origin<dim>(block_of_cell<dim>(cell_key<dim>(cell)));
    for (std::size_t d = 0; d < dim; ++d) {
      // The nearest multiple of the side that is not above, also for negative coordinates.
      EXPECT_EQ(origin[d], cell[d] - ((cell[d] % kBlockSide<dim>)+kBlockSide<dim>) % kBlockSide<dim>);
    }
    EXPECT_EQ(block_of_cell<dim>(cell_key<dim>(origin)), block_of_cell<dim>(cell_key<dim>(cell)));
    EXPECT_LE(cell_key<dim>(origin), cell_key<dim>(cell));
    EXPECT_LT(cell_key<dim>(cell) - cell_key<dim>(origin), std::uint64_t(kBlockNodes<dim>));
  }
}

}  // namespace
}  // namespace firn
