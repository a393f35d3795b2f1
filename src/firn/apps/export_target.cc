#include <firn/apps/export_target.h>
#include <firn/apps/run_folder.h>
#include <firn/core/error.h>
#include <firn/scene/nearest.h>
#include <fmt/format.h>

#include <cstdio>

namespace firn {

namespace fs = std::filesystem;

Client client_of(const std::string& name) {
  if (name.empty()) return Client::any;
  if (name == "blender") return Client::blender;
  if (name == "houdini") return Client::houdini;
  if (name == "paraview") return Client::paraview;
  throw Error(ErrorKind::usage,
              fmt::format("--for: no client \"{}\"{}", name,
                          suggestion(name, std::vector<std::string>{"blender", "houdini", "paraview"})));
}

UpAxis target_up(Client client, const std::string& up, const std::string& format, UpAxis own) {
  if (!up.empty() && up != "y" && up != "z") {
    throw Error(ErrorKind::usage, fmt::format("--up must be y or z, got \"{}\"", up));
  }
  if (!up.empty()) return up == "y" ? UpAxis::y : UpAxis::z;
  if (format == "obj" || client == Client::houdini) return UpAxis::y;
  return client == Client::blender ? UpAxis::z : own;
}

ExportTarget::ExportTarget(const FrameList& list, const std::string& output, const std::string& subfolder,
                           const std::string& name, const std::string& extension)
    : name_(name), extension_(extension) {
  const fs::path path = output;
  if (output.empty()) {
    const fs::path beside = list.frames.front().file.parent_path();
    folder_ = list.run.empty() ? (beside.empty() ? fs::path(".") : beside) : list.run / subfolder;
  } else if (path.extension() == extension) {
    if (list.frames.size() > 1) {
      throw Error(ErrorKind::usage,
                  fmt::format("-o {} is one file and there are {} frames; name a folder, or one frame with --frames",
                              output, list.frames.size()));
    }
    only_ = path;
    folder_ = path.has_parent_path() ? path.parent_path() : fs::path(".");
    name_ = path.stem().string();
  } else {
    folder_ = path;
  }
}

fs::path ExportTarget::file(const ListedFrame& frame) const {
  return only_.empty() ? folder_ / fmt::format("{}.{:04}{}", name_, frame.number, extension_) : only_;
}

void ExportTarget::prepare(const std::vector<fs::path>& files, bool force) const {
  make_folder(folder_);
  for (const fs::path& file : files) {
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    // Devices and pipes are written to, not replaced.
    if (force || !fs::exists(status) || fs::is_character_file(status) || fs::is_fifo(status)) continue;
    throw Error(ErrorKind::files,
                fmt::format("{} exists; use --force to replace it, or -o for another place", file.string()));
  }
}

void print_done(std::size_t done, std::size_t all, const fs::path& file, const std::string& what) {
  std::error_code error;
  const auto bytes = fs::file_size(file, error);
  const std::string size = error ? "" : fmt::format(", {:.1f} MB", static_cast<double>(bytes) * 1e-6);
  std::fputs(fmt::format("{:>{}}/{}  {}  ({}{})\n", done, fmt::format("{}", all).size(), all, file.string(), what, size)
                 .c_str(),
             stdout);
  std::fflush(stdout);
}

}  // namespace firn
