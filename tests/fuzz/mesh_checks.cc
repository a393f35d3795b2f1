#include "fuzz/mesh_checks.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>

#include "fuzz/fuzz_target.h"

namespace firn::fuzz {
namespace {

template <class T>
void append(std::string& bytes, T value) {
  for (std::size_t i = 0; i < sizeof value; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xff);
}

}  // namespace

void require_valid(const TriangleMesh& mesh) {
  require(!mesh.triangles.empty(), "a mesh without triangles was accepted");
  for (const auto& triangle : mesh.triangles) {
    for (const std::int32_t corner : triangle) {
      require(corner >= 0 && static_cast<std::size_t>(corner) < mesh.vertices.size(),
              fmt::format("corner {} of {} vertices was accepted", corner, mesh.vertices.size()));
    }
  }
  for (const Vec3d& x : mesh.vertices) {
    for (int i = 0; i < 3; ++i) require(std::isfinite(x[i]), "a coordinate that is not finite was accepted");
  }
  TriangleMesh cleaned = mesh;
  clean(cleaned);
}

void require_equal(const TriangleMesh& a, const TriangleMesh& b) {
  require(a.triangles == b.triangles, "the triangles are others after writing and reading");
  require(a.vertices.size() == b.vertices.size(), "there are other vertices after writing and reading");
  for (std::size_t v = 0; v < a.vertices.size(); ++v) {
    for (int i = 0; i < 3; ++i) {
      require(a.vertices[v][i] == b.vertices[v][i],
              fmt::format("coordinate {} of vertex {} was {} and is {}", i, v, a.vertices[v][i], b.vertices[v][i]));
    }
  }
}

std::string obj_text(const TriangleMesh& mesh) {
  std::string text;
  for (const Vec3d& x : mesh.vertices) text += fmt::format("v {} {} {}\n", x[0], x[1], x[2]);
  for (const auto& t : mesh.triangles) text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  return text;
}

std::string ascii_stl_text(const TriangleMesh& mesh) {
  std::string text = "solid s\n";
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    text += "facet normal 0 0 0 outer loop\n";
    for (int corner = 0; corner < 3; ++corner) {
      const Vec3d& x = mesh.corner(t, corner);
      text += fmt::format("vertex {} {} {}\n", x[0], x[1], x[2]);
    }
    text += "endloop endfacet\n";
  }
  return text + "endsolid s\n";
}

std::string painted_ply_bytes(const TriangleMesh& mesh, const std::vector<double>& values) {
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double "
      "z\nproperty double q\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
      mesh.vertices.size(), mesh.triangles.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    for (int i = 0; i < 3; ++i) append(bytes, std::bit_cast<std::uint64_t>(mesh.vertices[v][i]));
    append(bytes, std::bit_cast<std::uint64_t>(v < values.size() ? values[v] : 0));
  }
  for (const auto& triangle : mesh.triangles) {
    append(bytes, std::uint8_t(3));
    for (const std::int32_t corner : triangle) append(bytes, static_cast<std::uint32_t>(corner));
  }
  return bytes;
}

}  // namespace firn::fuzz
