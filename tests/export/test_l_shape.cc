// V40: one object that lies in the same place whichever way it is exported.

#include <openvdb/openvdb.h>

#include <cstdlib>

#include "export/export_run.h"

namespace firn::test {
namespace {

class LShape : public ExportRun {
 protected:
  static int check(const std::filesystem::path& file, const std::string& up) {
    return std::system(
        (FIRN_PYTHON " -B '" FIRN_SOURCE_DIR "/tests/export/check_l.py' " + in_shell(file) + " " + up).c_str());
  }
  static int check_quietly(const std::filesystem::path& file, const std::string& up) {
    return std::system(
        (FIRN_PYTHON " -B '" FIRN_SOURCE_DIR "/tests/export/check_l.py' " + in_shell(file) + " " + up + " 2>/dev/null")
            .c_str());
  }
};

struct Box {
  openvdb::Vec3d lower, upper;
};

/// Where a grid is more than `threshold` (fog) or negative (level set).
Box box_of(const openvdb::FloatGrid& grid) {
  const bool is_level_set = grid.getGridClass() == openvdb::GRID_LEVEL_SET;
  Box box{openvdb::Vec3d(1e9), openvdb::Vec3d(-1e9)};
  for (auto voxel = grid.cbeginValueOn(); voxel; ++voxel) {
    if (is_level_set ? *voxel > 0 : *voxel < 0.5F) continue;
    const openvdb::Vec3d x = grid.indexToWorld(voxel.getCoord());
    for (int a = 0; a < 3; ++a) {
      box.lower[a] = std::min(box.lower[a], x[a]);
      box.upper[a] = std::max(box.upper[a], x[a]);
    }
  }
  return box;
}

void expect_l(const std::filesystem::path& path, const char* scalar, const char* vector, bool z_up) {
  openvdb::initialize();
  openvdb::io::File file(path.string());
  file.open(false);
  const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid(scalar));
  ASSERT_TRUE(grid);
  const Box box = box_of(*grid);
  const openvdb::Vec3d lower = z_up ? openvdb::Vec3d(0, -0.3, 0) : openvdb::Vec3d(0, 0, 0);
  const openvdb::Vec3d upper = z_up ? openvdb::Vec3d(0.6, 0, 1) : openvdb::Vec3d(0.6, 1, 0.3);
  for (int a = 0; a < 3; ++a) {
    EXPECT_NEAR(box.lower[a], lower[a], 0.035) << scalar << ' ' << a;
    EXPECT_NEAR(box.upper[a], upper[a], 0.035) << scalar << ' ' << a;
  }
  const auto v = openvdb::gridPtrCast<openvdb::Vec3SGrid>(file.readGrid(vector));
  ASSERT_TRUE(v);
  const openvdb::Vec3d inside = z_up ? openvdb::Vec3d(0.02, -0.1, 0.8) : openvdb::Vec3d(0.02, 0.8, 0.1);
  const openvdb::Vec3s velocity = v->tree().getValue(openvdb::Coord::round(v->worldToIndex(inside)));
  const openvdb::Vec3s expected = z_up ? openvdb::Vec3s(1, -3, 2) : openvdb::Vec3s(1, 2, 3);
  for (int a = 0; a < 3; ++a) EXPECT_NEAR(velocity[a], expected[a], 1e-3) << a;
}

TEST_F(LShape, PointsLieWhereTheClientExpects) {
  for (const std::string format : {"ply", "csv", "vtp"}) {
    for (const std::string client : {"", "blender", "houdini", "paraview"}) {
      const std::filesystem::path to = out(format + client);
      const ProgramResult result =
          firn("export",
               "--frames 1 --format " + format + (client.empty() ? "" : " --for " + client) + " -o " + in_shell(to));
      ASSERT_EQ(result.exit_code, 0) << result.errors;
      const std::filesystem::path file = to / ("particles.0001." + format);
      const bool z_up = client == "blender";
      EXPECT_EQ(check(file, z_up ? "z" : "y"), 0) << format << ' ' << client;
      EXPECT_NE(check_quietly(file, z_up ? "y" : "z"), 0) << "the check accepts another axis";
    }
  }
}

TEST_F(LShape, VolumesLieWhereTheClientExpects) {
  ASSERT_EQ(firn("export", "--frames 1 --format vdb -o " + in_shell(out("v"))).exit_code, 0);
  expect_l(out("v/volume.0001.vdb"), "density", "v", false);
  ASSERT_EQ(firn("export", "--frames 1 --format vdb --for blender -o " + in_shell(out("b"))).exit_code, 0);
  expect_l(out("b/volume.0001.vdb"), "density", "velocity", true);
  ASSERT_EQ(firn("surface", "--frames 1 --format vdb --for houdini -o " + in_shell(out("h"))).exit_code, 0);
  expect_l(out("h/surface.0001.vdb"), "surface", "v", false);
  ASSERT_EQ(firn("surface", "--frames 1 --format vdb --for blender -o " + in_shell(out("c"))).exit_code, 0);
  expect_l(out("c/surface.0001.vdb"), "surface", "velocity", true);
}

TEST_F(LShape, SurfacesLieWhereTheClientExpects) {
  // Importers of OBJ take it for granted that y is up, and turn it.
  ASSERT_EQ(firn("surface", "--frames 1 --for blender -o " + in_shell(out("o"))).exit_code, 0);
  EXPECT_EQ(check(out("o/surface.0001.obj"), "y"), 0);
  ASSERT_EQ(firn("surface", "--frames 1 --for blender --format ply -o " + in_shell(out("p"))).exit_code, 0);
  EXPECT_EQ(check(out("p/surface.0001.ply"), "z"), 0);
  ASSERT_EQ(firn("surface", "--frames 1 --format ply -o " + in_shell(out("q"))).exit_code, 0);
  EXPECT_EQ(check(out("q/surface.0001.ply"), "y"), 0);
}

TEST_F(LShape, AFrameByItselfKnowsWhichAxisIsUp) {
  std::filesystem::copy_file(frame(1), out("particles.0001.hdf"));
  ASSERT_EQ(run_firn("export " + in_shell(out("particles.0001.hdf")) + " --for blender").exit_code, 0);
  EXPECT_EQ(check(out("particles.0001.ply"), "z"), 0);
}

TEST_F(LShape, ASceneWithZUpLiesTheSameForBlender) {
  // The same L, described with z up.
  const std::string text = file_bytes(FIRN_SOURCE_DIR "/tests/export/l_shape.toml");
  std::string turned = "up = \"z\"\n" + text;
  const auto replace = [&](const std::string& from, const std::string& to) {
    const std::size_t at = turned.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    turned.replace(at, from.size(), to);
  };
  replace("size = [0.2, 1, 0.2]", "size = [0.2, 0.2, 1]");
  replace("position = [0.1, 0.5, 0.1]", "position = [0.1, -0.1, 0.5]");
  replace("size = [0.4, 0.2, 0.2]", "size = [0.4, 0.2, 0.2]");
  replace("position = [0.4, 0.1, 0.1]", "position = [0.4, -0.1, 0.1]");
  replace("size = [0.2, 0.2, 0.1]", "size = [0.2, 0.1, 0.2]");
  replace("position = [0.1, 0.1, 0.25]", "position = [0.1, -0.25, 0.1]");
  for (int i = 0; i < 3; ++i) replace("velocity = [1, 2, 3]", "velocity = [1, -3, 2]");
  folder_.write("z.toml", turned);
  ASSERT_EQ(run_firn("run " + in_shell(out("z.toml")) + " -o " + in_shell(out("z"))).exit_code, 0);
  for (const auto& [client, up] : {std::pair("blender", "z"), std::pair("houdini", "y"), std::pair("paraview", "z")}) {
    const ProgramResult result = run_firn("export " + in_shell(out("z")) + " --frames 1 --format ply --for " + client +
                                          " -o " + in_shell(out(client)));
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(check(out(std::string(client) + "/particles.0001.ply"), up), 0) << client;
  }
}

}  // namespace
}  // namespace firn::test
