#pragma once

#include <firn/apps/bench_case.h>
#include <firn/apps/bench_landing.h>

#include <filesystem>
#include <set>

namespace firn {

/// Landed states, simulated once and kept as files named by the case and the hash of landing_settings(). A file that is
/// missing or damaged is made again.
class LandedStates {
 public:
  /// @param reuse false: every state is made anew, once, and replaces what was kept
  LandedStates(std::filesystem::path folder, bool reuse) : folder_(std::move(folder)), reuse_(reuse) {}

  /// $XDG_CACHE_HOME/firn/bench or ~/.cache/firn/bench. Error(files) if the environment has neither.
  static std::filesystem::path default_folder();

  struct State {
    std::filesystem::path file;
    Landing landing;
  };

  /// The case's landed state, which does not depend on its number of threads. Simulates it if need be, on all threads
  /// of a process of its own, with a line in the log. Error(files), Error(numerical).
  State get(const BenchCase& bench);

 private:
  template <class Real, int dim>
  void make(const BenchCase& bench, const std::string& settings, const std::filesystem::path& file) const;

  std::filesystem::path folder_;
  bool reuse_;
  std::set<std::filesystem::path> made_;
};

}  // namespace firn
