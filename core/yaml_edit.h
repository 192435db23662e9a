// Replaces one scalar of a YAML text and keeps everything else, lines and comments included. A reader of the
// result finds the same mistakes in the same lines.
#pragma once

#include <string>
#include <string_view>

namespace ttf {

// Returns `text` with the scalar at `path` replaced by `value`. `path` leads through mappings and sequences:
// "world.objects[0].speed". Both the old and the new value must be plain scalars; a missing key is not added.
// Throws InputError, which names the file `name`.
std::string with_value(const std::string& text, const std::string& name, std::string_view path, std::string_view value);

}  // namespace ttf
