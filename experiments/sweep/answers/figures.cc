#include "experiments/sweep/answers/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/results/percent.h"

namespace ttf::experiments::sweep::answers {

std::string interval_text(const results::Interval& interval, bool sign) {
  if (std::isnan(interval.mean)) return "-";
  const double width = std::isnan(interval.half_width) ? std::abs(interval.mean) * 1e-3 : interval.half_width;
  const int decimals =
      width > 0.0 && std::isfinite(width) ? std::clamp(1 - static_cast<int>(std::floor(std::log10(width))), 0, 9) : 3;
  std::string text = results::plain_number(interval.mean, decimals, sign);
  if (interval.uneven())
    text += fmt::format(" ({} to {})", results::plain_number(interval.low(), decimals, sign),
                        results::plain_number(interval.high(), decimals, sign));
  else if (!std::isnan(interval.half_width))
    text += fmt::format(" +- {:.{}f}", interval.half_width, decimals);
  return text;
}

double in_percent(double ratio) { return 100.0 * (ratio - 1.0); }

std::string percent_text(const results::Ratio& ratio) {
  return results::percent_words(in_percent(ratio.value), in_percent(ratio.low), in_percent(ratio.high), true);
}

std::string percent_size(const results::Ratio& ratio) {
  if (ratio.value >= 1.0)
    return results::percent_words(in_percent(ratio.value), in_percent(ratio.low), in_percent(ratio.high), false);
  return results::percent_words(-in_percent(ratio.value), -in_percent(ratio.high), -in_percent(ratio.low), false);
}

std::string range_text(double low, double high, bool sign, std::string_view unit) {
  const double most = std::max(std::abs(low), std::abs(high));
  const int decimals =
      most > 0.0 && std::isfinite(most) ? std::clamp(1 - static_cast<int>(std::floor(std::log10(most))), 0, 9) : 0;
  const std::string first = results::plain_number(low, decimals, sign),
                    last = results::plain_number(high, decimals, sign), behind = unit.empty() ? "" : " ";
  return (first == last ? first : fmt::format("{} to {}", first, last)) + behind + std::string(unit);
}

std::string_view verdict(const results::Interval& difference) {
  return difference.below(0.0) ? "less" : difference.above(0.0) ? "more" : "undecided";
}

}  // namespace ttf::experiments::sweep::answers
