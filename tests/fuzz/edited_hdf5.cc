#include "fuzz/edited_hdf5.h"

#include <firn/io/frame_image.h>

#include <algorithm>
#include <array>
#include <string>

namespace firn::fuzz {
namespace {

using hdf5::Handle;

constexpr int kMostEdits = 12;
/// More values than this are declared but not written: they read as zeros without taking space in the file.
constexpr hsize_t kMostWritten = 4096;

/// Gives the bytes of the edits one after another, then zeros.
class Bytes {
 public:
  explicit Bytes(std::string_view bytes) : bytes_(bytes) {}
  bool at_end() const { return at_ >= bytes_.size(); }
  std::size_t next() { return at_end() ? 0 : static_cast<unsigned char>(bytes_[at_++]); }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

struct Object {
  std::string path;
  std::string attribute;  ///< of the object at the path; empty: the object itself
  H5O_type_t type = H5O_TYPE_UNKNOWN;
};

herr_t add_attribute(hid_t, const char* name, const H5A_info_t*, void* data) {
  auto* objects = static_cast<std::vector<Object>*>(data);
  // The iteration began with the object itself.
  objects->push_back({objects->front().path, name, H5O_TYPE_UNKNOWN});
  return 0;
}

herr_t add_object(hid_t group, const char* name, const H5O_info_t* info, void* data) {
  auto* objects = static_cast<std::vector<Object>*>(data);
  std::vector<Object> found = {{name, "", info->type}};
  const Handle object(H5Oopen(group, name, H5P_DEFAULT), H5Oclose, "open");
  H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, nullptr, add_attribute, &found);
  objects->insert(objects->end(), found.begin(), found.end());
  return 0;
}

std::vector<Object> objects_of(hid_t file) {
  std::vector<Object> objects;
  hdf5::check(H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, add_object, &objects, H5O_INFO_BASIC), "visit");
  return objects;
}

/// A type, sizes and raw values: all there is to a dataset or attribute.
struct Contents {
  Handle type;
  std::vector<hsize_t> size;
  std::vector<char> values;

  /// No more than what is beyond every use here.
  hsize_t count() const {
    hsize_t product = 1;
    for (const hsize_t n : size)
      product = n == 0 ? 0 : std::min(product, kMostWritten + 1) * std::min(n, kMostWritten + 1);
    return product;
  }
};

Handle open_contents(hid_t file, const Object& object) {
  if (object.attribute.empty()) return Handle(H5Dopen2(file, object.path.c_str(), H5P_DEFAULT), H5Dclose, "open");
  return Handle(H5Aopen_by_name(file, object.path.c_str(), object.attribute.c_str(), H5P_DEFAULT, H5P_DEFAULT),
                H5Aclose, "open");
}

Contents read_contents(hid_t file, const Object& object) {
  const bool is_dataset = object.attribute.empty();
  const Handle source = open_contents(file, object);
  const Handle space(is_dataset ? H5Dget_space(source) : H5Aget_space(source), H5Sclose, "get");
  Contents contents{Handle(is_dataset ? H5Dget_type(source) : H5Aget_type(source), H5Tclose, "get"), {}, {}};
  contents.size.resize(static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space))));
  H5Sget_simple_extent_dims(space, contents.size.data(), nullptr);
  if (contents.count() > kMostWritten) return contents;
  contents.values.resize(contents.count() * H5Tget_size(contents.type));
  if (is_dataset) {
    H5Dread(source, contents.type, H5S_ALL, H5S_ALL, H5P_DEFAULT, contents.values.data());
  } else {
    H5Aread(source, contents.type, contents.values.data());
  }
  return contents;
}

void erase(hid_t file, const Object& object) {
  if (object.path == "." && object.attribute.empty()) return;
  if (object.attribute.empty()) {
    H5Ldelete(file, object.path.c_str(), H5P_DEFAULT);
  } else {
    H5Adelete_by_name(file, object.path.c_str(), object.attribute.c_str(), H5P_DEFAULT);
  }
}

void replace(hid_t file, const Object& object, Contents contents) {
  const bool is_dataset = object.attribute.empty();
  // HDF5 takes the memory of an attribute when it is made, however large it claims to be.
  if (!is_dataset && contents.count() > kMostWritten) return;
  erase(file, object);
  const int rank = static_cast<int>(contents.size.size());
  const Handle space(rank == 0 ? H5Screate(H5S_SCALAR) : H5Screate_simple(rank, contents.size.data(), nullptr),
                     H5Sclose, "create");
  const std::string path = object.path, attribute = object.attribute;
  const Handle made(is_dataset
                        ? H5Dcreate2(file, path.c_str(), contents.type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT)
                        : H5Acreate_by_name(file, path.c_str(), attribute.c_str(), contents.type, space, H5P_DEFAULT,
                                            H5P_DEFAULT, H5P_DEFAULT),
                    is_dataset ? H5Dclose : H5Aclose, "create");
  const hsize_t count = contents.count();
  // Pointers would be written as they are.
  if (count == 0 || count > kMostWritten || H5Tdetect_class(contents.type, H5T_VLEN) > 0 ||
      H5Tis_variable_str(contents.type) > 0 || H5Tget_class(contents.type) == H5T_REFERENCE) {
    return;
  }
  const std::size_t had = contents.values.size();
  contents.values.resize(count * H5Tget_size(contents.type));
  for (std::size_t i = had; i < contents.values.size() && had > 0; ++i) contents.values[i] = contents.values[i - had];
  if (is_dataset) {
    H5Dwrite(made, contents.type, H5S_ALL, H5S_ALL, H5P_DEFAULT, contents.values.data());
  } else {
    H5Awrite(made, contents.type, contents.values.data());
  }
}

Handle any_type(Bytes& bytes) {
  const std::array<hid_t, 11> numbers = {H5T_NATIVE_INT8,   H5T_NATIVE_UINT8, H5T_NATIVE_UINT16, H5T_NATIVE_INT32,
                                         H5T_NATIVE_UINT32, H5T_NATIVE_INT64, H5T_NATIVE_UINT64, H5T_NATIVE_FLOAT,
                                         H5T_NATIVE_DOUBLE, H5T_IEEE_F64BE,   H5T_STD_REF_OBJ};
  const std::size_t choice = bytes.next() % (numbers.size() + 3);
  if (choice < numbers.size()) return Handle(H5Tcopy(numbers[choice]), H5Tclose, "copy");
  Handle text(H5Tcopy(H5T_C_S1), H5Tclose, "copy");
  if (choice == numbers.size()) {
    H5Tset_size(text, H5T_VARIABLE);
  } else if (choice == numbers.size() + 1) {
    H5Tset_size(text, 1 + bytes.next());
  } else {
    return Handle(H5Tvlen_create(H5T_NATIVE_INT32), H5Tclose, "create");
  }
  return text;
}

std::vector<hsize_t> any_size(Bytes& bytes) {
  constexpr hsize_t kSizes[] = {
      0, 1, 2, 3, 4, 5, 6, 9, 1001, 70000, hsize_t(1) << 31, hsize_t(1) << 32, hsize_t(1) << 62};
  std::vector<hsize_t> size(bytes.next() % 4);
  for (hsize_t& n : size) n = kSizes[bytes.next() % std::size(kSizes)];
  return size;
}

void edit(hid_t file, const Object& object, Bytes& bytes) {
  switch (bytes.next() % 6) {
    case 0:
      erase(file, object);
      break;
    case 1:
      erase(file, object);
      if (object.attribute.empty()) hdf5::create_group(file, object.path);
      break;
    case 2: {  // other values
      Contents contents = read_contents(file, object);
      for (std::size_t n = bytes.next() % 8 + 1; n > 0 && !contents.values.empty(); --n) {
        const std::size_t at = bytes.next() + 256 * bytes.next();
        contents.values[at % contents.values.size()] = static_cast<char>(bytes.next());
      }
      replace(file, object, std::move(contents));
      break;
    }
    case 3: {  // other sizes
      Contents contents = read_contents(file, object);
      contents.size = any_size(bytes);
      replace(file, object, std::move(contents));
      break;
    }
    case 4: {  // other type
      Contents contents = read_contents(file, object);
      replace(file, object, {any_type(bytes), contents.size, contents.values});
      break;
    }
    default: {  // another thing altogether, also in the place of a group
      Handle type = any_type(bytes);
      std::vector<hsize_t> size = any_size(bytes);
      std::vector<char> values(bytes.next() % 32);
      for (char& value : values) value = static_cast<char>(bytes.next());
      replace(file, object, {std::move(type), std::move(size), std::move(values)});
      break;
    }
  }
}

void copy_all(hid_t from, hid_t to) {
  for (const Object& object : objects_of(from)) {
    const bool is_deep = object.path.find('/') != std::string::npos;
    if (object.attribute.empty() && !is_deep && object.path != ".") {
      hdf5::check(H5Ocopy(from, object.path.c_str(), to, object.path.c_str(), H5P_DEFAULT, H5P_DEFAULT), "copy");
    } else if (object.path == "." && !object.attribute.empty()) {
      replace(to, object, read_contents(from, object));
    }
  }
}

}  // namespace

std::vector<std::byte> edited_file(const std::vector<std::byte>& original, std::string_view edits) {
  const hdf5::SilencedErrors silenced;
  return hdf5::make_file([&](hid_t file) {
    hdf5::open_image(original, [&](hid_t source) { copy_all(source, file); });
    Bytes bytes(edits);
    for (int n = 0; n < kMostEdits && !bytes.at_end(); ++n) {
      try {
        const std::vector<Object> objects = objects_of(file);
        if (objects.empty()) return;
        edit(file, objects[bytes.next() % objects.size()], bytes);
      } catch (const hdf5::Failure&) {
        // HDF5 does not make everything; the next edit may be one that it makes.
      }
    }
  });
}

}  // namespace firn::fuzz
