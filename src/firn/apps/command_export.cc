#include <firn/apps/commands.h>
#include <firn/apps/export_attributes.h>
#include <firn/apps/export_series.h>
#include <firn/apps/export_target.h>
#include <firn/apps/export_usd.h>
#include <firn/apps/particle_colors.h>
#include <firn/apps/work_folder.h>
#include <firn/core/error.h>
#include <firn/io/atomic_file.h>
#include <firn/io/frame_reader.h>
#include <firn/io/frame_series.h>
#include <firn/io/point_files.h>
#include <firn/scene/nearest.h>
#include <firn/surface/fog.h>
#include <firn/surface/vdb_writer.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>

namespace firn {
namespace {

namespace fs = std::filesystem;

/// The frame with the axis and the columns that are asked for.
Snapshot prepared(const ListedFrame& frame, const FrameList& list, const ExportOptions& options, UpAxis up,
                  bool for_volume) {
  Snapshot snapshot = read_frame(frame.file);
  turn_up(snapshot, list.up, up);
  std::vector<std::string> names = chosen_attributes(options.attributes, options.format, snapshot);
  if (std::ranges::find(names, kColorColumn) != names.end()) {
    const Scene* scene = list.scene ? &*list.scene : nullptr;
    for_volume ? add_light_column(snapshot, scene) : add_color_column(snapshot, scene);
  }
  if (for_volume && snapshot.find("J") != nullptr) names.push_back("J");
  return select_columns(std::move(snapshot), names);
}

/// Houdini and ParaView show particles of any size; Houdini reads the radius from this name.
void add_radius(Snapshot& snapshot) {
  std::vector<float> radius(snapshot.size(), static_cast<float>(0.5 * snapshot.particle_spacing));
  snapshot.columns.push_back({"pscale", "m", "Radius of the particle.", 1, std::move(radius)});
}

/// What programs take the volumes for: Blender's volumes look for "velocity", Houdini's and most others for "v".
std::vector<VolumeName> volume_names(const std::vector<std::string>& columns, Client client) {
  std::vector<VolumeName> names;
  for (const std::string& column : columns) {
    const bool is_velocity = column == "velocity";
    names.push_back({column, is_velocity && client != Client::blender ? "v" : column});
  }
  return names;
}

ExportedSeries describe(const ExportOptions& options, UpAxis up) {
  ExportedSeries series;
  series.format = options.format;
  series.client = options.client;
  series.up = up;
  return series;
}

void describe_columns(const Snapshot& snapshot, ExportedSeries& series) {
  series.spacing = snapshot.particle_spacing;
  series.attributes.clear();
  series.materials.clear();
  for (const SnapshotMaterial& material : snapshot.materials) series.materials.push_back(material.name);
  for (const SnapshotColumn& column : snapshot.columns) {
    for (const std::string& name : component_names(column)) {
      series.attributes.push_back(name);
      series.units[name] = column.unit;
    }
  }
}

/// Writes the volumes of a frame and returns what to say of it.
std::string write_fog(const fs::path& path, Snapshot& snapshot, const ExportOptions& options, ExportedSeries& series) {
  std::vector<std::string> columns;
  const std::vector<std::string> asked = chosen_attributes(options.attributes, "vdb", snapshot);
  for (const SnapshotColumn& column : snapshot.columns) {
    const bool is_asked = std::ranges::find(asked, column.name) != asked.end();
    if (column.name != "position" && is_asked && column.components <= 3) columns.push_back(column.name);
  }
  const std::vector<VolumeName> names = volume_names(columns, client_of(options.client));
  const Volumes fog = fog_of(snapshot, options.voxel * snapshot.particle_spacing, names);
  write_file_atomically(path, vdb_bytes(fog.leaves, fog.volumes, {{"creator", "firn " FIRN_VERSION}}));
  series.attributes.clear();
  std::string grids;
  for (const SparseVolume& volume : fog.volumes) {
    series.attributes.push_back(volume.name);
    grids += (grids.empty() ? "" : ", ") + volume.name;
  }
  for (const VolumeName& name : names) series.units[name.volume] = snapshot.find(name.column)->unit;
  return fmt::format("{} particles as {}", snapshot.size(), grids);
}

std::string write_points(const fs::path& path, const Snapshot& snapshot, const std::string& format) {
  if (format == "vtp") {
    write_vtp(path, snapshot);
  } else if (format == "csv") {
    write_csv(path, snapshot);
  } else {
    write_ply(path, snapshot);
  }
  return fmt::format("{} particles", snapshot.size());
}

/// One file for each frame.
void export_frames(const FrameList& list, const ExportOptions& options, UpAxis up, const ExportTarget& target) {
  ExportedSeries series = describe(options, up);
  const Client client = client_of(options.client);
  const bool is_fog = options.format == "vdb";
  std::size_t done = 0;
  for (const ListedFrame& frame : list.frames) {
    Snapshot snapshot = prepared(frame, list, options, up, is_fog);
    if (client == Client::houdini && !is_fog) add_radius(snapshot);
    describe_columns(snapshot, series);
    const fs::path file = target.file(frame);
    const std::string what =
        is_fog ? write_fog(file, snapshot, options, series) : write_points(file, snapshot, options.format);
    print_done(++done, list.frames.size(), file, what);
  }
  if (target.is_one_file()) return;
  if (options.format == "vtp") {
    std::vector<SeriesFrame> files;
    for (const ListedFrame& frame : list.frames) files.push_back({target.file(frame).filename().string(), frame.time});
    write_pvd(target.beside(".pvd"), files);
  }
  write_series_description(target, list, series);
}

/// All frames in one file.
void export_usd(const FrameList& list, const ExportOptions& options, UpAxis up, const fs::path& file) {
  const std::string python = python_with_usd();
  const WorkFolder work;
  UsdScene usd;
  usd.frame_rate = list.frame_rate;
  usd.up = up;
  for (const ListedFrame& frame : list.frames) {
    const Snapshot snapshot = prepared(frame, list, options, up, false);
    const fs::path points = work.path() / fmt::format("points.{:04}.ply", frame.number);
    write_ply(points, snapshot);
    usd.points.push_back(points);
    usd.times.push_back(frame.time);
    usd.width = std::max(usd.width, snapshot.particle_spacing);
    print_done(usd.points.size(), list.frames.size(), points, fmt::format("{} particles", snapshot.size()));
  }
  write_usd(file, usd, python);
  print_done(list.frames.size(), list.frames.size(), file, fmt::format("{} frames", list.frames.size()));
}

const std::vector<std::string> kFormats = {"ply", "vtp", "csv", "vdb", "usd"};

/// The format that is meant where none is named: the one that the client reads best, or that of the file's ending.
std::string chosen_format(const ExportOptions& options) {
  if (options.format == "usdc" || options.format == "usda") return "usd";
  if (!options.format.empty()) {
    if (std::ranges::find(kFormats, options.format) != kFormats.end()) return options.format;
    throw Error(ErrorKind::usage,
                fmt::format("--format: no format \"{}\"{}", options.format, suggestion(options.format, kFormats)));
  }
  const std::string ending = fs::path(options.output).extension().string();
  for (const std::string& format : kFormats) {
    if (ending == "." + format || (format == "usd" && ending.starts_with(".usd"))) return format;
  }
  return client_of(options.client) == Client::paraview ? "vtp" : "ply";
}

void export_run(ExportOptions options) {
  options.format = chosen_format(options);
  const Client client = client_of(options.client);
  FrameList list = list_frames(options.paths);
  choose_frames(list, options.frames);
  const UpAxis up = target_up(client, options.up, options.format, list.up);
  // A wrong name is told before anything is written.
  chosen_attributes(options.attributes, options.format, read_frame(list.frames.front().file));
  if (!(options.voxel > 0))
    throw Error(ErrorKind::usage, fmt::format("--voxel must be above 0, got {}", options.voxel));

  if (options.format == "usd") {
    const std::string ending = fs::path(options.output).extension().string();
    const bool is_named = ending.starts_with(".usd");
    FrameList first = list;
    first.frames.resize(1);
    const ExportTarget target(first, is_named ? options.output : options.output, "export", "particles",
                              is_named ? ending : ".usdc");
    const fs::path file = is_named ? fs::path(options.output) : target.beside(".usdc");
    target.prepare({file}, options.force);
    export_usd(list, options, up, file);
    return;
  }
  const std::string name = options.format == "vdb" ? "volume" : "particles";
  const ExportTarget target(list, options.output, "export", name, "." + options.format);
  std::vector<fs::path> files;
  for (const ListedFrame& frame : list.frames) files.push_back(target.file(frame));
  target.prepare(files, options.force);
  export_frames(list, options, up, target);
  const std::string clicks = next_clicks(client, options.format, target, list);
  if (!clicks.empty()) fmt::print("{}\n", clicks);
}

}  // namespace

void add_export(CLI::App& program) {
  CLI::App* command = program.add_subcommand("export", "Write particles for other programs: PLY, VTP, CSV, VDB, USD");
  const auto options = std::make_shared<ExportOptions>();
  command->add_option("run", options->paths, "Output folder of a run, or frames of one (particles.0012.hdf)")
      ->required();
  command->add_option("--format", options->format, "ply, vtp, csv, vdb or usd; by default what the client reads best")
      ->type_name("FORMAT");
  command->add_option("--for", options->client, "blender, houdini or paraview: which axis is up, and the names")
      ->type_name("PROGRAM");
  command
      ->add_option("--attributes", options->attributes,
                   "Columns to write, separated by commas, or \"all\"; firn info lists them; color is one more")
      ->type_name("NAMES");
  command->add_option("--frames", options->frames, "Only these: 5, 1:24, 1:240:10, 1,5,9, 20:, last")
      ->type_name("LIST");
  command->add_option("--up", options->up, "y or z: the axis that is up in the files, instead of the client's");
  command->add_option("--voxel", options->voxel, "Edge of a voxel of vdb, in particle spacings")->capture_default_str();
  command->add_option("-o,--output", options->output, "Folder, or a file for a single frame; else export/ in the run's")
      ->type_name("PATH");
  command->add_flag("--force", options->force, "Replace files that exist");
  command->callback([options] { export_run(*options); });
}

}  // namespace firn
