#pragma once

#include <firn/render/image.h>

#include <string>

namespace firn::test {

/// A picture of the test window against the one in tests/viewer/pictures/NAME.png, which was looked at, and as a
/// negative control against another one. The panel, which tells times, is left out. To renew it:
/// FIRN_TEST_PICTURES=tests/viewer/pictures, and look.
void expect_as_reference(const std::string& name, const Image& picture, const Image& other);

}  // namespace firn::test
