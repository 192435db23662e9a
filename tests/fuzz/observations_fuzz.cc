// Any text as recorded observations. Laws: each broken line gives one finding with the file's name. Accepted
// rows are within their bounds, in order of their sensor's time, and the same when written and read again.
// Every list made of them has a covariance and arrives no sooner than it is measured. The resulting tracks
// are finite.
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/check.h"
#include "core/csv.h"
#include "core/decimal.h"
#include "recording/replay/recorded_lists.h"
#include "recording/replay/replay.h"
#include "recording/replay/sensor_timing.h"
#include "recording/rows/observation_rows.h"
#include "tests/fuzz/harness.h"

namespace {

using namespace ttf;
using recording::rows::ObservationRow;

constexpr char kFile[] = "o.csv";

std::string cell(const std::optional<double>& value) { return value ? fmt::to_string(*value) : ""; }

std::string written(const std::vector<ObservationRow>& rows) {
  std::string text =
      "time,arrival,sensor,x,y,range,bearing,range_rate,cov_11,cov_12,cov_22,cov_13,cov_23,cov_33,heading,sigma_"
      "heading,"
      "length,sigma_length,width,sigma_width,z,height,class,score\n";
  for (const ObservationRow& row : rows) {
    const bool position = row.kind == ObservationRow::Kind::kPosition;
    const bool three = recording::rows::dimension_of(row.kind) == 3;
    text += scaled_text(row.time_ns, 1'000'000'000) + ',' + scaled_text(row.arrival_ns, 1'000'000'000) + ',' +
            csv_field(row.sensor) + ',';
    text += position ? fmt::format("{},{},,,", row.z[0], row.z[1]) : fmt::format(",,{},{},", row.z[0], row.z[1]);
    text += three ? fmt::to_string(row.z[2]) : "";
    for (std::size_t i = 0; i < 6; ++i) {
      // With only range and bearing measured, the off-diagonal is absent.
      const bool given = row.covariance && (three || i == 0 || i == 2 || (i == 1 && position));
      text += ',' + (given ? fmt::to_string((*row.covariance)[i]) : "");
    }
    for (const auto& value : {row.heading, row.sigma_heading, row.length, row.sigma_length, row.width, row.sigma_width,
                              row.elevation, row.height})
      text += ',' + cell(value);
    text += ',' + csv_field(row.class_name) + ',' + (row.class_name.empty() ? "" : fmt::to_string(row.score)) + '\n';
  }
  return text;
}

void check_rows(const std::vector<ObservationRow>& rows) {
  for (const ObservationRow& row : rows) {
    TTF_CHECK(row.line > 1 && !row.sensor.empty() && row.arrival_ns >= row.time_ns, "line {}", row.line);
    for (const double value : row.z) TTF_CHECK(std::abs(value) <= 1e7, "line {}: {}", row.line, value);
    TTF_CHECK(row.score >= 0.0 && row.score <= 1e6, "line {}: score {}", row.line, row.score);
  }
}

void check_tracks(const std::vector<ObservationRow>& rows) {
  recording::replay::ReplayConfig config;
  config.tracker.history_scans = 8;  // little to set up, and soon too old
  recording::replay::RecordedLists arrivals;
  Findings findings;
  if (!fuzz::accepted(kFile, [&] {
        recording::replay::list_sensors(config, rows, {}, kFile);
        arrivals = recording::replay::recorded_lists_of(rows, config, kFile, findings);
        findings.throw_if_any();
      }))
    return;
  for (const recording::replay::RecordedList& list : arrivals.lists)
    TTF_CHECK(list.arrival >= list.measured && !list.observations.empty(), "list of {} ns", list.measured.ns);
  for (const auto strategy : {fusion::strategies::StrategyKind::kAdva, fusion::strategies::StrategyKind::kBuff}) {
    std::uint64_t fates = 0;
    const recording::replay::ReplaySetup setup{strategy, config.tracker,
                                               recording::replay::sensor_timings(arrivals, config, strategy), true};
    const recording::replay::ReplayAccount account =
        recording::replay::replay(arrivals, setup, [](GlobalTime, std::span<const fusion::tracks::TrackView> tracks) {
          for (const fusion::tracks::TrackView& track : tracks)
            TTF_CHECK(track.state.allFinite() && track.covariance.allFinite() && std::isfinite(track.heading),
                      "track {} at {} ns", index_of(track.id), track.valid_at.ns);
        });
    for (const recording::replay::SensorAccount& one : account.sensors)
      fates += one.in_order + one.late + one.too_old + one.duplicates;
    TTF_CHECK(fates == arrivals.lists.size(), "{} fates of {} lists", fates, arrivals.lists.size());
  }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text = fuzz::text_of(data, size);
  std::vector<ObservationRow> rows;
  Findings findings;
  if (!fuzz::accepted(kFile, [&] { rows = recording::rows::parse_observation_rows(text, kFile, findings); })) return 0;
  if (!findings.empty()) fuzz::check_refusal(InputError(findings.list()), kFile);
  check_rows(rows);
  if (rows.empty()) return 0;
  const std::string once = written(rows);
  Findings again;
  TTF_CHECK(written(recording::rows::parse_observation_rows(once, kFile, again)) == once && again.empty(),
            "rows change when written again: {}", again.empty() ? once : again.list().front().sentence());
  check_tracks(rows);
  return 0;
}
