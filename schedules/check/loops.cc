// The checker's rules about sensors that follow their hosts: the loop is closed, and shorter than `longest`.
#include <fmt/format.h>

#include "schedules/analysis/sensor_loop.h"
#include "schedules/check/checker.h"

namespace ttf::schedules::check {

void check_loops(const model::Cluster& cluster, ClusterFindings& findings) {
  const bool sound = findings.size() == 0;  // loop times are only valid after all other rules
  for (std::size_t s = 0; s < cluster.sensors.size(); ++s) {
    const model::Sensor& sensor = cluster.sensors[s];
    if (!sensor.follows()) continue;
    const std::string path = "sensors." + sensor.name;
    const auto loop = analysis::loop_of(cluster, static_cast<SensorId>(s));
    if (!loop || loop->raw->medium.is_flexray()) {
      findings.parameter(path + ".after", sensor.after,
                         fmt::format("must be a task of {}, activated by a list over a CAN from the measuring task of "
                                     "{} and followed by no other task",
                                     cluster.node(sensor.host).name, cluster.node(sensor.device).name));
      continue;
    }
    const auto longest = sound ? longest_round(cluster, *loop) : std::nullopt;
    if (longest && sensor.longest < *longest)
      findings.parameter(path + ".longest_period", ms(sensor.longest),
                         fmt::format("must be at least {}, the longest time between two measurements: without losses "
                                     "the device must not measure by itself",
                                     ms(*longest)));
  }
}

}  // namespace ttf::schedules::check
