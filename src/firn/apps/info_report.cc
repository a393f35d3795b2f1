#include <firn/apps/frame_list.h>
#include <firn/apps/info_parts.h>
#include <firn/apps/info_report.h>
#include <firn/core/error.h>
#include <fmt/format.h>

namespace firn {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// "  name        value"
std::string line(const char* name, const std::string& text) { return fmt::format("  {:<12}{}\n", name, text); }

std::string bytes_text(double bytes) {
  if (bytes < 1e4) return fmt::format("{:.0f} bytes", bytes);
  if (bytes < 1e9) return fmt::format("{:.1f} MB", bytes * 1e-6);
  return fmt::format("{:.2f} GB", bytes * 1e-9);
}

std::string text_of(const Json& info, const char* key) {
  const Json& value = info.at(key);
  return value.is_string() ? value.get<std::string>() : value.dump();
}

std::string length_text(const Json& info, const char* key) {
  return fmt::format("{:.5g} m", info.at(key).get<double>());
}

/// The keys that are there, as "key value", joined.
std::string joined(const Json& info, std::initializer_list<const char*> keys) {
  std::string text;
  for (const char* key : keys) {
    if (!info.contains(key)) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", key, text_of(info, key));
  }
  return text;
}

std::string range_text(const Json& column) {
  if (!column.contains("min")) return "";
  std::string text;
  for (std::size_t c = 0; c < column["min"].size(); ++c) {
    if (!text.empty()) text += ", ";
    // JSON has no infinities.
    const auto number = [&](const char* key) {
      const Json& n = column[key][c];
      return n.is_number() ? fmt::format("{:.6g}", n.get<double>()) : std::string("?");
    };
    text += fmt::format("{} to {}", number("min"), number("max"));
  }
  return text;
}

std::string columns_text(const Json& columns) {
  std::string text;
  for (const Json& column : columns) {
    const auto components = column["components"].get<int>();
    const std::string type = (components > 1 ? fmt::format("{} ", components) : "") + text_of(column, "type");
    const std::string unit = column.value("unit", "");
    text += fmt::format("    {:<18}{:<10}{:<6}{}", text_of(column, "name"), type, unit, range_text(column));
    if (column.contains("not_finite")) text += fmt::format("  ({} not finite)", column["not_finite"].dump());
    while (text.back() == ' ') text.pop_back();
    text += '\n';
  }
  return text;
}

std::string materials_text(const Json& materials) {
  std::string text;
  for (const Json& material : materials) {
    const std::string preset = material.value("preset", "");
    text += line("material",
                 fmt::format("{}: {} particles, model {}{}", text_of(material, "name"), material["particles"].dump(),
                             text_of(material, "model"), preset.empty() ? "" : ", preset " + preset));
  }
  return text;
}

std::string size_text(const Json& info) {
  std::string text = bytes_text(info.value("bytes", 0.0));
  if (info.contains("bytes_per_particle")) {
    text += fmt::format(", {:.1f} bytes per particle", info["bytes_per_particle"].get<double>());
  }
  return text;
}

/// Of a frame or checkpoint.
std::string file_lines(const Json& info) {
  std::string text;
  if (info.contains("frame")) {
    text += line("frame", joined(info, {"frame", "time"}).substr(6) + " s" +
                              (info.value("inside_frame", false) ? ", in the middle of the next" : ""));
  }
  text += line("particles", text_of(info, "particles"));
  if (info.contains("particle_spacing")) text += line("spacing", length_text(info, "particle_spacing"));
  if (info.contains("cell_size")) text += line("cell size", length_text(info, "cell_size"));
  text += materials_text(info.at("materials"));
  return text;
}

std::string run_lines(const Json& info) {
  std::string text;
  if (info.contains("title")) text += line("title", text_of(info, "title"));
  if (info.contains("scene")) text += line("scene", text_of(info, "scene"));
  const Json& frames = info.at("frames");
  std::string there = "none";
  if (frames["count"].get<std::int64_t>() > 0) {
    there = text_of(frames, "numbers");
    if (info.contains("planned_frames")) there += fmt::format(" of {}", info["planned_frames"].dump());
    there += fmt::format("; t = {} to {} s", frames["first_time"].dump(), frames["last_time"].dump());
    if (info.contains("frame_rate")) there += fmt::format(" at {} per second", info["frame_rate"].dump());
  }
  text += line("frames", there);
  const Json& checkpoints = info.at("checkpoints");
  std::string kept =
      checkpoints["count"].get<int>() == 0 ? "none" : checkpoints["count"].dump() + ", none of them whole";
  if (checkpoints.contains("newest")) {
    const Json& newest = checkpoints["newest"];
    kept = fmt::format("{}; the newest whole one is {}, {}frame {}, t = {} s, step {}", checkpoints["count"].dump(),
                       text_of(newest, "file"), newest["inside_frame"].get<bool>() ? "after " : "",
                       newest["frame"].dump(), newest["time"].dump(), newest["steps"].dump());
  }
  text += line("checkpoints", kept);
  text += line("disk", fmt::format("{} of frames, {} of checkpoints", bytes_text(frames["bytes"].get<double>()),
                                   bytes_text(checkpoints["bytes"].get<double>())));
  text += line("pictures", info["pictures"].dump() + (info["film"].get<bool>() ? " and a film" : ""));
  if (info.contains("wall_seconds")) {
    text += line("computed in",
                 fmt::format("{:.1f} s on {} threads", info["wall_seconds"].get<double>(), info["threads"].dump()));
  }
  if (!info.contains("newest_frame")) return text;
  return text + file_lines(info["newest_frame"]);
}

}  // namespace

std::string info_text(const Json& info) {
  const std::string kind = text_of(info, "kind");
  std::string head = text_of(info, "path") + ": a " + kind;
  if (info.contains("firn_version")) head += " of Firn " + text_of(info, "firn_version");
  if (info.contains("status")) head += ", " + text_of(info, "status");
  const bool is_whole = info["whole"].get<bool>();
  std::string text = head + (is_whole ? "; whole\n" : "; DAMAGED\n");
  if (info.contains("damage")) {
    for (const Json& damage : info["damage"]) text += line("damage", damage.get<std::string>());
  }
  if (info.contains("scene_note")) text += line("note", text_of(info, "scene_note"));
  const bool is_run = kind == "run";
  if (is_run) text += run_lines(info);
  const Json& content = is_run && info.contains("newest_frame") ? info["newest_frame"] : info;
  if (!is_run && info.contains("materials")) text += file_lines(info);
  const std::string method = joined(info, {"precision", "kernel", "transfer", "form", "up"});
  if (!method.empty()) text += line("method", method);
  if (content.contains("bytes")) text += line("size", size_text(content));
  if (content.contains("columns")) text += "  columns\n" + columns_text(content["columns"]);
  if (info.contains("next")) {
    for (const Json& next : info["next"]) text += line("next", next.get<std::string>());
  }
  return text;
}

Json info_of(const fs::path& path, const InfoOptions& options) {
  std::error_code error;
  if (!fs::exists(path, error)) {
    throw Error(ErrorKind::files, fmt::format("{}: there is no such file or folder", path.string()));
  }
  if (!fs::is_directory(path, error)) return info_of_file(path);
  if (is_run_folder(path)) return info_of_run(path, options);
  const fs::path above = path / "..";
  if (is_run_folder(above)) return info_of_run(above.lexically_normal(), options);
  throw Error(ErrorKind::files, fmt::format("{} is not the folder of a run: it holds neither run.json nor "
                                            "scene.resolved.toml",
                                            path.string()));
}

}  // namespace firn
