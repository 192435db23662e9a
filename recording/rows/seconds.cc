#include "recording/rows/seconds.h"

#include <charconv>
#include <cmath>

#include "core/decimal.h"

namespace ttf::recording::rows {

std::optional<std::int64_t> nanoseconds_of(std::string_view text) {
  std::optional<std::int64_t> exact = parse_scaled(text, kNsPerSecond);
  if (!exact) {
    double seconds = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
    if (error != std::errc{} || end != text.data() + text.size() || !(std::abs(seconds) <= 4e9)) return std::nullopt;
    exact = std::llround(seconds * 1e9);
  }
  if (*exact < -kLatest || *exact > kLatest) return std::nullopt;
  return exact;
}

}  // namespace ttf::recording::rows
