// The name that a mistyped one was probably meant to be.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ttf {

// Returns how many letters must be added, left out, replaced, or exchanged with the next one, to make `b` of `a`. No letter
// is edited twice. These are the four mistakes of F. J. Damerau, A technique for computer detection and correction of
// spelling errors, 1964.
std::size_t edit_distance(std::string_view a, std::string_view b);

// Returns the name with the least distance, the first of equals. A name is near if at most a third of the letters differ, or
// one of two. It is also near if `typed` abbreviates it.
std::optional<std::string> nearest(std::string_view typed, const std::vector<std::string>& names);

// Returns "; did you mean laser?", or an empty text.
std::string did_you_mean(std::string_view typed, const std::vector<std::string>& names);

}  // namespace ttf
