#include "recording/rows/scan_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>

#include "core/csv.h"
#include "core/decimal.h"
#include "core/file_bytes.h"
#include "recording/rows/leaping_stamps.h"
#include "recording/rows/seconds.h"

namespace ttf::recording::rows {
namespace scan_file {
namespace {

enum Column : std::size_t { kFrame, kTime, kAzimuth, kRange, kX, kY, kIntensity, kColumns };
struct Allowed {
  std::string_view name;
  double low, high;
  std::string_view unit;
};
constexpr double kFar_m = 1e4, kFarOnAxis_m = 7e3, kTurn_rad = 2.0 * std::numbers::pi;
// By Column. Azimuths have one turn to either side; the other bounds only separate numbers from garbage.
constexpr std::array<Allowed, kColumns> kAllowed{{{"frame", 0, 0, ""},
                                                  {"time", 0, 0, "s"},
                                                  {"azimuth_rad", -kTurn_rad, kTurn_rad, "rad"},
                                                  {"range_m", 0, kFar_m, "m"},
                                                  {"x", -kFarOnAxis_m, kFarOnAxis_m, "m"},
                                                  {"y", -kFarOnAxis_m, kFarOnAxis_m, "m"},
                                                  {"intensity", 0, 1e9, ""}}};
// More than one azimuth in so many beyond a turn is no damage but another unit.
constexpr std::size_t kOneDamagedIn = 20;
constexpr double kLatest_s = 4e9;
constexpr std::int64_t kSecond_frames = 10;  // a usual scanner turns ten times a second

std::string_view trim(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::string shown(std::string_view text) {
  std::string out;
  for (const char c : text.substr(0, 40)) out += c >= ' ' && c <= '~' ? c : '?';
  return text.size() > 40 ? out + "..." : out;
}

std::string range_text(const Allowed& of) { return fmt::format("{:.4g}..{:.4g} {}", of.low, of.high, of.unit); }

class ScanReader {
 public:
  ScanReader(const std::string& name, Findings& findings) : name_(name), findings_(findings) {}

  std::vector<RecordedScan> read(std::string_view text) {
    CsvLines lines(text);
    bool first = true;
    while (lines.next()) {
      line_ = lines.line();
      if (!lines.broken().empty()) {
        fail("", "", std::string(lines.broken()));
      } else if (std::exchange(first, false) && is_heading(lines.fields())) {
        take_heading(lines.fields());
      } else {
        take_row(lines.fields());
      }
    }
    if (rows_ > 0 && beyond_.size() * kOneDamagedIn > rows_)
      throw InputError({name_, beyond_.front().line, "azimuth_rad", beyond_.front().value,
                        fmt::format("must be {}: {} of {} azimuths are beyond a whole turn, so they may be in degrees",
                                    range_text(kAllowed[kAzimuth]), beyond_.size(), rows_)});
    for (Finding& finding : beyond_) findings_.add(std::move(finding));
    if (sound_.empty()) {
      findings_.throw_if_any();
      throw InputError({name_, 0, "", "", "holds no rows; expected frame, azimuth_rad, range_m, intensity"});
    }
    leave_out_leaps();
    return scans();
  }

 private:
  void fail(std::string_view column, std::string_view value, std::string expected) {
    findings_.add({name_, line_, std::string(column), shown(value), std::move(expected)});
  }

  static bool is_heading(const std::vector<std::string>& fields) {
    return std::any_of(fields.begin(), fields.end(), [](const std::string& field) {
      return field == "frame" || field == "time" || field == "azimuth_rad" || field == "range_m";
    });
  }

  // A wrong heading ends the reading: every row would be wrong.
  void take_heading(const std::vector<std::string>& fields) {
    place_.fill(-1);
    width_ = fields.size();
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const auto known = std::find_if(kAllowed.begin(), kAllowed.end(),
                                      [&](const Allowed& column) { return column.name == trim(fields[i]); });
      if (known == kAllowed.end())
        throw InputError({name_, line_, shown(fields[i]), "",
                          "is not a known column: frame, time, azimuth_rad, range_m, x, y, intensity"});
      int& place = place_[static_cast<std::size_t>(known - kAllowed.begin())];
      if (place >= 0) throw InputError({name_, line_, std::string(known->name), "", "must not be given twice"});
      place = static_cast<int>(i);
    }
    const bool polar = has(kAzimuth) && has(kRange), plane = has(kX) && has(kY);
    if (has(kFrame) == has(kTime) || polar == plane || has(kAzimuth) != has(kRange) || has(kX) != has(kY))
      throw InputError({name_, line_, "heading", "",
                        "must have either frame or time, and either azimuth_rad and range_m or x and y"});
  }

  bool has(Column column) const { return place_[column] >= 0; }
  std::string_view text(Column column, const std::vector<std::string>& fields) const {
    return trim(fields[static_cast<std::size_t>(place_[column])]);
  }

  // Returns false, with one finding, if the field is no such number.
  bool number(Column column, const std::vector<std::string>& fields, double& out) {
    if (!has(column)) return true;
    const std::string_view field = text(column, fields);
    const Allowed& allowed = kAllowed[column];
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), out);
    const bool sound = error == std::errc{} && end == field.data() + field.size() && std::isfinite(out);
    if (sound && out >= allowed.low && out <= allowed.high) return true;
    Finding finding{name_, line_, std::string(allowed.name), shown(field),
                    fmt::format("must be a number in {}", range_text(allowed))};
    if (sound && column == kAzimuth)
      beyond_.push_back(std::move(finding));
    else
      findings_.add(std::move(finding));
    return false;
  }

  // Returns the scan's instant or frame, or nothing, with one finding.
  std::optional<std::int64_t> stamp_of(const std::vector<std::string>& fields) {
    const bool timed = has(kTime);
    const std::string_view field = text(timed ? kTime : kFrame, fields);
    if (timed) {
      const std::optional<std::int64_t> time = parse_scaled(field, kNsPerSecond);
      if (time && std::abs(static_cast<double>(*time)) <= kLatest_s * kNsPerSecond) return time;
      fail("time", field, "must be a number in -4e+09..4e+09 s");
      return std::nullopt;
    }
    std::int64_t frame = 0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), frame);
    if (error == std::errc{} && end == field.data() + field.size() && frame >= 0) return frame;
    fail("frame", field, "must be a whole number of at least 0");
    return std::nullopt;
  }

  void take_row(const std::vector<std::string>& fields) {
    ++rows_;
    if (fields.size() != width_)
      return fail("columns", std::to_string(fields.size()),
                  place_ == kUsual ? "must be 4 columns, separated by commas: frame, azimuth_rad, range_m, intensity"
                                   : fmt::format("must be {}, as in the heading", width_));
    RecordedReturn hit;
    double x = 0.0, y = 0.0;
    if (!number(kAzimuth, fields, hit.azimuth_rad) || !number(kRange, fields, hit.range_m) || !number(kX, fields, x) ||
        !number(kY, fields, y) || !number(kIntensity, fields, hit.intensity))
      return;
    if (has(kX)) {
      hit.azimuth_rad = std::atan2(y, x);
      hit.range_m = std::hypot(x, y);
    }
    if (const std::optional<std::int64_t> stamp = stamp_of(fields)) sound_.push_back({*stamp, line_, hit});
  }

  // A scan whose rows all leap is left out, too.
  void leave_out_leaps() {
    const bool timed = has(kTime);
    const auto shown_stamp = [&](std::int64_t stamp) {
      return timed ? scaled_text(stamp, kNsPerSecond) + " s" : std::to_string(stamp);
    };
    std::vector<RowStamps> stamps;
    stamps.reserve(sound_.size());
    for (const SoundRow& row : sound_) stamps.push_back({row.stamp, row.stamp});
    std::vector<bool> leaps(sound_.size(), false);
    for (const Leap& leap : leaping_stamps(stamps, timed ? kNsPerSecond : kSecond_frames)) {
      leaps[leap.row] = true;
      const std::int64_t stamp = sound_[leap.row].stamp;
      findings_.add({name_, sound_[leap.row].line, timed ? "time" : "frame",
                     timed ? scaled_text(stamp, kNsPerSecond) : std::to_string(stamp),
                     fmt::format("must be near the {0}s above and below it, {1} and {2}: a single {0} that leaps is "
                                 "damaged",
                                 timed ? "stamp" : "frame", shown_stamp(leap.above), shown_stamp(leap.below))});
    }
    std::size_t row = 0;
    std::erase_if(sound_, [&](const SoundRow&) { return leaps[row++]; });
  }

  // The sound rows as scans, by stamp.
  std::vector<RecordedScan> scans() {
    std::ranges::stable_sort(sound_, {}, &SoundRow::stamp);
    std::vector<RecordedScan> scans;
    const SoundRow* before = nullptr;
    for (const SoundRow& row : sound_) {
      if (before == nullptr || before->stamp != row.stamp) {
        RecordedScan& scan = scans.emplace_back();
        scan.frame = has(kTime) ? static_cast<std::int64_t>(scans.size()) - 1 : row.stamp;
        if (has(kTime)) scan.time_ns = row.stamp;
      }
      scans.back().returns.push_back(row.hit);
      before = &row;
    }
    return scans;
  }

  struct SoundRow {
    std::int64_t stamp = 0;  // its time [ns] or frame
    int line = 0;
    RecordedReturn hit;
  };
  using Places = std::array<int, kColumns>;
  static constexpr Places kUsual{0, -1, 1, 2, -1, -1, 3};

  const std::string& name_;
  Findings& findings_;
  Places place_ = kUsual;
  std::size_t width_ = 4, rows_ = 0;
  int line_ = 0;
  std::vector<Finding> beyond_;  // azimuths beyond a turn
  std::vector<SoundRow> sound_;
};

}  // namespace
}  // namespace scan_file

std::vector<RecordedScan> parse_lidar_scans(const std::string& text, const std::string& name, Findings& findings) {
  return scan_file::ScanReader(name, findings).read(text);
}

std::vector<RecordedScan> parse_lidar_scans(const std::string& text, const std::string& name) {
  Findings findings;
  std::vector<RecordedScan> scans = parse_lidar_scans(text, name, findings);
  findings.throw_if_any();
  return scans;
}

std::vector<RecordedScan> read_lidar_scans(const std::string& path) { return parse_lidar_scans(read_file(path), path); }
std::vector<RecordedScan> read_lidar_scans(const std::string& path, Findings& findings) {
  return parse_lidar_scans(read_file(path), path, findings);
}

}  // namespace ttf::recording::rows
