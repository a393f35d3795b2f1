#pragma once

#include <firn/io/checkpoint.h>

#include <filesystem>
#include <string>
#include <string_view>

namespace firn {

/// What run.json knows of a checkpoint file, and what it is compared with before HDF5 sees a byte of it.
struct CheckpointStamp {
  std::uint64_t bytes = 0;
  std::string hash;  ///< 16 hexadecimal digits: XXH3 of all bytes with a seed of its own, so that zeros do not hash to
                     ///< what an empty file would
  bool operator==(const CheckpointStamp&) const = default;
};

/// Of a file with these bytes.
CheckpointStamp stamp_of(std::string_view bytes);

/// Writes the checkpoint beside its place, flushes it to the disk, renames it and flushes the folder: under its name
/// there is never a part of it, not even after a power cut. Throws Error(files) with the system's reason.
CheckpointStamp write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint);
/// The bytes of that file.
std::vector<std::byte> checkpoint_bytes(const Checkpoint& checkpoint);

/// The checkpoint, equal in every bit. Throws Error(files) if the file is missing, does not match the stamp, is of a
/// newer format, or was written with numbers of another kind (byte order, width).
Checkpoint read_checkpoint(const std::filesystem::path& path, const CheckpointStamp& stamp);
/// The same of the bytes of such a file; `name` stands first in messages.
Checkpoint parse_checkpoint(const std::vector<std::byte>& bytes, const CheckpointStamp& stamp, const std::string& name);

}  // namespace firn
