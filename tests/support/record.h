#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <string>

namespace firn::test {

/// Keeps a measured number: printed in the test's output, and a property of the test in its XML report.
inline void record(const std::string& name, double value) {
  const std::string text = fmt::format("{:.3g}", value);
  testing::Test::RecordProperty(name, text);
  std::printf("[ measured ] %s = %s\n", name.c_str(), text.c_str());
}

}  // namespace firn::test
