/// firn_verify [NAME...]: runs the checks (all without names) at full resolution and writes what they measured into
/// docs/verification-scenes.md. Exits with 1 if a gate does not hold or a control is not refused.

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <exception>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "verification_scenes/page.h"

namespace firn::test {
namespace {

struct Finished {
  Outcome outcome, control;
  std::string failure;
};

std::vector<Check> chosen(const std::vector<std::string>& names) {
  if (names.empty()) return all_checks();
  std::vector<Check> checks;
  for (const std::string& name : names) {
    const auto check = std::ranges::find(all_checks(), name, &Check::name);
    if (check == all_checks().end()) throw std::runtime_error("no check " + name);
    checks.push_back(*check);
  }
  return checks;
}

std::string first_fault(const Check& check, const Finished& finished) {
  for (const Gate& gate : finished.outcome.gates) {
    if (!gate.holds()) return fmt::format("{} is {:.6g}", gate.name, gate.measured);
  }
  for (const Gate& gate : finished.control.gates) {
    const bool must_fail = std::ranges::find(check.caught_by, gate.name) != check.caught_by.end();
    if (must_fail && gate.holds()) return fmt::format("the control passes: {} is {:.6g}", gate.name, gate.measured);
  }
  return "";
}

Finished run(const Check& check) {
  Finished finished;
  try {
    finished.outcome = check.measure(Level::full);
    finished.control = check.measure(Level::control);
    finished.failure = first_fault(check, finished);
  } catch (const std::exception& error) {
    finished.failure = error.what();
  }
  std::printf("%s: %s\n%s\n", check.name.c_str(), finished.failure.empty() ? "passed" : finished.failure.c_str(),
              block_of(check, finished.outcome, finished.control).c_str());
  std::fflush(stdout);
  return finished;
}

/// The scenes are small: one on each processor beats all processors on one.
std::vector<Finished> run_all(const std::vector<Check>& checks) {
  std::vector<Finished> results(checks.size());
  std::atomic<std::size_t> next = 0;
  std::vector<std::jthread> workers;
  for (unsigned w = 0; w < std::max(std::thread::hardware_concurrency(), 1u); ++w) {
    workers.emplace_back([&] {
      for (std::size_t i = next++; i < checks.size(); i = next++) results[i] = run(checks[i]);
    });
  }
  workers.clear();
  return results;
}

int verify(const std::vector<std::string>& names) {
  const std::vector<Check> checks = chosen(names);
  const std::vector<Finished> results = run_all(checks);
  std::stringstream text;
  text << std::ifstream(page_path()).rdbuf();
  std::string page = text.str();
  int failed = 0;
  for (std::size_t i = 0; i < checks.size(); ++i) {
    if (results[i].failure.empty()) {
      page = with_block(page, checks[i].name, block_of(checks[i], results[i].outcome, results[i].control));
    } else {
      ++failed;
    }
  }
  std::ofstream(page_path()) << page;
  std::printf("%zu checks, %d failed; numbers of those that passed are in %s\n", checks.size(), failed,
              page_path().c_str());
  return failed == 0 ? 0 : 1;
}

}  // namespace
}  // namespace firn::test

int main(int argc, char** argv) {
  try {
    return firn::test::verify({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
