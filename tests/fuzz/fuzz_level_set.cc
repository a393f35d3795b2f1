#include <firn/io/level_set_stream.h>

#include "fuzz/fuzz_target.h"

using namespace firn;

namespace {

/// One block of a plane, with a velocity.
LevelSetParts sample() {
  constexpr std::size_t kNodes = 9 * 9 * 9;
  LevelSetParts parts;
  parts.distance.cell = 0.1;
  parts.distance.mesh_upper = {{0.8, 0.8, 0.8}};
  parts.velocity.emplace();
  parts.velocity->cell = 0.1;
  for (int i = 0; i < 3; ++i) parts.distance.blocks[i] = parts.velocity->blocks[i] = 1;
  parts.distance.center = {0};
  parts.distance.fine = {0};
  parts.velocity->stored = {0};
  for (std::size_t n = 0; n < kNodes; ++n) {
    parts.distance.nodes.push_back(0.1F * (static_cast<float>(n % 9) - 4));
    parts.velocity->nodes.push_back({{1, 2, static_cast<float>(n)}});
  }
  return parts;
}

}  // namespace

// The input is laid over the sample from its first byte on (the header), or, after a first byte of 1, over its end:
// most of a level set is numbers of which any is as good as another. After a 2 it stands for itself.
FIRN_FUZZ_TARGET(level_set) {
  if (bytes.empty()) return;
  static const std::string original = level_set_bytes(sample());
  const std::string_view rest = bytes.substr(1);
  std::string input = original;
  if (bytes[0] == 2) {
    input = rest;
  } else {
    const std::size_t begin = bytes[0] == 1 && rest.size() < input.size() ? input.size() - rest.size() : 0;
    input.replace(begin, rest.size(), rest);
  }
  const LevelSetParts parts = parse_level_set(input, "level set");
  fuzz::require(level_set_bytes(parts) == input, "a level set changes when it is written and read");
}
