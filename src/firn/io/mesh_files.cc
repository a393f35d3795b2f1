#include <firn/io/atomic_file.h>
#include <firn/io/mesh_files.h>
#include <fmt/format.h>

#include <bit>
#include <iterator>
#include <string>

namespace firn {
namespace {

static_assert(std::endian::native == std::endian::little, "binary meshes are written as they lie in memory");

template <class T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

void write_mesh_obj(const std::filesystem::path& path, const CarryingMesh& mesh) {
  std::string text;
  const auto out = std::back_inserter(text);
  for (std::size_t v = 0; v < mesh.mesh.vertices.size(); ++v) {
    const Vec3d& x = mesh.mesh.vertices[v];
    fmt::format_to(out, "v {} {} {}", static_cast<float>(x[0]), static_cast<float>(x[1]), static_cast<float>(x[2]));
    if (!mesh.colors.empty()) {
      const auto& color = mesh.colors[v];
      fmt::format_to(out, " {:.4g} {:.4g} {:.4g}", color[0] / 255.0, color[1] / 255.0, color[2] / 255.0);
    }
    text += '\n';
  }
  for (const auto& [a, b, c] : mesh.mesh.triangles) fmt::format_to(out, "f {} {} {}\n", a + 1, b + 1, c + 1);
  write_file_atomically(path, text);
}

void write_mesh_ply(const std::filesystem::path& path, const CarryingMesh& mesh) {
  std::string bytes =
      fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", mesh.mesh.vertices.size());
  for (const char* name : {"x", "y", "z"}) bytes += fmt::format("property float {}\n", name);
  if (!mesh.velocities.empty()) bytes += "property float vx\nproperty float vy\nproperty float vz\n";
  if (!mesh.colors.empty()) bytes += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  bytes +=
      fmt::format("element face {}\nproperty list uchar int vertex_indices\nend_header\n", mesh.mesh.triangles.size());
  for (std::size_t v = 0; v < mesh.mesh.vertices.size(); ++v) {
    for (const double x : mesh.mesh.vertices[v].e) append(bytes, static_cast<float>(x));
    if (!mesh.velocities.empty()) {
      for (const float u : mesh.velocities[v].e) append(bytes, u);
    }
    if (!mesh.colors.empty()) {
      for (const std::uint8_t c : mesh.colors[v]) append(bytes, c);
    }
  }
  for (const auto& triangle : mesh.mesh.triangles) {
    append(bytes, std::uint8_t(3));
    for (const std::int32_t corner : triangle) append(bytes, corner);
  }
  write_file_atomically(path, bytes);
}

}  // namespace firn
