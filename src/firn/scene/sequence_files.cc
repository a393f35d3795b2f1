#include <firn/core/error.h>
#include <firn/io/file_sequence.h>
#include <firn/scene/sequence_files.h>

namespace firn {

std::vector<std::filesystem::path> sequence_files(const Scene& scene, const ColliderSettings& settings) {
  const bool meshes = settings.shape == ShapeSettings::Shape::mesh_sequence;
  const std::vector<std::string>& names = meshes ? settings.meshes : settings.level_sets;
  std::vector<std::filesystem::path> files;
  for (const std::string& name : names) {
    for (std::filesystem::path& file : expand_sequence(scene.locate(name))) files.push_back(std::move(file));
  }
  if (files.empty()) throw Error(ErrorKind::usage, "must name at least one file");
  return files;
}

}  // namespace firn
