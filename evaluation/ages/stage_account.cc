#include "evaluation/ages/stage_account.h"

#include <algorithm>
#include <string_view>
#include <utility>

namespace ttf::evaluation::ages {
namespace {

using schedules::analysis::AgePath;
using schedules::analysis::Contribution;
using schedules::analysis::Waypoint;

// No measurement is followed longer.
constexpr Duration kLongestWay = Duration::milliseconds(1500);
constexpr std::size_t kImagesRemembered = 64;
// A damaged log may hold any time. Within 36 years of the drive's start, differences fit their type.
constexpr bool possible(TrueTime at) {
  constexpr std::int64_t kFarthest_ns = std::int64_t{1} << 60;
  return at.ns >= -kFarthest_ns && at.ns <= kFarthest_ns;
}

constexpr std::string_view kHeld = "held for order";

// Leaves out waypoints that no stage leads to, such as the start of a task that a list activates at once. The fusion
// stays, because lists may be held for it.
void drop_empty_stages(AgePath& path) {
  std::size_t before = 0;
  std::erase_if(path.waypoints, [&](const Waypoint& point) {
    return point.stages == std::exchange(before, point.stages) && point.kind != Waypoint::Kind::kFused;
  });
}

// Returns the stages between the waypoints, as findings without measurements.
std::vector<StageFinding> stages_of(const AgePath& path, bool held) {
  const std::vector<Contribution>& parts = path.reaches_use ? path.to_use : path.to_fusion;
  std::vector<StageFinding> stages;
  std::size_t first = 0;
  for (std::size_t p = 0; p < path.waypoints.size(); ++p) {
    const Waypoint& point = path.waypoints[p];
    StageFinding& stage = stages.emplace_back();
    stage.age_best = point.best;
    stage.age_worst = held ? point.buffered_worst : point.worst;
    if (stage.age_worst == Duration{}) stage.age_worst.reset();
    if (point.stages == first) {  // between the start of the fusing task and the list's turn
      stage.name = kHeld;
      if (!held) stage.best = stage.worst = Duration{};
      continue;
    }
    stage.best = stage.worst = Duration{};
    for (std::size_t s = first; s < std::min(point.stages, parts.size()); ++s) {
      stage.name += (stage.name.empty() ? "" : ", ") + parts[s].name;
      *stage.best += parts[s].best;
      *stage.worst += parts[s].worst;
    }
    first = point.stages;
  }
  return stages;
}

}  // namespace

void DurationStatistics::add(Duration one) {
  least = count == 0 ? one : std::min(least, one);
  most = count == 0 ? one : std::max(most, one);
  ++count;
  sum += one;
  binned.add(one);
}

bool SensorStages::within() const {
  return std::ranges::all_of(stages, [](const StageFinding& stage) { return stage.beyond == 0; });
}

StageAccount::StageAccount(std::vector<AgePath> paths, bool held, TrueTime from) : held_(held), from_(from) {
  for (AgePath& path : paths) {
    drop_empty_stages(path);
    SensorStages findings{path.sensor, stages_of(path, held), 0, path.reaches_use};
    sensors_.push_back({std::move(path), std::move(findings), {}});
  }
}

StageAccount::Sensor* StageAccount::sensor_of(SensorId id) {
  const auto one = std::ranges::find(sensors_, id, [](const Sensor& sensor) { return sensor.path.sensor; });
  return one != sensors_.end() ? &*one : nullptr;
}

// The first of several equal instants counts.
void StageAccount::pass(Sensor& sensor, Way& way, Kind kind, NodeId node, PduId pdu, TrueTime at) {
  if (!possible(at)) return;
  for (std::size_t p = 0; p < sensor.path.waypoints.size(); ++p) {
    const Waypoint& point = sensor.path.waypoints[p];
    if (point.kind == kind && point.node == node && point.pdu == pdu && !way.at[p]) {
      way.at[p] = at;
      return;
    }
  }
}

void StageAccount::on(const recording::records::Measured& r) {
  Sensor* sensor = sensor_of(r.id.sensor);
  if (sensor == nullptr || !possible(r.stamp.true_time)) return;
  std::erase_if(sensor->ways, [&](const auto& way) { return way.second.measured + kLongestWay < r.stamp.true_time; });
  Way& way = sensor->ways[r.id.sequence];  // a sensor that restarts counts anew
  way = {r.stamp.true_time, {}, false};
  way.at.resize(sensor->path.waypoints.size());
  if (r.stamp.true_time >= from_) ++sensor->findings.measured;
}

void StageAccount::on(const recording::records::ListHop& r) {
  Kind kind{};
  switch (r.hop) {
    case recording::records::Hop::kWritten: kind = Kind::kWritten; break;
    case recording::records::Hop::kReceived: kind = Kind::kReceived; break;
    case recording::records::Hop::kRead: kind = Kind::kRead; break;
    case recording::records::Hop::kSent:
    case recording::records::Hop::kTorn:
    case recording::records::Hop::kOverwritten:
    case recording::records::Hop::kStale:
    case recording::records::Hop::kDiscarded: return;
  }
  const auto on_way = [&](const MeasurementId& id) {
    Sensor* sensor = sensor_of(id.sensor);
    if (sensor == nullptr) return;
    if (const auto way = sensor->ways.find(id.sequence); way != sensor->ways.end())
      pass(*sensor, way->second, kind, r.stamp.node, r.pdu, r.stamp.true_time);
  };
  if (r.sensor != kNoSensor) return on_way({r.sensor, r.sequence});
  if (const auto image = images_.find(r.sequence); image != images_.end())
    for (const MeasurementId& id : image->second.first) on_way(id);
}

void StageAccount::on(const recording::records::ListFused& r) {
  if (r.disposition != recording::records::Disposition::kFused &&
      r.disposition != recording::records::Disposition::kFusedLate)
    return;
  Sensor* sensor = sensor_of(r.id.sensor);
  if (sensor == nullptr) return;
  const auto way = sensor->ways.find(r.id.sequence);
  if (way == sensor->ways.end()) return;
  pass(*sensor, way->second, Kind::kFused, r.stamp.node, kNoPdu, r.stamp.true_time);
  if (!sensor->path.reaches_use) end(*sensor, way->second);
}

void StageAccount::on(const recording::records::ImageWritten& r) {
  Image& image = images_[r.sequence];
  image = {written_++, {}};
  if (images_.size() > kImagesRemembered)
    images_.erase(std::ranges::min_element(images_, {}, [](const auto& one) { return one.second.order; }));
  for (const MeasurementId& id : r.newest) {
    Sensor* sensor = sensor_of(id.sensor);
    if (sensor == nullptr) continue;
    const auto way = sensor->ways.find(id.sequence);
    if (way == sensor->ways.end() || std::exchange(way->second.in_image, true)) continue;
    pass(*sensor, way->second, Kind::kImage, r.stamp.node, kNoPdu, r.stamp.true_time);
    image.first.push_back(id);
  }
}

void StageAccount::on(const recording::records::FeatureUsed& r) {
  const auto image = images_.find(r.image_sequence);
  if (r.stale || image == images_.end()) return;
  std::erase_if(image->second.first, [&](const MeasurementId& id) {
    Sensor* sensor = sensor_of(id.sensor);
    if (sensor->path.waypoints.back().node != r.stamp.node) return false;  // another service
    if (const auto way = sensor->ways.find(id.sequence); way != sensor->ways.end()) {
      pass(*sensor, way->second, Kind::kUsed, r.stamp.node, kNoPdu, r.stamp.true_time);
      end(*sensor, way->second);
    }
    return true;
  });
}

void StageAccount::end(Sensor& sensor, const Way& way) {
  // A damaged log's way may lead far back, or far ahead.
  const auto seen = [&](const std::optional<TrueTime>& at) {
    return at && *at - way.measured <= kLongestWay && way.measured - *at <= kLongestWay;
  };
  if (way.measured < from_ || !std::ranges::all_of(way.at, seen)) return;
  TrueTime before = way.measured;
  for (std::size_t p = 0; p < way.at.size(); ++p) {
    StageFinding& stage = sensor.findings.stages[p];
    const Duration age = *way.at[p] - way.measured;
    stage.had.add(*way.at[p] - before);
    stage.age.add(age);
    if (age < stage.age_best || (stage.age_worst && age > *stage.age_worst)) ++stage.beyond;
    before = *way.at[p];
  }
}

std::vector<SensorStages> StageAccount::finish() {
  std::vector<SensorStages> all;
  for (Sensor& sensor : sensors_) {
    // Without holding, lists are taken in when they are read.
    if (!held_)
      std::erase_if(sensor.findings.stages,
                    [](const StageFinding& stage) { return stage.name == kHeld && stage.had.most == Duration{}; });
    all.push_back(std::move(sensor.findings));
  }
  return all;
}

}  // namespace ttf::evaluation::ages
