#include "recording/rows/laser_radar_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "core/errors.h"
#include "core/file_bytes.h"
#include "recording/mcap/bytes.h"
#include "recording/rows/leaping_stamps.h"

namespace ttf::recording::rows {
namespace {

constexpr std::string_view kBlank = " \t\r";

std::string_view trim(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::vector<std::string_view> split(std::string_view line, char separator) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t end = line.find(separator);
    fields.push_back(trim(line.substr(0, end)));
    if (end == std::string_view::npos) return fields;
    line.remove_prefix(end + 1);
  }
}

// Shortens a broken line for a message, and makes it printable.
std::string shown(std::string_view text) {
  std::string out;
  for (const char c : text.substr(0, 40)) out += c >= ' ' && c <= '~' ? c : '?';
  return text.size() > 40 ? out + "..." : out;
}

struct Column {
  std::string_view name;
  double low, high;
  std::string_view unit;
};

// Reads the numbers of a table's rows by column, with one finding per broken line.
class Rows {
 public:
  Rows(const std::string& name, Findings& findings) : name_(name), findings_(findings) {}

  void at_line(int line) { line_ = line; }
  void fail(std::string_view column, std::string_view value, std::string expected) {
    findings_.add({name_, line_, std::string(column), shown(value), std::move(expected)});
  }

  // Reads the fields as numbers into `out`, one per column. Returns false, with one finding, if one is broken.
  bool numbers(std::span<const std::string_view> fields, std::span<const Column> columns, std::span<double> out) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const std::string_view field = fields[i];
      const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), out[i]);
      const Column& column = columns[i];
      if (error != std::errc{} || end != field.data() + field.size() ||
          !(out[i] >= column.low && out[i] <= column.high)) {
        fail(column.name, field,
             fmt::format("must be a number in {:g}..{:g} {}", column.low, column.high, column.unit));
        return false;
      }
    }
    return true;
  }
  std::optional<std::int64_t> whole(std::string_view column, std::string_view field, std::string_view unit) {
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc{} || end != field.data() + field.size() || value < 0) {
      fail(column, field, fmt::format("must be a whole number of at least 0{}", unit));
      return std::nullopt;
    }
    return value;
  }

 private:
  const std::string& name_;
  Findings& findings_;
  int line_ = 0;
};

template <class Handle> void for_each_line(std::string_view text, Handle&& handle) {
  for (int line = 1; !text.empty(); ++line) {
    const std::size_t end = text.find('\n');
    handle(line, text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
}

// Bounds that only separate numbers from garbage: a road scene is far smaller than 10 km, and turns and speeds
// are lower.
constexpr double kFar = 1e4, kFast = 1e3, kTurns = 100;
constexpr std::array<Column, 2> kLaserColumns{{{"px", -kFar, kFar, "m"}, {"py", -kFar, kFar, "m"}}};
constexpr std::array<Column, 3> kRadarColumns{
    {{"range", 0, kFar, "m"}, {"bearing", -kTurns, kTurns, "rad"}, {"range_rate", -kFast, kFast, "m/s"}}};
constexpr std::array<Column, 6> kTruthColumns{{{"gt_x", -kFar, kFar, "m"},
                                               {"gt_y", -kFar, kFar, "m"},
                                               {"gt_vx", -kFast, kFast, "m/s"},
                                               {"gt_vy", -kFast, kFast, "m/s"},
                                               {"gt_yaw", -kTurns, kTurns, "rad"},
                                               {"gt_yawrate", -kTurns, kTurns, "rad/s"}}};

constexpr std::int64_t kLatest_us = 4'000'000'000'000'000;  // its nanoseconds fit the type

// A row with its truth; both times are the file's own stamp until all rows are known.
struct LaserRadarRow {
  RecordedObservation seen;
  RecordedTruth truth;
};

std::int64_t stamp_of(const LaserRadarRow& row) { return row.seen.time_us_from_start; }

// The rows by time; rows of one time in the order of the file. A stamp that leaps is a finding.
RecordedInput in_time_order(std::vector<LaserRadarRow> rows, const std::string& name, Findings& findings) {
  constexpr std::int64_t kSecond_us = 1'000'000;
  std::vector<RowStamps> stamps;
  for (const LaserRadarRow& row : rows) stamps.push_back({stamp_of(row), stamp_of(row)});
  std::vector<bool> leaps(rows.size(), false);
  for (const Leap& leap : leaping_stamps(stamps, kSecond_us)) {
    leaps[leap.row] = true;
    findings.add({name, rows[leap.row].seen.line, "t_us", std::to_string(stamp_of(rows[leap.row])),
                  fmt::format("must be near the stamps above and below it, {} us and {} us: a single stamp that leaps "
                              "is damaged",
                              leap.above, leap.below)});
  }
  std::vector<LaserRadarRow> kept;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (!leaps[i]) kept.push_back(std::move(rows[i]));
  std::stable_sort(kept.begin(), kept.end(),
                   [](const LaserRadarRow& a, const LaserRadarRow& b) { return stamp_of(a) < stamp_of(b); });
  RecordedInput input;
  input.name = name;
  if (!kept.empty()) input.first_time_us = stamp_of(kept.front());
  for (LaserRadarRow& row : kept) {
    row.seen.time_us_from_start -= input.first_time_us;
    row.truth.time_us_from_start = row.seen.time_us_from_start;
    input.observations.push_back(std::move(row.seen));
    input.truth.push_back(row.truth);
  }
  return input;
}

}  // namespace

RecordedInput parse_laser_radar(const std::string& text, const std::string& name, Findings& findings) {
  Rows table(name, findings);
  std::vector<LaserRadarRow> rows;
  for_each_line(text, [&](int line, std::string_view raw) {
    if (trim(raw).empty() || trim(raw).front() == '#') return;
    table.at_line(line);
    const std::vector<std::string_view> fields = split(raw, '\t');
    const bool laser = fields[0] == "L";
    if (!laser && fields[0] != "R") return table.fail("sensor", fields[0], "must be L (laser) or R (radar)");
    const std::size_t values = laser ? 2 : 3, columns = values + 8;
    if (fields.size() != columns)
      return table.fail("columns", std::to_string(fields.size()),
                        fmt::format("must be {} columns, separated by tabs, in a row of {}", columns, fields[0]));

    std::array<double, 3> seen{};
    std::array<double, 6> truth{};
    const std::span<const std::string_view> all(fields);
    const std::span<const Column> seen_columns =
        laser ? std::span<const Column>(kLaserColumns) : std::span<const Column>(kRadarColumns);
    if (!table.numbers(all.subspan(1), seen_columns, seen)) return;
    const std::optional<std::int64_t> time = table.whole("t_us", fields[values + 1], " us");
    if (!time || !table.numbers(all.subspan(values + 2), kTruthColumns, truth)) return;
    if (*time > kLatest_us)
      return table.fail("t_us", fields[values + 1], fmt::format("must be at most {} us", kLatest_us));

    LaserRadarRow& row = rows.emplace_back();
    RecordedObservation& out = row.seen;
    out.line = line;
    out.time_us_from_start = *time;
    out.sensor = laser ? "laser" : "radar";
    if (laser) {
      out.kind = RecordedObservation::Kind::kPosition;
      out.x = seen[0];
      out.y = seen[1];
    } else {
      out.kind = RecordedObservation::Kind::kRangeBearingRate;
      out.range = seen[0];
      out.bearing = seen[1];
      out.range_rate = seen[2];
    }
    row.truth = {*time, truth[0], truth[1], truth[2], truth[3], truth[4], truth[5]};
  });
  RecordedInput input = in_time_order(std::move(rows), name, findings);
  if (input.observations.empty()) {
    findings.throw_if_any();
    throw InputError({name, 0, "", "", "holds no rows; expected rows that begin with L or R"});
  }
  return input;
}

RecordedInput parse_laser_radar(const std::string& text, const std::string& name) {
  Findings findings;
  RecordedInput input = parse_laser_radar(text, name, findings);
  findings.throw_if_any();
  return input;
}

RecordedInput read_laser_radar(const std::string& path) { return parse_laser_radar(read_file(path), path); }
RecordedInput read_laser_radar(const std::string& path, Findings& findings) {
  return parse_laser_radar(read_file(path), path, findings);
}

RecordingFormat sniff_recording(const std::string& path) {
  return sniff_recording(read_file(path, kRecordingHead), path);
}

RecordingFormat sniff_recording(std::string_view text, const std::string& name) {
  if (text.substr(0, mcap::kMcapMagic.size()) == mcap::kMcapMagic) return RecordingFormat::kLog;
  std::optional<RecordingFormat> format;
  bool decided = false;
  for_each_line(text, [&](int, std::string_view raw) {
    const std::string_view row = trim(raw);
    if (decided || row.empty()) return;
    const bool comment = row.front() == '#';
    const std::string_view words = comment ? trim(row.substr(1)) : row;
    if (words.substr(0, 5) == "frame" || (!comment && words.find(',') != std::string_view::npos))
      format = RecordingFormat::kLidarScans;
    else if (!comment && (words.substr(0, 2) == "L\t" || words.substr(0, 2) == "R\t"))
      format = RecordingFormat::kLaserRadar;
    decided = !comment || format.has_value();
  });
  if (!format)
    throw InputError(
        {name, 0, "", "",
         "is not a known recording: expected rows of L or R (laser and radar), of frame, azimuth_rad, range_m, "
         "intensity (scanner), or an MCAP log"});
  return *format;
}

}  // namespace ttf::recording::rows
