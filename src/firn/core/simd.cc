#include <firn/core/error.h>
#include <firn/core/simd.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <hwy/highway.h>

#include <cstdint>
#include <cstdlib>

namespace firn {
namespace {

struct Target {
  std::string_view name;
  int64_t bits;
};

/// Narrowest first. The baseline is the instruction set that everything is compiled for.
constexpr Target kTargets[] = {
    {"baseline", HWY_STATIC_TARGET},
#if HWY_ARCH_X86
    {"avx2", HWY_AVX2},
    {"avx512", HWY_AVX3},
#endif
};

bool is_available(const Target& target) {
  return target.bits == HWY_STATIC_TARGET || (hwy::SupportedTargets() & target.bits) != 0;
}

/// What the processor can do, read before any forcing narrows what Highway reports.
const std::vector<Target>& processor_targets() {
  static const std::vector<Target> targets = [] {
    std::vector<Target> found;
    for (const Target& target : kTargets) {
      if (is_available(target)) found.push_back(target);
    }
    return found;
  }();
  return targets;
}

std::string& selected_name() {
  static std::string name = std::string(processor_targets().back().name);
  return name;
}

void select(std::string_view name) {
  for (const Target& target : processor_targets()) {
    if (target.name != name) continue;
    hwy::SetSupportedTargetsForTest(target.bits);
    selected_name() = name;
    return;
  }
  throw Error(ErrorKind::usage, fmt::format("SIMD target \"{}\" is not available; this processor and build have: {}",
                                            name, fmt::join(available_simd_targets(), ", ")));
}

void obey_environment_once() {
  static const bool done = [] {
    if (const char* forced = std::getenv("FIRN_SIMD"); forced != nullptr && *forced != '\0') select(forced);
    return true;
  }();
  (void)done;
}

}  // namespace

std::vector<std::string> available_simd_targets() {
  std::vector<std::string> names;
  for (const Target& target : processor_targets()) names.emplace_back(target.name);
  return names;
}

std::string simd_target() {
  obey_environment_once();
  return selected_name();
}

void select_simd_target(std::string_view name) {
  obey_environment_once();
  select(name);
}

}  // namespace firn
