#include "cli/decimal_option.h"

#include <fmt/format.h>

#include "core/decimal.h"
#include "core/errors.h"
#include "schedules/check/real_time_rules.h"

namespace ttf::cli {

std::int64_t decimal_option(const char* option, const std::string& text, std::int64_t scale,
                            Range<std::int64_t> allowed, std::string_view unit) {
  const auto value = parse_scaled(text, scale);
  if (!value || !allowed.contains(*value))
    throw InputError({"command line", 0, option, text,
                      fmt::format("must be a decimal number {}..{}{}", scaled_text(allowed.low, scale),
                                  scaled_text(allowed.high, scale), unit)});
  return *value;
}

std::int64_t time_scale_option(const std::string& text) {
  return decimal_option("--time-scale", text, schedules::check::kTimeScaleOne,
                        {schedules::check::kSmallestTimeScale, schedules::check::kLargestTimeScale}, "");
}

}  // namespace ttf::cli
