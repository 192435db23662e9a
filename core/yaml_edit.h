// A YAML text with one scalar of it replaced, and everything else, lines and comments included, as it was: what reads
// it then finds the same mistakes in the same lines.
#pragma once

#include <string>
#include <string_view>

namespace ttf {

// `path` leads through mappings and sequences: "world.objects[0].speed". What stands there must be a plain scalar, and
// so must the value be: nothing is added that was not written down before. Throws InputError, whose file is `name`.
std::string with_value(const std::string& text, const std::string& name, std::string_view path, std::string_view value);

}  // namespace ttf
