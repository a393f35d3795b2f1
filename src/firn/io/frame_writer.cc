#include <firn/core/error.h>
#include <firn/io/atomic_file.h>
#include <firn/io/frame_image.h>
#include <firn/io/frame_writer.h>

#include <fmt/format.h>

#include <numeric>
#include <span>

namespace firn {

namespace {

constexpr std::uint8_t kPolyVertex = 2;  // VTK's cell type

/// VTK's components per point for a column: 0 means a plain one-dimensional dataset.
int stored_components(const SnapshotColumn& column) { return column.components == 1 ? 0 : column.components; }

void write_column(hid_t group, const std::string& name, const SnapshotColumn& column, std::size_t rows) {
  std::visit(
      [&]<class T>(const std::vector<T>& values) {
        hdf5::write_rows(group, name, hdf5::native_type<T>(), values.data(), rows, stored_components(column));
      },
      column.values);
}

void require_consistent(const Snapshot& snapshot) {
  if (snapshot.columns.empty() || snapshot.columns[0].name != "position" || snapshot.columns[0].components != 3) {
    throw Error(ErrorKind::usage, "snapshot: the first column must be \"position\" with 3 components");
  }
  for (const SnapshotColumn& column : snapshot.columns) {
    const std::size_t stored = std::visit([](const auto& values) { return values.size(); }, column.values);
    const std::size_t expected = snapshot.size() * static_cast<std::size_t>(column.components);
    if (stored != expected || column.components < 1) {
      throw Error(ErrorKind::usage,
                  fmt::format("snapshot: the column \"{}\" holds {} values, not {} particles x {} components",
                              column.name, stored, snapshot.size(), column.components));
    }
  }
}

void write_cells(hid_t group, const Snapshot& snapshot) {
  const std::size_t count = snapshot.size();
  std::vector<std::int64_t> connectivity(count);
  std::iota(connectivity.begin(), connectivity.end(), 0);
  std::vector<std::int64_t> offsets = {0};
  for (const SnapshotMaterial& material : snapshot.materials) {
    if (material.end > material.begin) offsets.push_back(static_cast<std::int64_t>(material.end));
  }
  const std::vector<std::uint8_t> types(offsets.size() - 1, kPolyVertex);
  // Lists of one: VTK stores one entry per part of a distributed grid.
  const std::int64_t points = static_cast<std::int64_t>(count), cells = static_cast<std::int64_t>(types.size());
  hdf5::write_values<std::int64_t>(group, "NumberOfPoints", std::span(&points, 1));
  hdf5::write_values<std::int64_t>(group, "NumberOfConnectivityIds", std::span(&points, 1));
  hdf5::write_values<std::int64_t>(group, "NumberOfCells", std::span(&cells, 1));
  hdf5::write_values<std::int64_t>(group, "Connectivity", connectivity);
  hdf5::write_values<std::int64_t>(group, "Offsets", offsets);
  hdf5::write_values<std::uint8_t>(group, "Types", types);
}

void write_vtk_version(hid_t group) {
  const std::int64_t version[2] = {1, 0};
  const hsize_t two = 2;
  const hdf5::Handle space(H5Screate_simple(1, &two, nullptr), H5Sclose, "create a data space");
  const hdf5::Handle attribute(H5Acreate2(group, "Version", H5T_NATIVE_INT64, space, H5P_DEFAULT, H5P_DEFAULT),
                               H5Aclose, "create the attribute Version");
  hdf5::check(H5Awrite(attribute, H5T_NATIVE_INT64, version), "write the attribute Version");
}

/// What ParaView needs to draw points of the right size, and the time for those who open single files. Numbers only:
/// ParaView 5.11 reads no strings here.
void write_field_data(hid_t vtk_group, const Snapshot& snapshot) {
  const hdf5::Handle group = hdf5::create_group(vtk_group, "FieldData");
  const std::int64_t dimension = snapshot.dimension;
  hdf5::write_values<double>(group, "TimeValue", std::span(&snapshot.time, 1));
  hdf5::write_values<double>(group, "particle_spacing", std::span(&snapshot.particle_spacing, 1));
  hdf5::write_values<std::int64_t>(group, "dimension", std::span(&dimension, 1));
}

void write_vtk_group(hid_t file, const Snapshot& snapshot) {
  const hdf5::Handle group = hdf5::create_group(file, "VTKHDF");
  write_vtk_version(group);
  hdf5::write_attribute(group, "Type", std::string("UnstructuredGrid"));
  write_cells(group, snapshot);
  write_field_data(group, snapshot);
  write_column(group, "Points", snapshot.columns[0], snapshot.size());
  const hdf5::Handle point_data = hdf5::create_group(group, "PointData");
  for (std::size_t i = 1; i < snapshot.columns.size(); ++i) {
    write_column(point_data, snapshot.columns[i].name, snapshot.columns[i], snapshot.size());
  }
}

void write_column_table(hid_t group, const Snapshot& snapshot) {
  std::vector<std::string> names, units, helps;
  for (const SnapshotColumn& column : snapshot.columns) {
    names.push_back(column.name);
    units.push_back(column.unit);
    helps.push_back(column.help);
  }
  const hdf5::Handle columns = hdf5::create_group(group, "columns");
  hdf5::write_strings(columns, "name", names);
  hdf5::write_strings(columns, "unit", units);
  hdf5::write_strings(columns, "help", helps);
}

void write_material_table(hid_t group, const Snapshot& snapshot) {
  std::vector<std::string> names, models, presets;
  std::vector<std::int64_t> begins, ends;
  for (const SnapshotMaterial& material : snapshot.materials) {
    names.push_back(material.name);
    models.push_back(material.model);
    presets.push_back(material.preset);
    begins.push_back(static_cast<std::int64_t>(material.begin));
    ends.push_back(static_cast<std::int64_t>(material.end));
  }
  const hdf5::Handle materials = hdf5::create_group(group, "materials");
  hdf5::write_strings(materials, "name", names);
  hdf5::write_strings(materials, "model", models);
  hdf5::write_strings(materials, "preset", presets);
  hdf5::write_values<std::int64_t>(materials, "begin", begins);
  hdf5::write_values<std::int64_t>(materials, "end", ends);
}

void write_firn_group(hid_t file, const Snapshot& snapshot, const FrameMetadata& metadata) {
  const hdf5::Handle group = hdf5::create_group(file, "Firn");
  hdf5::write_attribute(group, "format_version", std::int64_t(kFrameFormatVersion));
  hdf5::write_attribute(group, "firn_version", metadata.firn_version);
  hdf5::write_attribute(group, "scene_hash", metadata.scene_hash);
  hdf5::write_attribute(group, "precision", metadata.precision);
  hdf5::write_attribute(group, "up", metadata.up);
  hdf5::write_attribute(group, "frame", metadata.frame);
  hdf5::write_attribute(group, "time", snapshot.time);
  hdf5::write_attribute(group, "dimension", std::int64_t(snapshot.dimension));
  hdf5::write_attribute(group, "cell_size", snapshot.cell_size);
  hdf5::write_attribute(group, "particle_spacing", snapshot.particle_spacing);
  write_column_table(group, snapshot);
  write_material_table(group, snapshot);
  hdf5::write_strings(group, "bodies", snapshot.bodies);
}

}  // namespace

std::string frame_file_name(std::int64_t frame) { return fmt::format("particles.{:04}.hdf", frame); }

std::vector<std::byte> frame_bytes(const Snapshot& snapshot, const FrameMetadata& metadata) {
  require_consistent(snapshot);
  const hdf5::SilencedErrors silenced;
  try {
    return hdf5::make_file([&](hid_t file) {
      write_vtk_group(file, snapshot);
      write_firn_group(file, snapshot, metadata);
    });
  } catch (const hdf5::Failure& failure) {
    throw Error(ErrorKind::files, fmt::format("cannot make the frame: HDF5 could not {}", failure.what));
  }
}

void write_frame(const std::filesystem::path& path, const Snapshot& snapshot, const FrameMetadata& metadata) {
  std::vector<std::byte> bytes;
  try {
    bytes = frame_bytes(snapshot, metadata);
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::usage) throw;
    throw Error(error.kind(), fmt::format("{}: {}", path.string(), error.what()));
  }
  write_file_atomically(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()}, Durability::synced);
}

}  // namespace firn
