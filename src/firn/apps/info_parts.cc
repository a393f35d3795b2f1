#include <firn/apps/info_parts.h>
#include <firn/core/error.h>
#include <firn/io/frame_reader.h>
#include <firn/scene/choice_names.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>

namespace firn {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

template <class Choice>
std::string choice_name(Choice choice) {
  return std::string(ChoiceNames<Choice>::list[static_cast<std::size_t>(choice)]);
}

const char* type_name(const SnapshotColumn& column) {
  constexpr const char* kNames[] = {"float", "double", "int32", "int64"};
  return kNames[column.values.index()];
}

Json column_info(const SnapshotColumn& column, std::size_t particles) {
  Json info = {
      {"name", column.name}, {"unit", column.unit}, {"type", type_name(column)}, {"components", column.components}};
  std::vector<double> least, most;
  std::int64_t bad = 0;
  for (int c = 0; c < column.components; ++c) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t p = 0; p < particles; ++p) {
      const double number = value(column, p, c);
      if (!std::isfinite(number)) ++bad;
      low = std::min(low, number);
      high = std::max(high, number);
    }
    least.push_back(low);
    most.push_back(high);
  }
  if (particles > 0) {
    info["min"] = least;
    info["max"] = most;
  }
  if (bad > 0) info["not_finite"] = bad;
  info["help"] = column.help;
  return info;
}

Json materials_info(const Snapshot& snapshot) {
  Json materials = Json::array();
  for (const SnapshotMaterial& material : snapshot.materials) {
    materials.push_back({{"name", material.name},
                         {"model", material.model},
                         {"preset", material.preset},
                         {"particles", material.end - material.begin}});
  }
  return materials;
}

}  // namespace

void note_damage(Json& info, const std::string& what) {
  info["whole"] = false;
  if (!info.contains("damage")) info["damage"] = Json::array();
  info["damage"].push_back(what);
}

std::uint64_t file_bytes(const fs::path& path) {
  std::error_code error;
  const auto size = fs::file_size(path, error);
  return error ? 0 : size;
}

std::string file_text(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw Error(ErrorKind::files, fmt::format("{}: cannot be read", path.string()));
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// What a frame says, with what its run's scene adds.
void add_frame(Json& info, const fs::path& file) {
  FrameMetadata metadata;
  const Snapshot snapshot = read_frame(file, &metadata);
  const std::uint64_t bytes = file_bytes(file);
  info["firn_version"] = metadata.firn_version;
  info["frame"] = metadata.frame;
  info["time"] = snapshot.time;
  info["dimension"] = snapshot.dimension;
  if (!metadata.up.empty()) info["up"] = metadata.up;
  info["precision"] = metadata.precision;
  info["particles"] = snapshot.size();
  info["cell_size"] = snapshot.cell_size;
  info["particle_spacing"] = snapshot.particle_spacing;
  info["scene_hash"] = metadata.scene_hash;
  info["bytes"] = bytes;
  if (snapshot.size() > 0) {
    info["bytes_per_particle"] = static_cast<double>(bytes) / static_cast<double>(snapshot.size());
  }
  info["materials"] = materials_info(snapshot);
  info["bodies"] = snapshot.bodies;
  info["columns"] = Json::array();
  for (const SnapshotColumn& column : snapshot.columns) {
    info["columns"].push_back(column_info(column, snapshot.size()));
  }
}

void add_method(Json& info, const Scene& scene) {
  info["kernel"] = choice_name(scene.method.kernel);
  info["transfer"] = choice_name(scene.method.transfer);
  info["form"] = choice_name(scene.method.form);
}

}  // namespace firn
