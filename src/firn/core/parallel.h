#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <cstddef>

namespace firn {

/// body(begin, end) over consecutive chunks of [0, count), each at most `grain` long, on the threads of the enclosing
/// tbb::task_arena. Chunk borders are multiples of `grain` whatever the number of threads, so that per-chunk partial
/// results, combined in chunk order, are the same bits on any number of threads.
template <class Body>
void parallel_chunks(std::size_t count, std::size_t grain, const Body& body) {
  const std::size_t chunks = (count + grain - 1) / grain;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, chunks, 1), [&](const tbb::blocked_range<std::size_t>& range) {
    for (std::size_t chunk = range.begin(); chunk < range.end(); ++chunk) {
      const std::size_t begin = chunk * grain;
      body(begin, begin + grain < count ? begin + grain : count);
    }
  });
}

/// body(i) for each i in [0, count).
template <class Body>
void parallel_each(std::size_t count, const Body& body) {
  tbb::parallel_for(std::size_t(0), count, body);
}

}  // namespace firn
