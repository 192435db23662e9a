// Replaces or adds scalars in a YAML text and keeps everything else, lines and comments included. A reader of the text
// with a replaced scalar finds the same mistakes in the same lines.
#pragma once

#include <string>
#include <string_view>

namespace ttf {

// Returns `text` with the scalar at `path` replaced by `value`. `path` leads through mappings and sequences:
// "world.objects[0].speed". Both the old and the new value must be plain scalars; a missing key is not added.
// Throws InputError, which names the file `name`.
std::string with_value(const std::string& text, const std::string& name, std::string_view path, std::string_view value);

// Returns `text` with the key at `path` added, in front of the first key of its mapping: "world.objects[0].speed". The
// mapping is there, without this key. One in braces keeps its line. Elsewhere the key has a new line, and `line` receives
// the old line behind it. Throws InputError for a missing mapping. It names the file `name`.
std::string with_key(const std::string& text, const std::string& name, std::string_view path, std::string_view value,
                     int* line);

}  // namespace ttf
