// Damaged files of other programs: a clear error or a whole mesh, never a crash of this process.

#include <firn/core/error.h>
#include <firn/io/mesh_reader.h>
#include <firn/io/vdb_file.h>
#include <gtest/gtest.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <cmath>
#include <functional>

#include "reader/foreign_files.h"
#include "support/random.h"
#include "support/temporary_folder.h"

namespace firn {
namespace {

struct Outcomes {
  int read = 0, refused = 0;
};

/// Counts what happens to the damaged files; `read` fails the test for anything but an Error of one line with the file.
void attempt(const std::filesystem::path& path, const std::function<void()>& read, Outcomes& outcomes) {
  try {
    read();
    ++outcomes.read;
  } catch (const Error& error) {
    const std::string text = error.what();
    EXPECT_EQ(text.find(path.string()), 0U) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    EXPECT_TRUE(error.kind() == ErrorKind::files || error.kind() == ErrorKind::usage) << text;
    ++outcomes.refused;
  }
}

bool is_whole(const TriangleMesh& mesh) {
  for (const Vec3d& x : mesh.vertices) {
    for (int i = 0; i < 3; ++i) {
      if (!std::isfinite(x[i])) return false;
    }
  }
  return !mesh.triangles.empty();
}

/// Every `step` bytes less, and `flips` files with one bit flipped.
void damage(const std::string& bytes, std::size_t step, int flips, const std::function<void(const std::string&)>& cut,
            const std::function<void(const std::string&)>& flipped) {
  for (std::size_t size = 0; size < bytes.size(); size += step) cut(bytes.substr(0, size));
  test::Random random(5);
  for (int n = 0; n < flips; ++n) {
    std::string other = bytes;
    const auto at = static_cast<std::size_t>(random.uniform(0, static_cast<double>(bytes.size())));
    other[at] = static_cast<char>(other[at] ^ (1 << static_cast<int>(random.uniform(0, 8))));
    flipped(other);
  }
}

TEST(DamagedFile, OfGltf) {
  const TemporaryFolder folder;
  const auto obj = folder.write("twin.obj", l_shape_obj());
  const std::string bytes = file_bytes(exported(obj, "glb2", folder / "whole.glb"));
  const TriangleMesh whole = read_mesh(folder / "whole.glb");
  const auto path = folder / "damaged.glb";
  Outcomes cut, flipped;
  damage(
      bytes, 50, 40,
      [&](const std::string& damaged) {
        folder.write("damaged.glb", damaged);
        attempt(
            path, [&] { EXPECT_EQ(enclosed_volume(read_mesh(path)), enclosed_volume(whole)); }, cut);
      },
      [&](const std::string& damaged) {
        folder.write("damaged.glb", damaged);
        attempt(
            path, [&] { EXPECT_TRUE(is_whole(read_mesh(path))); }, flipped);
      });
  EXPECT_GT(cut.refused, 10);
  // A flipped bit of a coordinate is another mesh, which nobody can tell; one of the header or the JSON is refused.
  EXPECT_GT(flipped.refused, 0);
  EXPECT_EQ(flipped.read + flipped.refused, 40);
}

TEST(DamagedFile, OfOpenVdb) {
  openvdb::initialize();
  const TemporaryFolder folder;
  auto grid = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(0.2F, openvdb::Vec3f(0.F), 0.05F);
  grid->setName("surface");
  openvdb::io::File file((folder / "whole.vdb").string());
  file.write({grid});
  file.close();
  const std::string bytes = file_bytes(folder / "whole.vdb");
  const Vec3d at = {{0.21, 0.02, 0.01}};
  const double whole = read_level_sets({folder / "whole.vdb"})[0].distance->distance(at);
  const auto path = folder / "damaged.vdb";
  Outcomes cut, flipped;
  damage(
      bytes, std::max<std::size_t>(50, bytes.size() / 40), 40,
      [&](const std::string& damaged) {
        folder.write("damaged.vdb", damaged);
        attempt(
            path, [&] { EXPECT_EQ(read_level_sets({path})[0].distance->distance(at), whole); }, cut);
      },
      [&](const std::string& damaged) {
        folder.write("damaged.vdb", damaged);
        attempt(
            path, [&] { EXPECT_TRUE(std::isfinite(read_level_sets({path})[0].distance->distance(at))); }, flipped);
      });
  EXPECT_GT(cut.refused, 10);
  EXPECT_EQ(flipped.read + flipped.refused, 40);
}

}  // namespace
}  // namespace firn
