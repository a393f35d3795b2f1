#include <firn/core/error.h>
#include <firn/io/frame_image.h>
#include <firn/io/frame_reader.h>
#include <firn/io/shown_text.h>

#include <fmt/format.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>

namespace firn {

namespace {

using hdf5::Failure;
using hdf5::Handle;

/// More than any column has; far less than what an int holds.
constexpr hsize_t kMostComponents = 1000;

Handle open_group(hid_t parent, const char* name) {
  return Handle(H5Gopen2(parent, name, H5P_DEFAULT), H5Gclose, std::string("find the group ") + name);
}

/// The dataset's values in the type they are stored in.
void read_stored_type(hid_t dataset, std::size_t count, SnapshotColumn* column) {
  const Handle type(H5Dget_type(dataset), H5Tclose, "read the type of " + column->name);
  const H5T_class_t kind = H5Tget_class(type);
  const std::size_t size = H5Tget_size(type);
  if (kind == H5T_FLOAT && size == 4) {
    column->values = hdf5::read_values<float>(dataset, count, column->name);
  } else if (kind == H5T_FLOAT && size == 8) {
    column->values = hdf5::read_values<double>(dataset, count, column->name);
  } else if (kind == H5T_INTEGER && size == 4) {
    column->values = hdf5::read_values<std::int32_t>(dataset, count, column->name);
  } else if (kind == H5T_INTEGER && size == 8) {
    column->values = hdf5::read_values<std::int64_t>(dataset, count, column->name);
  } else {
    throw Failure{"use the number type of the dataset " + column->name};
  }
}

void read_column(hid_t group, const char* dataset_name, std::size_t particles, SnapshotColumn* column) {
  const Handle dataset(H5Dopen2(group, dataset_name, H5P_DEFAULT), H5Dclose,
                       std::string("find the dataset ") + dataset_name);
  const std::vector<hsize_t> size = hdf5::extents(dataset);
  if (size.empty() || size.size() > 2 || size[0] != particles) {
    throw Failure{fmt::format("find {} rows in the dataset {}", particles, dataset_name)};
  }
  if (size.size() == 2 && (size[1] < 1 || size[1] > kMostComponents)) {
    throw Failure{fmt::format("use {} components in the dataset {}", size[1], dataset_name)};
  }
  column->components = size.size() == 2 ? static_cast<int>(size[1]) : 1;
  read_stored_type(dataset, particles * static_cast<std::size_t>(column->components), column);
}

std::vector<SnapshotMaterial> read_materials(hid_t firn_group) {
  const Handle group = open_group(firn_group, "materials");
  const auto names = hdf5::read_strings(group, "name"), models = hdf5::read_strings(group, "model"),
             presets = hdf5::read_strings(group, "preset");
  const auto begins = hdf5::read_values<std::int64_t>(group, "begin"),
             ends = hdf5::read_values<std::int64_t>(group, "end");
  std::vector<SnapshotMaterial> materials;
  std::int64_t expected_begin = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i >= models.size() || i >= presets.size() || i >= begins.size() || i >= ends.size() ||
        begins[i] != expected_begin || ends[i] < begins[i]) {
      throw Failure{"use the table of materials"};
    }
    expected_begin = ends[i];
    materials.push_back(
        {names[i], models[i], presets[i], static_cast<std::size_t>(begins[i]), static_cast<std::size_t>(ends[i])});
  }
  return materials;
}

std::vector<SnapshotColumn> read_columns(hid_t file, hid_t firn_group, std::size_t particles) {
  const Handle vtk = open_group(file, "VTKHDF");
  const Handle point_data = open_group(vtk, "PointData");
  const Handle table = open_group(firn_group, "columns");
  const auto names = hdf5::read_strings(table, "name"), units = hdf5::read_strings(table, "unit"),
             helps = hdf5::read_strings(table, "help");
  if (names.empty() || names[0] != "position" || units.size() != names.size() || helps.size() != names.size()) {
    throw Failure{"use the table of columns"};
  }
  std::vector<SnapshotColumn> columns;
  for (std::size_t i = 0; i < names.size(); ++i) {
    SnapshotColumn& column = columns.emplace_back();
    column.name = names[i];
    column.unit = units[i];
    column.help = helps[i];
    read_column(i == 0 ? vtk : point_data, i == 0 ? "Points" : names[i].c_str(), particles, &column);
  }
  if (columns[0].components != 3) throw Failure{"find 3 coordinates in the dataset Points"};
  return columns;
}

Snapshot read_open_file(hid_t file, FrameMetadata* metadata) {
  const Handle group = open_group(file, "Firn");
  const std::int64_t version = hdf5::read_integer_attribute(group, "format_version");
  if (version < 1 || version > kFrameFormatVersion) {
    throw Failure{fmt::format("use format version {} (this program reads 1 to {}; use a newer Firn)", version,
                              kFrameFormatVersion)};
  }
  Snapshot snapshot;
  snapshot.dimension = static_cast<int>(hdf5::read_integer_attribute(group, "dimension"));
  snapshot.time = hdf5::read_real_attribute(group, "time");
  snapshot.cell_size = hdf5::read_real_attribute(group, "cell_size");
  snapshot.particle_spacing = hdf5::read_real_attribute(group, "particle_spacing");
  if (snapshot.dimension != 2 && snapshot.dimension != 3) throw Failure{"use a dimension other than 2 or 3"};
  snapshot.materials = read_materials(group);
  snapshot.bodies = hdf5::read_strings(group, "bodies");
  snapshot.columns = read_columns(file, group, snapshot.size());
  if (metadata != nullptr) {
    metadata->frame = hdf5::read_integer_attribute(group, "frame");
    metadata->precision = hdf5::read_string_attribute(group, "precision");
    metadata->scene_hash = hdf5::read_string_attribute(group, "scene_hash");
    metadata->firn_version = hdf5::read_string_attribute(group, "firn_version");
    metadata->up = H5Aexists(group, "up") > 0 ? hdf5::read_string_attribute(group, "up") : "";
  }
  return snapshot;
}

/// Says itself what the system or the first bytes show, because HDF5 reports every cause as "unable to open".
std::vector<std::byte> read_bytes(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  // To open a pipe would wait for somebody to write.
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    throw Error(ErrorKind::files, fmt::format("{}: cannot read the frame: it is {}", path.string(),
                                              std::filesystem::is_directory(status) ? "a folder" : "no regular file"));
  }
  std::ifstream stream(path, std::ios::binary | std::ios::ate);
  if (!stream) {
    throw Error(ErrorKind::files, fmt::format("{}: cannot read the frame: {}", path.string(), std::strerror(errno)));
  }
  std::vector<std::byte> bytes(static_cast<std::size_t>(stream.tellg()));
  stream.seekg(0);
  if (!stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()))) {
    throw Error(ErrorKind::files, fmt::format("{}: cannot read the frame: {}", path.string(), std::strerror(errno)));
  }
  return bytes;
}

}  // namespace

Snapshot parse_frame(const std::vector<std::byte>& bytes, const std::string& name, FrameMetadata* metadata) {
  if (bytes.size() < 8 || std::memcmp(bytes.data(), "\x89HDF\r\n\x1a\n", 8) != 0) {
    throw Error(ErrorKind::files, fmt::format("{}: not a frame of Firn: the file does not begin as HDF5", name));
  }
  try {
    const hdf5::SilencedErrors silenced;
    Snapshot snapshot;
    hdf5::open_image(bytes, [&](hid_t file) { snapshot = read_open_file(file, metadata); });
    return snapshot;
  } catch (const Failure& failure) {
    throw Error(ErrorKind::files,
                fmt::format("{}: damaged, or not a frame of Firn: could not {}; compute the frame again", name,
                            one_line(failure.what)));
  }
}

Snapshot read_frame(const std::filesystem::path& path, FrameMetadata* metadata) {
  return parse_frame(read_bytes(path), path.string(), metadata);
}

}  // namespace firn
