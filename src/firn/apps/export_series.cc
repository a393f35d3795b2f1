#include <firn/apps/export_series.h>
#include <firn/io/atomic_file.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace firn {

void write_series_description(const ExportTarget& target, const FrameList& list, const ExportedSeries& series) {
  nlohmann::ordered_json json;
  json["program"] = "firn";
  json["version"] = FIRN_VERSION;
  json["format"] = series.format;
  if (!series.client.empty()) json["for"] = series.client;
  json["up"] = std::string(name(series.up));
  json["meters_per_unit"] = 1;
  json["frames_per_second"] = list.frame_rate;
  json["particle_spacing"] = series.spacing;
  json["materials"] = series.materials;
  json["attributes"] = nlohmann::ordered_json::array();
  for (const std::string& attribute : series.attributes) {
    const auto unit = series.units.find(attribute);
    json["attributes"].push_back({{"name", attribute}, {"unit", unit == series.units.end() ? "" : unit->second}});
  }
  json["files"] = nlohmann::ordered_json::array();
  for (const ListedFrame& frame : list.frames) {
    json["files"].push_back(
        {{"name", target.file(frame).filename().string()}, {"frame", frame.number}, {"time", frame.time}});
  }
  // One for each format, because they may have different axes, and one for those who do not care.
  for (const std::string& ending : {"." + series.format + ".series.json", std::string(".series.json")}) {
    write_file_atomically(target.beside(ending), json.dump(1) + "\n");
  }
}

std::string next_clicks(Client client, const std::string& format, const ExportTarget& target, const FrameList& list) {
  const std::string first = target.file(list.frames.front()).string();
  const bool is_series = list.frames.size() > 1;
  if (client == Client::paraview) {
    const std::string file = format == "vtp" && is_series ? target.beside(".pvd").string() : first;
    if (format == "vtp") return fmt::format("ParaView: File > Open {}, Apply, Representation: Point Gaussian", file);
    if (format == "ply" || format == "obj" || format == "csv")
      return fmt::format("ParaView: File > Open {}, Apply", file);
    return "";
  }
  if (client == Client::blender) {
    if (format == "vdb") {
      return fmt::format("Blender: Add > Volume > Import OpenVDB, {}{}; material: Principled Volume", first,
                         is_series ? " with all files of the sequence selected, scene start frame 1" : "");
    }
    if (format == "ply" || format == "obj") {
      return fmt::format("Blender: File > Import > {} {}; for the sequence use the add-on in tools/blender",
                         format == "ply" ? "Stanford PLY" : "Wavefront OBJ", first);
    }
    if (format == "usd") return fmt::format("Blender 4.4 or newer: File > Import > USD, {}", first);
    return "";
  }
  if (client == Client::houdini && format != "csv") {
    const std::string pattern = (target.folder() / (target.name() + ".$F4." + format)).string();
    return fmt::format("Houdini: a File SOP with {}; $F4 is the frame, and frame 1 is t = 0; set FPS to {:g}",
                       format == "usd" || !is_series ? first : pattern, list.frame_rate);
  }
  return "";
}

}  // namespace firn
