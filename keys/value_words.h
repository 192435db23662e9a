// The values of a key, in words.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "keys/outline.h"

namespace ttf::keys {

// "number 0..100 m/s", "`cold` or `integrated`"; with `mark` around words and names of keys.
std::string value_words(const Key& key, const std::string& mark);
// As in YAML. Nothing if the loader has no default, or one out of its own range.
std::optional<std::string> default_text(const Key& key);
// "required", "required without `like`" where that may be, "default `3`", "optional".
std::string need_words(const Key& key, bool may_be_alike, const std::string& mark);
std::string duration_text(std::int64_t ns);

}  // namespace ttf::keys
