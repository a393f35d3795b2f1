// The only file that knows assimp.

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/version.h>
#include <firn/core/error.h>
#include <firn/reader/foreign_mesh.h>
#include <fmt/format.h>

#include <assimp/Importer.hpp>
#include <bit>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace firn {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what) {
  throw Error(ErrorKind::usage, fmt::format("{}: {}", path.string(), what));
}

/// In double precision: a transform of a large scene must not move corners that meet apart.
aiMatrix4x4t<double> in_double(const aiMatrix4x4& m) {
  return {m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2, m.d3, m.d4};
}

void append(const std::filesystem::path& path, const aiMesh& part, const aiMatrix4x4t<double>& transform,
            TriangleMesh& mesh) {
  const std::size_t first = mesh.vertices.size();
  if (first + part.mNumVertices > std::size_t(std::numeric_limits<std::int32_t>::max())) {
    fail(path, "more than 2147483647 vertices");
  }
  for (unsigned v = 0; v < part.mNumVertices; ++v) {
    const aiVector3D& x = part.mVertices[v];
    const aiVector3t<double> at = transform * aiVector3t<double>(x.x, x.y, x.z);
    mesh.vertices.push_back({{at.x, at.y, at.z}});
  }
  // A mirror turns the outside in.
  const bool mirrored = transform.Determinant() < 0;
  for (unsigned f = 0; f < part.mNumFaces; ++f) {
    const aiFace& face = part.mFaces[f];
    if (face.mNumIndices != 3) continue;
    std::array<std::int32_t, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
      if (face.mIndices[i] >= part.mNumVertices) {
        fail(path, fmt::format("a triangle refers to vertex {} of {}", face.mIndices[i], part.mNumVertices));
      }
      corners[i] = static_cast<std::int32_t>(first + face.mIndices[i]);
    }
    if (mirrored) std::swap(corners[1], corners[2]);
    mesh.triangles.push_back(corners);
  }
}

TriangleMesh assembled(const std::filesystem::path& path, const aiScene& scene) {
  struct Place {
    const aiNode* node;
    aiMatrix4x4t<double> parent;
  };
  TriangleMesh mesh;
  // A list and not a recursion: how deep nodes nest is the file's choice.
  std::vector<Place> places = {{scene.mRootNode, {}}};
  while (!places.empty()) {
    const Place place = places.back();
    places.pop_back();
    const aiMatrix4x4t<double> transform = place.parent * in_double(place.node->mTransformation);
    for (unsigned i = 0; i < place.node->mNumMeshes; ++i) {
      append(path, *scene.mMeshes[place.node->mMeshes[i]], transform, mesh);
    }
    for (unsigned i = place.node->mNumChildren; i-- > 0;) places.push_back({place.node->mChildren[i], transform});
  }
  return mesh;
}

template <class T>
void append_bits(std::string& bytes, T value) {
  for (std::size_t i = 0; i < sizeof value; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xff);
}

}  // namespace

TriangleMesh read_foreign_mesh_here(const std::filesystem::path& path) {
  Assimp::Importer importer;
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  // GlobalScale: the unit that an FBX file gives, to metres. Not JoinIdenticalVertices, which takes corners for one
  // that lie 1e-5 apart, whatever the unit.
  const aiScene* scene = importer.ReadFile(path.string(), aiProcess_Triangulate | aiProcess_SortByPType |
                                                              aiProcess_GlobalScale | aiProcess_ValidateDataStructure);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    fail(path, fmt::format("cannot be read: {}", importer.GetErrorString()));
  }
  TriangleMesh mesh = assembled(path, *scene);
  if (mesh.triangles.empty()) fail(path, "the file has no faces");
  merge_vertices(mesh);
  return mesh;
}

std::string ply_bytes(const TriangleMesh& mesh) {
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double "
      "z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
      mesh.vertices.size(), mesh.triangles.size());
  bytes.reserve(bytes.size() + 24 * mesh.vertices.size() + 13 * mesh.triangles.size());
  for (const Vec3d& x : mesh.vertices) {
    for (int i = 0; i < 3; ++i) append_bits(bytes, std::bit_cast<std::uint64_t>(x[i]));
  }
  for (const auto& triangle : mesh.triangles) {
    append_bits(bytes, std::uint8_t(3));
    for (const std::int32_t corner : triangle) append_bits(bytes, static_cast<std::uint32_t>(corner));
  }
  return bytes;
}

std::string assimp_version() {
  return fmt::format("{}.{}.{}", aiGetVersionMajor(), aiGetVersionMinor(), aiGetVersionPatch());
}

bool assimp_reads(const std::string& ending) { return Assimp::Importer().IsExtensionSupported(ending); }

}  // namespace firn
