#include <firn/geometry/triangle_mesh.h>
#include <firn/io/mesh_reader.h>

#include "export/export_run.h"

namespace firn::test {
namespace {

namespace fs = std::filesystem;

class SurfaceCommand : public ExportRun {};

TEST_F(SurfaceCommand, MakesAClosedSurfaceOfTheBodiesVolume) {
  for (const std::string format : {"obj", "ply"}) {
    const fs::path file = out("l." + format);
    const ProgramResult result = firn("surface", "--frames 1 -o " + in_shell(file));
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const TriangleMesh mesh = read_mesh(file);
    EXPECT_NEAR(enclosed_volume(mesh), 0.06, 0.1 * 0.06);
    EXPECT_TRUE(matches(result.output, "1/1  .*l\\." + format + "  \\([0-9]+ particles, [0-9]+ triangles, .* MB\\)\n"));
  }
}

TEST_F(SurfaceCommand, SameBytesForAnyNumberOfThreads) {
  for (const std::string format : {"obj", "ply", "vdb"}) {
    std::string one;
    for (const std::string threads : {"1", "2", "4"}) {
      const fs::path file = out(threads + "." + format);
      ASSERT_EQ(firn("surface", "--frames 2 --threads " + threads + " -o " + in_shell(file)).exit_code, 0);
      if (one.empty()) one = file_bytes(file);
      EXPECT_TRUE(file_bytes(file) == one) << format << ' ' << threads;
    }
  }
}

TEST_F(SurfaceCommand, ByMaterialHasAFileForEach) {
  ASSERT_EQ(firn("surface", "--by-material --frames 1:2 -o " + in_shell(out("m"))).exit_code, 0);
  EXPECT_TRUE(fs::exists(out("m/surface_snow.0002.obj")));
  EXPECT_EQ(read_json(out("m/surface_snow.obj.series.json"))["files"].size(), 2u);
}

TEST_F(SurfaceCommand, MistakesAreTold) {
  EXPECT_EQ(firn("surface", "--voxel 20").errors, "firn: voxel must be 0.1 to 10 particle spacings, got 20\n");
  EXPECT_EQ(firn("surface", "--format vtp").errors,
            "firn: --format: no format \"vtp\"; known: \"obj\", \"ply\", \"vdb\"\n");
  folder_.write("flat.toml",
                "dimension = 2\nend_time = 0.01\n[material.snow]\npreset = \"snow\"\n"
                "[[body]]\nshape = \"disk\"\nradius = 0.2\nmaterial = \"snow\"\n"
                "[resolution]\nparticles = 500\n[render]\nevery_nth = 0\n");
  ASSERT_EQ(run_firn("run " + in_shell(out("flat.toml")) + " -o " + in_shell(out("flat"))).exit_code, 0);
  const ProgramResult flat = run_firn("surface " + in_shell(out("flat")));
  EXPECT_EQ(flat.exit_code, 2);
  EXPECT_NE(flat.errors.find("particles of a 2D run have no surface"), std::string::npos) << flat.errors;
  EXPECT_EQ(run_firn("export " + in_shell(out("flat")) + " --format vdb").exit_code, 0);
}

}  // namespace
}  // namespace firn::test
