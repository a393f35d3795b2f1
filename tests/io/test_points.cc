#include <firn/core/error.h>
#include <firn/io/axes.h>
#include <firn/io/frame_series.h>
#include <firn/io/mesh_files.h>
#include <firn/io/mesh_reader.h>
#include <firn/io/point_files.h>
#include <gtest/gtest.h>
#include <io/frame_samples.h>

#include <cstdlib>
#include <cstring>

#include "support/temporary_folder.h"

namespace firn {
namespace {

using Write = void (*)(const std::filesystem::path&, const Snapshot&);

struct Format {
  const char* ending;
  Write write;
};

class Points : public testing::TestWithParam<Format> {
 protected:
  std::filesystem::path write(const Snapshot& snapshot, const std::string& name = "points") const {
    const std::filesystem::path path = folder_ / (name + "." + GetParam().ending);
    GetParam().write(path, snapshot);
    return path;
  }
  static int check(const std::filesystem::path& path, std::size_t count) {
    const std::string command = FIRN_PYTHON " " FIRN_SOURCE_DIR "/tests/io/check_points.py '" + path.string() + "' " +
                                std::to_string(count) + " 2>/dev/null";
    return std::system(command.c_str());
  }

  const TemporaryFolder folder_;
};

INSTANTIATE_TEST_SUITE_P(Formats, Points,
                         testing::Values(Format{"ply", write_ply}, Format{"csv", write_csv}, Format{"vtp", write_vtp}),
                         [](const auto& format) { return std::string(format.param.ending); });

TEST_P(Points, AreReadByAnIndependentReaderAndWrittenAgainAreTheSameBytes) {
  EXPECT_EQ(check(write(sample_snapshot(1000)), 1000), 0);
  EXPECT_NE(check(write(sample_snapshot(998)), 1000), 0) << "the checker accepts other points";
}

TEST_P(Points, NoneAndOneAreLegal) {
  EXPECT_EQ(check(write(sample_snapshot(0), "none"), 0), 0);
  EXPECT_EQ(check(write(sample_snapshot(1), "one"), 1), 0);
}

TEST_P(Points, EqualSnapshotsGiveEqualBytes) {
  EXPECT_EQ(file_bytes(write(sample_snapshot(50), "a")), file_bytes(write(sample_snapshot(50), "b")));
}

TEST_P(Points, FullDiskIsAnError) {
  try {
    GetParam().write("/dev/full", sample_snapshot(100));
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::files);
    EXPECT_NE(std::string(error.what()).find("No space left"), std::string::npos) << error.what();
  }
}

TEST(PointColumns, AreChosenByName) {
  const Snapshot chosen = select_columns(sample_snapshot(4), {"pressure", "position", "pressure", "id"});
  ASSERT_EQ(chosen.columns.size(), 3u);
  EXPECT_EQ(chosen.columns[0].name, "position");
  EXPECT_EQ(chosen.columns[1].name, "pressure");
  EXPECT_EQ(chosen.columns[2].name, "id");
  EXPECT_EQ(message_of([] { select_columns(sample_snapshot(4), {"speed"}); }), "there is no column \"speed\"");
}

TEST(PointColumns, HaveNamesForTheirNumbers) {
  const auto names = [](const char* name, int components) {
    SnapshotColumn column;
    column.name = name;
    column.components = components;
    return component_names(column);
  };
  using List = std::vector<std::string>;
  EXPECT_EQ(names("position", 3), (List{"x", "y", "z"}));
  EXPECT_EQ(names("velocity", 3), (List{"vx", "vy", "vz"}));
  EXPECT_EQ(names("color", 3), (List{"red", "green", "blue"}));
  EXPECT_EQ(names("J", 1), (List{"J"}));
  EXPECT_EQ(names("force", 3), (List{"force_x", "force_y", "force_z"}));
  EXPECT_EQ(names("F", 9)[5], "F_yz");
}

TEST(PointPly, StatesColoursAsBytesAndSmallIdsAsIntegers) {
  Snapshot snapshot = sample_snapshot(2);
  std::get<std::vector<std::int64_t>>(snapshot.columns[2].values) = {1, 2, 3};
  snapshot.columns.push_back({kColorColumn, "", "", 3, std::vector<std::int32_t>{255, 128, 0, 1, 2, 3, 9, 8, 7}});
  const TemporaryFolder folder;
  write_ply(folder / "a.ply", select_columns(snapshot, {"id", kColorColumn}));
  const std::string bytes = file_bytes(folder / "a.ply");
  EXPECT_NE(bytes.find("property int id\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n"),
            std::string::npos);
  EXPECT_EQ(static_cast<unsigned char>(bytes[bytes.size() - 3]), 9);
  EXPECT_EQ(static_cast<unsigned char>(bytes.back()), 7);
}

TEST(PointCsv, NumbersHaveTheDigitsOfTheirType) {
  Snapshot snapshot = sample_snapshot(1);
  std::get<std::vector<float>>(snapshot.columns[0].values) = {0.1F, 1e-20F, 3};
  const TemporaryFolder folder;
  write_csv(folder / "a.csv", select_columns(snapshot, {}));
  EXPECT_EQ(file_bytes(folder / "a.csv"), "x,y,z\n0.1,1e-20,3\n");
}

TEST(Pvd, ListsFilesWithTheirTimes) {
  const TemporaryFolder folder;
  write_pvd(folder / "a.pvd", {{"a & b.0001.vtp", 0}, {"c.vtp", 0.1}});
  const std::string text = file_bytes(folder / "a.pvd");
  EXPECT_NE(text.find("<DataSet timestep=\"0\" part=\"0\" file=\"a &amp; b.0001.vtp\"/>"), std::string::npos) << text;
  EXPECT_NE(text.find("<DataSet timestep=\"0.1\" part=\"0\" file=\"c.vtp\"/>"), std::string::npos) << text;
}

TEST(Axes, TurnForthAndBackIsTheSame) {
  const Snapshot original = sample_snapshot(20);
  Snapshot turned_one = original;
  turn_up(turned_one, UpAxis::y, UpAxis::z);
  EXPECT_FALSE(turned_one.columns[0].values == original.columns[0].values);
  turn_up(turned_one, UpAxis::z, UpAxis::y);
  for (std::size_t c = 0; c < original.columns.size(); ++c) {
    EXPECT_TRUE(turned_one.columns[c].values == original.columns[c].values) << original.columns[c].name;
  }
  turn_up(turned_one, UpAxis::y, UpAxis::y);
  EXPECT_TRUE(turned_one.columns[1].values == original.columns[1].values);
}

TEST(Axes, UpBecomesUpAndTheHandStaysRight) {
  const auto up = turned({{0, 1, 0}}, UpAxis::y, UpAxis::z);
  EXPECT_EQ(up[2], 1);
  const Vec3d a = turned({{1, 0, 0}}, UpAxis::y, UpAxis::z), c = turned({{0, 0, 1}}, UpAxis::y, UpAxis::z);
  // a x up = c, as x x y = z.
  EXPECT_EQ(a[1] * up[2] - a[2] * up[1], c[0]);
  EXPECT_EQ(a[2] * up[0] - a[0] * up[2], c[1]);
  EXPECT_EQ(a[0] * up[1] - a[1] * up[0], c[2]);
}

TEST(Axes, MatricesTurnWithVectors) {
  Snapshot snapshot = sample_snapshot(6);
  const Snapshot before = snapshot;
  turn_up(snapshot, UpAxis::y, UpAxis::z);
  // Row by row, (R F R^T) (R v) = R (F v).
  for (std::size_t p = 0; p < snapshot.size(); ++p) {
    Vec3d v, Fv = {}, turned_Fv = {};
    for (int i = 0; i < 3; ++i) v[i] = 1.5 + i;
    const Vec3d w = turned(v, UpAxis::y, UpAxis::z);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        Fv[i] += value(*before.find("F"), p, 3 * i + j) * v[j];
        turned_Fv[i] += value(*snapshot.find("F"), p, 3 * i + j) * w[j];
      }
    }
    const Vec3d expected = turned(Fv, UpAxis::y, UpAxis::z);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(turned_Fv[i], expected[i], 1e-9);
  }
}

class MeshFiles : public testing::Test {
 protected:
  static CarryingMesh tetrahedron() {
    CarryingMesh mesh;
    mesh.mesh.vertices = {{{0, 0, 0}}, {{1, 0, 0}}, {{0, 0.5, 0}}, {{0, 0, -0.25}}};
    mesh.mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
    mesh.velocities = {{{1, 2, 3}}, {{4, 5, 6}}, {{7, 8, 9}}, {{-1, 0, 0.5}}};
    mesh.colors = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {51, 102, 153}};
    return mesh;
  }
  const TemporaryFolder folder_;
};

TEST_F(MeshFiles, AreReadBackEqual) {
  const CarryingMesh mesh = tetrahedron();
  write_mesh_obj(folder_ / "a.obj", mesh);
  write_mesh_ply(folder_ / "a.ply", mesh);
  for (const char* name : {"a.obj", "a.ply"}) {
    const TriangleMesh read = read_mesh(folder_ / name);
    EXPECT_EQ(read.triangles, mesh.mesh.triangles);
    ASSERT_EQ(read.vertices.size(), 4u);
    for (std::size_t v = 0; v < 4; ++v) {
      for (int c = 0; c < 3; ++c) EXPECT_EQ(read.vertices[v][c], mesh.mesh.vertices[v][c]);
    }
  }
}

TEST_F(MeshFiles, CarryColoursAndVelocities) {
  write_mesh_obj(folder_ / "a.obj", tetrahedron());
  EXPECT_NE(file_bytes(folder_ / "a.obj").find("v 0 0 -0.25 0.2 0.4 0.6\nf 1 2 3\n"), std::string::npos)
      << file_bytes(folder_ / "a.obj");
  write_mesh_ply(folder_ / "a.ply", tetrahedron());
  const std::string bytes = file_bytes(folder_ / "a.ply");
  const std::size_t start = bytes.find("end_header\n") + 11;
  float vy = 0;
  std::memcpy(&vy, bytes.data() + start + 27 + 16, sizeof vy);  // of the second vertex
  EXPECT_EQ(vy, 5);
  EXPECT_EQ(static_cast<unsigned char>(bytes[start + 27 + 25]), 255);
}

TEST_F(MeshFiles, EmptyOnesAreFilesToo) {
  write_mesh_obj(folder_ / "a.obj", {});
  write_mesh_ply(folder_ / "a.ply", {});
  EXPECT_EQ(file_bytes(folder_ / "a.obj"), "");
  EXPECT_NE(file_bytes(folder_ / "a.ply").find("element vertex 0\n"), std::string::npos);
}

}  // namespace
}  // namespace firn
