#include <firn/core/error.h>
#include <firn/geometry/mesh_report.h>
#include <firn/io/mesh_parsers.h>
#include <firn/io/mesh_reader.h>
#include <gtest/gtest.h>
#include "support/temporary_folder.h"

#include <clocale>
#include <cmath>

namespace firn {
namespace {

const std::string kTetrahedron =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
    "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

TriangleMesh read_obj(const std::string& text) {
  const TemporaryFolder folder;
  return read_mesh(folder.write("mesh.obj", text));
}

/// The message without the folder.
std::string obj_error(const std::string& text) {
  const std::string message = message_of([&] { read_obj(text); });
  const std::size_t name = message.find("mesh.obj");
  return name == std::string::npos ? message : message.substr(name);
}

TEST(ObjReader, ReadsTriangles) {
  const TriangleMesh mesh = read_obj(kTetrahedron);
  ASSERT_EQ(mesh.vertices.size(), 4u);
  ASSERT_EQ(mesh.triangles.size(), 4u);
  EXPECT_EQ(mesh.triangles[3], (std::array<std::int32_t, 3>{1, 2, 3}));
  EXPECT_DOUBLE_EQ(enclosed_volume(mesh), 1.0 / 6);
}

TEST(ObjReader, PolygonsNegativeIndicesAndAllIndexForms) {
  const TriangleMesh mesh = read_obj(
      "\xEF\xBB\xBF# comment\r\nmtllib a.mtl\r\no thing\r\nv 0 0 0 1.0\r\nv +1 0 0\r\nvt 0 0\r\nvn 0 0 1\r\n"
      "v 1e0 1 -.0 0.5 0.5 0.5\r\nv 0 1 0 # last\r\nf -4/1 -3//1 3/1/1 \\\r\n -1\r\n\r\ns off");
  ASSERT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.triangles[0], (std::array<std::int32_t, 3>{0, 1, 2}));
  EXPECT_EQ(mesh.triangles[1], (std::array<std::int32_t, 3>{0, 2, 3}));
  EXPECT_DOUBLE_EQ(mesh.vertices[1][0], 1);
}

TEST(ObjReader, FacesMayComeBeforeTheirVertices) {
  EXPECT_EQ(read_obj("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n").triangles.size(), 1u);
}

TEST(ObjReader, ErrorsNameLineAndColumn) {
  const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_EQ(obj_error(three + "f 1 2 9\n"), "mesh.obj:4:7: face refers to vertex 9, the file has 3");
  EXPECT_EQ(obj_error(three + "f 1 2 0\n"), "mesh.obj:4:7: face refers to vertex 0; OBJ files count from 1");
  EXPECT_EQ(obj_error(three + "f 1 -4 2\n"),
            "mesh.obj:4:5: face refers to vertex -4, but only 3 vertices come before it");
  EXPECT_EQ(obj_error(three + "f 1 2\n"), "mesh.obj:4:1: a face needs at least 3 corners, got 2");
  EXPECT_EQ(obj_error(three + "f 1/2/3// 2 3\n"), "mesh.obj:4:3: normal of a face is not a whole number: '3//'");
  EXPECT_EQ(obj_error(three + "f 1 2 99999999999999999999\n"),
            "mesh.obj:4:7: vertex of a face is not a whole number: '99999999999999999999'");
  EXPECT_EQ(obj_error("v 0 0\n"), "mesh.obj:1:6: z of vertex 1 is missing");
  EXPECT_EQ(obj_error("v 0 0 0\nv 1 nan 0\n"), "mesh.obj:2:5: y of vertex 2 is not finite: 'nan'");
  EXPECT_EQ(obj_error("v inf 0 0\n"), "mesh.obj:1:3: x of vertex 1 is not finite: 'inf'");
  EXPECT_EQ(obj_error("v 1e999 0 0\n"), "mesh.obj:1:3: x of vertex 1 is too large: '1e999'");
  EXPECT_EQ(obj_error("v 1,5 0 0\n"),
            "mesh.obj:1:3: x of vertex 1 is not a number: '1,5'; decimals are written with a point");
  EXPECT_EQ(obj_error("hello\nworld\n"),
            "mesh.obj:1:1: the file has no vertices (no line starts with 'v'); is it an OBJ file?");
  EXPECT_EQ(obj_error(three), "mesh.obj: the file has 3 vertices but no faces");
  EXPECT_EQ(obj_error(three + std::string("\0", 1)), "mesh.obj:4:1: this is not a text file (zero byte at offset 24)");
  EXPECT_EQ(obj_error(""), "mesh.obj: the file is empty");
}

TEST(ObjReader, ContinuedLinesKeepTheirPosition) {
  EXPECT_EQ(obj_error("v 0 0 0\nf 1 \\\n 1 \\\n  7\n"), "mesh.obj:4:3: face refers to vertex 7, the file has 1");
}

TEST(ObjReader, ALineOf20MegabytesIsRefused) {
  EXPECT_EQ(obj_error("v 0 0 0\nf 1 " + std::string(20 << 20, '1') + "\n"),
            "mesh.obj:2:1: the line is longer than 16 MiB");
}

TEST(ObjReader, ReadsTheSameInALocaleWithDecimalCommas) {
  const char* found = std::setlocale(LC_ALL, "de_DE.UTF-8");
  const TriangleMesh mesh = read_obj("v 0.5 0 0\nv 1.25 0 0\nv 0 1 0\nf 1 2 3\n");
  std::setlocale(LC_ALL, "C");
  EXPECT_DOUBLE_EQ(mesh.vertices[1][0], 1.25) << (found ? found : "this machine has no German locale");
}

TEST(MeshReader, FilesThatCannotBeRead) {
  const TemporaryFolder folder;
  const auto kind_of = [](const std::filesystem::path& path) {
    try {
      read_mesh(path);
    } catch (const Error& error) {
      return error.exit_code();
    }
    return 0;
  };
  const std::string missing = message_of([&] { read_mesh(folder / "snöw 雪.obj"); });
  EXPECT_NE(missing.find("snöw 雪.obj: cannot read the mesh: No such file or directory"), std::string::npos) << missing;
  EXPECT_EQ(kind_of(folder / "none.obj"), 3);
  const std::string relative = message_of([&] { read_mesh("none.obj"); });
  EXPECT_NE(relative.find("(looked for /"), std::string::npos) << relative;

  std::filesystem::create_directory(folder / "folder.obj");
  const std::string directory = message_of([&] { read_mesh(folder / "folder.obj"); });
  EXPECT_NE(directory.find("Is a directory"), std::string::npos) << directory;

  const std::string kind = message_of([&] { read_mesh(folder.write("a.max", "x")); });
  EXPECT_NE(kind.find("unknown kind of mesh '.max'; Firn reads .obj, .ply and .stl"), std::string::npos) << kind;
  EXPECT_EQ(kind_of(folder.write("a.max", "x")), 2);
  EXPECT_EQ(read_mesh(folder.write("UPPER.OBJ", kTetrahedron)).triangles.size(), 4u);
}

TEST(OutlineReader, ChainsLinesAndOrients) {
  const TemporaryFolder folder;
  const std::string square = "v 0 0 0\nv 0 2 0\nv 2 2 0\nv 2 0 0\n";
  const Polygon outline = read_polygon(folder.write("a.obj", square + "l 1 2 3\nl 1 4\nl 4 3\n"));
  ASSERT_EQ(outline.loops.size(), 1u);
  EXPECT_DOUBLE_EQ(area(outline), 4);

  const std::string hole = "v 0.5 0.5 0\nv 1 0.5 0\nv 1 1 0\n";
  EXPECT_DOUBLE_EQ(area(read_polygon(folder.write("b.obj", square + hole + "l 1 2 3 4 1\nl 5 6 7 5\n"))), 4 - 0.125);
}

TEST(OutlineReader, TakesTheBorderOfFaces) {
  const TemporaryFolder folder;
  const Polygon outline = read_polygon(folder.write("a.obj", "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nf 1 2 3\nf 1 3 4\n"));
  ASSERT_EQ(outline.loops.size(), 1u);
  EXPECT_EQ(outline.loops[0].size(), 4u);
  EXPECT_DOUBLE_EQ(area(outline), 4);
}

TEST(OutlineReader, RefusesOpenBranchingAndRaisedOutlines) {
  const TemporaryFolder folder;
  const std::string square = "v 0 0 0\nv 0 2 0\nv 2 2 0\nv 2 0 0\n";
  const auto error = [&](const std::string& text) {
    return message_of([&] { read_polygon(folder.write("a.obj", text)); });
  };
  EXPECT_NE(error(square + "l 1 2 3 4\n").find("the outline ends at vertex 1; close it"), std::string::npos);
  EXPECT_NE(error(square + "l 1 2 3 4 1\nl 1 3\n").find("branches at vertex 1"), std::string::npos);
  EXPECT_NE(error("v 0 0 0\nv 1 0 0.5\nv 0 1 0\nl 1 2 3 1\n").find("vertex 2 has z = 0.5"), std::string::npos);
  EXPECT_NE(error("v 0 0 0\n").find("neither lines (l) nor faces (f)"), std::string::npos);
}

TEST(ExampleMeshes, AreClosedAndFaceOutwards) {
  const std::filesystem::path folder = std::filesystem::path(FIRN_SOURCE_DIR) / "scenes/meshes";
  const TriangleMesh cube = read_mesh(folder / "cube.obj"), sphere = read_mesh(folder / "sphere.obj");
  EXPECT_EQ(cube.triangles.size(), 12u);
  EXPECT_DOUBLE_EQ(enclosed_volume(cube), 1);
  EXPECT_TRUE(inspect(cube).is_closed());
  EXPECT_TRUE(inspect(sphere).is_closed());
  EXPECT_NEAR(enclosed_volume(sphere), std::acos(-1.0) / 6, 0.01);
  EXPECT_NEAR(area(read_polygon(folder / "drop2d.obj")), 0.5426, 1e-4);
}

}  // namespace
}  // namespace firn
