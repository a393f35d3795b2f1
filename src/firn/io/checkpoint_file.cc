#include <firn/core/error.h>
#include <firn/io/atomic_file.h>
#include <firn/io/checkpoint_file.h>
#include <firn/io/frame_image.h>
#include <firn/io/shown_text.h>
#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace firn {

std::size_t CheckpointColumn::value_count() const {
  return std::visit([](const auto& v) { return v.size(); }, values);
}

namespace {

using hdf5::Failure;
using hdf5::Handle;

/// Not zero: with a zero seed, hashes of all-zero or empty parts are the ones that a lost page would have, too.
constexpr std::uint64_t kSeed = 0x4669726e2d636b70;  // "Firn-ckp"
constexpr const char* kFormat = "firn checkpoint";

std::string_view text_of(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// ---- writing

/// Uncompressed, so that a checkpoint takes the time that the disk takes; the hash covers the whole file.
void write_column(hid_t group, const CheckpointColumn& column, std::size_t particles) {
  if (column.value_count() != column.components * particles) {
    throw Error(ErrorKind::usage,
                fmt::format("checkpoint: the column \"{}\" holds {} values, not {} components x {} particles",
                            column.name, column.value_count(), column.components, particles));
  }
  const std::array<hsize_t, 2> size = {column.components, particles};
  const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "create a property list");
  hdf5::check(H5Pset_obj_track_times(properties, false), "switch time stamps off");
  const Handle space(H5Screate_simple(2, size.data(), nullptr), H5Sclose, "create a data space");
  std::visit(
      [&]<class T>(const std::vector<T>& values) {
        const hid_t type = hdf5::native_type<T>();
        const Handle dataset(H5Dcreate2(group, column.name.c_str(), type, space, H5P_DEFAULT, properties, H5P_DEFAULT),
                             H5Dclose, "create the dataset " + column.name);
        if (values.empty()) return;
        hdf5::check(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
                    "write the dataset " + column.name);
      },
      column.values);
}

/// A group with a list of names and a list of what they stand for.
template <class T>
void write_table(hid_t parent, const std::string& name, const std::map<std::string, T>& entries) {
  const Handle group = hdf5::create_group(parent, name);
  std::vector<std::string> names;
  std::vector<T> values;
  for (const auto& [key, value] : entries) {
    names.push_back(key);
    values.push_back(value);
  }
  hdf5::write_strings(group, "name", names);
  if constexpr (std::is_same_v<T, std::string>) {
    hdf5::write_strings(group, "value", values);
  } else {
    hdf5::write_values<T>(group, "value", values);
  }
}

void write_state(hid_t parent, const std::string& name, const CheckpointState& state) {
  const Handle group = hdf5::create_group(parent, name);
  write_table(group, "numbers", state.numbers);
  write_table(group, "counters", state.counters);
  write_table(group, "texts", state.texts);
  hdf5::write_attribute(group, "materials", static_cast<std::int64_t>(state.materials.size()));
  for (std::size_t m = 0; m < state.materials.size(); ++m) {
    const CheckpointMaterial& material = state.materials[m];
    const Handle place = hdf5::create_group(group, fmt::format("material{}", m));
    hdf5::write_attribute(place, "name", material.name);
    hdf5::write_attribute(place, "model", material.model);
    hdf5::write_attribute(place, "particles", static_cast<std::int64_t>(material.particles));
    write_table(place, "numbers", material.numbers);
    std::vector<std::string> names;
    const Handle columns = hdf5::create_group(place, "columns");
    for (const CheckpointColumn& column : material.columns) {
      names.push_back(column.name);
      write_column(columns, column, material.particles);
    }
    hdf5::write_strings(place, "column_names", names);
  }
}

void write_all(hid_t file, const Checkpoint& checkpoint) {
  hdf5::write_attribute(file, "format", std::string(kFormat));
  hdf5::write_attribute(file, "format_version", std::int64_t(kCheckpointFormatVersion));
  hdf5::write_attribute(file, "firn_version", checkpoint.firn_version);
  hdf5::write_attribute(file, "arithmetic", checkpoint.arithmetic);
  hdf5::write_attribute(file, "layout", checkpoint.layout);
  hdf5::write_strings(file, "scene", {checkpoint.scene_text});
  write_table(file, "scene_keys", checkpoint.scene_keys);
  write_state(file, "state", checkpoint.state);
  if (checkpoint.frame_start) write_state(file, "frame_start", *checkpoint.frame_start);
}

// ---- reading

Handle open_group(hid_t parent, const std::string& name) {
  return Handle(H5Gopen2(parent, name.c_str(), H5P_DEFAULT), H5Gclose, "find the group " + name);
}

template <class T>
bool read_column_as(hid_t dataset, hid_t type, std::size_t count, CheckpointColumn& column) {
  if (H5Tequal(type, hdf5::native_type<T>()) <= 0) return false;
  column.values = hdf5::read_values<T>(dataset, count, column.name);
  return true;
}

CheckpointColumn read_column(hid_t group, const std::string& name, std::size_t particles) {
  CheckpointColumn column;
  column.name = name;
  const Handle dataset(H5Dopen2(group, name.c_str(), H5P_DEFAULT), H5Dclose, "find the dataset " + name);
  const std::vector<hsize_t> size = hdf5::extents(dataset);
  if (size.size() != 2 || size[1] != particles || size[0] < 1 || size[0] > 1000) {
    throw Failure{fmt::format("find {} particles in the dataset {}", particles, name)};
  }
  column.components = static_cast<std::size_t>(size[0]);
  const std::size_t count = column.components * particles;
  const Handle type(H5Dget_type(dataset), H5Tclose, "read the type of " + name);
  // HDF5 would convert; converted numbers are not the same bits.
  if (!read_column_as<float>(dataset, type, count, column) && !read_column_as<double>(dataset, type, count, column) &&
      !read_column_as<std::uint16_t>(dataset, type, count, column) &&
      !read_column_as<std::uint32_t>(dataset, type, count, column) &&
      !read_column_as<std::uint64_t>(dataset, type, count, column)) {
    throw Failure{"use the numbers of the dataset " + name + ", of another byte order or width than this machine's"};
  }
  return column;
}

template <class T>
std::map<std::string, T> read_table(hid_t parent, const std::string& name) {
  const Handle group = open_group(parent, name);
  const std::vector<std::string> names = hdf5::read_strings(group, "name");
  std::vector<T> values;
  if constexpr (std::is_same_v<T, std::string>) {
    values = hdf5::read_strings(group, "value");
  } else {
    values = hdf5::read_values<T>(group, "value");
  }
  if (values.size() != names.size()) throw Failure{"use the table " + name};
  std::map<std::string, T> entries;
  for (std::size_t i = 0; i < names.size(); ++i) entries[names[i]] = values[i];
  return entries;
}

CheckpointState read_state(hid_t parent, const std::string& name) {
  const Handle group = open_group(parent, name);
  CheckpointState state;
  state.numbers = read_table<double>(group, "numbers");
  state.counters = read_table<std::int64_t>(group, "counters");
  state.texts = read_table<std::string>(group, "texts");
  const std::int64_t materials = hdf5::read_integer_attribute(group, "materials");
  for (std::int64_t m = 0; m < materials; ++m) {
    const Handle place = open_group(group, fmt::format("material{}", m));
    CheckpointMaterial& material = state.materials.emplace_back();
    material.name = hdf5::read_string_attribute(place, "name");
    material.model = hdf5::read_string_attribute(place, "model");
    material.particles = static_cast<std::size_t>(hdf5::read_integer_attribute(place, "particles"));
    material.numbers = read_table<double>(place, "numbers");
    const Handle columns = open_group(place, "columns");
    for (const std::string& column : hdf5::read_strings(place, "column_names")) {
      material.columns.push_back(read_column(columns, column, material.particles));
    }
  }
  return state;
}

Checkpoint read_all(hid_t file) {
  if (hdf5::read_string_attribute(file, "format") != kFormat) throw Failure{"find a checkpoint in it"};
  const std::int64_t version = hdf5::read_integer_attribute(file, "format_version");
  Checkpoint checkpoint;
  checkpoint.firn_version = hdf5::read_string_attribute(file, "firn_version");
  if (version < 1 || version > kCheckpointFormatVersion) {
    throw Failure{fmt::format("use format version {} of Firn {} (this program reads 1 to {}; use that Firn)", version,
                              checkpoint.firn_version, kCheckpointFormatVersion)};
  }
  checkpoint.arithmetic = hdf5::read_string_attribute(file, "arithmetic");
  checkpoint.layout = hdf5::read_string_attribute(file, "layout");
  const std::vector<std::string> scene = hdf5::read_strings(file, "scene");
  if (scene.size() != 1) throw Failure{"find the scene"};
  checkpoint.scene_text = scene.front();
  checkpoint.scene_keys = read_table<std::string>(file, "scene_keys");
  checkpoint.state = read_state(file, "state");
  if (H5Lexists(file, "frame_start", H5P_DEFAULT) > 0) checkpoint.frame_start = read_state(file, "frame_start");
  return checkpoint;
}

[[noreturn]] void refuse(const std::string& name, const std::string& why) {
  throw Error(ErrorKind::files, fmt::format("{}: cannot use the checkpoint: {}", name, one_line(why)));
}

[[noreturn]] void refuse_size(const std::string& name, std::uintmax_t found, const CheckpointStamp& stamp) {
  refuse(name, fmt::format("it is {} bytes long, and run.json says {}", found, stamp.bytes));
}

std::vector<std::byte> read_bytes(const std::filesystem::path& path, const CheckpointStamp& stamp) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) refuse(path.string(), "it is a folder");
  const auto size = std::filesystem::file_size(path, error);
  if (error) refuse(path.string(), error.message());
  if (size != stamp.bytes) refuse_size(path.string(), size, stamp);
  std::vector<std::byte> bytes(stamp.bytes);
  std::ifstream stream(path, std::ios::binary);
  if (!stream || !stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()))) {
    refuse(path.string(), std::strerror(errno));
  }
  return bytes;
}

}  // namespace

CheckpointStamp stamp_of(std::string_view bytes) {
  return {bytes.size(), fmt::format("{:016x}", XXH3_64bits_withSeed(bytes.data(), bytes.size(), kSeed))};
}

std::vector<std::byte> checkpoint_bytes(const Checkpoint& checkpoint) {
  const hdf5::SilencedErrors silenced;
  try {
    return hdf5::make_file([&](hid_t file) { write_all(file, checkpoint); });
  } catch (const Failure& failure) {
    throw Error(ErrorKind::files, fmt::format("cannot make the checkpoint: HDF5 could not {}", failure.what));
  }
}

CheckpointStamp write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint) {
  std::vector<std::byte> bytes;
  try {
    bytes = checkpoint_bytes(checkpoint);
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::usage) throw;
    throw Error(error.kind(), fmt::format("{}: {}", path.string(), error.what()));
  }
  write_file_atomically(path, text_of(bytes), Durability::synced);
  return stamp_of(text_of(bytes));
}

Checkpoint parse_checkpoint(const std::vector<std::byte>& bytes, const CheckpointStamp& stamp,
                            const std::string& name) {
  if (bytes.size() != stamp.bytes) refuse_size(name, bytes.size(), stamp);
  if (const CheckpointStamp found = stamp_of(text_of(bytes)); found != stamp) {
    refuse(name, fmt::format("its hash is {}, and run.json says {}: it was damaged or changed after it was written",
                             found.hash, stamp.hash));
  }
  try {
    const hdf5::SilencedErrors silenced;
    Checkpoint checkpoint;
    hdf5::open_image(bytes, [&](hid_t file) { checkpoint = read_all(file); });
    return checkpoint;
  } catch (const Failure& failure) {
    refuse(name, fmt::format("could not {}", failure.what));
  }
}

Checkpoint read_checkpoint(const std::filesystem::path& path, const CheckpointStamp& stamp) {
  return parse_checkpoint(read_bytes(path, stamp), stamp, path.string());
}

}  // namespace firn
