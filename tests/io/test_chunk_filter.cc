#include <firn/io/chunk_filter.h>
#include <firn/io/frame_hdf5.h>
#include <firn/io/frame_image.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstring>

namespace firn::hdf5 {
namespace {

std::vector<std::byte> bytes_of(const std::string& text) {
  std::vector<std::byte> bytes(text.size());
  std::memcpy(bytes.data(), text.data(), text.size());
  return bytes;
}

std::uint32_t noise(std::uint32_t i) {
  std::uint32_t x = i * 2654435761U;
  x = (x ^ (x >> 15)) * 0x85EBCA6BU;
  return (x ^ (x >> 13)) * 0xC2B2AE35U;
}

TEST(ChunkFilter, ChecksumIsFletchers) {
  // As words with the first byte higher: sums modulo 65535 of 6162 6364 6500, and of their partial sums.
  EXPECT_EQ(fletcher32(bytes_of("abcde")),
            ((3 * 0x6162U + 2 * 0x6364U + 0x6500U) % 65535) << 16 | ((0x6162U + 0x6364U + 0x6500U) % 65535));
  EXPECT_EQ(fletcher32({}), 0u);
}

TEST(ChunkFilter, IsUndoneByZlibAndAnUnshuffle) {
  std::vector<float> values;
  for (std::uint32_t i = 0; i < 5000; ++i) {
    values.push_back(i % 3 == 0 ? 1.0F : std::ldexp(static_cast<float>(noise(i) >> 8), -24));
  }
  ChunkFilter filter;
  for (int repeat = 0; repeat < 2; ++repeat) {
    const auto filtered = filter.apply(std::as_bytes(std::span(values)), sizeof(float));
    std::vector<Bytef> planes(values.size() * sizeof(float));
    uLongf size = planes.size();
    ASSERT_EQ(uncompress(planes.data(), &size, reinterpret_cast<const Bytef*>(filtered.data()), filtered.size() - 4),
              Z_OK);
    ASSERT_EQ(size, planes.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
      Bytef raw[4];
      for (std::size_t b = 0; b < 4; ++b) raw[b] = planes[b * values.size() + i];
      ASSERT_EQ(std::memcmp(raw, &values[i], 4), 0) << i;
    }
  }
}

TEST(ChunkFilter, StoresNoiseAndPressesTheRest) {
  std::vector<std::uint32_t> random, counting;
  for (std::uint32_t i = 0; i < 20000; ++i) {
    random.push_back(noise(i));
    counting.push_back(i);
  }
  ChunkFilter filter;
  const std::size_t stored = filter.apply(std::as_bytes(std::span(random)), 4).size();
  EXPECT_NEAR(static_cast<double>(stored), 80000, 200);
  EXPECT_LT(filter.apply(std::as_bytes(std::span(counting)), 4).size(), 4000u);
}

template <class T>
void expect_read_back(std::size_t rows, int components) {
  std::vector<T> values;
  for (std::size_t i = 0; i < rows * static_cast<std::size_t>(components); ++i) {
    values.push_back(static_cast<T>(noise(static_cast<std::uint32_t>(i)) % (i % 5 == 0 ? 3 : 1000003)));
  }
  const auto bytes = make_file([&](hid_t file) {
    write_rows(file, "x", native_type<T>(), values.data(), rows, components == 1 ? 0 : components);
  });
  open_image(bytes, [&](hid_t file) { EXPECT_EQ(read_values<T>(file, "x"), values) << rows << ' ' << components; });
}

TEST(ChunkFilter, HdfReadsWhatItMade) {
  for (const std::size_t rows : {1, 2, 1000, 32768, 32769, 100000}) {
    expect_read_back<float>(rows, 3);
    expect_read_back<std::int64_t>(rows, 1);
    expect_read_back<std::uint8_t>(rows, 1);
    expect_read_back<double>(rows, 9);
  }
}

}  // namespace
}  // namespace firn::hdf5
