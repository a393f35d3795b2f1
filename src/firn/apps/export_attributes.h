#pragma once

#include <firn/state/snapshot.h>

#include <string>
#include <vector>

namespace firn {

/// Names of the columns to write: those of the comma-separated list, which may also be "all", or, if it is empty, what
/// the format's users need. Throws Error (usage) for a name that there is not, with the nearest one.
std::vector<std::string> chosen_attributes(const std::string& list, const std::string& format,
                                           const Snapshot& snapshot);

}  // namespace firn
