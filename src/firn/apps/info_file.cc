#include <firn/apps/frame_list.h>
#include <firn/apps/info_parts.h>
#include <firn/apps/run_folder.h>
#include <firn/core/error.h>
#include <firn/io/checkpoint_file.h>
#include <firn/scene/load_scene.h>
#include <fmt/format.h>

#include <fstream>
#include <set>
#include <string_view>

namespace firn {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json frame_info(const fs::path& file) {
  Json info = {{"path", file.string()}, {"kind", "frame"}, {"whole", true}};
  add_frame(info, file);
  const FrameList list = list_frames({file.string()});
  if (list.scene) add_method(info, *list.scene);
  if (!list.run.empty()) info["run"] = list.run.string();
  const std::string shown = file.string();
  info["next"] = {fmt::format("firn export {} --for blender|houdini|paraview writes it for other programs", shown),
                  fmt::format("firn surface {} makes a surface of it", shown)};
  return info;
}

void add_checkpoint(Json& info, const Checkpoint& checkpoint) {
  info["firn_version"] = checkpoint.firn_version;
  info["layout"] = checkpoint.layout;
  info["arithmetic"] = checkpoint.arithmetic;
  info["inside_frame"] = checkpoint.frame_start.has_value();
  for (const auto& [name, number] : checkpoint.state.counters) info["counters"][name] = number;
  std::size_t particles = 0;
  info["materials"] = Json::array();
  info["columns"] = Json::array();
  std::set<std::string> names;
  for (const CheckpointMaterial& material : checkpoint.state.materials) {
    particles += material.particles;
    info["materials"].push_back(
        {{"name", material.name}, {"model", material.model}, {"particles", material.particles}});
    for (const CheckpointColumn& column : material.columns) {
      if (names.insert(column.name).second) {
        constexpr const char* kTypes[] = {"float", "double", "uint16", "uint32", "uint64"};
        info["columns"].push_back(
            {{"name", column.name}, {"type", kTypes[column.values.index()]}, {"components", column.components}});
      }
    }
  }
  info["particles"] = particles;
}

/// What run.json around it says, else what its bytes are: then only the hash at its own end vouches for it.
CheckpointStamp stamp_of_file(const fs::path& file, Json& info) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  try {
    for (const CheckpointEntry& entry : read_run_info({folder / ".."}).checkpoints) {
      if (entry.file != file.filename()) continue;
      info["listed"] = true;
      info["frame"] = entry.frame;
      info["time"] = entry.time;
      info["steps"] = entry.steps;
      return entry.stamp;
    }
  } catch (const Error&) {
    // It lies by itself.
  }
  info["listed"] = false;
  return stamp_of(file_text(file));
}

Json checkpoint_info(const fs::path& file) {
  Json info = {{"path", file.string()}, {"kind", "checkpoint"}, {"whole", true}};
  const CheckpointStamp stamp = stamp_of_file(file, info);
  const Checkpoint checkpoint = read_checkpoint(file, stamp);
  add_checkpoint(info, checkpoint);
  info["bytes"] = file_bytes(file);
  if (const auto particles = info["particles"].get<double>(); particles > 0) {
    info["bytes_per_particle"] = static_cast<double>(file_bytes(file)) / particles;
  }
  try {
    const Scene scene = parse_scene(checkpoint.scene_text, file.parent_path() / "scene");
    add_method(info, scene);
  } catch (const Error&) {
    // Its meshes are elsewhere.
  }
  const std::string run =
      info["listed"].get<bool>() ? (file.parent_path() / "..").lexically_normal().string() : "FOLDER";
  info["next"] = {
      fmt::format("firn resume {} goes on from the newest checkpoint, --from-frame N from an earlier one", run)};
  return info;
}

bool begins_as_hdf5(const fs::path& path) {
  char bytes[8] = {};
  // To open a pipe would wait for somebody to write.
  if (std::error_code error; !fs::is_regular_file(path, error)) return false;
  std::ifstream(path, std::ios::binary).read(bytes, sizeof bytes);
  return std::string_view(bytes, sizeof bytes) == std::string_view("\x89HDF\r\n\x1a\n", 8);
}

}  // namespace

/// A frame that cannot be read may be a checkpoint, and the other way round: names are only hints.
Json info_of_file(const fs::path& path) {
  if (!begins_as_hdf5(path)) {
    throw Error(ErrorKind::files, fmt::format("{} is neither a frame nor a checkpoint of Firn: it does not begin as "
                                              "HDF5",
                                              path.string()));
  }
  const bool may_be_checkpoint = path.filename().string().starts_with("checkpoint") || path.extension() == ".h5";
  try {
    return may_be_checkpoint ? checkpoint_info(path) : frame_info(path);
  } catch (const Error& first) {
    try {
      return may_be_checkpoint ? frame_info(path) : checkpoint_info(path);
    } catch (const Error&) {
      Json info = {{"path", path.string()}, {"kind", may_be_checkpoint ? "checkpoint" : "frame"}};
      note_damage(info, first.what());
      return info;
    }
  }
}

}  // namespace firn
