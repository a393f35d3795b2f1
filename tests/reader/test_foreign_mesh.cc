// Meshes of other formats are those of their OBJ twins.

#include <firn/core/error.h>
#include <firn/io/mesh_reader.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "reader/foreign_files.h"
#include "support/temporary_folder.h"

namespace firn {
namespace {

/// The corners of the triangles, turned so that the first is the smallest, in a fixed order.
std::vector<std::array<Vec3d, 3>> sorted_triangles(const TriangleMesh& mesh) {
  const auto less = [](const Vec3d& a, const Vec3d& b) {
    return std::array{a[0], a[1], a[2]} < std::array{b[0], b[1], b[2]};
  };
  std::vector<std::array<Vec3d, 3>> triangles;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<Vec3d, 3> corners;
    for (int i = 0; i < 3; ++i) {
      corners[static_cast<std::size_t>(i)] = mesh.corner(t, i);
      // Neighbours of a rounded number must not be sorted by its last digit.
      for (int c = 0; c < 3; ++c) {
        double& x = corners[static_cast<std::size_t>(i)][c];
        x = std::round(x * 1e4) / 1e4 + 0.0;
      }
    }
    std::ranges::rotate(corners, std::ranges::min_element(corners, less));
    triangles.push_back(corners);
  }
  std::ranges::sort(triangles,
                    [&](const auto& a, const auto& b) { return std::ranges::lexicographical_compare(a, b, less); });
  return triangles;
}

void expect_same_surface(const TriangleMesh& found, const TriangleMesh& expected) {
  EXPECT_EQ(found.vertices.size(), expected.vertices.size());
  ASSERT_EQ(found.triangles.size(), expected.triangles.size());
  EXPECT_NEAR(enclosed_volume(found), enclosed_volume(expected), 1e-5 * enclosed_volume(expected));
  EXPECT_NEAR(surface_area(found), surface_area(expected), 1e-5 * surface_area(expected));
  const auto a = sorted_triangles(found), b = sorted_triangles(expected);
  for (std::size_t t = 0; t < a.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) EXPECT_LT(norm(a[t][i] - b[t][i]), 2e-4) << "triangle " << t;
  }
}

TriangleMesh turned(TriangleMesh mesh, double scale, bool z_up_to_y_up) {
  for (Vec3d& x : mesh.vertices) {
    if (z_up_to_y_up) x = {{x[0], x[2], -x[1]}};
    x = scale * x;
  }
  return mesh;
}

TEST(ForeignMesh, IsThatOfTheObjTwin) {
  const TemporaryFolder folder;
  const auto obj = folder.write("twin.obj", l_shape_obj());
  const TriangleMesh twin = read_mesh(obj);
  ASSERT_NEAR(enclosed_volume(twin), 4, 1e-12);
  for (const char* format : {"gltf2", "glb2", "collada", "3mf", "x3d", "x"}) {
    SCOPED_TRACE(format);
    const std::string ending = format == std::string("gltf2")     ? "gltf"
                               : format == std::string("glb2")    ? "glb"
                               : format == std::string("collada") ? "DAE"
                                                                  : format;
    expect_same_surface(read_mesh(exported(obj, format, folder / ("mesh." + ending))), twin);
  }
}

TEST(ForeignMesh, UnitsAndAxesOfTheFormat) {
  const TemporaryFolder folder;
  const auto obj = folder.write("twin.obj", l_shape_obj());
  const TriangleMesh twin = read_mesh(obj);
  // An FBX file says how many centimetres its unit is, and assimp writes 1.
  const auto fbx = exported(obj, "fbxa", folder / "mesh.fbx");
  expect_same_surface(turned(read_mesh(fbx), 100, false), twin);
  std::string text = file_bytes(fbx);
  const std::string unit = "\"UnitScaleFactor\", \"double\", \"Number\", \"\", ";
  text.replace(text.find(unit) + unit.size(), 1, "100");
  expect_same_surface(read_mesh(folder.write("metres.fbx", text)), twin);
  // 3DS and Collada files say or mean that z is up, and assimp turns them.
  expect_same_surface(read_mesh(exported(obj, "3ds", folder / "mesh.3ds")), turned(twin, 1, true));
  std::string dae = file_bytes(exported(obj, "collada", folder / "mesh.dae"));
  dae.replace(dae.find("Y_UP"), 4, "Z_UP");
  dae.replace(dae.find("meter=\"1\""), 9, "meter=\".1\"");
  expect_same_surface(turned(read_mesh(folder.write("z.dae", dae)), 10, false), turned(twin, 1, true));
}

const std::string kOff = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

TEST(ForeignMesh, WrittenByHand) {
  const TemporaryFolder folder;
  const TriangleMesh mesh = read_mesh(folder.write("a tetrahedron ü.off", kOff));
  EXPECT_EQ(mesh.vertices.size(), 4U);
  EXPECT_NEAR(enclosed_volume(mesh), 1.0 / 6, 1e-7);
}

/// Two instances of a triangle, moved, scaled and mirrored by nodes within nodes.
const std::string kNodes = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"children":[1,2],"translation":[10,0,0]},{"mesh":0,"scale":[2,2,2]},{"mesh":0,"scale":[-1,1,1],"translation":[0,0,5]}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
{"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6}],
"buffers":[{"byteLength":42,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIA"}]})";

TEST(ForeignMesh, TransformsOfNodesAreApplied) {
  const TemporaryFolder folder;
  const TriangleMesh mesh = read_mesh(folder.write("nodes.gltf", kNodes));
  ASSERT_EQ(mesh.triangles.size(), 2U);
  const Vec3d expected[2][3] = {{{{10, 0, 0}}, {{12, 0, 0}}, {{10, 2, 0}}}, {{{10, 0, 5}}, {{9, 0, 5}}, {{10, 1, 5}}}};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(norm(mesh.corner(0, static_cast<int>(i)) - expected[0][i]), 0);
    // The mirror image turns the other way round, so that its outside stays outside.
    EXPECT_EQ(norm(mesh.corner(1, static_cast<int>(i)) - expected[1][(3 - i) % 3]), 0);
  }
}

TEST(ForeignMesh, RefusalsNameTheFile) {
  const TemporaryFolder folder;
  const auto said = [&](const std::string& name, const std::string& bytes) {
    const auto path = folder.write(name, bytes);
    std::string text = message_of([&] { read_mesh(path); });
    return text.starts_with(path.string()) ? text.substr(path.string().size() - name.size()) : "not named: " + text;
  };
  EXPECT_EQ(said("m.fbx", ""), "m.fbx: the file is empty");
  EXPECT_EQ(said("m.fbx", "hello").find("m.fbx: cannot be read: "), 0U);
  EXPECT_EQ(said("m.gltf", "{}").find("m.gltf: cannot be read: "), 0U);
  EXPECT_EQ(said("m.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n").find("m.off: "), 0U);
  const std::string unknown = said("m.max", "x");
  EXPECT_EQ(
      unknown.find("m.max: unknown kind of mesh '.max'; Firn reads .obj, .ply and .stl, and with assimp .3ds .3mf"), 0U)
      << unknown;
  EXPECT_NE(message_of([&] { read_mesh(folder / "none.glb"); }).find("No such file"), std::string::npos);
}

}  // namespace
}  // namespace firn
