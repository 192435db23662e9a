// Options with a decimal number.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/strict_yaml.h"

namespace ttf::cli {

// Returns the number in units of 1 / scale, exactly: "2.5" with a scale of 10^6 is 2'500'000. Throws
// InputError with the option and the range for an invalid or excessive number.
std::int64_t decimal_option(const char* option, const std::string& text, std::int64_t scale,
                            Range<std::int64_t> allowed, std::string_view unit);

// Returns --time-scale in parts per million (schedules/check/real_time_rules.h).
std::int64_t time_scale_option(const std::string& text);

}  // namespace ttf::cli
