#include <firn/io/atomic_file.h>
#include <firn/io/mesh_points.h>
#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <string>

namespace firn {

template <int dim>
void write_points_ply(const std::filesystem::path& path, std::span<const Vec<double, dim>> positions) {
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float "
      "z\nend_header\n",
      positions.size());
  bytes.reserve(bytes.size() + 12 * positions.size());
  for (const Vec<double, dim>& x : positions) {
    for (int i = 0; i < 3; ++i) {
      const float value = i < dim ? static_cast<float>(x[i]) : 0.0f;
      const auto bits = std::bit_cast<std::uint32_t>(value);
      for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(bits >> shift & 0xff);
    }
  }
  write_file_atomically(path, bytes);
}

template void write_points_ply<2>(const std::filesystem::path&, std::span<const Vec2d>);
template void write_points_ply<3>(const std::filesystem::path&, std::span<const Vec3d>);

}  // namespace firn
