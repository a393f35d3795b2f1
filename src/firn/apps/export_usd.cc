#include <firn/apps/export_usd.h>
#include <firn/apps/share_folder.h>
#include <firn/core/error.h>
#include <firn/core/child_process.h>
#include <fmt/format.h>

#include <cstdlib>
#include <system_error>

namespace firn {

namespace fs = std::filesystem;

std::string python_with_usd() {
  const char* chosen = std::getenv("FIRN_PYTHON");
  const std::string python = chosen != nullptr && *chosen != '\0' ? chosen : "python3";
  constexpr const char* kAdvice = "pip install usd-core, and let FIRN_PYTHON name the Python that has it";
  try {
    ChildProcess child({python, "-c", "import pxr.Usd"});
    if (child.finish()) return python;
    throw Error(ErrorKind::resources, fmt::format("USD needs the Python package usd-core, and {} has none ({}): {}",
                                                  python, child.last_error_line(), kAdvice));
  } catch (const Error& error) {
    if (std::string(error.what()).starts_with("USD")) throw;
    throw Error(ErrorKind::resources,
                fmt::format("USD needs Python with the package usd-core: {}: {}", error.what(), kAdvice));
  }
}

void write_usd(const fs::path& path, const UsdScene& scene, const std::string& python) {
  // The ending stays, because it decides the kind of file.
  const fs::path part = path.parent_path() / (path.stem().string() + ".part" + path.extension().string());
  std::vector<std::string> command = {python, shared_file("usd/firn_to_usd.py").string(), "--ply"};
  for (const fs::path& file : scene.points) command.push_back(file.string());
  command.push_back("--times");
  for (const double time : scene.times) command.push_back(fmt::format("{}", time));
  for (const std::string& word :
       {std::string("--fps"), fmt::format("{}", scene.frame_rate), std::string("--up"),
        std::string(scene.up == UpAxis::y ? "Y" : "Z"), std::string("--meters-per-unit"), std::string("1"),
        std::string("--widths"), fmt::format("{}", scene.width), std::string("-o"), part.string()}) {
    command.push_back(word);
  }
  ChildProcess child(command);
  std::error_code error;
  const bool is_good = child.finish() && fs::is_regular_file(part, error);
  if (is_good) fs::rename(part, path, error);
  if (!is_good || error) {
    std::error_code ignored;
    fs::remove(part, ignored);
    throw Error(ErrorKind::files, fmt::format("{}: cannot write USD: {}", path.string(),
                                              is_good ? error.message() : child.last_error_line()));
  }
}

}  // namespace firn
