#include "experiments/sweep/answers/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ttf::experiments::sweep::answers {
namespace {

double percent(double ratio) { return 100.0 * (ratio - 1.0); }

// Decimals that show a width with one digit, or two from 10 on.
int decimals_for(double width) {
  return width > 1e-4 && std::isfinite(width) ? std::clamp(-static_cast<int>(std::floor(std::log10(width))), 0, 4) : 1;
}

// Returns 0 without a sign.
std::string signed_number(double value, int decimals) {
  std::string text = fmt::format("{:+.{}f}", value, decimals);
  return text.find_first_of("123456789") == std::string::npos ? text.substr(1) : text;
}

// The interval's ends, in this order, as numbers in per cent.
std::string change_text(double value, double from, double to, bool sign) {
  if (std::isnan(value)) return "-";
  const double width = std::isnan(from) ? std::abs(value) * 0.1 : 0.5 * std::abs(to - from);
  const int decimals = decimals_for(width);
  const auto number = [&](double x) { return sign ? signed_number(x, decimals) : fmt::format("{:.{}f}", x, decimals); };
  return number(value) + " %" + (std::isnan(from) ? "" : fmt::format(" ({} to {})", number(from), number(to)));
}

}  // namespace

std::string interval_text(const results::Interval& interval, bool sign) {
  if (std::isnan(interval.mean)) return "-";
  const double width = std::isnan(interval.half_width) ? std::abs(interval.mean) * 1e-3 : interval.half_width;
  const int decimals =
      width > 0.0 && std::isfinite(width) ? std::clamp(1 - static_cast<int>(std::floor(std::log10(width))), 0, 9) : 3;
  std::string text =
      sign ? fmt::format("{:+.{}f}", interval.mean, decimals) : fmt::format("{:.{}f}", interval.mean, decimals);
  if (!std::isnan(interval.half_width)) text += fmt::format(" +- {:.{}f}", interval.half_width, decimals);
  return text;
}

std::string percent_text(const results::Ratio& ratio) {
  return change_text(percent(ratio.value), percent(ratio.low), percent(ratio.high), true);
}

std::string percent_size(const results::Ratio& ratio) {
  if (ratio.value >= 1.0) return change_text(percent(ratio.value), percent(ratio.low), percent(ratio.high), false);
  return change_text(-percent(ratio.value), -percent(ratio.high), -percent(ratio.low), false);
}

std::string percent_range(double low, double high) {
  const double a = percent(low), b = percent(high);
  const double most = std::max(std::abs(a), std::abs(b));
  const int decimals = most >= 10.0 ? 0 : most >= 1.0 ? 1 : 2;
  const std::string first = signed_number(a, decimals), last = signed_number(b, decimals);
  return first == last ? first + " %" : fmt::format("{} to {} %", first, last);
}

std::string_view verdict(const results::Interval& difference) {
  return difference.below(0.0) ? "less" : difference.above(0.0) ? "more" : "undecided";
}

}  // namespace ttf::experiments::sweep::answers
