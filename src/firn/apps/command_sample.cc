#include <firn/apps/commands.h>
#include <firn/core/error.h>
#include <firn/geometry/prepare_mesh.h>
#include <firn/io/mesh_points.h>
#include <firn/io/mesh_reader.h>
#include <firn/seeding/sampling.h>

#include <fmt/format.h>

#include <memory>

namespace firn {
namespace {

struct SampleOptions {
  std::string mesh, output;
  double radius = 0;
  std::int64_t count = 0;
  std::uint64_t seed = 1;
  bool strict = false;
};

void run_sample(const SampleOptions& options, bool by_radius) {
  const PreparedMesh prepared = prepare_mesh(read_mesh(options.mesh), options.mesh, options.strict);
  SamplingRequest request;
  request.seed = options.seed;
  if (by_radius) {
    request.radius = options.radius;
  } else {
    request.count = options.count;
  }
  const Samples<3> samples = sample_mesh(prepared.mesh, request, options.mesh);
  write_points_ply<3>(options.output, samples.positions);
  fmt::print("{} points, at least {:.6g} apart, in a volume of {:.6g}: {}\n", samples.positions.size(), samples.radius,
             prepared.report.volume, options.output);
}

}  // namespace

void add_sample(CLI::App& program) {
  CLI::App* command = program.add_subcommand("sample", "Fill a closed mesh with Poisson-disk points");
  const auto options = std::make_shared<SampleOptions>();
  command->add_option("mesh", options->mesh, "OBJ, PLY or STL file")->required();
  CLI::Option_group* density = command->add_option_group("Density", "One of these says how dense the points lie");
  CLI::Option* radius =
      density->add_option("--radius", options->radius, "Least distance of two points, in the unit of the mesh");
  density->add_option("--count", options->count, "Number of points, met within 2 %");
  density->require_option(1);
  command->add_option("--seed", options->seed, "Number that the random placement starts from")->capture_default_str();
  command->add_option("-o,--output", options->output, "PLY file to write")->required();
  command->add_flag("--strict", options->strict, "An open mesh is an error instead of a warning");
  command->callback([options, radius] { run_sample(*options, radius->count() > 0); });
}

}  // namespace firn
