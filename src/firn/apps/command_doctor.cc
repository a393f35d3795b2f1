#include <firn/apps/commands.h>
#include <firn/apps/machine.h>
#include <firn/core/simd.h>
#include <firn/io/foreign_reader.h>

#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <hdf5.h>
#include <tbb/info.h>
#include <tbb/version.h>

#include <cstdio>
#include <filesystem>

namespace firn {
namespace {

std::string gibibytes(std::uint64_t bytes) {
  return bytes == 0 ? "unknown" : fmt::format("{:.1f} GiB", static_cast<double>(bytes) / (1ull << 30));
}

std::string hdf5_version() {
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  return fmt::format("{}.{}.{}", major, minor, release);
}

std::string embree_version() {
  const RTCDevice device = rtcNewDevice("threads=1");
  if (!device) return "cannot start: pictures cannot be drawn on this processor";
  const auto version = rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_VERSION);
  rtcReleaseDevice(device);
  return fmt::format("{}.{}.{}", version / 10000, version / 100 % 100, version % 100);
}

std::string simd_text() {
  std::string others;
  for (const std::string& name : available_simd_targets())
    others += fmt::format("{}{}", others.empty() ? "" : ", ", name);
  return fmt::format("{} (available: {}; FIRN_SIMD chooses)", simd_target(), others);
}

std::string folder_text() {
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::current_path(error);
  const auto space = std::filesystem::space(folder, error);
  if (error) return "unknown: " + error.message();
  return fmt::format("{}: {} free", folder.string(), gibibytes(space.available));
}

void run_doctor() {
  const auto line = [](const char* what, const std::string& text) { fmt::print("{:<11}{}\n", what, text); };
  const std::filesystem::path ffmpeg = find_program("ffmpeg");
  line("firn", FIRN_VERSION);
  line("processor", processor_name());
  line("threads", std::to_string(tbb::info::default_concurrency()));
  line("simd", simd_text());
  line("memory", fmt::format("{}, {} available", gibibytes(total_memory()), gibibytes(available_memory())));
  line("folder", folder_text());
  line("ffmpeg",
       ffmpeg.empty() ? "missing: pictures are made, but no films; install the package ffmpeg" : ffmpeg.string());
  line("hdf5", hdf5_version());
  const std::vector<std::string> libraries = foreign_libraries();
  line("reader", libraries.empty()
                     ? "missing: files of other programs cannot be opened; firn-reader belongs beside firn"
                     : fmt::format("{}", fmt::join(libraries, ", ")));
  line("embree", embree_version());
  line("tbb", TBB_runtime_version());
}

}  // namespace

void add_doctor(CLI::App& program) {
  program.add_subcommand("doctor", "What this machine offers: processor, memory, disk, libraries")
      ->callback(run_doctor);
}

}  // namespace firn
