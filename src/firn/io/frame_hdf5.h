#pragma once

#include <hdf5.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

/// The few uses of HDF5 that frames and checkpoints make, with failures as exceptions. Internal to the io module.
namespace firn::hdf5 {

/// A call into HDF5 failed. Callers turn it into firn::Error with the path.
struct Failure {
  std::string what;  ///< what could not be done, for example "read the dataset Points"
};

/// Owns one identifier and closes it.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  /// Throws Failure{what} if id is negative, which is how HDF5 reports failure.
  Handle(hid_t id, Close close, const std::string& what);
  ~Handle();
  Handle(Handle&& other) noexcept;
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;

  operator hid_t() const { return id_; }

  /// Throws Failure{what} if that fails.
  void close_now(const std::string& what);

 private:
  hid_t id_;
  Close close_;
};

/// Keeps HDF5 from printing its error stack to stderr while it lives, on this thread.
class SilencedErrors {
 public:
  SilencedErrors();
  ~SilencedErrors();
  SilencedErrors(const SilencedErrors&) = delete;
  SilencedErrors& operator=(const SilencedErrors&) = delete;

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

/// Throws Failure{what} if status is negative.
void check(herr_t status, const std::string& what);

template <class T>
hid_t native_type();
template <>
inline hid_t native_type<float>() {
  return H5T_NATIVE_FLOAT;
}
template <>
inline hid_t native_type<double>() {
  return H5T_NATIVE_DOUBLE;
}
template <>
inline hid_t native_type<std::uint8_t>() {
  return H5T_NATIVE_UINT8;
}
template <>
inline hid_t native_type<std::uint16_t>() {
  return H5T_NATIVE_UINT16;
}
template <>
inline hid_t native_type<std::uint32_t>() {
  return H5T_NATIVE_UINT32;
}
template <>
inline hid_t native_type<std::uint64_t>() {
  return H5T_NATIVE_UINT64;
}
template <>
inline hid_t native_type<std::int32_t>() {
  return H5T_NATIVE_INT32;
}
template <>
inline hid_t native_type<std::int64_t>() {
  return H5T_NATIVE_INT64;
}

/// A group or dataset without time stamps.
Handle create_group(hid_t parent, const std::string& name);

/// Rows of `components` values (0: a one-dimensional dataset), checksummed, shuffled and lightly compressed.
void write_rows(hid_t group, const std::string& name, hid_t type, const void* values, std::size_t rows, int components);

template <class T>
void write_values(hid_t group, const std::string& name, std::span<const T> values) {
  write_rows(group, name, native_type<T>(), values.data(), values.size(), 0);
}

/// A one-dimensional dataset of UTF-8 strings.
void write_strings(hid_t group, const std::string& name, const std::vector<std::string>& values);

void write_attribute(hid_t object, const std::string& name, std::int64_t value);
void write_attribute(hid_t object, const std::string& name, double value);
void write_attribute(hid_t object, const std::string& name, const std::string& value);

std::int64_t read_integer_attribute(hid_t object, const std::string& name);
double read_real_attribute(hid_t object, const std::string& name);
std::string read_string_attribute(hid_t object, const std::string& name);
std::vector<std::string> read_strings(hid_t group, const std::string& name);

/// Lengths along each axis of a dataset.
std::vector<hsize_t> extents(hid_t dataset);

/// Of all axes together. Throws Failure if so many values cannot lie in the dataset's part of the file: a few bytes may
/// declare any number, and memory is taken for it before anything is read.
std::size_t value_count(hid_t dataset, const std::string& name);

/// All values of a dataset. Throws Failure if their count is not `count` or a checksum does not match.
template <class T>
std::vector<T> read_values(hid_t dataset, std::size_t count, const std::string& name) {
  const std::size_t stored = value_count(dataset, name);
  if (stored != count) throw Failure{"find " + std::to_string(count) + " values in the dataset " + name};
  std::vector<T> values(count);
  if (count > 0) {
    check(H5Dread(dataset, native_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), "read the dataset " + name);
  }
  return values;
}

template <class T>
std::vector<T> read_values(hid_t group, const char* name) {
  const Handle dataset(H5Dopen2(group, name, H5P_DEFAULT), H5Dclose, std::string("open the dataset ") + name);
  return read_values<T>(dataset, value_count(dataset, name), name);
}

}  // namespace firn::hdf5
