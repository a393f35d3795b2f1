#pragma once

#include <firn/io/frame_metadata.h>
#include <firn/state/snapshot.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace firn {

/// The snapshot in a file of write_frame, equal in every value; fills *metadata unless it is null. Throws Error (files)
/// if the file cannot be read, is no frame of Firn, is of a newer format, or is damaged: checksums and sizes are
/// verified.
Snapshot read_frame(const std::filesystem::path& path, FrameMetadata* metadata = nullptr);
/// The same of the bytes of such a file; `name` stands first in messages.
Snapshot parse_frame(const std::vector<std::byte>& bytes, const std::string& name, FrameMetadata* metadata = nullptr);

}  // namespace firn
