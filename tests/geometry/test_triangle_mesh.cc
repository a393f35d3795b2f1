#include <firn/core/error.h>
#include <firn/core/log.h>
#include <firn/geometry/prepare_mesh.h>
#include <geometry/mesh_builders.h>
#include <gtest/gtest.h>

#include <limits>

namespace firn {
namespace {

const double kPi = std::acos(-1.0);

/// Collects warnings while it lives.
class Warnings {
 public:
  Warnings() {
    before_ = set_log_sink([this](LogLevel level, const std::string& line) {
      if (level == LogLevel::warning) text += line + "\n";
    });
  }
  ~Warnings() { set_log_sink(before_); }
  std::string text;

 private:
  LogSink before_;
};

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::string error_of(const TriangleMesh& mesh, bool strict = false) {
  try {
    prepare_mesh(mesh, "body 'a'", strict);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(TriangleMesh, VolumeAndAreaOfKnownSolids) {
  const TriangleMesh box = box_mesh({{0.5, 1, 1.5}});
  EXPECT_NEAR(enclosed_volume(box), 6, 1e-14);
  EXPECT_NEAR(surface_area(box), 22, 1e-13);
  // The meshes are inscribed, so they approach the smooth solids from below, with second order.
  const double coarse = 4 * kPi / 3 - enclosed_volume(sphere_mesh(1, 3));
  const double fine = 4 * kPi / 3 - enclosed_volume(sphere_mesh(1, 4));
  EXPECT_GT(fine, 0);
  EXPECT_NEAR(coarse / fine, 4, 0.1);
  EXPECT_NEAR(enclosed_volume(torus_mesh(1, 0.3, 400, 200)), 2 * kPi * kPi * 0.09, 1e-3);
}

TEST(TriangleMesh, PlacementScalesTheVolumeAndKeepsItFarFromTheOrigin) {
  TriangleMesh mesh = sphere_mesh(1, 3);
  const double volume = enclosed_volume(mesh);
  Placement placement;
  placement.scale = 0.5;
  placement.rotation = {{0, -1, 0, 1, 0, 0, 0, 0, 1}};
  placement.translation = {{1000, -2000, 3000}};
  apply(placement, mesh);
  EXPECT_NEAR(enclosed_volume(mesh), volume / 8, 1e-11 * volume);
  EXPECT_NEAR(bounds(mesh).lower[0], 999.5, 1e-12);
  EXPECT_NEAR(bounds(mesh).center()[2], 3000, 1e-12);
  flip(mesh);
  EXPECT_LT(enclosed_volume(mesh), 0);
}

TEST(TriangleMesh, CleaningMergesAndCounts) {
  TriangleMesh soup;
  const TriangleMesh box = box_mesh({{1, 1, 1}});
  for (std::size_t t = 0; t < box.triangles.size(); ++t) {
    const auto base = static_cast<std::int32_t>(soup.vertices.size());
    for (int i = 0; i < 3; ++i) soup.vertices.push_back(box.corner(t, i));
    soup.triangles.push_back({{base, base + 1, base + 2}});
  }
  soup.triangles.push_back({{1, 2, 0}});  // the first triangle again
  soup.triangles.push_back({{0, 1, 1}});
  soup.vertices.push_back({{9, 9, 9}});
  const MeshCleanup cleanup = clean(soup);
  EXPECT_EQ(cleanup.merged_vertices, 28u);
  EXPECT_EQ(cleanup.duplicate_triangles, 1u);
  EXPECT_EQ(cleanup.degenerate_triangles, 1u);
  EXPECT_EQ(cleanup.unused_vertices, 1u);
  EXPECT_EQ(soup.vertices.size(), 8u);
  EXPECT_EQ(soup.triangles.size(), 12u);
  EXPECT_TRUE(inspect(soup).is_closed());
}

TEST(MeshReport, ClosedMeshesAreClosedAndCountTheirPieces) {
  TriangleMesh two = torus_mesh(1, 0.3, 20, 10);
  append(two, sphere_mesh(0.2, 2));
  const MeshReport report = inspect(two);
  EXPECT_TRUE(report.is_closed());
  EXPECT_EQ(report.components, 2u);
  EXPECT_EQ(report.non_manifold.count, 0u);
  EXPECT_EQ(report.mixed.count, 0u);
  EXPECT_NEAR(report.bounds.upper[2], 0.3, 0.02);
}

TEST(MeshReport, OpenMeshListsItsBoundary) {
  TriangleMesh box = box_mesh({{1, 1, 1}});
  box.triangles.erase(box.triangles.begin());
  const MeshReport report = inspect(box);
  EXPECT_EQ(report.boundary.count, 3u);
  EXPECT_NEAR(report.boundary.length, 4 + std::sqrt(8.0), 1e-14);
  EXPECT_EQ(report.boundary.first[0], (MeshEdge{0, 2}));

  Warnings warnings;
  EXPECT_FALSE(prepare_mesh(box, "body 'a'").report.is_closed());
  EXPECT_TRUE(contains(warnings.text, "body 'a': the surface is open: 3 boundary edges")) << warnings.text;
  EXPECT_TRUE(contains(warnings.text, "vertices 1 and 3 at (-1, -1, -1) - (-1, 1, -1)")) << warnings.text;
  EXPECT_TRUE(contains(error_of(box, true), "close the holes")) << error_of(box, true);
}

TEST(MeshReport, InvertedMeshIsFlippedWithAWarning) {
  TriangleMesh sphere = sphere_mesh(1, 2);
  const double volume = enclosed_volume(sphere);
  flip(sphere);
  Warnings warnings;
  const PreparedMesh prepared = prepare_mesh(sphere, "ball");
  EXPECT_TRUE(prepared.flipped);
  EXPECT_NEAR(enclosed_volume(prepared.mesh), volume, 1e-14);
  EXPECT_TRUE(contains(warnings.text, "inside out")) << warnings.text;
}

TEST(MeshReport, MixedOrientationNamesTwoVertices) {
  TriangleMesh box = box_mesh({{1, 1, 1}});
  std::swap(box.triangles[0][1], box.triangles[0][2]);
  EXPECT_EQ(inspect(box).mixed.count, 3u);
  EXPECT_TRUE(contains(error_of(box), "vertices 1 and 3")) << error_of(box);
}

TEST(MeshReport, NonManifoldEdgesAreReportedAndKept) {
  TriangleMesh box = box_mesh({{1, 1, 1}});
  TriangleMesh neighbour = box_mesh({{1, 1, 1}});
  Placement placement;
  placement.translation = {{2, 2, 0}};
  apply(placement, neighbour);
  append(box, neighbour);  // the two touch along one edge
  Warnings warnings;
  const PreparedMesh prepared = prepare_mesh(box, "a");
  EXPECT_EQ(prepared.report.non_manifold.count, 1u);
  EXPECT_EQ(prepared.report.components, 1u);
  EXPECT_TRUE(contains(warnings.text, "more than two triangles")) << warnings.text;
}

TEST(MeshReport, FlatAndEmptyMeshesAreRefused) {
  TriangleMesh sheet;
  sheet.vertices = {{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}};
  sheet.triangles = {{{0, 1, 2}}, {{0, 2, 1}}};
  EXPECT_TRUE(contains(error_of(sheet), "encloses no volume")) << error_of(sheet);
  sheet.triangles.pop_back();
  EXPECT_TRUE(contains(error_of(sheet), "encloses no volume")) << error_of(sheet);
  sheet.triangles.clear();
  EXPECT_TRUE(contains(error_of(sheet), "no triangle")) << error_of(sheet);
}

}  // namespace
}  // namespace firn
