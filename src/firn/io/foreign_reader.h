#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace firn {

/// What the program firn-reader may take for one file before it counts as caught in it.
struct ReaderLimits {
  double seconds = 300;
  std::size_t memory = 0;                      ///< bytes of address space
  std::size_t answer = std::size_t(16) << 30;  ///< bytes of what it makes of the file

  /// Half of this machine's memory; FIRN_READER_SECONDS in the environment sets the time.
  static ReaderLimits of_this_machine();
};

/// Files of formats that are read by the libraries of others are opened in a process of its own, firn-reader, so that a
/// crash of such a library, an endless loop or a request for all memory is an Error (files) that names the file.
///
/// @param arguments of firn-reader
/// @param files     that it is to read, in this order; it gives an answer for each
/// @param take      gets the answer for file k; not yet checked
///
/// Throws the Error of firn-reader for a file that is refused; Error (files) if it crashed, gave up, took longer or
/// more than the limits or did not answer in its form; Error (resources) if it cannot be started. It is looked for at
/// FIRN_READER of the environment, then beside the running program, then where this build puts it.
void read_foreign_files(const std::vector<std::string>& arguments, const std::vector<std::filesystem::path>& files,
                        const std::function<void(std::size_t k, std::string answer)>& take,
                        const ReaderLimits& limits = ReaderLimits::of_this_machine());

/// "assimp 5.2.5", "OpenVDB 10.0.1": of firn-reader; empty if it does not answer.
std::vector<std::string> foreign_libraries();

/// firn-reader's side: how it gives an answer and refuses a file. `output` is its standard output.
void send_foreign_answer(std::FILE* output, std::string_view answer);
void send_foreign_refusal(std::FILE* errors, const std::string& message);

/// Exit code of firn-reader; a refusal has that of its Error.
inline constexpr int kReaderOutOfMemory = 6;

}  // namespace firn
