#include <firn/core/log.h>

#include <mutex>
#include <utility>

namespace firn {
namespace {

std::mutex mutex;
LogSink current_sink;

void log(LogLevel level, const std::string& line) {
  const std::lock_guard lock(mutex);
  if (current_sink) current_sink(level, line);
}

}  // namespace

LogSink set_log_sink(LogSink sink) {
  const std::lock_guard lock(mutex);
  return std::exchange(current_sink, std::move(sink));
}

void log_info(const std::string& line) { log(LogLevel::info, line); }

void log_warning(const std::string& line) { log(LogLevel::warning, line); }

}  // namespace firn
