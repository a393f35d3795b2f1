#pragma once

#include <firn/surface/sparse_volume.h>

#include <map>
#include <string>
#include <vector>

namespace firn {

/// An OpenVDB file with volumes on the same leaves. Equal volumes give equal bytes: the file's random name for itself
/// is one that its content decides.
/// @param metadata texts of the file, such as who wrote it
std::string vdb_bytes(const LeafSet& leaves, const std::vector<SparseVolume>& volumes,
                      const std::map<std::string, std::string>& metadata = {});

}  // namespace firn
