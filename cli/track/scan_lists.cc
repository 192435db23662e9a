#include "cli/track/scan_lists.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/decimal.h"
#include "core/errors.h"
#include "fusion/sensors/known_sensor.h"

namespace ttf::cli::track {
namespace {

using sensors::laser::LaserObject;

// Keeps the nearest objects, in their order.
std::size_t keep_nearest(std::vector<LaserObject>& objects, std::size_t most) {
  if (objects.size() <= most) return 0;
  std::vector<double> ranges;
  for (const LaserObject& object : objects) ranges.push_back(std::hypot(object.x, object.y));
  std::vector<double> sorted = ranges;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(most), sorted.end());
  std::vector<LaserObject> kept;
  for (std::size_t i = 0; i < objects.size(); ++i)
    if (ranges[i] < sorted[most]) kept.push_back(objects[i]);
  const std::size_t dropped = objects.size() - kept.size();
  objects = std::move(kept);
  return dropped;
}

// Instants are whole nanoseconds.
void check_frames(const std::vector<recording::rows::RecordedScan>& scans, Duration period, const std::string& name) {
  constexpr std::int64_t kLatest_ns = 4'000'000'000'000'000'000;
  const recording::rows::RecordedScan& last = scans.back();
  if (!last.time_ns && last.frame > kLatest_ns / period.ns)
    throw InputError({name, 0, "frame", std::to_string(last.frame),
                      fmt::format("must be at most {}, {} a frame", kLatest_ns / period.ns,
                                  scaled_text(period.ns, 1'000'000'000) + " s")});
}

}  // namespace

ScanLists lists_of(const std::vector<recording::rows::RecordedScan>& scans,
                   const sensors::laser::RecordedScansConfig& how, const recording::replay::ReplayConfig& config,
                   const std::string& name) {
  check_frames(scans, how.period, name);
  ScanLists lists;
  lists.recorded.sensors.push_back(config.sensors.front().first);
  std::size_t most_returns = 0;
  for (const recording::rows::RecordedScan& scan : scans) most_returns = std::max(most_returns, scan.returns.size());
  sensors::laser::LaserPreprocessor preprocessor(how.preprocessing, most_returns);
  std::vector<sensors::laser::ScanPoint> points;
  std::vector<LaserObject> objects;
  std::uint32_t number = 0;
  for (const recording::rows::RecordedScan& scan : scans) {
    points.clear();
    for (const recording::rows::RecordedReturn& hit : scan.returns) points.push_back({0, hit.azimuth_rad, hit.range_m});
    preprocessor.process(points, objects);
    ScanAccount& account = lists.account;
    ++account.scans;
    account.returns += points.size();
    account.fates += preprocessor.fates();
    account.left_out += keep_nearest(objects, config.tracker.max_observations);
    recording::replay::RecordedList& list = lists.recorded.lists.emplace_back();
    list.id = {SensorId{0}, number++};
    list.measured = list.arrival = sensors::laser::instant_of(scan, how);
    for (const LaserObject& object : objects) {
      list.observations.push_back(sensors::laser::observation_of(object, how));
      fusion::sensors::place(list.observations.back(), SensorId{0}, config.sensors.front().second.known);
    }
  }
  return lists;
}

}  // namespace ttf::cli::track
