#include <firn/state/column_store.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <vector>

#include "support/random.h"

namespace firn {
namespace {

class Columns : public testing::Test {
 protected:
  Columns() {
    store.add({"wide", "", "", 2, 8});
    store.add({"narrow", "", "", 3, 4});
    store.add({"other", "", "", 1, 8});
  }

  std::uint64_t wide(std::size_t i, int c) const { return 1000 * i + static_cast<std::size_t>(c) + (1ull << 40); }
  std::uint32_t narrow(std::size_t i, int c) const {
    return static_cast<std::uint32_t>(10 * i) + static_cast<unsigned>(c);
  }

  void fill(std::size_t from) {
    for (std::size_t i = from; i < store.size(); ++i) {
      for (int c = 0; c < 2; ++c) store.component<std::uint64_t>(0, c)[i] = wide(i, c);
      for (int c = 0; c < 3; ++c) store.component<std::uint32_t>(1, c)[i] = narrow(i, c);
      store.component<double>(2)[i] = static_cast<double>(i);
    }
  }

  /// Element i is what element `was` was filled with.
  void expect_element(std::size_t i, std::size_t was) const {
    for (int c = 0; c < 2; ++c) EXPECT_EQ(store.component<std::uint64_t>(0, c)[i], wide(was, c));
    for (int c = 0; c < 3; ++c) EXPECT_EQ(store.component<std::uint32_t>(1, c)[i], narrow(was, c));
    EXPECT_EQ(store.component<double>(2)[i], static_cast<double>(was));
  }

  void expect_zero(std::size_t i) const {
    for (int c = 0; c < 2; ++c) EXPECT_EQ(store.component<std::uint64_t>(0, c)[i], 0u);
    for (int c = 0; c < 3; ++c) EXPECT_EQ(store.component<std::uint32_t>(1, c)[i], 0u);
    EXPECT_EQ(store.component<double>(2)[i], 0);
  }

  ColumnStore store;
};

TEST_F(Columns, KeepTheirElementsWhenTheyGrowOrShrink) {
  std::size_t filled = 0;
  for (const std::size_t size : {0u, 1u, 5u, 1000u, 1001u, 7u, 9u, 0u, 3u}) {
    const std::size_t kept = std::min(filled, size);
    store.resize(size);
    ASSERT_EQ(store.size(), size);
    for (std::size_t i = 0; i < kept; ++i) expect_element(i, i);
    for (std::size_t i = kept; i < size; ++i) expect_zero(i);
    fill(kept);
    filled = size;
  }
}

TEST_F(Columns, AreAlignedAndPadded) {
  for (const std::size_t size : {1u, 17u, 1000u}) {
    store.resize(size);
    fill(0);
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(reinterpret_cast<std::uintptr_t>(store.component<std::uint32_t>(1, c)) % 64, 0u);
      std::vector<std::uint32_t> behind(ColumnStore::kPadding, 1);
      std::memcpy(behind.data(), store.component<std::uint32_t>(1, c) + size, behind.size() * 4);
      EXPECT_EQ(behind, std::vector<std::uint32_t>(ColumnStore::kPadding, 0));
    }
  }
}

TEST_F(Columns, AreReorderedTogether) {
  test::Random random(1);
  for (const std::size_t size : {0u, 1u, 2u, 100u, 40000u}) {
    store.resize(size);
    fill(0);
    std::vector<std::uint32_t> order(size);
    std::iota(order.begin(), order.end(), 0u);
    for (std::size_t i = size; i > 1; --i) std::swap(order[i - 1], order[random.next() % i]);
    store.reorder(order);
    for (std::size_t i = 0; i < size; ++i) expect_element(i, order[i]);
  }
}

TEST_F(Columns, HashSeesEveryColumnAndTheOrder) {
  store.resize(100);
  fill(0);
  const std::uint64_t before = store.hash();
  EXPECT_EQ(store.hash(), before);
  for (int column = 0; column < store.column_count(); ++column) {
    for (int c = 0; c < store.spec(column).components; ++c) {
      auto* byte = store.component<unsigned char>(column, c) + 50 * store.spec(column).element_bytes;
      *byte ^= 1;
      EXPECT_NE(store.hash(), before) << column << ", " << c;
      *byte ^= 1;
    }
  }
  EXPECT_EQ(store.hash(), before);
  std::swap(store.component<double>(2)[0], store.component<double>(2)[1]);
  EXPECT_NE(store.hash(), before);
  std::swap(store.component<double>(2)[0], store.component<double>(2)[1]);
  store.resize(99);
  EXPECT_NE(store.hash(), before);
}

}  // namespace
}  // namespace firn
