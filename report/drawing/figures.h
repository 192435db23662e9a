// Numbers as people read them.
#pragma once

#include <string>
#include <string_view>

namespace ttf::report::drawing {

// Returns three significant digits, or "-" for a value that is not finite.
std::string brief(double value);
// Returns "0.0123 ± 0.0004", with two digits for the interval; without an interval, as brief(). `sign` marks
// a difference.
std::string with_interval(double mean, double half_width, bool sign = false);
// Compares a difference with 0 by its interval: "less", "more" or "undecided".
std::string_view verdict(double mean, double half_width);

}  // namespace ttf::report::drawing
