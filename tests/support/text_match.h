#pragma once

#include <gtest/gtest.h>

#include <string>

namespace firn::test {

/// True if the whole text matches the regular expression (ECMAScript). Compiled once for all tests, because <regex> in
/// every file of theirs takes the compiler longer than the rest.
testing::AssertionResult matches(const std::string& text, const std::string& pattern);

/// True if the text contains the part.
testing::AssertionResult contains(const std::string& text, const std::string& part);

}  // namespace firn::test
