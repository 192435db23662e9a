// Exact decimals: convert a number in a file's unit to a whole number in a smaller unit, and back (12.5 ns is
// 12500 ps).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/time.h"

namespace ttf {

// Returns decimal text ("-12.50") times `scale` (1..10^13), exactly. Returns nullopt when the text is no plain
// decimal, has more than 13 decimals, or the product is not whole or does not fit.
std::optional<std::int64_t> parse_scaled(std::string_view text, std::int64_t scale);

// Parses "40 ms" or "40ms": a plain decimal and ns, us, ms or s, with at most one space between. Returns nullopt
// unless it is a whole number of nanoseconds.
std::optional<Duration> parse_duration(std::string_view text);

// Returns "40 ms": whole milliseconds, or else microseconds or nanoseconds. parse_duration reads it.
std::string duration_text(Duration time);

// Returns value / scale as a decimal without trailing zeros; scale is a power of ten up to 10^13. parse_scaled
// returns every such value unchanged.
std::string scaled_text(std::int64_t value, std::int64_t scale);

}  // namespace ttf
