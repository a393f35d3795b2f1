#pragma once

#include <firn/apps/frame_list.h>

#include <filesystem>
#include <string>
#include <vector>

namespace firn {

/// Who the files are for.
enum class Client { any, blender, houdini, paraview };

/// What decides where files go and how they lie.
struct ExportOptions {
  std::vector<std::string> paths;
  std::string format;
  std::string client;      ///< "" for any
  std::string up;          ///< "y", "z" or "" for what the client expects
  std::string frames;      ///< of --frames
  std::string attributes;  ///< of --attributes
  std::string output;
  double voxel = 1;  ///< in particle spacings
  bool force = false;
};

/// Throws Error (usage) with the nearest name.
Client client_of(const std::string& name);

/// The axis that is up in files for the client: the run's own unless the client expects one. OBJ files have y up,
/// because programs take that for granted.
UpAxis target_up(Client client, const std::string& up, const std::string& format, UpAxis own);

/// One file for each frame of a list, "NAME.0012.EXTENSION" in a folder, or the one file that -o names.
class ExportTarget {
 public:
  /// @param output what -o says: a folder, or a file if it ends as the format does; "" for `subfolder` of the run, or
  ///               the folder of the frames
  ExportTarget(const FrameList& list, const std::string& output, const std::string& subfolder, const std::string& name,
               const std::string& extension);

  const std::filesystem::path& folder() const { return folder_; }
  std::filesystem::path file(const ListedFrame& frame) const;
  /// A file beside those of the frames.
  std::filesystem::path beside(const std::string& suffix) const { return folder_ / (name_ + suffix); }
  const std::string& name() const { return name_; }
  bool is_one_file() const { return !only_.empty(); }

  /// Creates the folder. Throws Error (files) if one of the files exists, unless `force`.
  void prepare(const std::vector<std::filesystem::path>& files, bool force) const;

 private:
  std::filesystem::path folder_, only_;
  std::string name_, extension_;
};

/// A line for each file as it is done: "  3/240  out/export/particles.0003.ply  (104000 particles, 4.1 MB)".
void print_done(std::size_t done, std::size_t all, const std::filesystem::path& file, const std::string& what);

}  // namespace firn
