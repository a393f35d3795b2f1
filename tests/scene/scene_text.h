#pragma once

#include <firn/core/error.h>
#include <firn/scene/load_scene.h>

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/text_match.h"

namespace firn::test {

/// The smallest valid scene.
inline const std::string kMinimal =
    "end_time = 1\n"                // line 1
    "resolution.cell_size = 0.1\n"  // 2
    "[material.snow]\n"             // 3
    "preset = \"snow\"\n"           // 4
    "[[body]]\n"                    // 5
    "shape = \"sphere\"\n"          // 6
    "radius = 0.5\n"                // 7
    "material = \"snow\"\n";        // 8

/// A scene with kMinimal in the plane: one more line, and a body that has a place there.
inline std::string of_2d(std::string text) {
  return "dimension = 2\n" + text.replace(text.find("sphere"), std::string("sphere").size(), "disk");
}

/// kMinimal with other text in front, at its root.
inline std::string with_root(const std::string& text) { return text + "\n" + kMinimal; }

inline Scene parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return parse_scene(text, "scene.toml", overrides);
}

/// The message of the error that reading the text ends with, "" if there is none; `kind` receives its kind.
inline std::string error_of(const std::string& text, const std::vector<std::string>& overrides = {},
                            ErrorKind* kind = nullptr) {
  try {
    parse(text, overrides);
  } catch (const Error& error) {
    if (kind) *kind = error.kind();
    return error.what();
  }
  return "";
}

}  // namespace firn::test
