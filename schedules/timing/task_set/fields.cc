#include "schedules/timing/task_set/fields.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "core/check.h"
#include "core/decimal.h"
#include "core/nearest.h"

namespace ttf::schedules::timing::task_set {

std::string duration_words(Duration time) {
  constexpr std::pair<std::int64_t, std::string_view> kUnits[] = {
      {1'000'000'000, "s"}, {1'000'000, "ms"}, {1'000, "us"}};
  for (const auto& [length, unit] : kUnits)
    if (time.ns != 0 && time.ns % length == 0) return fmt::format("{} {}", time.ns / length, unit);
  return fmt::format("{} ns", time.ns);
}

Fields::Fields(const std::string& file, int line, std::vector<std::string> fields,
               std::span<const std::string_view> columns, Findings& findings)
    : file_(file), line_(line), fields_(std::move(fields)), columns_(columns), findings_(findings) {
  if (fields_.size() > columns_.size())
    findings_.add({file_, line_, "columns", std::to_string(fields_.size()),
                   fmt::format("must be at most {}: {}", columns_.size(), fmt::join(columns_, ", "))});
  fields_.resize(columns_.size());
}

const std::string& Fields::text(std::string_view column) const {
  const auto found = std::ranges::find(columns_, column);
  TTF_CHECK(found != columns_.end(), "no column {}", column);
  return fields_[static_cast<std::size_t>(found - columns_.begin())];
}

std::string Fields::name() {
  constexpr std::size_t kLongestName = 60;
  const std::string& name = text("name");
  const bool plain = std::ranges::all_of(name, [](char c) { return c >= ' ' && c <= '~' && c != '>'; });
  if (name.empty() || name.size() > kLongestName || !plain)
    fail("name", fmt::format("must be 1..{} printable ASCII characters without >", kLongestName));
  return name;
}

std::optional<Duration> Fields::duration(std::string_view column, Range<Duration> allowed) {
  if (is_blank(column)) return std::nullopt;
  const std::optional<Duration> value = parse_duration(text(column));
  if (value && allowed.contains(*value)) return value;
  fail(column, fmt::format("must be a time with its unit (ns, us, ms or s), {}..{}", duration_words(allowed.low),
                           duration_words(allowed.high)));
  return allowed.low;
}

Duration Fields::needed_duration(std::string_view column, Range<Duration> allowed) {
  if (const std::optional<Duration> value = duration(column, allowed)) return *value;
  fail(column, fmt::format("is missing: must be a time with its unit, {}..{}", duration_words(allowed.low),
                           duration_words(allowed.high)));
  return allowed.low;
}

std::optional<std::int64_t> Fields::integer(std::string_view column, Range<std::int64_t> allowed,
                                            std::string_view unit) {
  if (is_blank(column)) return std::nullopt;
  const std::optional<std::int64_t> value = parse_scaled(text(column), 1);
  if (value && allowed.contains(*value)) return value;
  fail(column,
       fmt::format("must be a whole number {}..{}{}{}", allowed.low, allowed.high, unit.empty() ? "" : " ", unit));
  return allowed.low;
}

std::size_t Fields::choice(std::string_view column, const std::vector<std::string_view>& words) {
  const auto found = std::ranges::find(words, text(column));
  if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  const std::string meant = did_you_mean(text(column), {words.begin(), words.end()});
  fail(column,
       fmt::format("{}must be one of {}{}", is_blank(column) ? "is missing: " : "", fmt::join(words, ", "), meant));
  return 0;
}

void Fields::must_be_blank(std::string_view column, std::string_view why) {
  if (!is_blank(column)) fail(column, fmt::format("must be blank: {}", why));
}

void Fields::fail(std::string_view column, std::string expected) {
  const std::string& name = text("name");
  const std::string key = name.empty() || column == "name" ? std::string(column) : fmt::format("{}.{}", name, column);
  findings_.add({file_, line_, key, text(column), std::move(expected)});
}

}  // namespace ttf::schedules::timing::task_set
