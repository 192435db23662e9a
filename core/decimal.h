// Exact decimals: a number in a file's unit times a power of ten is a whole number of ours (12.5 ns is 12500
// ps), and back.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/time.h"

namespace ttf {

// Decimal text ("-12.50") times `scale`, 1..10^13, exactly; nothing where it is no plain decimal, has more than 13
// decimals, is not whole, or does not fit.
std::optional<std::int64_t> parse_scaled(std::string_view text, std::int64_t scale);

// "40 ms", "40ms": a plain decimal with ns, us, ms or s, a space between them or none, that is whole nanoseconds.
std::optional<Duration> parse_duration(std::string_view text);

// value / scale as a decimal without trailing zeros; scale is a power of ten up to 10^13. parse_scaled gives the
// value again, whichever it is.
std::string scaled_text(std::int64_t value, std::int64_t scale);

}  // namespace ttf
