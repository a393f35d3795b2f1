#include <firn/core/error.h>
#include <firn/io/mesh_parsers.h>
#include <firn/io/mesh_reader.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

namespace firn {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail_to_read(const fs::path& path, int code) {
  std::string message = path.string() + ": cannot read the mesh: " + std::generic_category().message(code);
  std::error_code ignored;
  if (path.is_relative()) message += fmt::format(" (looked for {})", fs::absolute(path, ignored).string());
  throw Error(ErrorKind::files, message);
}

std::string read_bytes(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) fail_to_read(path, EISDIR);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) fail_to_read(path, errno);
  std::string bytes;
  const auto size = fs::file_size(path, error);
  if (!error) bytes.reserve(size);
  char buffer[1 << 16];
  while (true) {
    const std::size_t count = std::fread(buffer, 1, sizeof buffer, file.get());
    bytes.append(buffer, count);
    if (count < sizeof buffer) break;
  }
  if (std::ferror(file.get())) fail_to_read(path, errno);
  if (bytes.empty()) throw Error(ErrorKind::usage, path.string() + ": the file is empty");
  return bytes;
}

std::string extension(const fs::path& path) {
  std::string result = path.extension().string();
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

TriangleMesh triangulate(const ObjFile& file, const std::string& name) {
  TriangleMesh mesh;
  mesh.vertices = file.vertices;
  for (std::size_t i = 0, begin = 0; i < file.face_ends.size(); begin = file.face_ends[i++]) {
    add_fan(file.corners.data() + begin, file.face_ends[i] - begin, mesh);
  }
  if (mesh.triangles.empty()) {
    const char* hint = file.segments.empty() ? "" : "; its lines are an outline for a 2D scene";
    throw Error(ErrorKind::usage,
                fmt::format("{}: the file has {} vertices but no faces{}", name, file.vertices.size(), hint));
  }
  return mesh;
}

}  // namespace

void add_fan(const std::int32_t* corners, std::size_t count, TriangleMesh& mesh) {
  for (std::size_t i = 2; i < count; ++i) mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
}

TriangleMesh read_mesh(const fs::path& path) {
  const std::string name = path.string(), kind = extension(path);
  if (kind != ".obj" && kind != ".ply" && kind != ".stl") {
    throw Error(ErrorKind::usage,
                fmt::format("{}: unknown kind of mesh '{}'; Firn reads .obj, .ply and .stl", name, kind));
  }
  const std::string bytes = read_bytes(path);
  if (kind == ".obj") return triangulate(parse_obj(bytes, name), name);
  return kind == ".ply" ? parse_ply(bytes, name) : parse_stl(bytes, name);
}

PaintedMesh read_painted_mesh(const fs::path& path, const std::string& attribute) {
  const std::string name = path.string(), kind = extension(path);
  if (kind != ".ply") {
    throw Error(ErrorKind::usage, fmt::format("{}: the attribute \"{}\" can only be read from a .ply mesh, which has "
                                              "properties of vertices",
                                              name, attribute));
  }
  return parse_painted_ply(read_bytes(path), name, attribute);
}

Polygon read_polygon(const fs::path& path) {
  const std::string name = path.string(), kind = extension(path);
  if (kind != ".obj") {
    throw Error(ErrorKind::usage, fmt::format("{}: unknown kind of outline '{}'; Firn reads .obj", name, kind));
  }
  const std::string bytes = read_bytes(path);
  return chain_outline(parse_obj(bytes, name), name);
}

}  // namespace firn
