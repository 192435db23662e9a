// The steps of sensors: a device's emulator, and its host's preprocessing.
#include "nodes/host/signals.h"
#include "nodes/sensing/emulators.h"
#include "nodes/sensing/mono_camera.h"
#include "nodes/sensing/odometry.h"
#include "nodes/sensing/preprocessing.h"
#include "nodes/sensing/recorded.h"
#include "sim/drives/drive.h"
#include "sim/drives/played_recording.h"
#include "sim/drives/step_catalog.h"

namespace ttf::sim::drives {
namespace {

using nodes::host::Step;

std::string_view sensor_name(const schedules::model::Cluster& cluster, SensorId sensor) {
  return sensor == kNoSensor ? std::string_view() : cluster.sensor(sensor).name;
}

// `kKind`: the member of Sensors with the sensor's kind.
template <class Emulator, auto kKind> std::shared_ptr<Step> emulator(const StepSite& site) {
  const SensorId sensor = site.task.activation.sensor;
  return std::make_shared<Emulator>(nodes::sensing::EmulatorConfig{&site.cluster(), &site.task, sensor, site.set.scene,
                                                                   site.set.seed, site.set.replication},
                                    (site.scenario().sensors.*kKind).of(sensor_name(site.cluster(), sensor)).model);
}

template <class Preprocessing, auto kKind> std::shared_ptr<Step> preprocessing(const StepSite& site) {
  return std::make_shared<Preprocessing>(
      site.cluster(), site.task,
      (site.scenario().sensors.*kKind).preprocessing_of(raw_sensor_name(site.cluster(), site.task)));
}

std::shared_ptr<Step> recorded_source(const StepSite& site) {
  if (!site.set.recorded)
    throw InputError(site.cluster().finding(site.task.line, "nodes." + site.node.name + "." + site.task.name,
                                            site.task.step, "needs a recording: give one with --input"));
  const SensorId sensor = site.task.activation.sensor;
  return std::make_shared<nodes::sensing::RecordedSource>(
      site.cluster(), site.task, sensor, rows_of(site.scenario(), site.cluster(), *site.set.recorded, sensor),
      drive_start(site.cluster()));
}

std::shared_ptr<Step> recorded_preprocessing(const StepSite& site) {
  return std::make_shared<nodes::sensing::RecordedPreprocessing>(
      site.cluster(), site.task, site.scenario().recorded_noises.of(raw_sensor_name(site.cluster(), site.task)));
}

using nodes::sensing::MonoCameraEmulator;
using nodes::sensing::MonoCameraPreprocessing;

constexpr StepRow kSensorSteps[] = {
    {{.step = "laser_emulator", .writes = {"raw"}},
     StepRole::kEmulator,
     &emulator<nodes::sensing::LaserEmulator, &Sensors::lasers>},
    {{.step = "camera_emulator", .writes = {"raw"}},
     StepRole::kEmulator,
     &emulator<nodes::sensing::CameraEmulator, &Sensors::cameras>},
    {{.step = "radar_emulator", .writes = {"raw"}},
     StepRole::kEmulator,
     &emulator<nodes::sensing::RadarEmulator, &Sensors::radars>},
    {{.step = "mono_camera_emulator", .writes = {"raw"}},
     StepRole::kEmulator,
     &emulator<MonoCameraEmulator, &Sensors::mono_cameras>},
    {{.step = "lane_camera_emulator", .writes = {"raw", "marks"}},
     StepRole::kEmulator,
     &emulator<MonoCameraEmulator, &Sensors::mono_cameras>},
    {{.step = "odometry_emulator", .writes = {"raw"}},
     StepRole::kEmulator,
     &emulator<nodes::sensing::OdometryEmulator, &Sensors::odometries>},
    {{.step = "recorded_source", .writes = {"raw"}}, StepRole::kRecordedSource, &recorded_source},
    {{.step = "laser_preprocessing", .reads = {"raw"}, .writes = {"objects"}},
     StepRole::kPreprocessing,
     &preprocessing<nodes::sensing::LaserPreprocessing, &Sensors::lasers>},
    {{.step = "camera_preprocessing", .reads = {"raw"}, .writes = {"objects"}},
     StepRole::kPreprocessing,
     &preprocessing<nodes::sensing::CameraPreprocessing, &Sensors::cameras>},
    {{.step = "radar_preprocessing", .reads = {"raw"}, .writes = {"objects"}},
     StepRole::kPreprocessing,
     &preprocessing<nodes::sensing::RadarPreprocessing, &Sensors::radars>},
    {{.step = "mono_camera_preprocessing", .reads = {"raw"}, .writes = {"objects"}},
     StepRole::kPreprocessing,
     &preprocessing<MonoCameraPreprocessing, &Sensors::mono_cameras>},
    {{.step = "lane_camera_preprocessing", .reads = {"raw", "marks"}, .writes = {"objects", "lanes"}},
     StepRole::kPreprocessing,
     &preprocessing<MonoCameraPreprocessing, &Sensors::mono_cameras>},
    {{.step = "odometry_preprocessing", .reads = {"raw"}, .writes = {"odometry"}},
     StepRole::kPreprocessing,
     &preprocessing<nodes::sensing::OdometryPreprocessing, &Sensors::odometries>},
    {{.step = "recorded_preprocessing", .reads = {"raw"}, .writes = {"objects"}},
     StepRole::kPreprocessing,
     &recorded_preprocessing},
};
static_assert(complete(kSensorSteps));

}  // namespace

std::string_view raw_sensor_name(const schedules::model::Cluster& cluster, const schedules::model::Task& task) {
  return sensor_name(cluster, cluster.pdu(nodes::host::binding_of(task.reads, "raw").pdu).sensor);
}

std::span<const StepRow> sensor_steps() { return kSensorSteps; }

}  // namespace ttf::sim::drives
