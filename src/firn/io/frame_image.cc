#include <firn/io/frame_image.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <array>
#include <atomic>
#include <cstring>
#include <new>
#include <string>
#include <utility>

namespace firn::hdf5 {

namespace {

/// Memory of one file. HDF5's own buffer is not used: what lies between its blocks would be whatever the heap held.
struct Buffer {
  std::vector<std::byte> bytes;
  bool is_out_of_memory = false;  ///< HDF5 itself does not tell why it failed
};

void* allocate(std::size_t size, H5FD_file_image_op_t, void* data) try {
  auto* buffer = static_cast<Buffer*>(data);
  buffer->bytes.assign(size, std::byte{0});
  return buffer->bytes.data();
} catch (const std::bad_alloc&) {
  static_cast<Buffer*>(data)->is_out_of_memory = true;
  return nullptr;
}

void* reallocate(void*, std::size_t size, H5FD_file_image_op_t, void* data) try {
  auto* buffer = static_cast<Buffer*>(data);
  buffer->bytes.resize(size);
  return buffer->bytes.data();
} catch (const std::bad_alloc&) {
  static_cast<Buffer*>(data)->is_out_of_memory = true;
  return nullptr;
}

void* copy(void* target, const void* source, std::size_t size, H5FD_file_image_op_t, void*) {
  return std::memcpy(target, source, size);
}

/// The buffer outlives the file: its owner frees it.
herr_t release(void*, H5FD_file_image_op_t, void*) { return 0; }
void* share(void* data) { return data; }
herr_t unshare(void*) { return 0; }

/// HDF5 takes two files in memory for the same one if they have the same name: what is read while another is made would
/// be that one.
std::string unused_name() {
  static std::atomic<std::uint64_t> count = 0;
  return "image " + std::to_string(count++);
}

constexpr std::size_t kGrowth = std::size_t(1) << 20;

constexpr char kMagic[8] = {'F', 'I', 'R', 'N', 'X', 'X', 'H', '3'};
constexpr std::size_t kTrailerSize = sizeof kMagic + sizeof(std::uint64_t);

/// Magic word and hash, the hash with its lowest byte first.
std::array<std::byte, kTrailerSize> trailer(const std::byte* bytes, std::size_t size) {
  std::array<std::byte, kTrailerSize> result;
  std::memcpy(result.data(), kMagic, sizeof kMagic);
  const std::uint64_t hash = XXH3_64bits(bytes, size);
  for (std::size_t i = 0; i < sizeof hash; ++i) result[sizeof kMagic + i] = static_cast<std::byte>(hash >> (8 * i));
  return result;
}

void make_file_in(Buffer& buffer, const std::function<void(hid_t file)>& fill) {
  H5FD_file_image_callbacks_t callbacks = {allocate, copy, reallocate, release, share, unshare, &buffer};
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "create a property list");
  check(H5Pset_fapl_core(access, kGrowth, false), "keep the file in memory");
  check(H5Pset_file_image_callbacks(access, &callbacks), "keep the file in memory");
  // The first version whose chunk index has checksums too; fixed, so that newer libraries write the same bytes.
  check(H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110), "fix the file version");
  // Without space reserved ahead the size before closing is the final one.
  check(H5Pset_meta_block_size(access, 0), "set the block size");
  check(H5Pset_small_data_block_size(access, 0), "set the block size");
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose, "create a property list");
  check(H5Pset_obj_track_times(creation, false), "switch time stamps off");

  Handle file(H5Fcreate(unused_name().c_str(), H5F_ACC_TRUNC, creation, access), H5Fclose, "create the file");
  fill(file);
  check(H5Fflush(file, H5F_SCOPE_GLOBAL), "flush the file");
  const ssize_t size = H5Fget_file_image(file, nullptr, 0);
  if (size < 0) throw Failure{"find the size of the file"};
  file.close_now("close the file");
  buffer.bytes.resize(static_cast<std::size_t>(size));
}

}  // namespace

std::vector<std::byte> make_file(const std::function<void(hid_t file)>& fill) {
  Buffer buffer;
  try {
    make_file_in(buffer, fill);
  } catch (const Failure&) {
    if (buffer.is_out_of_memory) throw std::bad_alloc();
    throw;
  }
  const auto end = trailer(buffer.bytes.data(), buffer.bytes.size());
  buffer.bytes.insert(buffer.bytes.end(), end.begin(), end.end());
  return std::move(buffer.bytes);
}

void open_image(const std::vector<std::byte>& bytes, const std::function<void(hid_t file)>& read) {
  const std::size_t size = bytes.size() - std::min(bytes.size(), kTrailerSize);
  const auto end = trailer(bytes.data(), size);
  if (size == 0 || std::memcmp(end.data(), bytes.data() + size, kTrailerSize) != 0) {
    throw Failure{"match the checksum at its end (truncated, changed on the disk, or written by another program)"};
  }
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "create a property list");
  check(H5Pset_fapl_core(access, kGrowth, false), "open the file in memory");
  check(H5Pset_file_image(access, const_cast<std::byte*>(bytes.data()), size), "open the file in memory");
  const Handle file(H5Fopen(unused_name().c_str(), H5F_ACC_RDONLY, access), H5Fclose, "open it");
  read(file);
}

}  // namespace firn::hdf5
