#include <firn/io/chunk_filter.h>
#include <firn/io/frame_hdf5.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

namespace firn::hdf5 {

namespace {

/// Large enough for compression to work, small enough for the chunk cache (1 MiB) to hold one of doubles N x 3.
constexpr std::size_t kChunkRows = 32768;
/// Level 1 takes a tenth of the time of level 6 and gains nearly as much on shuffled floating-point numbers.
constexpr unsigned kDeflateLevel = 1;

Handle fixed_string_type(std::size_t length, H5T_cset_t character_set) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "copy a type");
  check(H5Tset_size(type, std::max<std::size_t>(length, 1)), "set a string length");
  check(H5Tset_strpad(type, H5T_STR_NULLPAD), "set string padding");
  check(H5Tset_cset(type, character_set), "set a character set");
  return type;
}

void write_scalar_attribute(hid_t object, const std::string& name, hid_t type, const void* value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, "create a data space");
  const Handle attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                         "create the attribute " + name);
  check(H5Awrite(attribute, type, value), "write the attribute " + name);
}

Handle open_attribute(hid_t object, const std::string& name) {
  return Handle(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, "find the attribute " + name);
}

void require_scalar(hid_t attribute, const std::string& name) {
  const Handle space(H5Aget_space(attribute), H5Sclose, "read the attribute " + name);
  if (H5Sget_simple_extent_npoints(space) != 1) throw Failure{"find one value in the attribute " + name};
}

/// A stored string of `length` bytes without its padding.
std::string unpadded(const char* bytes, std::size_t length) { return std::string(bytes, strnlen(bytes, length)); }

/// Bytes per string of a fixed-length string type.
std::size_t fixed_length(hid_t type, const std::string& name) {
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0) throw Failure{"find a string in " + name};
  return H5Tget_size(type);
}

}  // namespace

Handle::Handle(hid_t id, Close close, const std::string& what) : id_(id), close_(close) {
  if (id < 0) throw Failure{what};
}

Handle::~Handle() {
  if (id_ >= 0) close_(id_);
}

Handle::Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}

void Handle::close_now(const std::string& what) { check(close_(std::exchange(id_, -1)), what); }

SilencedErrors::SilencedErrors() {
  H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

SilencedErrors::~SilencedErrors() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }

void check(herr_t status, const std::string& what) {
  if (status < 0) throw Failure{what};
}

Handle create_group(hid_t parent, const std::string& name) {
  const Handle properties(H5Pcreate(H5P_GROUP_CREATE), H5Pclose, "create a property list");
  check(H5Pset_obj_track_times(properties, false), "switch time stamps off");
  return Handle(H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, properties, H5P_DEFAULT), H5Gclose,
                "create the group " + name);
}

namespace {

/// All rows, chunk by chunk, through our own filter instead of HDF5's.
void write_chunks(hid_t dataset, const std::string& name, std::size_t element, const void* values, std::size_t rows,
                  int components) {
  const std::size_t row = element * static_cast<std::size_t>(components), most = std::min(rows, kChunkRows);
  const auto* bytes = static_cast<const std::byte*>(values);
  ChunkFilter filter;
  std::vector<std::byte> last;
  for (std::size_t begin = 0; begin < rows; begin += most) {
    std::span<const std::byte> chunk(bytes + begin * row, std::min(most, rows - begin) * row);
    if (chunk.size() < most * row) {  // the last chunk is a whole one, too
      last.assign(chunk.begin(), chunk.end());
      last.resize(most * row);
      chunk = last;
    }
    const std::vector<std::byte>& filtered = filter.apply(chunk, element);
    const std::array<hsize_t, 2> offset = {begin, 0};
    check(H5Dwrite_chunk(dataset, H5P_DEFAULT, 0, offset.data(), filtered.size(), filtered.data()),
          "write the dataset " + name);
  }
}

}  // namespace

void write_rows(hid_t group, const std::string& name, hid_t type, const void* values, std::size_t rows,
                int components) {
  const int rank = components > 0 ? 2 : 1;
  const std::array<hsize_t, 2> size = {rows, static_cast<hsize_t>(components)};
  const std::array<hsize_t, 2> chunk = {std::min(rows, kChunkRows), size[1]};
  const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "create a property list");
  check(H5Pset_obj_track_times(properties, false), "switch time stamps off");
  if (rows > 0) {  // a chunk cannot be empty
    check(H5Pset_chunk(properties, rank, chunk.data()), "set the chunk size");
    check(H5Pset_shuffle(properties), "set the shuffle filter");
    check(H5Pset_deflate(properties, kDeflateLevel), "set the compression");
    check(H5Pset_fletcher32(properties), "set the checksum");
  }
  const Handle space(H5Screate_simple(rank, size.data(), nullptr), H5Sclose, "create a data space");
  const Handle dataset(H5Dcreate2(group, name.c_str(), type, space, H5P_DEFAULT, properties, H5P_DEFAULT), H5Dclose,
                       "create the dataset " + name);
  if (rows > 0) write_chunks(dataset, name, H5Tget_size(type), values, rows, std::max(components, 1));
}

void write_strings(hid_t group, const std::string& name, const std::vector<std::string>& values) {
  std::size_t length = 1;
  for (const std::string& value : values) length = std::max(length, value.size());
  std::string bytes;
  for (std::string value : values) {
    value.resize(length, '\0');
    bytes += value;
  }
  const Handle type = fixed_string_type(length, H5T_CSET_UTF8);
  write_rows(group, name, type, bytes.data(), values.size(), 0);
}

void write_attribute(hid_t object, const std::string& name, std::int64_t value) {
  write_scalar_attribute(object, name, H5T_NATIVE_INT64, &value);
}

void write_attribute(hid_t object, const std::string& name, double value) {
  write_scalar_attribute(object, name, H5T_NATIVE_DOUBLE, &value);
}

void write_attribute(hid_t object, const std::string& name, const std::string& value) {
  const bool ascii =
      std::all_of(value.begin(), value.end(), [](char c) { return static_cast<unsigned char>(c) < 128; });
  const Handle type = fixed_string_type(value.size(), ascii ? H5T_CSET_ASCII : H5T_CSET_UTF8);
  const std::string padded = value.empty() ? std::string(1, '\0') : value;
  write_scalar_attribute(object, name, type, padded.data());
}

std::int64_t read_integer_attribute(hid_t object, const std::string& name) {
  const Handle attribute = open_attribute(object, name);
  require_scalar(attribute, name);
  std::int64_t value = 0;
  check(H5Aread(attribute, H5T_NATIVE_INT64, &value), "read the attribute " + name);
  return value;
}

double read_real_attribute(hid_t object, const std::string& name) {
  const Handle attribute = open_attribute(object, name);
  require_scalar(attribute, name);
  double value = 0;
  check(H5Aread(attribute, H5T_NATIVE_DOUBLE, &value), "read the attribute " + name);
  return value;
}

std::string read_string_attribute(hid_t object, const std::string& name) {
  const Handle attribute = open_attribute(object, name);
  require_scalar(attribute, name);
  const Handle type(H5Aget_type(attribute), H5Tclose, "read the attribute " + name);
  std::vector<char> bytes(fixed_length(type, name));
  check(H5Aread(attribute, type, bytes.data()), "read the attribute " + name);
  return unpadded(bytes.data(), bytes.size());
}

std::vector<std::string> read_strings(hid_t group, const std::string& name) {
  const Handle dataset(H5Dopen2(group, name.c_str(), H5P_DEFAULT), H5Dclose, "open the dataset " + name);
  const std::vector<hsize_t> size = extents(dataset);
  const Handle type(H5Dget_type(dataset), H5Tclose, "read the dataset " + name);
  const std::size_t length = fixed_length(type, name);
  if (size.size() != 1) throw Failure{"find a list in the dataset " + name};
  std::vector<char> bytes(value_count(dataset, name) * length);
  if (!bytes.empty()) {
    check(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()), "read the dataset " + name);
  }
  std::vector<std::string> values;
  for (std::size_t i = 0; i < size[0]; ++i) values.push_back(unpadded(bytes.data() + i * length, length));
  return values;
}

std::vector<hsize_t> extents(hid_t dataset) {
  const Handle space(H5Dget_space(dataset), H5Sclose, "read the size of a dataset");
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank < 0) throw Failure{"read the size of a dataset"};
  std::vector<hsize_t> size(static_cast<std::size_t>(rank));
  H5Sget_simple_extent_dims(space, size.data(), nullptr);
  return size;
}

std::size_t value_count(hid_t dataset, const std::string& name) {
  const Handle type(H5Dget_type(dataset), H5Tclose, "read the type of " + name);
  // Deflate makes of 1032 equal bytes one at best.
  constexpr hsize_t kBestCompression = 1032;
  const hsize_t most = H5Dget_storage_size(dataset) * kBestCompression / std::max<hsize_t>(1, H5Tget_size(type));
  const std::vector<hsize_t> lengths = extents(dataset);
  if (std::ranges::find(lengths, hsize_t(0)) != lengths.end()) return 0;
  hsize_t count = 1;
  for (const hsize_t length : lengths) {
    if (count > most / length) throw Failure{"find the values of the dataset " + name + " in the file"};
    count *= length;
  }
  return static_cast<std::size_t>(count);
}

}  // namespace firn::hdf5
