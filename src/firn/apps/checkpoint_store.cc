#include <firn/apps/checkpoint_store.h>
#include <firn/core/error.h>
#include <firn/core/log.h>
#include <firn/scene/resolved.h>
#include <firn/scene/scene_keys.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <tuple>
#include <vector>

namespace firn {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPrefix = "checkpoint.", kSuffix = ".h5";
/// Of the interval, from when on the end of a frame is soon enough.
constexpr double kSoon = 0.8;

std::string file_name(std::int64_t number) { return fmt::format("{}{:04}{}", kPrefix, number, kSuffix); }

std::int64_t number_of_file(const std::string& name) {
  std::int64_t number = 0;
  if (name.starts_with(kPrefix)) std::from_chars(name.data() + kPrefix.size(), name.data() + name.size(), number);
  return number;
}

bool is_before(const CheckpointEntry& a, const CheckpointEntry& b) {
  return std::tie(a.time, a.steps) < std::tie(b.time, b.steps);
}

void remove_file(const RunFolder& folder, const std::string& name) {
  std::error_code error;
  // One file too many does no harm, and is tried again by the next resume.
  fs::remove(folder.checkpoints() / name, error);
}

std::string frames_text(const RunInfo& info) {
  std::vector<std::int64_t> frames;
  for (const CheckpointEntry& entry : info.checkpoints) frames.push_back(entry.frame);
  frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
  return fmt::format("{}", fmt::join(frames, ", "));
}

}  // namespace

CheckpointStore::CheckpointStore(const Scene& scene, const RunFolder& folder, RunInfo& info)
    : scene_(scene),
      folder_(folder),
      info_(info),
      keys_(scene_keys(scene)),
      scene_text_(resolved_toml(scene, folder.root)) {
  make_folder(folder_.checkpoints());
}

double CheckpointStore::minutes_since_last() const {
  return std::chrono::duration<double>(Clock::now() - last_).count() / 60;
}

bool CheckpointStore::due() const {
  const double interval = scene_.checkpoint.every_minutes;
  return interval > 0 && minutes_since_last() >= interval;
}

bool CheckpointStore::due_after(std::int64_t frame) const {
  const int every = scene_.checkpoint.every_frames;
  if (every > 0 && frame % every == 0) return true;
  const double interval = scene_.checkpoint.every_minutes;
  return interval > 0 && minutes_since_last() >= kSoon * interval;
}

bool CheckpointStore::holds(const Simulation& simulation) const {
  return !info_.checkpoints.empty() && info_.checkpoints.back().frame == simulation.frame() &&
         info_.checkpoints.back().time == simulation.time();
}

void CheckpointStore::save(const Simulation& simulation) {
  Checkpoint checkpoint = simulation.checkpoint();
  checkpoint.firn_version = FIRN_VERSION;
  checkpoint.scene_text = scene_text_;
  checkpoint.scene_keys = keys_;

  std::int64_t number = 0;
  for (const CheckpointEntry& entry : info_.checkpoints) number = std::max(number, number_of_file(entry.file));
  CheckpointEntry entry;
  entry.file = file_name(number + 1);
  entry.frame = simulation.frame();
  entry.is_inside_frame = checkpoint.state.texts.contains("next.limit");
  entry.time = simulation.time();
  entry.steps = checkpoint.state.counters.at("steps");
  entry.stamp = write_checkpoint(folder_.checkpoints() / entry.file, checkpoint);

  std::vector<CheckpointEntry> all = info_.checkpoints;
  std::vector<std::string> superfluous;
  std::erase_if(all, [&](const CheckpointEntry& old) {
    if (is_before(old, entry) || is_before(entry, old)) return false;
    superfluous.push_back(old.file);
    return true;
  });
  all.insert(std::upper_bound(all.begin(), all.end(), entry, is_before), entry);
  const auto keep = static_cast<std::size_t>(scene_.checkpoint.keep);
  while (keep > 0 && all.size() > keep && all.front().file != entry.file) {
    superfluous.push_back(all.front().file);
    all.erase(all.begin());
  }
  info_.checkpoints = std::move(all);
  write_run_info(folder_, scene_, info_);
  for (const std::string& file : superfluous) remove_file(folder_, file);
  last_ = Clock::now();
}

FoundCheckpoint newest_checkpoint(const RunFolder& folder, const RunInfo& info,
                                  std::optional<std::int64_t> at_or_before) {
  if (info.checkpoints.empty()) {
    throw Error(ErrorKind::files, fmt::format("{}: the run has no checkpoint yet; start it again with firn run --force",
                                              folder.root.string()));
  }
  std::string damage;
  for (auto entry = info.checkpoints.rbegin(); entry != info.checkpoints.rend(); ++entry) {
    // The middle of a frame is after it.
    const bool is_later =
        at_or_before && (entry->frame > *at_or_before || (entry->frame == *at_or_before && entry->is_inside_frame));
    if (is_later) continue;
    try {
      return {*entry, read_checkpoint(folder.checkpoints() / entry->file, entry->stamp)};
    } catch (const Error& error) {
      log_warning(fmt::format("{}; trying the one before", error.what()));
      damage = error.what();
    }
  }
  if (damage.empty()) {
    throw Error(ErrorKind::usage, fmt::format("{}: there is no checkpoint at or before frame {}; there are ones of "
                                              "frames {}",
                                              folder.root.string(), *at_or_before, frames_text(info)));
  }
  throw Error(ErrorKind::files, fmt::format("{}: no checkpoint can be used; start the run again with firn run --force",
                                            folder.root.string()));
}

void drop_checkpoints_after(const RunFolder& folder, const Scene& scene, RunInfo& info, const CheckpointEntry& entry) {
  std::erase_if(info.checkpoints, [&](const CheckpointEntry& other) { return is_before(entry, other); });
  write_run_info(folder, scene, info);
  remove_unlisted_checkpoints(folder, info);
}

void remove_unlisted_checkpoints(const RunFolder& folder, const RunInfo& info) {
  std::vector<std::string> unlisted;
  std::error_code error;
  for (fs::directory_iterator place(folder.checkpoints(), error), end; !error && place != end; place.increment(error)) {
    const std::string name = place->path().filename().string();
    const bool is_ours = name.starts_with(kPrefix) && name.ends_with(kSuffix);
    const bool is_listed =
        std::ranges::any_of(info.checkpoints, [&](const CheckpointEntry& entry) { return entry.file == name; });
    if (is_ours && !is_listed) unlisted.push_back(name);
  }
  for (const std::string& name : unlisted) remove_file(folder, name);
}

}  // namespace firn
