#pragma once

#include <firn/apps/viewer/frame_source.h>

#include <cstdint>

namespace firn::test {

/// A source that does nothing of what it is asked; what it shows is set by who derives from it.
class StillSource : public FrameSource {
 public:
  void play() override {}
  void pause() override {}
  void step() override {}
  void reset() override {}
  void run_to(std::int64_t) override {}
  void seek(std::int64_t) override {}
};

}  // namespace firn::test
