#include <firn/measure/id_order.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace firn {
namespace {

IdOrder order_of(const std::vector<std::uint32_t>& ids) {
  return {ids.size(), [&](const auto& visit) { std::for_each(ids.begin(), ids.end(), visit); }};
}

void expect_ranks(std::vector<std::uint32_t> ids) {
  const IdOrder order = order_of(ids);
  std::sort(ids.begin(), ids.end());
  for (std::uint32_t rank = 0; rank < ids.size(); ++rank) ASSERT_EQ(order.rank(ids[rank]), rank) << ids[rank];
}

/// `count` different ids, a share of those from `first` on, in no order.
std::vector<std::uint32_t> some_ids(std::uint32_t first, std::uint32_t count, std::uint32_t step) {
  std::mt19937 random(count);
  std::vector<std::uint32_t> ids;
  for (std::uint32_t i = 0; i < count; ++i)
    ids.push_back(first + i * step + static_cast<std::uint32_t>(random()) % step);
  std::shuffle(ids.begin(), ids.end(), random);
  return ids;
}

TEST(IdOrder, CountsLowerIds) {
  expect_ranks({});
  expect_ranks({0});
  expect_ranks({4294967295});
  expect_ranks({63, 64, 0, 127, 128});
  expect_ranks(some_ids(0, 5000, 1));
  expect_ranks(some_ids(977, 5000, 3));
}

TEST(IdOrder, CopesWithIdsThatLieFarApart) {
  expect_ranks({0, 4294967295});
  expect_ranks({4294967295, 7, 0, 1u << 31});
  expect_ranks(some_ids(5, 5000, 800000));
}

}  // namespace
}  // namespace firn
