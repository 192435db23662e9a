#include "report/drawing/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ttf::report::drawing {

std::string brief(double value) {
  if (!std::isfinite(value)) return "-";
  if (value == 0.0) return "0";
  const int decimals = std::clamp(2 - static_cast<int>(std::floor(std::log10(std::abs(value)))), 0, 12);
  return fmt::format("{:.{}f}", value, decimals);
}

std::string with_interval(double mean, double half_width, bool sign) {
  if (!std::isfinite(mean)) return "-";
  const std::string plus = sign && mean > 0.0 ? "+" : "";
  if (!std::isfinite(half_width)) return plus + brief(mean);
  if (half_width <= 0.0) return plus + brief(mean) + " ± 0";
  const int decimals = std::clamp(1 - static_cast<int>(std::floor(std::log10(half_width))), 0, 12);
  const std::string text = fmt::format("{:.{}f}", mean, decimals);
  if (text.find_first_of("123456789") == text.npos)  // 0 has no sign
    return fmt::format("{:.{}f} ± {:.{}f}", 0.0, decimals, half_width, decimals);
  return fmt::format("{}{} ± {:.{}f}", plus, text, half_width, decimals);
}

std::string_view verdict(double mean, double half_width) {
  if (!std::isfinite(mean) || !std::isfinite(half_width)) return "undecided";
  return mean + half_width < 0.0 ? "less" : mean - half_width > 0.0 ? "more" : "undecided";
}

}  // namespace ttf::report::drawing
