#include <firn/core/error.h>
#include <firn/io/foreign_reader.h>
#include <firn/io/mesh_parsers.h>
#include <firn/io/mesh_reader.h>
#include <firn/io/shown_text.h>
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

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

File opened(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) fail_to_read(path, EISDIR);
  File file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) fail_to_read(path, errno);
  return file;
}

/// The kinds of assimp that other modelling programs write.
constexpr std::string_view kForeignMeshes[] = {".3ds", ".3mf", ".ac",   ".amf", ".ase", ".b3d", ".dae", ".dxf",
                                               ".fbx", ".glb", ".gltf", ".lwo", ".off", ".x",   ".x3d", ".zae"};

/// In a process of its own (io/foreign_reader.h), which gives the mesh as PLY.
TriangleMesh read_foreign_mesh(const fs::path& path) {
  if (std::fgetc(opened(path).get()) == EOF) throw Error(ErrorKind::usage, path.string() + ": the file is empty");
  TriangleMesh mesh;
  read_foreign_files({"mesh"}, {path}, [&](std::size_t, const std::string& answer) {
    try {
      mesh = parse_ply(answer, "its answer");
    } catch (const Error& error) {
      throw Error(ErrorKind::files, fmt::format("{}: the reader made no mesh of it ({}); export it as OBJ, PLY or STL",
                                                path.string(), error.what()));
    }
  });
  return mesh;
}

std::string read_bytes(const fs::path& path) {
  const File file = opened(path);
  std::error_code error;
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

}  // namespace

TriangleMesh read_mesh(const fs::path& path) {
  const std::string name = path.string(), kind = extension(path);
  const bool is_foreign = std::ranges::find(kForeignMeshes, kind) != std::end(kForeignMeshes);
  if (kind != ".obj" && kind != ".ply" && kind != ".stl" && !is_foreign) {
    throw Error(ErrorKind::usage, fmt::format("{}: unknown kind of mesh '{}'; Firn reads .obj, .ply and .stl, and with "
                                              "assimp {}",
                                              name, shown_text(kind), fmt::join(kForeignMeshes, " ")));
  }
  if (is_foreign) return read_foreign_mesh(path);
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
