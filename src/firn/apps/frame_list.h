#pragma once

#include <firn/io/axes.h>
#include <firn/io/frame_metadata.h>
#include <firn/scene/settings.h>
#include <firn/state/snapshot.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace firn {

struct ListedFrame {
  std::filesystem::path file;
  std::int64_t number = 1;  ///< frame 1 is t = 0
  double time = 0;          ///< s
};

/// Frames that a command line names, and what is known of the run that they are of.
struct FrameList {
  std::vector<ListedFrame> frames;  ///< by number
  std::filesystem::path run;        ///< folder of the run; empty if there is none
  std::optional<Scene> scene;       ///< of that folder, if it can be read
  double frame_rate = 24;           ///< 1/s
  UpAxis up = UpAxis::y;            ///< of the coordinates in the files
};

/// The frames of a run (its folder, the folder of its frames or their series file) or the frame files that are named.
/// Throws Error (files) for what is neither, and for a run without frames; Error (usage) for several runs, for a run
/// and frames, and for two frames with one number.
FrameList list_frames(const std::vector<std::string>& paths);

/// The number in the name of a frame's file, "particles.0012.hdf"; 0 if there is none.
std::int64_t number_in_name(const std::filesystem::path& file);

/// Whether the folder is that of a run.
bool is_run_folder(const std::filesystem::path& folder);

/// What remains of the frames after --frames: "5", "1:24", "1:240:10", "1,5,9", ":10", "20:", "last", and these joined
/// by commas; "" for all. Throws Error (usage) for other texts and for frames that are not there.
void choose_frames(FrameList& list, const std::string& text);

/// Numbers as a person writes them: "1 to 24, 30".
std::string ranges_text(const std::vector<std::int64_t>& numbers);

}  // namespace firn
