#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

/// The frame of the fuzz targets. Each tests/fuzz/fuzz_<name>.cc defines one with FIRN_FUZZ_TARGET(name); it is linked
/// with libFuzzer (libfuzzer_entry.cc) to search and with GoogleTest (test_corpus.cc) to replay its corpus.
namespace firn::fuzz {

/// A property that every input must have does not hold.
class Finding : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

/// Throws Finding unless `holds`.
void require(bool holds, const std::string& what);

using Function = void (*)(std::string_view bytes);

struct Target {
  std::string name;
  Function function;
};

/// Of this program.
std::vector<Target>& targets();

/// Gives the bytes to a target. Nothing may come out of it but Error, whose message is one line without control
/// characters, and Finding, which goes on to the caller. The same holds for what is logged meanwhile. False if the
/// bytes were refused with an Error.
bool run(Function function, std::string_view bytes);

struct Registration {
  Registration(const char* name, Function function) { targets().push_back({name, function}); }
};

/// What `function` does, or a Finding with `what` if it refuses something that it must take.
template <class F>
auto must_accept(const std::string& what, const F& function);

}  // namespace firn::fuzz

#define FIRN_FUZZ_TARGET(name)                                                   \
  static void fuzz_##name(std::string_view bytes);                               \
  static const firn::fuzz::Registration registration_##name(#name, fuzz_##name); \
  static void fuzz_##name([[maybe_unused]] std::string_view bytes)

#include <firn/core/error.h>

template <class F>
auto firn::fuzz::must_accept(const std::string& what, const F& function) {
  try {
    return function();
  } catch (const Error& error) {
    throw Finding(what + ": " + error.what());
  }
}
