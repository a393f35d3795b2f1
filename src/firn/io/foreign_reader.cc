#include <firn/core/child_process.h>
#include <firn/core/error.h>
#include <firn/io/foreign_reader.h>
#include <firn/io/shown_text.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace firn {
namespace {

namespace fs = std::filesystem;

/// Every answer begins so; then its length, lowest byte first.
constexpr std::string_view kAnswerMark = "firnread";
constexpr std::size_t kHeaderBytes = 16;
/// Tells a refusal from what a library prints.
constexpr std::string_view kRefusalMark = "firn-reader: ";

std::array<char, kHeaderBytes> header_of(std::uint64_t size) {
  std::array<char, kHeaderBytes> header;
  kAnswerMark.copy(header.data(), kAnswerMark.size());
  for (std::size_t i = 0; i < 8; ++i) header[8 + i] = static_cast<char>(size >> (8 * i) & 0xff);
  return header;
}

std::uint64_t size_in(const std::array<char, kHeaderBytes>& header) {
  std::uint64_t size = 0;
  for (std::size_t i = 8; i-- > 0;) size = size << 8 | static_cast<unsigned char>(header[8 + i]);
  return size;
}

std::string reader_program() {
  if (const char* given = std::getenv("FIRN_READER"); given != nullptr && *given != 0) return given;
  std::error_code error;
  const fs::path beside = fs::read_symlink("/proc/self/exe", error).parent_path() / "firn-reader";
  if (!error && fs::exists(beside, error)) return beside.string();
  if (fs::exists(FIRN_READER_OF_BUILD, error)) return FIRN_READER_OF_BUILD;
  throw Error(ErrorKind::resources,
              fmt::format("the program firn-reader, which opens files of other programs, is missing: it belongs beside "
                          "firn (looked for {}); FIRN_READER in the environment names it elsewhere",
                          beside.string()));
}

bool is_vdb(const fs::path& file) { return file.extension() == ".vdb"; }

/// What to do about a file that no reader takes.
const char* advice(const fs::path& file) {
  return is_vdb(file) ? "write it again with the program that made it" : "export it as OBJ, PLY or STL";
}

/// Whose fault it is, with the version if that can be had.
std::string library_of(const fs::path& file) {
  const std::string name = is_vdb(file) ? "OpenVDB" : "assimp";
  for (const std::string& known : foreign_libraries()) {
    if (known.starts_with(name + " ")) return known;
  }
  return name;
}

class Conversation {
 public:
  Conversation(const std::vector<std::string>& command, const std::vector<fs::path>& files, const ReaderLimits& limits)
      : child_(command, ChildProcess::Use::read), files_(files), limits_(limits) {
#if !defined(__SANITIZE_ADDRESS__)
    // The sanitizer reserves terabytes that it does not use.
    child_.limit_memory(limits.memory);
#endif
  }

  std::string answer(std::size_t k) {
    const auto time = std::chrono::duration<double>(limits_.seconds);
    deadline_ = ChildProcess::Clock::now() + std::chrono::ceil<ChildProcess::Clock::duration>(time);
    std::array<char, kHeaderBytes> header;
    read(k, header.data(), header.size());
    if (std::memcmp(header.data(), kAnswerMark.data(), kAnswerMark.size()) != 0) {
      fail(k, "gave an answer that is none", advice(files_[k]));
    }
    const std::uint64_t size = size_in(header);
    if (size > limits_.answer) {
      fail(k, fmt::format("made more than {} MiB of it", limits_.answer >> 20), advice(files_[k]));
    }
    // Not all at once: the length may be rubbish, and memory is taken as bytes come.
    std::string bytes;
    while (bytes.size() < size) {
      const std::size_t begin = bytes.size();
      bytes.resize(begin + std::min<std::uint64_t>(size - begin, std::uint64_t(64) << 20));
      read(k, bytes.data() + begin, bytes.size() - begin);
    }
    return bytes;
  }

 private:
  [[noreturn]] void fail(std::size_t k, const std::string& what, const std::string& hint) const {
    throw Error(ErrorKind::files, fmt::format("{}: the reader ({}) {} while reading it; {}", files_[k].string(),
                                              library_of(files_[k]), what, hint));
  }

  void read(std::size_t k, char* bytes, std::size_t size) {
    const ChildProcess::Reading reading = child_.read(bytes, size, deadline_);
    if (reading == ChildProcess::Reading::complete) return;
    if (reading == ChildProcess::Reading::late) {
      fail(k, fmt::format("took longer than {:g} s", limits_.seconds),
           fmt::format("{}, or set FIRN_READER_SECONDS to a longer time", advice(files_[k])));
    }
    explain_end(k);
  }

  [[noreturn]] void explain_end(std::size_t k) {
    const ChildProcess::Ending ending = child_.end(deadline_);
    std::string said = child_.last_error_line();
    if (ending.signal != 0) fail(k, fmt::format("crashed with signal {}", ending.signal), advice(files_[k]));
    if (said.starts_with(kRefusalMark) && (ending.exit_code == 2 || ending.exit_code == 3 || ending.exit_code == 5)) {
      said.erase(0, kRefusalMark.size());
      throw Error(static_cast<ErrorKind>(ending.exit_code), one_line(said));
    }
    if (ending.exit_code == kReaderOutOfMemory) {
      fail(k, fmt::format("needed more than {} MiB of memory", limits_.memory >> 20), advice(files_[k]));
    }
    fail(k, fmt::format("gave up with exit code {} ({})", ending.exit_code, shown_text(said)), advice(files_[k]));
  }

  ChildProcess child_;
  const std::vector<fs::path>& files_;
  ReaderLimits limits_;
  ChildProcess::Clock::time_point deadline_;
};

}  // namespace

ReaderLimits ReaderLimits::of_this_machine() {
  ReaderLimits limits;
  const auto pages = static_cast<std::size_t>(std::max(0L, ::sysconf(_SC_PHYS_PAGES)));
  // Never less than what the libraries take before they read anything.
  limits.memory = std::max(pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) / 2, std::size_t(2) << 30);
  limits.answer = limits.memory;
  if (const char* given = std::getenv("FIRN_READER_SECONDS"); given != nullptr && std::atof(given) > 0) {
    limits.seconds = std::atof(given);
  }
  return limits;
}

void read_foreign_files(const std::vector<std::string>& arguments, const std::vector<fs::path>& files,
                        const std::function<void(std::size_t k, std::string answer)>& take,
                        const ReaderLimits& limits) {
  std::vector<std::string> command = {reader_program()};
  command.insert(command.end(), arguments.begin(), arguments.end());
  for (const fs::path& file : files) command.push_back(file.string());
  Conversation conversation(command, files, limits);
  for (std::size_t k = 0; k < files.size(); ++k) take(k, conversation.answer(k));
}

std::vector<std::string> foreign_libraries() {
  std::vector<std::string> libraries(1);
  try {
    ChildProcess child({reader_program(), "versions"}, ChildProcess::Use::read);
    const auto deadline = ChildProcess::Clock::now() + std::chrono::seconds(5);
    char c = 0;
    for (std::size_t n = 0; n < 1000 && child.read(&c, 1, deadline) == ChildProcess::Reading::complete; ++n) {
      if (c == '\n') {
        libraries.emplace_back();
      } else {
        libraries.back() += is_control(c) ? '?' : c;
      }
    }
    if (child.end(deadline).exit_code != 0) return {};
  } catch (const Error&) {
    return {};
  }
  libraries.pop_back();
  return libraries;
}

void send_foreign_answer(std::FILE* output, std::string_view answer) {
  const auto header = header_of(answer.size());
  // Nothing to be done about a reader that left: it has its reasons.
  std::fwrite(header.data(), 1, header.size(), output);
  std::fwrite(answer.data(), 1, answer.size(), output);
  std::fflush(output);
}

void send_foreign_refusal(std::FILE* errors, const std::string& message) {
  std::fprintf(errors, "\n%s%s\n", std::string(kRefusalMark).c_str(), message.c_str());
  std::fflush(errors);
}

}  // namespace firn
