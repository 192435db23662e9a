// Puts YAML texts together: each text changes the one before it, as a JSON merge patch does (RFC 7396, section 2).
//
//   A mapping changes the mapping of the same key, key by key. `~` removes a key. Anything else, a list too, takes the
//   place of what was there.
//
// Two rules go beyond RFC 7396, where mappings have no order. A key keeps its place. A new key goes behind the key that
// is before it in its own text. The first one goes in front of the next key that both have, or to the end. And a `~` must have something to remove.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/text_place.h"

namespace ttf {

struct YamlLayer {
  std::string text;
  std::string name;  // the file, for messages
};

struct MergedYaml {
  std::string text;  // one document without comments
  TextOrigins origins;
};

// Merges the layers, the lowest first; at least one. The result has no key `left_out` at the top level. Mappings that only
// one layer has keep their style, so that a line is from one file alone. Throws InputError with all findings. These are
// about texts that are no mapping, keys that are not plain or given twice, and `~` without a key. Aliases must not make a
// text endless or huge.
MergedYaml merge_yaml(const std::vector<YamlLayer>& layers, std::string_view left_out);

// Returns the text as a YAML scalar, in quotes where it needs them.
std::string yaml_scalar(const std::string& text);

}  // namespace ttf
