// Numbers of an answer, as people read them.
#pragma once

#include <string>
#include <string_view>

#include "experiments/results/ratio.h"
#include "experiments/results/statistics.h"

namespace ttf::experiments::sweep::answers {

// Returns "+0.0021 +- 0.0004", with two digits for the interval, or "0.02 (0.005 to 0.07)" if it is uneven; "-" without
// a mean. `sign` marks a difference.
std::string interval_text(const results::Interval& interval, bool sign);

// A ratio as a change in per cent: 0.88 is -12.
double in_percent(double ratio);
// Returns a ratio as a change, "-12 % (-16 to -7)"; without an interval "-12 %"; "-" without a value.
std::string percent_text(const results::Ratio& ratio);
// The same behind "less by" or "more by", without a sign: "12 % (7 to 16)".
std::string percent_size(const results::Ratio& ratio);
// Returns the lowest and highest of several estimates, "-54 to -26 %", or one number if they read alike. The larger one has
// two digits or more. `sign` marks differences.
std::string range_text(double low, double high, bool sign, std::string_view unit);

// "less", "more" or "undecided".
std::string_view verdict(const results::Interval& difference);

}  // namespace ttf::experiments::sweep::answers
