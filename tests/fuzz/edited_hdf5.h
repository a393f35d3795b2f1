#pragma once

#include <firn/io/frame_hdf5.h>

#include <cstddef>
#include <string_view>
#include <vector>

namespace firn::fuzz {

/// A file of ours with other contents, but a right hash at its end: what the code after the gate has to bear. The bytes
/// are a list of edits: which group, dataset or attribute of the original is left out or replaced, by what type, sizes
/// and values. They are made with HDF5 itself, because the search is for faults in Firn, not in HDF5, which is not
/// instrumented and never sees a file without the hash.
///
/// @param original bytes of a whole file, with its hash
std::vector<std::byte> edited_file(const std::vector<std::byte>& original, std::string_view edits);

}  // namespace firn::fuzz
