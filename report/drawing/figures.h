// Figures as people read them.
#pragma once

#include <string>
#include <string_view>

namespace ttf::report::drawing {

// Three significant digits, "-" for what is not finite.
std::string brief(double value);
// "0.0123 ± 0.0004": as many digits as the interval has two of; without one, brief(). `sign`: of a difference.
std::string with_interval(double mean, double half_width, bool sign = false);
// How a difference with an interval stands to 0: "less", "more" or "undecided".
std::string_view verdict(double mean, double half_width);

}  // namespace ttf::report::drawing
