#include "simulation/source_scenes.h"

#include <firn/core/error.h>
#include <firn/state/snapshot.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace firn {
namespace {

/// Mean displacement along x of slices of a bar, from a straight line through them: its slope is the strain.
struct Stretch {
  double strain = 0;  ///< of the middle half
  double end = 0;     ///< displacement of the last cell over its place
  double stress = 0;  ///< mean of the middle half, Pa
};

Stretch stretch(const Snapshot& before, const Snapshot& after, double end_at) {
  const SnapshotColumn& pressure = *after.find("pressure");
  double sum = 0, n = 0, sx = 0, su = 0, sxx = 0, sxu = 0, end = 0, ends = 0;
  for (std::size_t p = 0; p < before.size(); ++p) {
    const double x = before.position(p)[0], u = after.position(p)[0] - x;
    if (x > end_at - 0.05) {
      end += u;
      ends += x;
    }
    if (x < 0.25 * end_at || x > 0.75 * end_at) continue;
    ++n;
    // The other two stresses are zero.
    sum -= 3 * value(pressure, p);
    sx += x;
    su += u;
    sxx += x * x;
    sxu += x * u;
  }
  return {(n * sxu - sx * su) / (n * sxx - sx * sx), end / ends, sum / n};
}

/// A bar of 1 m by 0.2 m (by 0.2 m) that is held at x < 0, with E = 1 MPa and Poisson's ratio 0, and no gravity. Its
/// first sound takes 0.13 s for a period; loads come over seven of these.
std::string bar(int dimension, const std::string& traction, const std::string& fill) {
  const bool flat = dimension == 2;
  return "dimension = " + std::to_string(dimension) +
         "\nprecision = \"double\"\nframe_rate = 2\nend_time = 1\nresolution.cell_size = 0.05\ngravity = " +
         (flat ? "[0, 0]" : "[0, 0, 0]") +
         "\n[material.rubber]\nmodel = \"neo_hookean\"\nyoungs_modulus = 1e6\npoisson_ratio = 0\ndensity = 1000\n"
         "[[body]]\nname = \"bar\"\nshape = \"box\"\nmaterial = \"rubber\"\nfill = \"" +
         fill + "\"\nsize = " + (flat ? "[1.1, 0.2]" : "[1.1, 0.2, 0.2]") +
         "\nposition = " + (flat ? "[0.45, 0]" : "[0.45, 0, 0]") +
         "\n[[pin]]\nshape = \"box\"\nsize = " + (flat ? "[0.2002, 1]" : "[0.2002, 1, 1]") +
         "\nposition = " + (flat ? "[-0.1, 0]" : "[-0.1, 0, 0]") +
         "\n[[traction]]\nname = \"pull\"\nshape = \"box\"\nsize = " + (flat ? "[0.2, 1]" : "[0.2, 1, 1]") +
         "\nposition = " + (flat ? "[1, 0]" : "[1, 0, 0]") + "\n" + traction;
}

Stretch stretch_of(const std::string& text) {
  const auto simulation = make(text);
  const Snapshot before = simulation->snapshot();
  run(*simulation);
  return stretch(before, simulation->snapshot(), 1);
}

constexpr double kStress = 1e4;
const std::string kRamp = " * 0.5 * (1 - cos(pi * min(t / 0.95, 1)))\"";

TEST(Traction, StretchesABarByStressOverModulus) {
  const std::string pull = "normal = [1, 0]\nstress = [\"1e4" + kRamp + ", 0]\n";
  const Stretch found = stretch_of(bar(2, pull, "lattice"));
  EXPECT_NEAR(found.stress, kStress, 2e-3 * kStress);
  EXPECT_NEAR(found.strain, kStress / 1e6, 0.02 * kStress / 1e6);
  EXPECT_NEAR(found.end, kStress / 1e6, 0.03 * kStress / 1e6);
  // The load does not depend on where the particles lie; that a bar of four random ones per cell is softer is the
  // method's own error.
  const Stretch random = stretch_of(bar(2, pull, "poisson"));
  EXPECT_NEAR(random.stress, kStress, 0.03 * kStress);
  EXPECT_NEAR(random.strain, kStress / 1e6, 0.1 * kStress / 1e6);
  // The same by a negative pressure, which also pulls at the sides near the end: Poisson's ratio is 0.
  const Stretch by_pressure = stretch_of(bar(2, "pressure = \"-1e4" + kRamp + "\n", "lattice"));
  EXPECT_NEAR(by_pressure.strain, kStress / 1e6, 0.02 * kStress / 1e6);
  EXPECT_NEAR(by_pressure.stress, kStress, 5e-3 * kStress);
  // And what has not begun does nothing.
  EXPECT_NEAR(stretch_of(bar(2, pull + "start = 9\n", "lattice")).strain, 0, 1e-9);
}

TEST(Traction, StretchesABarIn3D) {
  const std::string pull = "normal = [1, 0, 0]\nstress = [\"1e4" + kRamp + ", 0, 0]\n";
  const Stretch found = stretch_of(bar(3, pull, "lattice"));
  EXPECT_NEAR(found.strain, kStress / 1e6, 0.02 * kStress / 1e6);
  EXPECT_NEAR(found.end, kStress / 1e6, 0.03 * kStress / 1e6);
  EXPECT_NEAR(found.stress, kStress, 2e-3 * kStress);
}

/// Momentum of a free liquid or soft body after 0.1 s.
Vec3d momentum(const std::string& more) {
  const auto simulation = make(scene(more, 0.1, "gravity = [0, 0]\n"));
  run(*simulation);
  return simulation->totals().momentum;
}

TEST(Traction, GivesStressTimesAreaTimesTime) {
  const std::string on_top = "[[traction]]\nshape = \"box\"\nsize = [9, 0.1]\nposition = [0, 0.2]\n";
  // Shear on the top face of 0.2 m, whatever the sides do that are inside the shape too.
  const Vec3d shear = momentum(body() + on_top + "normal = [0, 1]\nstress = [50, 0]\n");
  EXPECT_NEAR(shear[0], 50 * 0.2 * 0.1, 1e-9);
  EXPECT_NEAR(shear[1], 0, 1e-9);
  const Vec3d pressure = momentum(body() + on_top + "pressure = 50\n");
  EXPECT_NEAR(pressure[0], 0, 1e-9);
  EXPECT_NEAR(pressure[1], -50 * 0.2 * 0.1, 1e-9);
  const Vec3d short_time = momentum(body() + on_top + "pressure = 50\nstart = 0.03\nstop = 0.05\n");
  EXPECT_NEAR(short_time[1], -50 * 0.2 * 0.02, 1e-9);
  // From "along stress", as most loads are.
  EXPECT_NEAR(momentum(body() + on_top + "stress = [0, 50]\n")[1], 50 * 0.2 * 0.1, 1e-9);

  const std::string ball = "[[body]]\nshape = \"disk\"\nradius = 0.1\nmaterial = \"liquid\"\n";
  const std::string around = "[[traction]]\nshape = \"disk\"\nradius = 1\npressure = 50\n";
  const Vec3d closed = momentum(ball + around);
  EXPECT_NEAR(norm(closed), 0, 1e-3 * 50 * 0.2 * 0.1) << "a closed surface has no vector area";
  const std::string below = "[[traction]]\nshape = \"box\"\nsize = [1, 1]\nposition = [0, -0.5]\npressure = 50\n";
  EXPECT_NEAR(momentum(ball + below)[1], 50 * 0.2 * 0.1, 0.01 * 50 * 0.2 * 0.1) << "half a disk has its diameter";
}

TEST(Traction, IsOfItsBodyAlone) {
  const std::string two = body() +
                          "[[body]]\nname = \"other\"\nshape = \"box\"\nsize = [0.1, 0.2]\nposition = [1, 0.1]\n"
                          "material = \"liquid\"\n";
  const std::string on_top = "[[traction]]\nshape = \"box\"\nsize = [9, 0.1]\nposition = [0, 0.2]\nstress = [0, 50]\n";
  EXPECT_NEAR(momentum(two + on_top)[1], 50 * 0.3 * 0.1, 1e-9);
  EXPECT_NEAR(momentum(two + on_top + "body = \"other\"\n")[1], 50 * 0.1 * 0.1, 1e-9);
}

TEST(Traction, RefusesAShapeWithoutASurface) {
  const std::string inside =
      "[[traction]]\nname = \"push\"\nshape = \"box\"\nsize = [0.05, 0.05]\nposition = [0, 0.1]\n";
  try {
    make(scene(body() + inside + "stress = [1, 0]\nbody = \"block\"\n"));
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "traction \"push\": at t = 0 its shape holds no surface of body \"block\" that faces normal; move it, "
                 "or make it larger, so that the surface lies inside");
  }
}

}  // namespace
}  // namespace firn
