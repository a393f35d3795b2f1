#include <firn/render/density_field.h>
#include <gtest/gtest.h>

#include <cmath>

namespace firn {
namespace {

std::vector<Vec3f> lattice(int n, float spacing) {
  std::vector<Vec3f> places;
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        places.push_back(spacing * Vec3f{{static_cast<float>(i), static_cast<float>(j), static_cast<float>(k)}});
      }
    }
  }
  return places;
}

TEST(DensityField, IsOneInsideAndZeroOutside) {
  const DensityField field(lattice(16, 0.1F), 0.1F);
  EXPECT_NEAR(field.sample({{0.75F, 0.75F, 0.75F}}).density, 1, 0.02);
  EXPECT_NEAR(norm(field.sample({{0.75F, 0.75F, 0.75F}}).gradient), 0, 0.3);
  EXPECT_EQ(field.sample({{3, 0.75F, 0.75F}}).density, 0);
  EXPECT_EQ(field.sample({{-100, 0, 0}}).density, 0);
}

TEST(DensityField, GradientPointsIntoTheBody) {
  const DensityField field(lattice(16, 0.1F), 0.1F);
  const Vec3f left = normalized(field.sample({{0, 0.75F, 0.75F}}).gradient);
  EXPECT_GT(left[0], 0.98F);
  const Vec3f top = normalized(field.sample({{0.75F, 1.5F, 0.75F}}).gradient);
  EXPECT_LT(top[1], -0.98F);
}

TEST(DensityField, GradientIsTheDerivativeOfTheDensity) {
  const DensityField field(lattice(9, 0.1F), 0.1F);
  const Vec3f x = {{0.031F, 0.113F, 0.872F}};
  const DensityField::Sample at = field.sample(x);
  for (int a = 0; a < 3; ++a) {
    const float h = 4e-3F;
    Vec3f plus = x, minus = x;
    plus[a] += h;
    minus[a] -= h;
    const float slope = (field.sample(plus).density - field.sample(minus).density) / (2 * h);
    EXPECT_NEAR(slope, at.gradient[a], 0.02F * norm(at.gradient) + 1e-3F);
  }
}

TEST(DensityField, RunawayParticlesDoNotThinTheBody) {
  std::vector<Vec3f> places = lattice(16, 0.1F);
  places.push_back({{1e7F, -1e7F, 1e7F}});
  const DensityField field(places, 0.1F);
  EXPECT_NEAR(field.sample({{0.75F, 0.75F, 0.75F}}).density, 1, 0.02);
  EXPECT_EQ(field.sample({{1e7F, -1e7F, 1e7F}}).density, 0);
}

TEST(DensityField, WithoutParticlesIsEmpty) {
  EXPECT_EQ(DensityField({}, 0.1F).sample({}).density, 0);
  EXPECT_EQ(DensityField({{{0, 0, 0}}}, 0.0F).sample({}).density, 0);
}

}  // namespace
}  // namespace firn
