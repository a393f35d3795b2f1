#pragma once

#include <firn/io/frame_hdf5.h>

#include <functional>
#include <vector>

namespace firn::hdf5 {

/// The bytes of a new HDF5 file whose contents `fill` writes into the file it is given.
///
/// The file is made in memory and not on the disk, because HDF5 cannot be left cleanly when a write fails (disk full):
/// the file stays open, and the library complains on stderr when the process ends. The memory is that of the compressed
/// file. Unused space is zero, so that equal contents give equal bytes.
///
/// Throws std::bad_alloc if there is no memory, and what `fill` throws.
///
/// A trailer of 16 bytes that HDF5 ignores ends the file: a magic word and the XXH3 hash of all before it.
std::vector<std::byte> make_file(const std::function<void(hid_t file)>& fill);

/// Gives `read` the open file. Throws Failure if the trailer is missing or does not match: HDF5's own checks come too
/// late, since it cannot close some damaged files and then complains on stderr when the process ends.
void open_image(const std::vector<std::byte>& bytes, const std::function<void(hid_t file)>& read);

}  // namespace firn::hdf5
