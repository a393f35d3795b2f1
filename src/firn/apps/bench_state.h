#pragma once

#include <firn/apps/bench_landing.h>
#include <firn/integrators/world.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

/// Files with the particles of one world. Binary, in the byte order of the machine, because they never leave it:
///
///   "FIRNBNCH", version, number of particles, length of the file, the settings' text, the landing,
///   slabs of particles, column by column, XXH64 of everything before
///
/// Stress and the speeds that choose the time step are left out: prepare() derives them from what is there. (It
/// may round the strain of yielding particles once more; a benchmark does not mind.)
namespace firn {

/// Of the format and of what the simulation makes of equal settings: raise it when either changes.
inline constexpr std::uint32_t kBenchStateVersion = 3;

/// Writes beside the place and renames. Error(files).
template <class Real, int dim>
void write_bench_state(const std::filesystem::path& path, const World<Real, dim>& world, const std::string& settings,
                       const Landing& landing);

/// How the state in the file came to be; nothing if there is no file, if it is of another version or of other settings,
/// or if it is damaged: length and checksum of the whole file are compared.
std::optional<Landing> check_bench_state(const std::filesystem::path& path, const std::string& settings);

/// Adds the file's particles to the world's empty set and prepares it for its first step. The file is streamed, so that
/// it does not count as memory of the simulation. Error(files) if it is not the one that check_bench_state saw.
template <class Real, int dim>
void read_bench_state(const std::filesystem::path& path, World<Real, dim>& world);

}  // namespace firn
