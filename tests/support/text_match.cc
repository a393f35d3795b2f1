#include "support/text_match.h"

#include <regex>

namespace firn::test {

testing::AssertionResult matches(const std::string& text, const std::string& pattern) {
  if (std::regex_match(text, std::regex(pattern))) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "\n  text:    " << text << "\n  pattern: " << pattern;
}

testing::AssertionResult contains(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "\n  text: " << text << "\n  lacks: " << part;
}

}  // namespace firn::test
