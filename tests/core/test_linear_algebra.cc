#include <firn/core/linear_algebra.h>
#include <gtest/gtest.h>

namespace firn {
namespace {

const Mat3d kA = {{2, -1, 3, 0.5, 4, -2, 1, 7, -6}};

TEST(LinearAlgebra, DeterminantMatchesHandExpansion) {
  // 2 (4 * -6 + 2 * 7) + 1 (0.5 * -6 + 2 * 1) + 3 (0.5 * 7 - 4 * 1) = -20 - 1 - 1.5
  EXPECT_DOUBLE_EQ(determinant(kA), -22.5);
  EXPECT_DOUBLE_EQ(determinant(Mat<double, 2>{{3, 2, -1, 4}}), 14);
}

TEST(LinearAlgebra, AdjugateTimesMatrixIsDeterminantTimesIdentity) {
  const Mat3d product = kA * adjugate(kA);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(product(i, j), i == j ? -22.5 : 0, 1e-13);
  }
  const Mat<double, 2> b = {{3, 2, -1, 4}};
  const Mat<double, 2> small = b * adjugate(b);
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) EXPECT_NEAR(small(i, j), i == j ? 14 : 0, 1e-14);
  }
}

TEST(LinearAlgebra, MatrixVectorAndOuterFollowRowMajorIndexing) {
  const Vec3d x = {{1, 10, 100}};
  const Vec3d y = kA * x;
  EXPECT_DOUBLE_EQ(y[0], 292);
  EXPECT_DOUBLE_EQ(y[1], -159.5);
  EXPECT_DOUBLE_EQ(y[2], -529);
  EXPECT_DOUBLE_EQ(outer(x, y)(0, 2), -529);
  EXPECT_DOUBLE_EQ(outer(x, y)(2, 0), 29200);
  EXPECT_DOUBLE_EQ(transpose(kA)(0, 2), 1);
  EXPECT_DOUBLE_EQ(trace(kA), 0);
}

TEST(LinearAlgebra, CrossIsPerpendicularAndRightHanded) {
  const Vec3d z = cross(Vec3d{{1, 0, 0}}, Vec3d{{0, 1, 0}});
  EXPECT_DOUBLE_EQ(z[2], 1);
  const Vec3d a = {{1, 2, 3}}, b = {{-4, 0.5, 2}};
  EXPECT_NEAR(dot(a, cross(a, b)), 0, 1e-14);
  EXPECT_NEAR(norm(normalized(a)), 1, 1e-15);
}

}  // namespace
}  // namespace firn
