#include <firn/apps/work_folder.h>
#include <firn/core/error.h>
#include <fmt/format.h>
#include <stdlib.h>

#include <string>
#include <system_error>

namespace firn {

namespace fs = std::filesystem;

WorkFolder::WorkFolder() {
  std::string name = (fs::temp_directory_path() / "firn.XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) {
    throw Error(ErrorKind::files, fmt::format("cannot create a folder in {}; let TMPDIR name another place",
                                              fs::temp_directory_path().string()));
  }
  path_ = name;
}

WorkFolder::~WorkFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace firn
