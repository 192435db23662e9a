#include "sensors/preprocessing.h"

namespace ttf::sensors {

Preprocessing::Preprocessing(const schedules::model::Cluster& cluster, const schedules::model::Task& task)
    : sensor_(layout_read(cluster, task, "raw").sensor) {}

void Preprocessing::run(nodes::host::StepContext& context) {
  if (const auto measurement = nodes::host::measurement_of(context, sensor_)) process(context, *measurement);
}

}  // namespace ttf::sensors
