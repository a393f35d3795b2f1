#ifdef __SANITIZE_THREAD__
#include <tbb/global_control.h>

// The system's TBB is compiled without the thread sanitizer, which then takes every hand-over of a task for a race.
// With one thread for the loops it sees what these tests are about: the window's thread beside the one that simulates.
static const tbb::global_control kOneThread(tbb::global_control::max_allowed_parallelism, 1);
#endif
