#pragma once

#include <functional>
#include <string>
#include <type_traits>

namespace firn {

/// Runs the work in a process of its own and returns the bytes that it gave. Each case of the benchmark begins so with
/// a memory that no other case has used: in one process, what earlier cases leave in the allocator adds a tenth to the
/// memory of later ones. An Error of the work is thrown here; Error(resources) if the process was killed.
///
/// The calling process must not have started the parallel scheduler, whose threads a child would miss.
std::string bytes_from_own_process(const std::function<std::string()>& work);

/// The same for a plain value.
template <class Result>
Result in_own_process(const std::function<Result()>& work) {
  static_assert(std::is_trivially_copyable_v<Result>);
  const std::string bytes = bytes_from_own_process([&] {
    const Result result = work();
    return std::string(reinterpret_cast<const char*>(&result), sizeof(result));
  });
  Result result;
  bytes.copy(reinterpret_cast<char*>(&result), sizeof(result));
  return result;
}

}  // namespace firn
