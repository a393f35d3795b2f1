#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace firn {

/// Model name of the processor; "unknown" where the system does not tell.
std::string processor_name();

/// Installed and currently available memory, bytes; 0 where the system does not tell.
std::uint64_t total_memory();
std::uint64_t available_memory();

/// Memory that this process has in use now, and its peak since the start or the last reset, bytes; 0 where the system
/// does not tell.
std::uint64_t resident_memory();
std::uint64_t peak_memory();
void reset_peak_memory();

/// The program of this name that the shell would start; empty if there is none.
std::filesystem::path find_program(const std::string& name);

}  // namespace firn
