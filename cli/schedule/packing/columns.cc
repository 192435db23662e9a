#include "cli/schedule/packing/columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "core/decimal.h"

namespace ttf::cli::schedule::packing {
namespace {

constexpr std::int64_t kNsPerMs = 1'000'000;

}  // namespace

Rows::Rows(std::string_view text, const std::string& name, const std::vector<Column>& needed)
    : lines_(text), name_(name) {
  if (!lines_.next())
    throw InputError({name, 0, "heading", "", "is missing: must name the columns (docs/schedules/packing.md)"});
  if (!lines_.broken().empty()) throw InputError({name, lines_.line(), "heading", "", std::string(lines_.broken())});
  Findings findings;
  columns_ = lines_.fields().size();
  for (std::size_t i = 0; i < columns_; ++i) {
    const std::string& field = lines_.fields()[i];
    const auto known = std::find(kColumnNames.begin(), kColumnNames.end(), field);
    if (known == kColumnNames.end()) {
      findings.add({name, line(), "column", field, fmt::format("must be one of {}", fmt::join(kColumnNames, ", "))});
      continue;
    }
    auto& at = at_[static_cast<std::size_t>(known - kColumnNames.begin())];
    if (at) findings.add({name, line(), "column", field, "occurs twice"});
    at = i;
  }
  for (const Column column : needed)
    if (!at_[column])
      findings.add(
          {name, line(), std::string(kColumnNames[column]), "", "is missing: must be a column of the heading"});
  findings.throw_if_any();
}

bool Rows::next(Findings& findings) {
  while (lines_.next()) {
    if (!lines_.broken().empty())
      findings.add({name_, line(), "line", "", std::string(lines_.broken())});
    else if (lines_.fields().size() != columns_)
      findings.add({name_, line(), "line", fmt::format("{} fields", lines_.fields().size()),
                    fmt::format("must have {}, as the heading", columns_)});
    else
      return true;
  }
  return false;
}

const std::string& Rows::text(Column column) const {
  static const std::string kAbsent;
  return at_[column] ? lines_.fields()[*at_[column]] : kAbsent;
}

Finding Rows::finding(Column column, std::string expected) const {
  return {name_, line(), std::string(kColumnNames[column]), text(column), std::move(expected)};
}

std::optional<int> Rows::whole(Column column, Range<int> allowed, Findings& findings) const {
  const std::string& field = text(column);
  int value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error == std::errc{} && end == field.data() + field.size() && allowed.contains(value)) return value;
  findings.add(finding(column, fmt::format("must be a whole number {}..{}", allowed.low, allowed.high)));
  return std::nullopt;
}

std::optional<Duration> Rows::milliseconds(Column column, Range<Duration> allowed, std::optional<Duration> empty,
                                           Findings& findings) const {
  if (empty && text(column).empty()) return empty;
  const auto ns = parse_scaled(text(column), kNsPerMs);
  if (ns && allowed.contains(Duration{*ns})) return Duration{*ns};
  findings.add(finding(column, fmt::format("must be a decimal number {}..{} ms", scaled_text(allowed.low.ns, kNsPerMs),
                                           scaled_text(allowed.high.ns, kNsPerMs))));
  return std::nullopt;
}

}  // namespace ttf::cli::schedule::packing
