#pragma once

#include <string>

#include "verification_scenes/check.h"

namespace firn::test {

/// The page that shows the results.
std::string page_path();

/// What stands between a check's markers: its table, and its gates with what the control came to.
std::string block_of(const Check& check, const Outcome& outcome, const Outcome& control);

/// `page` with the lines between `<!-- begin <name> -->` and `<!-- end <name> -->` replaced. Throws
/// std::runtime_error if either marker is missing.
std::string with_block(const std::string& page, const std::string& name, const std::string& block);

}  // namespace firn::test
