#include "recording/rows/observation_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <string_view>

#include "core/csv.h"
#include "core/decimal.h"
#include "core/file_bytes.h"
#include "recording/rows/leaping_stamps.h"
#include "recording/rows/seconds.h"

namespace ttf::recording::rows {
namespace {

struct NumberColumn {
  std::string_view name;
  double low, high;
  std::string_view unit;
};

// Bounds that separate numbers from garbage, and keep the filters' arithmetic within the reach of doubles.
constexpr double kAway = 1e7, kCovariance = 1e8, kAngle = 100, kSide = 1e3;
// In the order of kNumberColumns.
enum NumberIndex : std::size_t {
  kX,
  kY,
  kRange,
  kBearing,
  kRangeRate,
  kCov11,
  kCov12,
  kCov22,
  kCov13,
  kCov23,
  kCov33,
  kHeading,
  kSigmaHeading,
  kLength,
  kSigmaLength,
  kWidth,
  kSigmaWidth,
  kZ,
  kHeight,
  kScore,
  kTruthX,
  kTruthY,
  kTruthVx,
  kTruthVy,
  kNumbers
};
constexpr std::array<NumberColumn, kNumbers> kNumberColumns{{
    {"x", -kAway, kAway, " m"},
    {"y", -kAway, kAway, " m"},
    {"range", 1e-3, kAway, " m"},
    {"bearing", -kAngle, kAngle, " rad"},
    {"range_rate", -1e4, 1e4, " m/s"},
    {"cov_11", 1e-8, kCovariance, ""},
    {"cov_12", -kCovariance, kCovariance, ""},
    {"cov_22", 1e-8, kCovariance, ""},
    {"cov_13", -kCovariance, kCovariance, ""},
    {"cov_23", -kCovariance, kCovariance, ""},
    {"cov_33", 1e-8, kCovariance, ""},
    {"heading", -kAngle, kAngle, " rad"},
    {"sigma_heading", 1e-4, 10, " rad"},
    {"length", 1e-3, kSide, " m"},
    {"sigma_length", 1e-3, kSide, " m"},
    {"width", 1e-3, kSide, " m"},
    {"sigma_width", 1e-3, kSide, " m"},
    {"z", -kAway, kAway, " m"},
    {"height", 0, kSide, " m"},
    {"score", 0, 1e6, ""},
    {"gt_x", -kAway, kAway, " m"},
    {"gt_y", -kAway, kAway, " m"},
    {"gt_vx", -1e4, 1e4, " m/s"},
    {"gt_vy", -1e4, 1e4, " m/s"},
}};
enum TextIndex : std::size_t { kTime, kArrival, kSensor, kClass, kTruthObject, kTexts };
constexpr std::array<std::string_view, kTexts> kTextColumns{"time", "arrival", "sensor", "class", "gt_object"};

constexpr std::int64_t kLongestWay = 3600 * kNsPerSecond;
constexpr std::size_t kLongestName = 40;

// The heading's columns, counted from 0; absent columns have no value.
struct Heading {
  std::array<std::optional<std::size_t>, kNumbers> number;
  std::array<std::optional<std::size_t>, kTexts> text;
  std::size_t columns = 0;
};

Heading heading_of(const CsvLines& lines, const std::string& name) {
  Findings findings;
  Heading heading;
  heading.columns = lines.fields().size();
  if (!lines.broken().empty()) throw InputError({name, lines.line(), "heading", "", std::string(lines.broken())});
  for (std::size_t i = 0; i < heading.columns; ++i) {
    const std::string& field = lines.fields()[i];
    const auto number = std::find_if(kNumberColumns.begin(), kNumberColumns.end(),
                                     [&](const NumberColumn& column) { return column.name == field; });
    const auto text = std::find(kTextColumns.begin(), kTextColumns.end(), field);
    std::optional<std::size_t>* place = nullptr;
    if (number != kNumberColumns.end())
      place = &heading.number[static_cast<std::size_t>(number - kNumberColumns.begin())];
    else if (text != kTextColumns.end())
      place = &heading.text[static_cast<std::size_t>(text - kTextColumns.begin())];
    else if (field.substr(0, 3) != "gt_")
      findings.add({name, lines.line(), "column", field, "is not known (docs/use/track.md lists the columns)"});
    if (place == nullptr) continue;
    if (*place) findings.add({name, lines.line(), "column", field, "occurs twice"});
    *place = i;
  }
  const auto missing = [&](std::string_view column, std::string_view why) {
    findings.add({name, lines.line(), std::string(column), "", fmt::format("is missing: {}", why)});
  };
  for (const TextIndex needed : {kTime, kSensor})
    if (!heading.text[needed]) missing(kTextColumns[needed], "must be a column of the heading");
  if (!(heading.number[kX] && heading.number[kY]) && !(heading.number[kRange] && heading.number[kBearing]))
    missing("x", "columns x and y, or range and bearing, must be there");
  findings.throw_if_any();
  // Without a true position, columns of truth say nothing.
  if (!heading.number[kTruthX] || !heading.number[kTruthY]) {
    for (const NumberIndex column : {kTruthX, kTruthY, kTruthVx, kTruthVy}) heading.number[column].reset();
    heading.text[kTruthObject].reset();
  }
  return heading;
}

bool is_name(std::string_view text) {
  return !text.empty() && text.size() <= kLongestName &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

// Reads one line as a row. Its first error is its finding.
class RowReader {
 public:
  RowReader(const Heading& heading, const std::string& name, Findings& findings)
      : heading_(heading), name_(name), findings_(findings) {}

  std::optional<ObservationRow> read(const CsvLines& lines) {
    fields_ = &lines.fields();
    row_ = {};
    row_.line = lines.line();
    if (!lines.broken().empty()) {
      fail("line", fields_->back(), std::string(lines.broken()));
    } else if (fields_->size() != heading_.columns) {
      fail("columns", std::to_string(fields_->size()), fmt::format("must be {}, as in the heading", heading_.columns));
    } else if (numbers() && measurement() && covariance() && names() && truth() && times()) {
      rest();
      return row_;
    }
    return std::nullopt;
  }

 private:
  bool fail(std::string_view column, std::string_view value, std::string expected) {
    findings_.add({name_, row_.line, std::string(column), std::string(value), std::move(expected)});
    return false;
  }
  std::string_view text(TextIndex column) const {
    return heading_.text[column] ? std::string_view((*fields_)[*heading_.text[column]]) : std::string_view();
  }
  // Returns the text in a column of numbers, for a message.
  std::string_view shown_in(NumberIndex column) const {
    return heading_.number[column] ? std::string_view((*fields_)[*heading_.number[column]]) : std::string_view();
  }

  bool numbers() {
    for (std::size_t i = 0; i < kNumbers; ++i) {
      value_[i].reset();
      const std::string_view field = shown_in(static_cast<NumberIndex>(i));
      if (field.empty()) continue;
      const NumberColumn& column = kNumberColumns[i];
      double value = 0;
      const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
      if (error != std::errc{} || end != field.data() + field.size() || !(value >= column.low && value <= column.high))
        return fail(column.name, field,
                    fmt::format("must be a number in {:g}..{:g}{}", column.low, column.high, column.unit));
      value_[i] = value;
    }
    return true;
  }

  // Checks that either both are given or neither is.
  bool both(NumberIndex there, NumberIndex needed) {
    if (value_[there].has_value() == value_[needed].has_value()) return true;
    const NumberIndex absent = value_[there] ? needed : there, given = value_[there] ? there : needed;
    return fail(kNumberColumns[absent].name, "", fmt::format("must be given where {} is", kNumberColumns[given].name));
  }
  bool absent(NumberIndex column, std::string_view where) {
    if (!value_[column]) return true;
    return fail(kNumberColumns[column].name, shown_in(column), fmt::format("must be empty {}", where));
  }

  bool measurement() {
    if (value_[kX] || value_[kY]) {
      row_.kind = ObservationRow::Kind::kPosition;
      for (const NumberIndex other : {kRange, kBearing, kRangeRate})
        if (!absent(other, "where x and y are given")) return false;
      if (!both(kX, kY)) return false;
      row_.z = {*value_[kX], *value_[kY], 0.0};
      return true;
    }
    if (!value_[kRange] && !value_[kBearing]) return fail("x", "", "must be given with y, or range with bearing");
    if (!both(kRange, kBearing)) return false;
    row_.kind = value_[kRangeRate] ? ObservationRow::Kind::kRangeBearingRate : ObservationRow::Kind::kRangeBearing;
    row_.z = {*value_[kRange], *value_[kBearing], value_[kRangeRate].value_or(0.0)};
    return true;
  }

  bool covariance() {
    const bool three = dimension_of(row_.kind) == 3;
    if (!three)
      for (const NumberIndex other : {kCov13, kCov23, kCov33})
        if (!absent(other, "where two numbers were measured")) return false;
    bool any = false;
    for (std::size_t i = kCov11; i <= kCov33; ++i) any = any || value_[i].has_value();
    if (!any) return true;
    if (row_.kind == ObservationRow::Kind::kRangeBearing &&
        !absent(kCov12, "where only range and bearing were measured: their errors are taken as independent"))
      return false;
    for (const NumberIndex diagonal : {kCov11, kCov22, kCov33})
      if (!value_[diagonal] && (three || diagonal != kCov33))
        return fail(kNumberColumns[diagonal].name, "", "must be given where another part of the covariance is");
    // With a larger variance a bearing does not help a position (fusion/sensors/converted_position.h).
    constexpr double kLargestBearingVariance = 0.25;  // [rad^2]
    if (row_.kind == ObservationRow::Kind::kRangeBearing && *value_[kCov22] > kLargestBearingVariance)
      return fail("cov_22", fmt::format("{}", *value_[kCov22]),
                  "must be at most 0.25 rad^2 where only range and bearing were measured");
    row_.covariance.emplace();
    for (std::size_t i = 0; i < 6; ++i) (*row_.covariance)[i] = value_[kCov11 + i].value_or(0.0);
    return true;
  }

  bool names() {
    const std::string allowed = fmt::format("must be a name of 1..{} printable ASCII characters", kLongestName);
    if (!is_name(text(kSensor))) return fail("sensor", text(kSensor), allowed);
    if (!text(kClass).empty() && !is_name(text(kClass))) return fail("class", text(kClass), allowed);
    if (value_[kScore] && text(kClass).empty()) return absent(kScore, "where no class is given");
    row_.sensor = text(kSensor);
    row_.class_name = text(kClass);
    return true;
  }

  bool truth() {
    if (!both(kTruthX, kTruthY) || !both(kTruthVx, kTruthVy)) return false;
    if (!value_[kTruthX]) return absent(kTruthVx, "where gt_x and gt_y are not given");
    if (!text(kTruthObject).empty() && !is_name(text(kTruthObject)))
      return fail("gt_object", text(kTruthObject),
                  fmt::format("must be a name of 1..{} printable ASCII characters", kLongestName));
    row_.truth = {std::string(text(kTruthObject)), *value_[kTruthX], *value_[kTruthY], std::nullopt};
    if (value_[kTruthVx]) row_.truth->velocity = {*value_[kTruthVx], *value_[kTruthVy]};
    return true;
  }

  bool times() {
    const std::optional<std::int64_t> time = nanoseconds_of(text(kTime));
    if (!time) return fail("time", text(kTime), "must be a number in -4e+09..4e+09 s");
    row_.time_ns = row_.arrival_ns = *time;
    if (text(kArrival).empty()) return true;
    const std::optional<std::int64_t> arrival = nanoseconds_of(text(kArrival));
    if (!arrival || *arrival < *time || *arrival > *time + kLongestWay)
      return fail("arrival", text(kArrival),
                  fmt::format("must be a number in {}..{} s, from the measurement to an hour after it",
                              scaled_text(*time, kNsPerSecond), scaled_text(*time + kLongestWay, kNsPerSecond)));
    row_.arrival_ns = *arrival;
    return true;
  }

  void rest() {
    row_.heading = value_[kHeading];
    row_.sigma_heading = value_[kSigmaHeading];
    row_.length = value_[kLength];
    row_.sigma_length = value_[kSigmaLength];
    row_.width = value_[kWidth];
    row_.sigma_width = value_[kSigmaWidth];
    row_.elevation = value_[kZ];
    row_.height = value_[kHeight];
    row_.score = value_[kScore].value_or(1.0);
  }

  const Heading& heading_;
  const std::string& name_;
  Findings& findings_;
  const std::vector<std::string>* fields_ = nullptr;
  std::array<std::optional<double>, kNumbers> value_;
  ObservationRow row_;
};

// Leaves out the rows whose stamps leap among those of their sensor, each with a finding.
void leave_out_leaps(std::vector<ObservationRow>& rows, const std::string& name, Findings& findings) {
  std::map<std::string, std::vector<std::size_t>> of_sensor;
  for (std::size_t i = 0; i < rows.size(); ++i) of_sensor[rows[i].sensor].push_back(i);
  std::map<std::size_t, Leap> leaps;  // by row
  for (const auto& [sensor, places] : of_sensor) {
    std::vector<RowStamps> stamps;
    for (const std::size_t i : places) stamps.push_back({rows[i].time_ns, rows[i].arrival_ns});
    for (const Leap& leap : leaping_stamps(stamps, kNsPerSecond)) leaps.emplace(places[leap.row], leap);
  }
  if (leaps.empty()) return;
  for (const auto& [i, leap] : leaps)
    findings.add(
        {name, rows[i].line, "time", scaled_text(rows[i].time_ns, kNsPerSecond),
         fmt::format("must be near the stamps of {} above and below it, {} s and {} s: a single stamp that "
                     "leaps is damaged",
                     rows[i].sensor, scaled_text(leap.above, kNsPerSecond), scaled_text(leap.below, kNsPerSecond))});
  std::vector<ObservationRow> kept;
  kept.reserve(rows.size() - leaps.size());
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (!leaps.contains(i)) kept.push_back(std::move(rows[i]));
  rows = std::move(kept);
}

}  // namespace

std::vector<ObservationRow> parse_observation_rows(const std::string& text, const std::string& name,
                                                   Findings& findings) {
  CsvLines lines(text);
  if (!lines.next()) throw InputError({name, 0, "", "", "holds no heading; expected one with time, sensor, x, y"});
  const Heading heading = heading_of(lines, name);
  RowReader reader(heading, name, findings);
  std::vector<ObservationRow> rows;
  bool any = false;
  while (lines.next()) {
    any = true;
    if (std::optional<ObservationRow> row = reader.read(lines)) rows.push_back(std::move(*row));
  }
  if (!any) throw InputError({name, 0, "", "", "holds no row below its heading"});
  leave_out_leaps(rows, name, findings);
  return rows;
}

std::vector<ObservationRow> read_observation_rows(const std::string& path, Findings& findings) {
  return parse_observation_rows(read_file(path), path, findings);
}

std::vector<ObservationRow> observation_rows_of(const RecordedInput& input, const std::string& name) {
  constexpr std::int64_t kLatestUs = kLatest / 1000;
  std::vector<ObservationRow> rows;
  for (std::size_t i = 0; i < input.observations.size(); ++i) {
    const RecordedObservation& seen = input.observations[i];
    const std::int64_t at = input.first_time_us + seen.time_us_from_start;
    if (at > kLatestUs)
      throw InputError({name, seen.line, "t_us", std::to_string(at), fmt::format("must be at most {} us", kLatestUs)});
    ObservationRow& row = rows.emplace_back();
    row.line = seen.line;
    row.time_ns = row.arrival_ns = at * 1000;
    row.sensor = seen.sensor;
    if (i < input.truth.size()) {
      const RecordedTruth& truth = input.truth[i];
      row.truth = {"", truth.x, truth.y, std::array{truth.vx, truth.vy}};
    }
    if (seen.kind == RecordedObservation::Kind::kPosition) {
      row.z = {seen.x, seen.y, 0.0};
    } else {
      if (seen.range < kNumberColumns[kRange].low)
        throw InputError({name, seen.line, "range", fmt::format("{:g}", seen.range),
                          fmt::format("must be at least {:g} m", kNumberColumns[kRange].low)});
      row.kind = ObservationRow::Kind::kRangeBearingRate;
      row.z = {seen.range, seen.bearing, seen.range_rate};
    }
  }
  return rows;
}

}  // namespace ttf::recording::rows
