#pragma once

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace firn {

/// An L of three boxes' length, 1 x 2 x 3 m in all: no two axes can be exchanged and no direction turned round without
/// another mesh. Volume 4 m^3, all quadrilaterals.
inline std::string l_shape_obj() {
  std::string text;
  const double outline[6][2] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 3}, {0, 3}};
  for (const double x : {0.0, 1.0}) {
    for (const auto& point : outline) {
      text += "v " + std::to_string(x) + ' ' + std::to_string(point[0]) + ' ' + std::to_string(point[1]) + '\n';
    }
  }
  text += "f 6 5 4 1\nf 4 3 2 1\nf 7 10 11 12\nf 7 8 9 10\n";
  for (int i = 0; i < 6; ++i) {
    const int a = i + 1, b = (i + 1) % 6 + 1;
    text += "f " + std::to_string(a) + ' ' + std::to_string(b) + ' ' + std::to_string(b + 6) + ' ' +
            std::to_string(a + 6) + '\n';
  }
  return text;
}

/// Writes the mesh of an OBJ file in a format of assimp's exporter.
inline std::filesystem::path exported(const std::filesystem::path& obj, const char* format,
                                      const std::filesystem::path& path) {
  Assimp::Importer importer;
  const aiScene* scene =
      importer.ReadFile(obj.string(), aiProcess_Triangulate | aiProcess_JoinIdenticalVertices | aiProcess_SortByPType);
  Assimp::Exporter exporter;
  if (scene == nullptr || exporter.Export(scene, format, path.string()) != aiReturn_SUCCESS) {
    throw std::runtime_error(std::string("assimp cannot write ") + format + ": " + exporter.GetErrorString());
  }
  return path;
}

}  // namespace firn
