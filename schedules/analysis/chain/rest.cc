#include "schedules/analysis/chain/rest.h"

#include <algorithm>
#include <utility>

#include "schedules/analysis/chain/ways.h"
#include "schedules/analysis/clock_bounds.h"
#include "schedules/model/round.h"

namespace ttf::schedules::analysis::chain {

RestOfChain::RestOfChain(const model::Cluster& cluster, std::string name, Path path, std::size_t first)
    : cluster_(cluster), name_(std::move(name)), path_(std::move(path)), first_(first) {}

Duration RestOfChain::behind(GlobalTime start, Duration lasts, bool latest) const {
  const ClockBounds clocks = clock_bounds(cluster_);
  const std::int64_t unsure = clocks.drift_ns(lasts.ns) + model::kGranularity_ns;
  const std::int64_t written = start.ns + std::max<std::int64_t>(0, lasts.ns + (latest ? unsure : -unsure));
  const std::int64_t sum = walk(cluster_, path_, first_ + 1, path_.used, written, latest, false).back() - start.ns;
  const std::int64_t apart = clocks.apart_ns + clocks.drift_ns(sum);
  return {latest ? sum + apart : std::max<std::int64_t>(0, sum - apart)};
}

RestOfChain::PictureAge RestOfChain::picture_at_start() const {
  PictureAge age;
  const std::vector<AgePath> ages = ages_along(cluster_, {path_});
  for (const Waypoint& point : ages.at(0).waypoints)
    if (point.kind == Waypoint::Kind::kRead && point.stages <= first_) age = {point.best, point.worst};
  return age;
}

std::vector<RestOfChain> rests_behind(const model::Cluster& cluster, NodeId node, const model::Task& task) {
  std::vector<RestOfChain> rests;
  for (std::size_t s = 0; s < cluster.sensors.size(); ++s) {
    const auto sensor = static_cast<SensorId>(s);
    for (const std::vector<Reading>& way : ways_to_actuators(cluster, sensor)) {
      if (std::ranges::none_of(way, [&](const Reading& one) { return one.task == &task; })) continue;
      Path path = path_along(cluster, sensor, way);
      // The task's execution is the stage before its list is visible.
      for (const Waypoint& point : path.waypoints)
        if (point.kind == Waypoint::Kind::kWritten && point.node == node && point.stages < path.used &&
            std::ranges::any_of(task.writes, [&](const auto& out) {
              return out.pdu == point.pdu && cluster.pdu(out.pdu).sensor == sensor;
            })) {
          rests.emplace_back(cluster, name_of(cluster, sensor, way), path, point.stages - 1);
          break;
        }
    }
  }
  return rests;
}

}  // namespace ttf::schedules::analysis::chain
