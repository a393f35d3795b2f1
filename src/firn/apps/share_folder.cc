#include <firn/apps/share_folder.h>
#include <firn/core/error.h>
#include <fmt/format.h>

#include <system_error>

namespace firn {

namespace fs = std::filesystem;

fs::path shared_file(const fs::path& name) {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path installed = program.parent_path().parent_path() / "share" / "firn" / name;
  const fs::path source = fs::path(FIRN_SOURCE_DIR) / "tools" / name;
  for (const fs::path& place : {installed, source}) {
    if (fs::is_regular_file(place, error)) return place;
  }
  throw Error(ErrorKind::files, fmt::format("{} is missing; it belongs to Firn and should be in {}; install Firn again",
                                            name.filename().string(), installed.parent_path().string()));
}

}  // namespace firn
