#include "core/decimal.h"

#include <fmt/format.h>

#include <utility>

#include "core/int128.h"

namespace ttf {

std::optional<std::int64_t> parse_scaled(std::string_view text, std::int64_t scale) {
  const bool negative = text.starts_with('-');
  if (negative) text.remove_prefix(1);
  Int128 digits = 0;
  std::int64_t denominator = 1;
  bool after_point = false, any = false;
  for (const char c : text) {
    if (c == '.' && !after_point) {
      after_point = true;
      continue;
    }
    if (c < '0' || c > '9' || digits > (static_cast<Int128>(1) << 62) || denominator > 1'000'000'000'000)
      return std::nullopt;
    digits = digits * 10 + (c - '0');
    if (after_point) denominator *= 10;
    any = true;
  }
  const Int128 scaled = digits * scale;
  if (!any || scaled % denominator != 0) return std::nullopt;
  const Int128 value = negative ? -(scaled / denominator) : scaled / denominator;
  if (value < INT64_MIN || value > INT64_MAX) return std::nullopt;
  return static_cast<std::int64_t>(value);
}

std::string duration_text(Duration time) {
  if (time.ns % 1'000'000 == 0) return fmt::format("{} ms", time.ns / 1'000'000);
  if (time.ns % 1'000 == 0) return fmt::format("{} us", time.ns / 1'000);
  return fmt::format("{} ns", time.ns);
}

std::string scaled_text(std::int64_t value, std::int64_t scale) {
  const bool negative = value < 0;
  Int128 rest = negative ? -static_cast<Int128>(value) : static_cast<Int128>(value);
  std::string text = negative ? "-" : "";
  text += std::to_string(static_cast<std::uint64_t>(rest / scale));
  rest %= scale;
  if (rest != 0) text += '.';
  for (std::int64_t place = scale / 10; rest != 0; place /= 10) {
    text += static_cast<char>('0' + static_cast<int>(rest / place));
    rest %= place;
  }
  return text;
}

std::optional<Duration> parse_duration(std::string_view text) {
  constexpr std::pair<std::string_view, std::int64_t> kUnits[] = {
      {"ns", 1}, {"us", 1'000}, {"ms", 1'000'000}, {"s", 1'000'000'000}};  // "s" last: the others end in s
  for (const auto& [unit, ns] : kUnits) {
    if (!text.ends_with(unit)) continue;
    text.remove_suffix(unit.size());
    if (text.ends_with(' ')) text.remove_suffix(1);
    const auto value = parse_scaled(text, ns);
    return value ? std::optional(Duration{*value}) : std::nullopt;
  }
  return std::nullopt;
}

}  // namespace ttf
