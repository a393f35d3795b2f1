// What is copied to the graphics memory.

#include <firn/apps/viewer/cloud_data.h>
#include <firn/render/color_map.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace firn {
namespace {

/// Numbers of many sizes; seven particles are more than one block and not whole ones.
template <class T>
std::vector<T> numbers(std::size_t count) {
  std::vector<T> x;
  for (std::size_t i = 0; i < count; ++i) x.push_back(static_cast<T>((static_cast<double>(i) - 7.25) * 1.125));
  return x;
}

template <class T>
Snapshot snapshot_of(std::size_t particles) {
  Snapshot snapshot;
  snapshot.materials = {{"stuff", "snow", "", 0, particles}};
  snapshot.columns.push_back({"position", "m", "", 3, numbers<T>(3 * particles)});
  return snapshot;
}

template <class T>
void check_positions(std::size_t particles, const Vec3d& origin) {
  const Snapshot snapshot = snapshot_of<T>(particles);
  // One more than is written, so that writing too much is seen.
  std::vector<float> written(3 * particles + 1, -77);
  write_positions(snapshot, origin, written.data());
  for (std::size_t p = 0; p < particles; ++p) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(written[3 * p + static_cast<std::size_t>(c)],
                static_cast<float>(value(snapshot.columns[0], p, c) - origin[c]));
    }
  }
  EXPECT_EQ(written.back(), -77);
}

TEST(CloudData, PositionsCountFromTheOriginInEitherPrecision) {
  for (const std::size_t particles : {0, 1, 3, 4, 7, 8, 13}) {
    check_positions<double>(particles, {{1.5, -2.25, 1e6}});
    check_positions<float>(particles, {});
  }
}

TEST(CloudData, FarFromTheWorldsOriginPlacesKeepTheirDigits) {
  Snapshot snapshot = snapshot_of<double>(5);
  for (double& x : std::get<std::vector<double>>(snapshot.columns[0].values)) x += 1e9;
  std::vector<float> written(15);
  write_positions(snapshot, snapshot.position(0), written.data());
  EXPECT_EQ(written[3], 3 * 1.125F);
  write_positions(snapshot, {}, written.data());
  EXPECT_NE(written[3] - written[0], 3 * 1.125F) << "negative control";
}

template <class T>
void check_values(int components) {
  const std::size_t particles = 7;
  const SnapshotColumn column{"c", "", "", components, numbers<T>(particles * static_cast<std::size_t>(components))};
  std::vector<float> written(particles + 1, -77);
  write_values(column, written.data());
  for (std::size_t p = 0; p < particles; ++p) EXPECT_FLOAT_EQ(written[p], static_cast<float>(color_value(column, p)));
  EXPECT_EQ(written.back(), -77);
}

TEST(CloudData, ValuesAreWhatOneColoursBy) {
  for (const int components : {1, 3, 9}) {
    check_values<float>(components);
    check_values<double>(components);
  }
  check_values<std::int32_t>(1);
  check_values<std::int64_t>(1);
}

TEST(CloudData, TheRangeOfAFewThousandParticlesIsAboutThatOfAll) {
  for (const int components : {1, 3}) {
    std::vector<double> x;
    for (int i = 0; i < 20000 * components; ++i) x.push_back((i / components * 7919 % 20011) * 1e-3);
    const SnapshotColumn column{"c", "", "", components, std::move(x)};
    const auto sampled = sampled_color_range(column, 20000), all = automatic_color_range(column, 20000);
    const double width = all[1] - all[0];
    EXPECT_NE(sampled, all) << "negative control: it is a sample";
    EXPECT_NEAR(sampled[0], all[0], 0.02 * width);
    EXPECT_NEAR(sampled[1], all[1], 0.02 * width);
  }
}

TEST(CloudData, TinyAndLostNumbersStayWhatTheyAre) {
  const float tiny = 1e-15F, nan = std::numeric_limits<float>::quiet_NaN();
  const SnapshotColumn column{"c", "", "", 3, std::vector<float>{3 * tiny, 0, 4 * tiny, nan, 0, 0}};
  float written[2];
  write_values(column, written);
  EXPECT_FLOAT_EQ(written[0], 5 * tiny);
  EXPECT_TRUE(std::isnan(written[1]));
}

}  // namespace
}  // namespace firn
