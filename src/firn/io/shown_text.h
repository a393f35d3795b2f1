#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace firn {

/// What a terminal would obey instead of showing it.
inline bool is_control(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte < 32 || byte == 127;
}

/// Text that a file, a scene or a command line gave, as it can stand in a one-line message.
inline std::string one_line(std::string_view text) {
  std::string line(text);
  std::ranges::replace_if(line, is_control, '?');
  return line;
}

/// Its beginning.
inline std::string shown_text(std::string_view text) {
  constexpr std::size_t kMost = 40;
  const std::string result = one_line(text.substr(0, kMost));
  return text.size() > kMost ? result + "..." : result;
}

}  // namespace firn
