#include <firn/apps/frame_list.h>
#include <firn/apps/run_folder.h>
#include <firn/core/error.h>
#include <firn/core/log.h>
#include <firn/io/frame_reader.h>
#include <firn/io/frame_series.h>
#include <firn/scene/load_scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>
#include <string_view>

namespace firn {
namespace {

namespace fs = std::filesystem;

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

bool is_folder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

/// "" stands for the current folder.
fs::path folder_of(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

/// Where the frames of a run are listed; empty if the path is not that of a run.
fs::path series_of(const fs::path& path) {
  if (is_file(path / kFrameSeriesName)) return path / kFrameSeriesName;
  const RunFolder run = {path};
  if (is_file(run.particles() / kFrameSeriesName)) return run.particles() / kFrameSeriesName;
  if (path.filename() == kFrameSeriesName && is_file(path)) return path;
  return {};
}

std::vector<ListedFrame> frames_of_series(const fs::path& series) {
  std::vector<ListedFrame> frames;
  for (const SeriesFrame& entry : read_frame_series(series)) {
    const fs::path file = folder_of(series) / entry.name;
    const std::int64_t number = number_in_name(file);
    frames.push_back({file, number > 0 ? number : static_cast<std::int64_t>(frames.size()) + 1, entry.time});
  }
  return frames;
}

/// The folder of the run that lies around a frame; empty without.
fs::path run_around(const fs::path& frame) {
  const fs::path particles = folder_of(fs::absolute(frame).lexically_normal());
  const fs::path run = folder_of(particles);
  if (RunFolder{run}.particles() != particles || !is_run_folder(run)) return {};
  // As the path was given, and not from the root, because it is shown.
  const fs::path shown = folder_of(frame).lexically_normal() / "..";
  return frame.is_absolute() ? run : shown.lexically_normal();
}

std::optional<Scene> scene_of(const fs::path& run) {
  if (run.empty() || !is_file(RunFolder{run}.scene())) return std::nullopt;
  const LogSink sink = set_log_sink({});  // its warnings were for who ran it
  std::optional<Scene> scene;
  try {
    scene = load_scene(RunFolder{run}.scene());
  } catch (const Error&) {
    // A mesh that has gone is no reason to refuse frames that are there.
  }
  set_log_sink(sink);
  return scene;
}

void learn_scene(FrameList& list) {
  list.scene = scene_of(list.run);
  if (list.scene) {
    list.frame_rate = list.scene->frame_rate;
    list.up = list.scene->up == Scene::Up::z ? UpAxis::z : UpAxis::y;
    return;
  }
  FrameMetadata metadata;
  read_frame(list.frames.front().file, &metadata);
  list.up = metadata.up == "z" ? UpAxis::z : UpAxis::y;
  for (std::size_t i = 1; i < list.frames.size(); ++i) {
    const ListedFrame &a = list.frames[0], &b = list.frames[i];
    if (!(b.time > a.time)) continue;
    list.frame_rate = static_cast<double>(b.number - a.number) / (b.time - a.time);
    return;
  }
}

[[noreturn]] void fail_no_frames(const fs::path& path) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) {
    throw Error(ErrorKind::files, fmt::format("{}: there is no such file or folder", path.string()));
  }
  throw Error(ErrorKind::files,
              fmt::format("{} is not the folder of a run: it holds no {}; name a run's folder or frames (*.hdf)",
                          path.string(), kFrameSeriesName));
}

void add_frame(FrameList& list, const fs::path& file) {
  FrameMetadata metadata;
  const Snapshot snapshot = read_frame(file, &metadata);
  const std::int64_t number = number_in_name(file);
  list.frames.push_back({file, number > 0 ? number : metadata.frame, snapshot.time});
}

std::int64_t parse_number(std::string_view text, const std::string& whole) {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || number < 1) {
    throw Error(
        ErrorKind::usage,
        fmt::format("--frames: \"{}\" in \"{}\" is no number of a frame; write 5, 1:24, 1:240:10, 1,5,9 or last", text,
                    whole));
  }
  return number;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == text.npos) return parts;
    text.remove_prefix(end + 1);
  }
}

/// A:B or A:B:S; either end may be left out. A range takes those of its frames that are there.
void choose_range(const std::vector<std::string_view>& parts, const std::string& whole, std::int64_t first,
                  std::int64_t last, const std::set<std::int64_t>& there, std::set<std::int64_t>& chosen) {
  if (parts.size() > 3) {
    throw Error(ErrorKind::usage, fmt::format("--frames: \"{}\" has too many colons; write A:B or A:B:STEP", whole));
  }
  const std::int64_t begin = parts[0].empty() ? first : parse_number(parts[0], whole);
  const std::int64_t end = parts[1].empty() || parts[1] == "last" ? last : parse_number(parts[1], whole);
  const std::int64_t step = parts.size() == 3 ? parse_number(parts[2], whole) : 1;
  bool is_empty = true;
  for (const std::int64_t number : there) {
    if (number < begin || number > end || (number - begin) % step != 0) continue;
    chosen.insert(number);
    is_empty = false;
  }
  if (is_empty) {
    throw Error(ErrorKind::usage, fmt::format("--frames: no frame is in {}; there are {}", whole,
                                              ranges_text({there.begin(), there.end()})));
  }
}

}  // namespace

std::int64_t number_in_name(const fs::path& file) {
  const std::string stem = file.stem().string();
  const std::size_t digits = stem.find_last_not_of("0123456789") + 1;  // 0 if all are digits
  std::int64_t number = 0;
  std::from_chars(stem.data() + digits, stem.data() + stem.size(), number);
  return number;
}

bool is_run_folder(const fs::path& folder) {
  const RunFolder run = {folder};
  return is_folder(folder) && (is_file(run.run_info()) || is_file(run.scene()));
}

FrameList list_frames(const std::vector<std::string>& paths) {
  FrameList list;
  bool is_run = false;
  for (const std::string& text : paths) {
    const fs::path path = text;
    const fs::path series = series_of(path);
    if (is_run || (!series.empty() && !list.frames.empty())) {
      throw Error(ErrorKind::usage, "name one run, or frames of one; several runs take a command each");
    }
    if (!series.empty()) {
      is_run = true;
      list.frames = frames_of_series(series);
      if (list.frames.empty()) {
        throw Error(ErrorKind::files, fmt::format("{}: the run has no frames yet", series.string()));
      }
    } else if (is_file(path)) {
      add_frame(list, path);
    } else {
      fail_no_frames(path);
    }
  }
  std::ranges::stable_sort(list.frames, {}, &ListedFrame::number);
  for (std::size_t i = 1; i < list.frames.size(); ++i) {
    if (list.frames[i].number != list.frames[i - 1].number) continue;
    throw Error(ErrorKind::usage,
                fmt::format("{} and {} have the same frame number, {}", list.frames[i - 1].file.string(),
                            list.frames[i].file.string(), list.frames[i].number));
  }
  list.run = run_around(list.frames.front().file);
  learn_scene(list);
  return list;
}

void choose_frames(FrameList& list, const std::string& text) {
  if (text.empty()) return;
  std::set<std::int64_t> there, chosen;
  for (const ListedFrame& frame : list.frames) there.insert(frame.number);
  for (const std::string_view part : split(text, ',')) {
    const std::vector<std::string_view> ends = split(part, ':');
    if (ends.size() > 1) {
      choose_range(ends, std::string(part), *there.begin(), *there.rbegin(), there, chosen);
      continue;
    }
    const std::int64_t number = part == "last" ? *there.rbegin() : parse_number(part, text);
    if (!there.contains(number)) {
      throw Error(ErrorKind::usage, fmt::format("--frames: there is no frame {}; there are {}", number,
                                                ranges_text({there.begin(), there.end()})));
    }
    chosen.insert(number);
  }
  std::erase_if(list.frames, [&](const ListedFrame& frame) { return !chosen.contains(frame.number); });
}

std::string ranges_text(const std::vector<std::int64_t>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t end = i + 1;
    while (end < numbers.size() && numbers[end] == numbers[end - 1] + 1) ++end;
    if (!text.empty()) text += ", ";
    text += end - i == 1 ? fmt::format("{}", numbers[i]) : fmt::format("{} to {}", numbers[i], numbers[end - 1]);
    i = end;
  }
  return text;
}

}  // namespace firn
