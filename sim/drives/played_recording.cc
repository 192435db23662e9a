#include "sim/drives/played_recording.h"

#include <fmt/format.h>

#include "core/counted.h"
#include "core/decimal.h"
#include "sim/drives/drive.h"
#include "sim/drives/step_catalog.h"
#include "sim/engine/cluster_simulation.h"

namespace ttf::sim::drives {
namespace {

std::string seconds(Duration duration) { return scaled_text(duration.ns, 1'000'000'000) + " s"; }

std::string sentence_of(const RecordingUse::OfSensor& of, const RecordingUse& use) {
  const sensors::recorded::PlayedRows& rows = of.rows;
  std::string text =
      fmt::format("{}: {}, {} played{}", of.sensor, counted(rows.rows, "row"), counted(rows.lists, "list"),
                  use.played == sensors::recorded::RowsArePlayed::kResampled ? " (resampled)" : "");
  if (rows.beyond > 0)
    text += fmt::format("; {} beyond the drive's end at {}", counted(rows.beyond, "unused row"), seconds(use.duration));
  if (rows.between > 0) text += fmt::format("; {} between the instants", counted(rows.between, "unused row"));
  if (rows.silent > 0) text += fmt::format("; {} without a row", counted(rows.silent, "measurement"));
  return text + '\n';
}

}  // namespace

std::vector<SensorId> played_sensors(const schedules::model::Cluster& cluster) {
  std::vector<SensorId> sensors;
  for (const PlacedTask& source : tasks_with(cluster, StepRole::kRecordedSource))
    if (source.task->activation.kind == schedules::model::ActivationKind::kSensor)
      sensors.push_back(source.task->activation.sensor);
  return sensors;
}

sensors::recorded::PlayedRows rows_of(const Scenario& scenario, const schedules::model::Cluster& cluster,
                                      const recording::rows::RecordedInput& recorded, SensorId sensor) {
  return sensors::recorded::played_rows(recorded, cluster, sensor, scenario.recorded_playing,
                                        drive_end(scenario) - drive_start(cluster));
}

schedules::model::Cluster cluster_that_plays(const Scenario& scenario, const schedules::model::Cluster& cluster,
                                             const recording::rows::RecordedInput& recorded) {
  schedules::model::Cluster plays = cluster;
  for (const SensorId sensor : played_sensors(cluster))
    plays.sensors[index_of(sensor)].instants = rows_of(scenario, cluster, recorded, sensor).instants;
  return plays;
}

RecordingUse recording_use(const Scenario& scenario, const schedules::model::Cluster& cluster,
                           const recording::rows::RecordedInput& recorded) {
  RecordingUse use;
  use.played = scenario.recorded_playing.rows;
  use.duration = scenario.duration;
  for (const SensorId sensor : played_sensors(cluster)) {
    const std::string& name = cluster.sensor(sensor).name;
    use.sensors.push_back({name, rows_of(scenario, cluster, recorded, sensor)});
    if (use.sensors.back().rows.lists == 0)
      throw InputError({recorded.name, 0, "sensor", name,
                        fmt::format("must have a row within the drive of {}", seconds(scenario.duration))});
  }
  use.end = drive_start(cluster) + Duration::microseconds(recorded.observations.back().time_us_from_start);
  use.ends_after = use.end - sim::engine::kFirstCycle;
  return use;
}

std::string recording_text(const RecordingUse& use) {
  std::string text;
  for (const RecordingUse::OfSensor& of : use.sensors) text += sentence_of(of, use);
  if (use.ends_early())
    text += fmt::format("the recording ended at {} of {}: uses of images and their ages are judged until then\n",
                        seconds(use.ends_after), seconds(use.duration));
  return text;
}

}  // namespace ttf::sim::drives
