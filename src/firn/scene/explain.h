#pragma once

#include <firn/scene/schema.h>

#include <string>
#include <string_view>

/// Texts for people and editors, all derived from the schema and the materials' declarations.
namespace firn {

/// Help for a key ("material.snow.density", "density"), a section ("material"), a model or a preset ("snow"); for ""
/// the list of all keys. Ends with a newline. Throws Error(usage), with the nearest name, if there is no such thing.
std::string explain(std::string_view what);

/// JSON Schema (draft-07) of scene files, for editors that check TOML. Ends with a newline.
std::string scene_json_schema();

/// Markdown page with every key, model and preset. Ends with a newline.
std::string scene_reference();

/// "required", the default value as TOML, or how the default is found.
std::string default_words(const Section& section, const Key& key);
/// "[[body]]", "[material.<name>]", "top of the file".
std::string header_words(const Section& section);

}  // namespace firn
