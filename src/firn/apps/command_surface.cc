#include <firn/apps/commands.h>
#include <firn/apps/export_series.h>
#include <firn/apps/export_target.h>
#include <firn/apps/particle_colors.h>
#include <firn/core/error.h>
#include <firn/io/atomic_file.h>
#include <firn/io/frame_reader.h>
#include <firn/io/mesh_files.h>
#include <firn/render/color_map.h>
#include <firn/scene/nearest.h>
#include <firn/surface/particle_surface.h>
#include <firn/surface/vdb_writer.h>
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

namespace firn {
namespace {

namespace fs = std::filesystem;

struct Options : ExportOptions {
  SurfaceOptions surface;
  bool by_material = false;
  int threads = 0;
};

/// Particles [begin, end) of a frame.
SurfaceParticles particles_of(const Snapshot& snapshot, const std::vector<Vec3f>& colors, std::size_t begin,
                              std::size_t end) {
  SurfaceParticles particles;
  particles.spacing = snapshot.particle_spacing;
  const SnapshotColumn* velocity = snapshot.find("velocity");
  for (std::size_t p = begin; p < end; ++p) {
    particles.positions.push_back(snapshot.position(p));
    particles.colors.push_back(colors[p]);
    if (velocity == nullptr) continue;
    Vec3f v;
    for (int c = 0; c < 3; ++c) v[c] = static_cast<float>(value(*velocity, p, c));
    particles.velocities.push_back(v);
  }
  return particles;
}

CarryingMesh mesh_of(const ParticleSurface& surface) {
  CarryingMesh mesh;
  mesh.mesh = triangulated(surface.mesh);
  mesh.velocities = surface.velocities;
  for (const Vec3f& color : surface.colors) {
    std::array<std::uint8_t, 3> bytes = {};
    for (std::size_t c = 0; c < 3; ++c) {
      const float srgb = srgb_from_linear(std::clamp(color[static_cast<int>(c)], 0.0F, 1.0F));
      bytes[c] = static_cast<std::uint8_t>(std::lround(255 * srgb));
    }
    mesh.colors.push_back(bytes);
  }
  return mesh;
}

/// Writes one surface and returns what to say of it.
std::string write_surface(const fs::path& file, const SurfaceParticles& particles, const Options& options) {
  const ParticleSurface surface = particle_surface(particles, options.surface);
  if (options.format == "vdb") {
    const bool is_blender = client_of(options.client) == Client::blender;
    SurfaceVolumes volumes = surface_volumes(particles, surface, options.surface);
    for (SparseVolume& volume : volumes.volumes) {
      if (volume.name == "v" && is_blender) volume.name = "velocity";
    }
    write_file_atomically(file, vdb_bytes(volumes.leaves, volumes.volumes, {{"creator", "firn " FIRN_VERSION}}));
    return fmt::format("{} particles, {} leaves", particles.positions.size(), volumes.leaves.size());
  }
  const CarryingMesh mesh = mesh_of(surface);
  options.format == "obj" ? write_mesh_obj(file, mesh) : write_mesh_ply(file, mesh);
  return fmt::format("{} particles, {} triangles", particles.positions.size(), mesh.mesh.triangles.size());
}

Snapshot read_3d_frame(const ListedFrame& frame, const FrameList& list, UpAxis up) {
  Snapshot snapshot = read_frame(frame.file);
  if (snapshot.dimension != 3) {
    throw Error(ErrorKind::usage,
                fmt::format("{}: particles of a 2D run have no surface; firn export writes them", frame.file.string()));
  }
  turn_up(snapshot, list.up, up);
  return snapshot;
}

ExportedSeries describe(const Options& options, UpAxis up, const Snapshot& snapshot) {
  ExportedSeries series;
  series.format = options.format;
  series.client = options.client;
  series.up = up;
  series.spacing = snapshot.particle_spacing;
  for (const SnapshotMaterial& material : snapshot.materials) series.materials.push_back(material.name);
  if (options.format == "vdb") {
    series.attributes = {"surface", client_of(options.client) == Client::blender ? "velocity" : "v"};
    series.units[series.attributes[1]] = "m/s";
    return series;
  }
  series.attributes = {"x", "y", "z"};
  if (options.format == "ply") series.attributes.insert(series.attributes.end(), {"vx", "vy", "vz"});
  series.attributes.insert(series.attributes.end(), {"red", "green", "blue"});
  for (const char* name : {"x", "y", "z"}) series.units[name] = "m";
  for (const char* name : {"vx", "vy", "vz"}) series.units[name] = "m/s";
  return series;
}

/// The surfaces that a frame becomes: one, or one for each material.
struct Part {
  std::string name;  ///< of the files
  std::optional<std::size_t> material;
};

/// A name that any file system takes.
std::string file_word(const std::string& name) {
  std::string word = name;
  for (char& c : word) {
    if (c == '/' || c == '\\' || static_cast<unsigned char>(c) <= ' ') c = '_';
  }
  return word;
}

std::vector<Part> parts_of(const FrameList& list, const Options& options) {
  if (!options.by_material) return {{"surface", std::nullopt}};
  std::vector<Part> parts;
  const Snapshot first = read_frame(list.frames.front().file);
  for (std::size_t m = 0; m < first.materials.size(); ++m) {
    parts.push_back({"surface_" + file_word(first.materials[m].name), m});
  }
  return parts;
}

const std::vector<std::string> kFormats = {"obj", "ply", "vdb"};

std::string chosen_format(const Options& options) {
  if (!options.format.empty()) {
    if (std::ranges::find(kFormats, options.format) != kFormats.end()) return options.format;
    throw Error(ErrorKind::usage,
                fmt::format("--format: no format \"{}\"{}", options.format, suggestion(options.format, kFormats)));
  }
  const std::string ending = fs::path(options.output).extension().string();
  for (const std::string& format : kFormats) {
    if (ending == "." + format) return format;
  }
  return "obj";
}

void make_surfaces(Options options) {
  std::optional<tbb::global_control> threads;
  if (options.threads > 0) {
    threads.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(options.threads));
  }
  options.format = chosen_format(options);
  FrameList list = list_frames(options.paths);
  choose_frames(list, options.frames);
  const Client client = client_of(options.client);
  const UpAxis up = target_up(client, options.up, options.format, list.up);
  const std::vector<Part> parts = parts_of(list, options);
  std::vector<ExportTarget> targets;
  for (const Part& part : parts) {
    targets.emplace_back(list, options.output, "surface", part.name, "." + options.format);
    if (parts.size() > 1 && targets.back().is_one_file()) {
      throw Error(ErrorKind::usage, fmt::format("-o {} is one file and there are {} materials; name a folder",
                                                options.output, parts.size()));
    }
    std::vector<fs::path> files;
    for (const ListedFrame& frame : list.frames) files.push_back(targets.back().file(frame));
    targets.back().prepare(files, options.force);
  }
  ExportedSeries series;
  std::size_t done = 0;
  for (const ListedFrame& frame : list.frames) {
    const Snapshot snapshot = read_3d_frame(frame, list, up);
    series = describe(options, up, snapshot);
    const std::vector<Vec3f> colors = particle_colors(snapshot, list.scene ? &*list.scene : nullptr);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      std::size_t begin = 0, end = snapshot.size();
      if (parts[i].material) {
        const SnapshotMaterial& material = snapshot.materials.at(*parts[i].material);
        begin = material.begin;
        end = material.end;
      }
      const fs::path file = targets[i].file(frame);
      const std::string what = write_surface(file, particles_of(snapshot, colors, begin, end), options);
      print_done(++done, list.frames.size() * parts.size(), file, what);
    }
  }
  for (const ExportTarget& target : targets) {
    if (!target.is_one_file()) write_series_description(target, list, series);
  }
  const std::string clicks = next_clicks(client, options.format, targets.front(), list);
  if (!clicks.empty()) fmt::print("{}\n", clicks);
}

}  // namespace

void add_surface(CLI::App& program) {
  CLI::App* command = program.add_subcommand("surface", "Make surfaces of particles: OBJ, PLY, VDB level sets");
  const auto options = std::make_shared<Options>();
  command->add_option("run", options->paths, "Output folder of a run, or frames of one (particles.0012.hdf)")
      ->required();
  command->add_option("--format", options->format, "obj, ply (with velocities) or vdb; by default obj")
      ->type_name("FORMAT");
  command->add_option("--for", options->client, "blender, houdini or paraview: which axis is up, and the names")
      ->type_name("PROGRAM");
  command->add_option("--frames", options->frames, "Only these: 5, 1:24, 1:240:10, 1,5,9, 20:, last")
      ->type_name("LIST");
  command
      ->add_option("--radius", options->surface.radius,
                   "How far the surface is from the outermost particles, in particle spacings; more closes gaps")
      ->capture_default_str();
  command->add_option("--voxel", options->surface.voxel, "How fine the surface is, in particle spacings")
      ->capture_default_str();
  command->add_option("--smoothing", options->surface.smoothing, "Passes that take bumps away and keep the volume")
      ->capture_default_str();
  command
      ->add_option("--adaptivity", options->surface.adaptivity,
                   "0 to 1: larger polygons where the surface is flat (obj and ply)")
      ->capture_default_str();
  command->add_flag("--by-material", options->by_material, "A surface for each material");
  command->add_option("--up", options->up, "y or z: the axis that is up in the files, instead of the client's");
  command->add_option("--threads", options->threads, "Threads to compute with; any number gives the same bits")
      ->check(CLI::Range(1, 1024));
  command
      ->add_option("-o,--output", options->output, "Folder, or a file for a single frame; else surface/ in the run's")
      ->type_name("PATH");
  command->add_flag("--force", options->force, "Replace files that exist");
  command->callback([options] { make_surfaces(*options); });
}

}  // namespace firn
