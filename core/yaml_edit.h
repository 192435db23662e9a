// Replaces or adds scalars in a YAML text and keeps everything else, lines and comments included. A reader of the text
// with a replaced scalar finds the same mistakes in the same lines.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ttf {

// Returns `text` with the scalar at `path` replaced by `value`. `path` leads through mappings and sequences:
// "world.objects[0].speed". Both the old and the new value must be plain scalars; a missing key is not added.
// Throws InputError, which names the file `name`.
std::string with_value(const std::string& text, const std::string& name, std::string_view path, std::string_view value);

struct NewKey {
  std::string path;  // "world.objects[0].speed": its mapping is there, without this key
  std::string value;
};

// Returns `text` with the keys added, in front of the first key of their mappings and in this order. A mapping in braces
// keeps its line. Elsewhere a key has a new line, and `lines` receives the old line behind it. Throws InputError for a
// missing mapping. It names the file `name`.
std::string with_keys(const std::string& text, const std::string& name, const std::vector<NewKey>& keys,
                      std::vector<int>* lines = nullptr);

}  // namespace ttf
