#include <firn/core/parallel.h>
#include <firn/render/scene_view.h>
#include <gtest/gtest.h>
#include <render/picture_samples.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <xmmintrin.h>

#include <atomic>
#include <thread>

namespace firn {
namespace {

View busy_view() {
  View view = small_view();
  view.camera->position = {{2, 2, 3}};
  view.half_spaces.push_back({.point = {{0, -0.5, 0}}});
  view.boxes.push_back({.center = {{0.8, -0.3, 0}}, .half_size = {{0.2, 0.2, 0.2}}});
  return view;
}

TEST(Threads, PictureHasTheSameBitsOnAnyNumber) {
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 3);
  const Snapshot snapshot = snapshot_of(cube_of(16, 0.0625, {{-0.5, -0.5, -0.5}}), 0.0625);
  Image one;
  for (const int threads : {1, 2, 3}) {
    tbb::task_arena arena(threads);
    Image image;
    arena.execute([&] { image = render_snapshot(snapshot, busy_view()); });
    if (threads == 1) one = image;
    EXPECT_TRUE(image.rgb == one.rgb) << threads << " threads";
  }
}

/// Rounding and flush-to-zero bits, without the sticky exception flags.
unsigned float_mode() { return _mm_getcsr() & ~0x3FU; }

/// Iterations of a parallel loop in which the mode was not `expected`.
int wrong_modes(unsigned expected) {
  std::atomic<int> wrong = 0;
  parallel_chunks(20000, 1, [&](std::size_t, std::size_t) {
    if (float_mode() != expected) ++wrong;
  });
  return wrong;
}

// Embree asks its users to flush denormals on all threads; a simulation on the same threads would then lose its bits.
TEST(Threads, RenderingLeavesTheFloatingPointModesAlone) {
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 3);
  const Snapshot snapshot = snapshot_of(cube_of(24, 0.03125, {{-0.5, -0.5, -0.5}}), 0.03125);
  const unsigned before = float_mode();
  std::atomic<bool> done = false;
  std::atomic<int> wrong_meanwhile = 0;
  std::thread simulation([&] {
    while (!done) wrong_meanwhile += wrong_modes(before);
  });
  for (int i = 0; i < 3; ++i) render_snapshot(snapshot, busy_view());
  done = true;
  simulation.join();
  EXPECT_EQ(float_mode(), before);
  EXPECT_EQ(wrong_modes(before), 0);
  EXPECT_EQ(wrong_meanwhile, 0);
}

TEST(Threads, ModeCheckSeesAChangedMode) {
  const unsigned before = _mm_getcsr();
  _mm_setcsr(before | 0x8000U);  // flush to zero
  const unsigned changed = float_mode();
  _mm_setcsr(before);
  EXPECT_NE(changed, float_mode());
}

}  // namespace
}  // namespace firn
