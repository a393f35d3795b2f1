// Numbered files, and meshes that differ in the positions of their vertices only.

#include <firn/core/error.h>
#include <firn/core/log.h>
#include <firn/io/file_sequence.h>
#include <firn/io/mesh_sequence.h>
#include <gtest/gtest.h>

#include <cmath>

#include "geometry/mesh_builders.h"
#include "support/temporary_folder.h"

namespace firn {
namespace {

std::string obj_text(const TriangleMesh& mesh) {
  std::ostringstream text;
  text.precision(17);
  for (const Vec3d& x : mesh.vertices) text << "v " << x[0] << ' ' << x[1] << ' ' << x[2] << '\n';
  for (const auto& t : mesh.triangles) text << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
  return text.str();
}

SequenceClock seconds(std::size_t entries) {
  std::vector<double> times;
  for (std::size_t k = 0; k < entries; ++k) times.push_back(static_cast<double>(k));
  return {times, Interpolation::linear, AtEnd::hold};
}

std::vector<std::string> names_of(const std::vector<std::filesystem::path>& files) {
  std::vector<std::string> names;
  for (const auto& file : files) names.push_back(file.filename().string());
  return names;
}

TEST(FileSequence, IsInTheOrderOfItsNumbers) {
  const TemporaryFolder folder;
  for (const char* name : {"belt_0010.obj", "belt_0009.obj", "belt_0011.obj", "belt_00010.obj", "belt_12.obj",
                           "belt_0011.ply", "belt_001a.obj", "elt_0001.obj"}) {
    folder.write(name, "");
  }
  using Names = std::vector<std::string>;
  EXPECT_EQ(names_of(expand_sequence(folder / "belt_####.obj")),
            (Names{"belt_0009.obj", "belt_0010.obj", "belt_0011.obj"}));
  EXPECT_EQ(names_of(expand_sequence(folder / "belt_####.ply")), (Names{"belt_0011.ply"}));
  EXPECT_EQ(names_of(expand_sequence(folder / "belt_12.obj")), (Names{"belt_12.obj"}));
  folder.write("long_99.obj", "");
  folder.write("long_100.obj", "");
  EXPECT_EQ(names_of(expand_sequence(folder / "long_##.obj")), (Names{"long_99.obj", "long_100.obj"}));
}

TEST(FileSequence, SaysWhatIsMissing) {
  const TemporaryFolder folder;
  for (const char* name : {"a_1.obj", "a_2.obj", "a_4.obj", "b_1.obj", "b_5.obj"}) folder.write(name, "");
  const auto message = [&](const std::string& pattern) {
    return message_of([&] { expand_sequence(folder / pattern); }).substr((folder / "").string().size());
  };
  EXPECT_EQ(
      message("a_#.obj"),
      "a_#.obj: number 3 is missing between a_2.obj and a_4.obj; a sequence needs every number, or list the files "
      "and their times");
  EXPECT_EQ(message("b_#.obj"),
            "b_#.obj: numbers 2 to 4 are missing between b_1.obj and b_5.obj; a sequence needs every number, or list "
            "the files and their times");
  EXPECT_EQ(message("c_##.obj"), "c_##.obj: no file has such a name, with a number of at least 2 digits for ##");
  EXPECT_EQ(message("a_#_#.obj"), "a_#_#.obj: only one run of # can stand for numbers");
  EXPECT_EQ(message("x#/a.obj"), "x#/a.obj: # must be in the file's name, not in a folder's");
  EXPECT_EQ(message("none/a_#.obj"), "none/a_#.obj: cannot read the folder: No such file or directory");
  EXPECT_EQ(message("none.obj"), "none.obj: is not a file");
}

TEST(MeshSequence, ReadsPositionsAndMergesWhatIsOneInAllMeshes) {
  const TemporaryFolder folder;
  TriangleMesh ball = sphere_mesh(1, 1);
  // Every corner a vertex of its own, as exports with texture seams have it, and two that part later.
  TriangleMesh split;
  for (const auto& t : ball.triangles) {
    const auto first = static_cast<std::int32_t>(split.vertices.size());
    for (const std::int32_t v : t) split.vertices.push_back(ball.vertices[static_cast<std::size_t>(v)]);
    split.triangles.push_back({first, first + 1, first + 2});
  }
  folder.write("m1.obj", obj_text(split));
  for (Vec3d& x : split.vertices) x = 2.0 * x;
  folder.write("m2.obj", obj_text(split));
  const MeshSequence sequence = read_mesh_sequence({folder / "m1.obj", folder / "m2.obj"}, seconds(2));
  EXPECT_FALSE(DeformingMesh(sequence).uses_winding_number());
  EXPECT_NEAR(enclosed_volume(sequence.mesh_at(0.5)), 1.5 * 1.5 * 1.5 * enclosed_volume(ball), 1e-12);
}

TEST(MeshSequence, TurnsAnInvertedSurfaceThroughout) {
  const TemporaryFolder folder;
  TriangleMesh ball = sphere_mesh(1, 1);
  flip(ball);
  folder.write("m.obj", obj_text(ball));
  std::string warning;
  const auto old = set_log_sink([&](LogLevel, std::string_view text) { warning = text; });
  const MeshSequence sequence = read_mesh_sequence({folder / "m.obj", folder / "m.obj"}, seconds(2));
  set_log_sink(old);
  EXPECT_NE(warning.find("inside out"), std::string::npos);
  EXPECT_GT(enclosed_volume(sequence.mesh_at(1)), 2);
}

TEST(MeshSequence, SaysWhichFilesDiffer) {
  const TemporaryFolder folder;
  const TriangleMesh ball = sphere_mesh(1, 1);
  TriangleMesh other = ball;
  std::swap(other.triangles[4], other.triangles[5]);
  TriangleMesh turned = ball;
  for (Vec3d& x : turned.vertices) x[0] = -x[0];
  const std::string a = folder.write("a.obj", obj_text(ball)).string(),
                    finer = folder.write("finer.obj", obj_text(sphere_mesh(1, 2))).string(),
                    mixed = folder.write("mixed.obj", obj_text(other)).string(),
                    mirrored = folder.write("mirrored.obj", obj_text(turned)).string(),
                    broken = folder.write("broken.obj", "v 1 2\n").string();
  const auto message = [&](const std::string& second) {
    return message_of([&] { read_mesh_sequence({a, second}, seconds(2)); });
  };
  const std::string rule = "; all meshes of a sequence need the same vertices and triangles in the same order";
  EXPECT_EQ(message(finer),
            finer + ": has 66 vertices and 128 triangles, but " + a + " has 18 vertices and 32 triangles" + rule);
  EXPECT_EQ(message(mixed).find(mixed + ": triangle 5 has the corners "), 0U) << message(mixed);
  EXPECT_NE(message(mixed).find(", but in " + a), std::string::npos);
  EXPECT_NE(message(mirrored).find("mirrored.obj: encloses -"), std::string::npos) << message(mirrored);
  EXPECT_NE(message(mirrored).find("the surface is turned inside out on the way"), std::string::npos);
  EXPECT_EQ(message(broken).find(broken + ":1:"), 0U) << message(broken);
  EXPECT_NE(message((folder / "none.obj").string()).find("cannot read the mesh: No such file"), std::string::npos);
}

}  // namespace
}  // namespace firn
