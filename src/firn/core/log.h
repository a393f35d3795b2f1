#pragma once

#include <functional>
#include <string>

namespace firn {

enum class LogLevel { info, warning };

using LogSink = std::function<void(LogLevel, const std::string&)>;

/// Replaces where log lines go and returns the sink before. The library never writes to stdout or stderr unless the
/// program installs a sink that does; without one, lines are dropped.
LogSink set_log_sink(LogSink sink);

/// One line, no trailing newline. Safe to call from any thread.
void log_info(const std::string& line);
void log_warning(const std::string& line);

}  // namespace firn
