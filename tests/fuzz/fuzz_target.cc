#include "fuzz/fuzz_target.h"

#include <firn/core/log.h>

#include <algorithm>
#include <typeinfo>

namespace firn::fuzz {
namespace {

/// A message goes to terminals and log files: a line of its own, and no byte that a terminal would obey.
void require_one_line(const std::string& message) {
  require(!message.empty(), "an empty message");
  const bool plain = std::ranges::all_of(message, [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte >= 32 && byte != 127;
  });
  require(plain, "a message with control characters: " + message);
}

}  // namespace

void require(bool holds, const std::string& what) {
  if (!holds) throw Finding(what);
}

std::vector<Target>& targets() {
  static std::vector<Target> list;
  return list;
}

bool run(Function function, std::string_view bytes) {
  std::string logged;
  const LogSink before = set_log_sink([&](LogLevel, const std::string& line) { logged = line; });
  struct Restore {
    const LogSink& sink;
    ~Restore() { set_log_sink(sink); }
  } restore{before};
  bool accepted = true;
  try {
    function(bytes);
  } catch (const Error& error) {
    require_one_line(error.what());
    accepted = false;
  } catch (const Finding&) {
    throw;
  } catch (const std::exception& error) {
    throw Finding(std::string("an exception that is no Error: ") + typeid(error).name() + ": " + error.what());
  }
  if (!logged.empty()) require_one_line(logged);
  return accepted;
}

}  // namespace firn::fuzz
