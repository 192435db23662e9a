#include "experiments/results/percent.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ttf::experiments::results {
namespace {

constexpr int kMostDecimals = 6;

// Decimals that show a width with one digit, or two from 10 on.
int decimals_for(double width) {
  return width > 1e-4 && std::isfinite(width) ? std::clamp(-static_cast<int>(std::floor(std::log10(width))), 0, 4) : 1;
}

bool is_zero(const std::string& number) { return number.find_first_of("123456789") == std::string::npos; }

}  // namespace

std::string plain_number(double value, int decimals, bool sign) {
  std::string text = sign ? fmt::format("{:+.{}f}", value, decimals) : fmt::format("{:.{}f}", value, decimals);
  if (std::isfinite(value) && is_zero(text) && (text.front() == '+' || text.front() == '-')) text.erase(0, 1);
  return text;
}

std::string percent_words(double value, double low, double high, bool sign) {
  if (std::isnan(value)) return "-";
  if (std::isnan(low)) return plain_number(value, decimals_for(std::abs(value) * 0.1), sign) + " %";
  int decimals = decimals_for(0.5 * std::abs(high - low));
  const double nearest = low > 0.0 ? low : high < 0.0 ? high : 0.0;  // an interval that excludes 0 shows it
  if (nearest != 0.0)
    while (decimals < kMostDecimals && is_zero(plain_number(nearest, decimals, false))) ++decimals;
  return fmt::format("{} % ({} to {})", plain_number(value, decimals, sign), plain_number(low, decimals, sign),
                     plain_number(high, decimals, sign));
}

std::string_view interaction_columns(bool by_ratio) {
  return by_ratio ? "changes as shares of the values before, and the ratio of their factors"
                  : "changes as differences, and their difference";
}

}  // namespace ttf::experiments::results
