#include "recording/rows/ego_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <span>
#include <string_view>

#include "core/csv.h"
#include "core/file_bytes.h"
#include "recording/rows/seconds.h"

namespace ttf::recording::rows {
namespace {

struct EgoColumn {
  std::string_view name;
  double most;
  std::string_view unit;
};
constexpr std::array<EgoColumn, 3> kPose{{{"x", 1e7, " m"}, {"y", 1e7, " m"}, {"heading", 1e6, " rad"}}};
constexpr std::array<EgoColumn, 2> kOdometry{{{"speed", 200.0, " m/s"}, {"yaw_rate", 20.0, " rad/s"}}};

// The columns' places in a line; the first is that of the time.
struct EgoHeading {
  std::span<const EgoColumn> columns;
  std::array<std::size_t, 4> place{};
  std::size_t width = 0;
};

EgoHeading ego_heading_of(const CsvLines& lines, const std::string& name) {
  if (!lines.broken().empty()) throw InputError({name, lines.line(), "heading", "", std::string(lines.broken())});
  const std::vector<std::string>& fields = lines.fields();
  const auto has = [&](std::string_view column) {
    return std::find(fields.begin(), fields.end(), column) != fields.end();
  };
  EgoHeading heading;
  heading.columns =
      has("speed") || has("yaw_rate") ? std::span<const EgoColumn>(kOdometry) : std::span<const EgoColumn>(kPose);
  heading.width = fields.size();
  std::vector<std::string_view> wanted{"time"};
  for (const EgoColumn& column : heading.columns) wanted.push_back(column.name);
  if (fields.size() != wanted.size() || !std::all_of(wanted.begin(), wanted.end(), has))
    throw InputError(
        {name, lines.line(), "heading", "", "must be time, x, y, heading or time, speed, yaw_rate, in any order"});
  for (std::size_t i = 0; i < wanted.size(); ++i)
    heading.place[i] = static_cast<std::size_t>(std::find(fields.begin(), fields.end(), wanted[i]) - fields.begin());
  return heading;
}

std::optional<EgoRow> ego_row_of(const CsvLines& lines, const EgoHeading& heading, const std::string& name,
                                 Findings& findings) {
  EgoRow row{.line = lines.line()};
  const auto fail = [&](std::string_view column, std::string_view value, std::string expected) {
    findings.add({name, row.line, std::string(column), std::string(value), std::move(expected)});
    return std::nullopt;
  };
  if (!lines.broken().empty()) return fail("line", lines.fields().back(), std::string(lines.broken()));
  if (lines.fields().size() != heading.width)
    return fail("columns", std::to_string(lines.fields().size()),
                fmt::format("must be {}, as in the heading", heading.width));
  const std::string& time = lines.fields()[heading.place[0]];
  const std::optional<std::int64_t> at = nanoseconds_of(time);
  if (!at) return fail("time", time, "must be a number in -4e+09..4e+09 s");
  row.time_ns = *at;
  for (std::size_t i = 0; i < heading.columns.size(); ++i) {
    const EgoColumn& column = heading.columns[i];
    const std::string& field = lines.fields()[heading.place[i + 1]];
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), row.value[i]);
    if (error != std::errc{} || end != field.data() + field.size() ||
        !(row.value[i] >= -column.most && row.value[i] <= column.most))
      return fail(column.name, field,
                  fmt::format("must be a number in {:g}..{:g}{}", -column.most, column.most, column.unit));
  }
  return row;
}

}  // namespace

EgoRows parse_ego_rows(const std::string& text, const std::string& name) {
  CsvLines lines(text);
  if (!lines.next())
    throw InputError({name, 0, "", "", "holds no heading; expected time, x, y, heading or time, speed, yaw_rate"});
  const EgoHeading heading = ego_heading_of(lines, name);
  EgoRows ego{.poses = heading.columns.size() == kPose.size(), .rows = {}};
  Findings findings;
  while (lines.next())
    if (const std::optional<EgoRow> row = ego_row_of(lines, heading, name, findings)) ego.rows.push_back(*row);
  findings.throw_if_any();
  if (ego.rows.empty()) throw InputError({name, 0, "", "", "holds no row below its heading"});
  std::stable_sort(ego.rows.begin(), ego.rows.end(),
                   [](const EgoRow& a, const EgoRow& b) { return a.time_ns < b.time_ns; });
  for (std::size_t i = 1; i < ego.rows.size(); ++i)
    if (ego.rows[i].time_ns == ego.rows[i - 1].time_ns)
      findings.add(
          {name, ego.rows[i].line, "time", "", fmt::format("must not be that of line {}, too", ego.rows[i - 1].line)});
  findings.throw_if_any();
  return ego;
}

EgoRows read_ego_rows(const std::string& path) { return parse_ego_rows(read_file(path), path); }

}  // namespace ttf::recording::rows
