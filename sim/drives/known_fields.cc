#include "sim/drives/known_fields.h"

#include "nodes/fusion/fusion_host.h"
#include "sim/drives/step_catalog.h"

namespace ttf::sim::drives {

fusion::config::TrackerConfig tracker_of(const Scenario& scenario, const schedules::model::Cluster& cluster) {
  fusion::config::TrackerConfig tracker = nodes::fusion::tracker_in(cluster, scenario.tracker, scenario.file);
  if (sensors::recorded::is_recorded(cluster)) return tracker;
  tracker.sensors.resize(cluster.sensors.size());
  for (std::size_t s = 0; s < cluster.sensors.size(); ++s) {
    fusion::sensors::KnownSensor& known = tracker.sensors[s];
    const schedules::model::Sensor& sensor = cluster.sensors[s];
    if (!known.field || !scenario.sensors.enabled(sensor)) known.field = scenario.sensors.field_of(sensor);
    known.resolution = scenario.sensors.resolution(sensor);
    if (known.range_rate_span == fusion::sensors::Field::kUnbounded)
      known.range_rate_span = scenario.sensors.rate_span(sensor).value_or(fusion::sensors::Field::kUnbounded);
  }
  return tracker;
}

}  // namespace ttf::sim::drives
