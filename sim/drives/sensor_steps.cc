// The steps of sensors: a device's emulator, and its host's preprocessing.
#include <array>

#include "nodes/host/signals.h"
#include "sensors/kinds/sensors.h"
#include "sensors/recorded/recorded.h"
#include "sim/drives/drive.h"
#include "sim/drives/played_recording.h"
#include "sim/drives/step_catalog.h"

namespace ttf::sim::drives {
namespace {

using nodes::host::Step;

std::string_view sensor_name(const schedules::model::Cluster& cluster, SensorId sensor) {
  return sensor == kNoSensor ? std::string_view() : cluster.sensor(sensor).name;
}

// Makes a step of a kind of sensor by the kind's row.
std::shared_ptr<Step> kinds_step(const StepSite& site) {
  return sensors::kinds::make_step(site.scenario().sensors, {&site.cluster(), &site.task, site.task.activation.sensor,
                                                             site.set.scene, site.set.seed, site.set.replication});
}

std::shared_ptr<Step> recorded_source(const StepSite& site) {
  if (!site.set.recorded)
    throw InputError(site.cluster().finding(site.task.line, "nodes." + site.node.name + "." + site.task.name,
                                            site.task.step, "needs a recording: give one with --input"));
  const SensorId sensor = site.task.activation.sensor;
  return std::make_shared<sensors::recorded::RecordedSource>(
      site.cluster(), site.task, sensor, rows_of(site.scenario(), site.cluster(), *site.set.recorded, sensor),
      drive_start(site.cluster()));
}

std::shared_ptr<Step> recorded_preprocessing(const StepSite& site) {
  return std::make_shared<sensors::recorded::RecordedPreprocessing>(
      site.cluster(), site.task, site.scenario().recorded_noises.of(raw_sensor_name(site.cluster(), site.task)));
}

constexpr StepRow kRecordedSource{
    {.step = "recorded_source", .writes = {"raw"}}, StepRole::kRecordedSource, &recorded_source};
constexpr StepRow kRecordedPreprocessing{{.step = "recorded_preprocessing", .reads = {"raw"}, .writes = {"objects"}},
                                         StepRole::kPreprocessing,
                                         &recorded_preprocessing};

// Devices come first.
constexpr auto kSensorSteps = [] {
  std::array<StepRow, 2 * sensors::kinds::kSteps.size() + 2> rows{};
  std::size_t n = 0;
  for (const sensors::SensorSteps& one : sensors::kinds::kSteps)
    rows[n++] = {one.emulator, StepRole::kEmulator, &kinds_step};
  rows[n++] = kRecordedSource;
  for (const sensors::SensorSteps& one : sensors::kinds::kSteps)
    rows[n++] = {one.preprocessing, StepRole::kPreprocessing, &kinds_step};
  rows[n++] = kRecordedPreprocessing;
  return rows;
}();
static_assert(complete(kSensorSteps));

}  // namespace

std::string_view raw_sensor_name(const schedules::model::Cluster& cluster, const schedules::model::Task& task) {
  return sensor_name(cluster, cluster.pdu(nodes::host::binding_of(task.reads, "raw").pdu).sensor);
}

std::span<const StepRow> sensor_steps() { return kSensorSteps; }

}  // namespace ttf::sim::drives
