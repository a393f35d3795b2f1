#include "bad_input.h"

namespace firn::test {
namespace {

using BadMesh = BadInput;

/// An axis-aligned cube, outside out, whose first vertex has the number `first`.
std::string cube(double low, double side, int first = 1) {
  std::ostringstream obj;
  for (int corner = 0; corner < 8; ++corner) {
    obj << "v " << low + side * (corner & 1) << " " << low + side * (corner >> 1 & 1) << " "
        << low + side * (corner >> 2) << "\n";
  }
  constexpr int kFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& face : kFaces) {
    obj << "f";
    for (const int corner : face) obj << " " << corner + first;
    obj << "\n";
  }
  return obj.str();
}

TEST_F(BadMesh, FaceIndexOutOfRange) {  // row 1
  use_mesh(kCorners + "f 1 3 2\nf 1 2 9\n");
  expect_refused(run(), 2, "thing.obj:6:7: face refers to vertex 9, the file has 4");
  use_mesh(kCorners + "f 1 3 2\nf 1 2 0\n");
  expect_refused(run(), 2, "thing.obj:6:7: face refers to vertex 0; OBJ files count from 1");
  use_mesh(kCorners + "f 1 3 2\nf 1 2 -9\n");
  expect_refused(run(), 2, "thing.obj:6:7: face refers to vertex -9, but only 4 vertices come before it");
}

TEST_F(BadMesh, NotTextTruncatedTooLongOrOfWindows) {  // row 2
  use_mesh(std::string("o \x7f\x45\x4c\x46\0\0", 8));
  expect_refused_like(run(), 2, R"(thing.obj:1:1: this is not a text file \(zero byte at offset 6\))");
  use_mesh(kCorners + "f 1 3");
  expect_refused(run(), 2, "thing.obj:5:1: a face needs at least 3 corners, got 2");
  use_mesh("v " + std::string(20'000'000, '1'));
  expect_refused(run(), 2, "thing.obj:1:1: the line is longer than 16 MiB");
  use_mesh(kCorners + "f 1/2/3// 2 3\n");
  expect_refused(run(), 2, "thing.obj:5:3: normal of a face is not a whole number: '3//'");
  std::string windows;
  for (const char c : kCorners + "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
    windows += c == '\n' ? "\r\n" : std::string(1, c);
  use_mesh(windows);
  EXPECT_EQ(run("--set end_time=0.02").exit_code, 0);
}

TEST_F(BadMesh, VertexThatIsNotFinite) {  // row 3
  use_mesh("v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n");
  expect_refused(run(), 2, "thing.obj:2:7: z of vertex 2 is not finite: 'nan'");
  use_mesh("v 0 0 1e999\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  expect_refused(run(), 2, "thing.obj:1:7: z of vertex 1 is too large: '1e999'");
}

const std::string kHole =
    "thing.obj: the surface is open: 3 boundary edges, 4.24 m long in all, for example vertices 2 and 3 at (1, 0, 0) - "
    "(0, 1, 0); vertices 2 and 4 at (1, 0, 0) - (0, 0, 1); vertices 3 and 4 at (0, 1, 0) - (0, 0, 1); ";

TEST_F(BadMesh, OpenSurfaceIsFilledWithAWarning) {  // row 4
  use_mesh(kCorners + "f 1 3 2\nf 1 2 4\nf 1 4 3\n");
  expect_warned(run(), kHole + "what the winding number calls inside is filled");
  EXPECT_GT(stats("particles").at(0), 400);
}

TEST_F(BadMesh, OpenSurfaceIsAnErrorIfStrict) {  // row 4
  use_mesh(kCorners + "f 1 3 2\nf 1 2 4\nf 1 4 3\n");
  expect_refused(run("--set strict_mesh=true"), 2, kHole + "close the holes or set strict_mesh = false");
}

TEST_F(BadMesh, EdgesOfMoreThanTwoTrianglesAreListed) {  // row 5
  use_mesh(kCorners + "v 0 0 -1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\nf 1 2 3\nf 1 5 2\nf 1 3 5\nf 2 5 3\n");
  expect_warned(
      run(),
      "thing.obj: 3 edges have more than two triangles, for example vertices 1 and 2 at (0, 0, 0) - (1, 0, 0); "
      "vertices 1 and 3 at (0, 0, 0) - (0, 1, 0); vertices 2 and 3 at (1, 0, 0) - (0, 1, 0)");
}

TEST_F(BadMesh, OverlappingPartsAreFilledOnce) {  // row 5
  use_mesh(cube(0, 1) + cube(0.5, 1, 9));
  expect_warned(run(), "thing.obj: parts of the surface overlap; what lies inside several of them is filled once");
  EXPECT_NEAR(stats("volume").at(0), 1.875, 0.01) << "and not 2";
}

TEST_F(BadMesh, InsideOutIsFlipped) {  // row 6
  use_mesh(kCorners + "f 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n");
  expect_warned(run(), "thing.obj: the surface is inside out (negative volume); its triangles were flipped");
  EXPECT_NEAR(stats("volume").at(0), 1.0 / 6, 1e-4);
}

TEST_F(BadMesh, MixedOrientationNamesTheVertices) {  // row 6
  use_mesh(kCorners + "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 4 3\n");
  expect_refused(
      run(), 2,
      "thing.obj: 3 pairs of neighbouring triangles face different sides, for example along vertices 2 and 3 "
      "at (1, 0, 0) - (0, 1, 0); vertices 2 and 4 at (1, 0, 0) - (0, 0, 1); vertices 3 and 4 at (0, 1, 0) - "
      "(0, 0, 1); make the normals consistent (in Blender: Mesh > Normals > Recalculate Outside)");
}

TEST_F(BadMesh, FlatOnesNeedAThickness) {  // row 7
  use_mesh("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n");
  expect_refused(run(), 2,
                 "thing.obj: the mesh encloses no volume (0 m^3 in a box of 1 x 1 x 0 m); give it a thickness (in "
                 "Blender: the modifier Solidify)");
}

TEST_F(BadMesh, RepeatedAndDegenerateFacesAreCounted) {  // row 8
  use_mesh(kCorners + "v 0 0 0\nv 2 0 0\nf 1 3 2\nf 5 2 4\nf 1 4 3\nf 2 3 4\nf 2 3 4\nf 1 1 2\nf 1 2 6\n");
  expect_warned(
      run(), "thing.obj: removed 2 degenerate and 1 repeated triangles, merged 1 vertex at the same places as others");
  use_mesh(kCorners + "v 0 0 0\nf 1 3 2\nf 5 2 4\nf 1 4 3\nf 2 3 4\n");
  EXPECT_EQ(check().errors, "firn: thing.obj: merged 1 vertex at the same places as others\n");
}

TEST_F(BadMesh, MillimetresShowInCellsAndInTheCheck) {  // row 9
  use_mesh(cube(0, 20));
  expect_refused(
      run("--set 'resolution={cell_size=0.01}'"), 2,
      "body \"thing\": 6.4e+10 particles are more than the 2147483647 that Firn can number: it is 2e+03 cells "
      "wide (cell size 0.01 m); did you mean units = \"mm\"? Otherwise use larger cells");
  expect_warned(firn("run scene.toml -o mm --set body.thing.units=mm --set 'resolution={cell_size=0.021}'"),
                "body \"thing\": it is 0.95 cells wide (0.02 m, cells of 0.021 m) and gets 7 particles; did you mean "
                "units = \"m\" instead of \"mm\"? Otherwise use smaller cells");
  EXPECT_TRUE(matches(check().output, "[^]*body +thing: 500 particles, 8000 m.3, 20 m or 4.0 cells wide\n[^]*"));
}

}  // namespace
}  // namespace firn::test
