// Any text as a recording. Laws: each broken line gives one finding with file and column. Times never
// decrease. Rows written again are read the same. A scan stays finite through laser preprocessing.
#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "core/check.h"
#include "recording/rows/laser_radar_file.h"
#include "sensors/laser/preprocessor.h"
#include "sensors/recorded/recorded.h"
#include "tests/fuzz/harness.h"

namespace {

using namespace ttf;
using recording::rows::RecordedObservation;

constexpr char kFile[] = "rows.txt";

std::string written(const recording::rows::RecordedInput& input) {
  std::string text;
  for (std::size_t i = 0; i < input.observations.size(); ++i) {
    const RecordedObservation& o = input.observations[i];
    const recording::rows::RecordedTruth& t = input.truth[i];
    text += o.kind == RecordedObservation::Kind::kPosition
                ? fmt::format("L\t{}\t{}", o.x, o.y)
                : fmt::format("R\t{}\t{}\t{}", o.range, o.bearing, o.range_rate);
    text += fmt::format("\t{}\t{}\t{}\t{}\t{}\t{}\t{}\n", input.first_time_us + o.time_us_from_start, t.x, t.y, t.vx,
                        t.vy, t.yaw, t.yaw_rate);
  }
  return text;
}

void check_laser_radar(const std::string& text) {
  recording::rows::RecordedInput input;
  if (!fuzz::accepted(kFile, [&] { input = recording::rows::parse_laser_radar(text, kFile); })) return;
  TTF_CHECK(!input.observations.empty() && input.observations.size() == input.truth.size(), "{} rows, {} truths",
            input.observations.size(), input.truth.size());
  std::int64_t last = 0;
  for (std::size_t i = 0; i < input.observations.size(); ++i) {
    const std::int64_t at = input.observations[i].time_us_from_start;
    TTF_CHECK(at >= last && at == input.truth[i].time_us_from_start, "row {} at {} us", i, at);
    last = at;
  }
  const std::string once = written(input);
  TTF_CHECK(written(recording::rows::parse_laser_radar(once, kFile)) == once, "rows change when written again");

  const sensors::recorded::RecordedScene scene(input, TrueTime{});
  std::vector<sim::world::ObjectState> states;
  for (const Duration at : {Duration{-1}, Duration{}, Duration::milliseconds(50), Duration::milliseconds(3'600'000)}) {
    scene.states_at(TrueTime{} + at, states);
    const bool recorded = at.ns >= 0 && (at.ns + 999) / 1000 <= input.truth.back().time_us_from_start;
    TTF_CHECK(states.size() == (recorded ? 1u : 0u), "{} states", states.size());
    TTF_CHECK(!recorded || (std::isfinite(states[0].x) && std::isfinite(states[0].y) && std::isfinite(states[0].speed)),
              "at {} ns", at.ns);
  }
}

void check_scans(const std::string& text) {
  std::vector<recording::rows::RecordedScan> scans;
  if (!fuzz::accepted(kFile, [&] { scans = recording::rows::parse_lidar_scans(text, kFile); })) return;
  TTF_CHECK(!scans.empty(), "no scan");
  std::string once;
  const recording::rows::RecordedScan* before = nullptr;
  for (const recording::rows::RecordedScan& scan : scans) {
    TTF_CHECK(!scan.returns.empty() && (before == nullptr || before->frame < scan.frame), "scan {}", scan.frame);
    before = &scan;
    std::vector<sensors::laser::ScanPoint> points;
    for (const recording::rows::RecordedReturn& hit : scan.returns) {
      once += fmt::format("{},{},{},{}\n", scan.frame, hit.azimuth_rad, hit.range_m, hit.intensity);
      points.push_back({0, hit.azimuth_rad, hit.range_m});
    }
    std::vector<sensors::laser::LaserObject> objects;
    sensors::laser::LaserPreprocessor(sensors::laser::LaserPreprocessingConfig{}, points.size())
        .process(points, objects);
    for (const sensors::laser::LaserObject& o : objects)
      TTF_CHECK(std::isfinite(o.x) && std::isfinite(o.y) && std::isfinite(o.heading) && std::isfinite(o.length) &&
                    std::isfinite(o.width) && o.sxx > 0 && o.syy > 0 && o.sxy * o.sxy < o.sxx * o.syy,
                "x {} y {} heading {} length {} width {} covariance {} {} {}", o.x, o.y, o.heading, o.length, o.width,
                o.sxx, o.sxy, o.syy);
  }
  std::string twice;
  for (const recording::rows::RecordedScan& scan : recording::rows::parse_lidar_scans(once, kFile))
    for (const recording::rows::RecordedReturn& hit : scan.returns)
      twice += fmt::format("{},{},{},{}\n", scan.frame, hit.azimuth_rad, hit.range_m, hit.intensity);
  TTF_CHECK(once == twice, "rows change when written again");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text = fuzz::text_of(data, size);
  fuzz::accepted(kFile, [&] { recording::rows::sniff_recording(text, kFile); });
  check_laser_radar(text);
  check_scans(text);
  return 0;
}
