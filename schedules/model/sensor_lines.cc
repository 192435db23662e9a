#include "schedules/model/sensor_lines.h"

namespace ttf::schedules::model {

std::optional<std::size_t> can_of_lines(const Cluster& cluster, SensorId sensor) {
  for (const Task& task : cluster.node(cluster.sensor(sensor).device).tasks) {
    if (task.activation.kind != ActivationKind::kSensor || task.activation.sensor != sensor) continue;
    for (const PortBinding& port : task.writes)
      if (port.medium.is_can()) return port.medium.can_index();
  }
  return std::nullopt;
}

}  // namespace ttf::schedules::model
