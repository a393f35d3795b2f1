#pragma once

#include <firn/io/shown_text.h>
#include <firn/scene/schema.h>

#include <string>
#include <string_view>
#include <vector>

namespace firn {

/// The shortest decimal text that reads back as the same number.
std::string number_text(double value);

/// "a", "b" or "c" without the "or": in double quotes, joined by commas.
std::string quoted_list(const std::vector<std::string_view>& names);
std::string quoted_list(const std::vector<std::string>& names);

/// A TOML basic string, quotes included; control characters are escaped.
std::string in_quotes(std::string_view text);

/// Whether the text is UTF-8, as TOML and JSON want it: no overlong forms, no surrogates.
bool is_utf8(std::string_view text);

/// A key as TOML wants it: bare if possible, else quoted.
std::string key_text(std::string_view key);

/// The value as TOML for a scene of this dimension.
std::string value_text(const Key& key, const Value& value, int dimension);

}  // namespace firn
