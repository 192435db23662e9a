#include "sim/drives/step_catalog.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/errors.h"
#include "nodes/driving/actuator.h"
#include "nodes/driving/adaptive_cruise_control.h"
#include "nodes/driving/blind_spot_warning.h"
#include "nodes/driving/emergency_braking.h"
#include "nodes/driving/motion_planner.h"
#include "nodes/driving/steering/lane_keeping.h"
#include "nodes/driving/vehicle_control.h"
#include "nodes/foreign/foreign_step.h"
#include "nodes/fusion/fusion_host.h"
#include "nodes/host/signals.h"
#include "nodes/sensing/emulators.h"
#include "nodes/sensing/gateway.h"
#include "nodes/sensing/mono_camera.h"
#include "nodes/sensing/odometry.h"
#include "nodes/sensing/preprocessing.h"
#include "nodes/sensing/recorded.h"
#include "nodes/service/feature_service.h"
#include "nodes/vision/adaptive_camera.h"
#include "nodes/vision/mode_camera.h"
#include "sim/drives/detectors.h"
#include "sim/drives/drive.h"
#include "sim/drives/known_fields.h"
#include "sim/drives/played_recording.h"

namespace ttf::sim::drives {
namespace {

std::string_view name_of(const schedules::model::Cluster& cluster, SensorId sensor) {
  return sensor == kNoSensor ? std::string_view() : cluster.sensor(sensor).name;
}
// Returns the sensors' vehicle; the usual one, where the scenario has none that drives.
const sim::world::vehicle::EgoConfig& ego_of(const Scenario& scenario) {
  static const sim::world::vehicle::EgoConfig kUsual;
  return scenario.world.ego ? *scenario.world.ego : kUsual;
}
// Returns the pictures of the cluster's cameras with one lens, as far as they measure and their regions are looked at.
std::vector<nodes::driving::Picture> pictures_of(const Scenario& scenario, const schedules::model::Cluster& cluster) {
  std::vector<nodes::driving::Picture> pictures;
  for (std::size_t s = 0; s < cluster.sensors.size(); ++s) {
    if (cluster.sensors[s].kind != schedules::model::SensorKind::kMonoCamera) continue;
    const sim::world::MonoCameraConfig& camera = scenario.sensors.mono_cameras.of(cluster.sensors[s].name).model;
    if (!camera.device.enabled || !looks_at_regions(cluster, static_cast<SensorId>(s))) continue;
    const sim::world::Placement& at = camera.device.placement;
    pictures.push_back({static_cast<SensorId>(s), at.x, at.y, at.heading, camera.height_m, camera.focal_px,
                        camera.focal_px * std::tan(camera.half_field_rad), camera.half_height_px});
  }
  return pictures;
}
// Returns the name of the sensor whose raw list the task reads.
std::string_view name_read(const schedules::model::Cluster& cluster, const schedules::model::Task& task) {
  return name_of(cluster, cluster.pdu(nodes::host::binding_of(task.reads, "raw").pdu).sensor);
}
const schedules::model::Task* writer_of(const schedules::model::Cluster& cluster, PduId list) {
  for (const schedules::model::Node& node : cluster.nodes)
    for (const schedules::model::Task& task : node.tasks)
      for (const schedules::model::PortBinding& out : task.writes)
        if (out.pdu == list) return &task;
  return nullptr;
}
// Returns the name of the camera that measures these marks, empty if only a library's step knows it.
std::string_view camera_of(const schedules::model::Cluster& cluster, PduId marks) {
  for (std::size_t hops = 0; hops < cluster.pdus.size(); ++hops) {
    const schedules::model::Task* const writer = writer_of(cluster, marks);
    if (writer == nullptr) break;
    if (writer->step == "lane_camera_preprocessing") return name_read(cluster, *writer);
    if (writer->step != "gateway") break;
    marks = nodes::host::binding_of(writer->reads, "in").pdu;
  }
  return {};
}
// Returns the service's parameters, with the vehicle's and the camera's.
nodes::driving::steering::LaneKeepingConfig lane_keeping_of(const Scenario& scenario,
                                                            const schedules::model::Cluster& cluster,
                                                            const schedules::model::Task& task) {
  nodes::driving::steering::LaneKeepingConfig config = scenario.lane_keeping;
  const sim::world::vehicle::EgoConfig& ego = ego_of(scenario);
  const sim::world::vehicle::Parameters& vehicle = ego.vehicle;
  config.wheelbase_m = vehicle.wheelbase();
  config.width_m = ego.width;
  // At rest the front axle has its share of the weight.
  constexpr double kGravity = 9.81;
  config.load = {
      vehicle.mass, vehicle.front_axle, vehicle.rear_axle,
      vehicle.friction * vehicle.front_stiffness * kGravity * vehicle.mass * vehicle.rear_axle / vehicle.wheelbase()};
  const PduId marks = nodes::host::binding_of(task.reads, "marks").pdu;
  config.lane.ahead_m = scenario.sensors.mono_cameras.of(camera_of(cluster, marks)).model.marks.ahead_m;
  return config;
}

}  // namespace

std::span<const schedules::model::StepPorts> step_ports() {
  static const std::vector<schedules::model::StepPorts> kPorts{
      {"laser_emulator", {}, {"raw"}, false},
      {"camera_emulator", {}, {"raw"}, false},
      {"radar_emulator", {}, {"raw"}, false},
      {"mono_camera_emulator", {}, {"raw"}, false},
      {"lane_camera_emulator", {}, {"raw", "marks"}, false},
      {"odometry_emulator", {}, {"raw"}, false},
      {"recorded_source", {}, {"raw"}, false},
      {"laser_preprocessing", {"raw"}, {"objects"}, false},
      {"camera_preprocessing", {"raw"}, {"objects"}, false},
      {"radar_preprocessing", {"raw"}, {"objects"}, false},
      {"mono_camera_preprocessing", {"raw"}, {"objects"}, false},
      {"lane_camera_preprocessing", {"raw", "marks"}, {"objects", "lanes"}, false},
      {"odometry_preprocessing", {"raw"}, {"odometry"}, false},
      {"recorded_preprocessing", {"raw"}, {"objects"}, false},
      {"adaptive_camera", {}, {}, true, {"regions"}, true},
      {"gateway", {"in"}, {"out"}, false},
      {"fusion", {}, {}, true},
      {"image_output", {}, {"image"}, false},
      {"feature_service", {"image"}, {}, false, {"odometry"}},
      {"adaptive_cruise_control", {"image", "odometry"}, {"command"}, false},
      {"emergency_braking", {"image", "odometry"}, {"command"}, false},
      {"lane_keeping", {"marks", "odometry"}, {"command"}, false},
      {"blind_spot_warning", {"image"}, {}, false},
      {"motion_planner", {"image", "odometry"}, {"plan"}, false, {}, false, {"regions"}},
      {"vehicle_control", {"plan", "odometry"}, {"command"}, false},
      {"actuator", {"command"}, {}, false, {"emergency", "lateral"}},
  };
  return kPorts;
}

void check_steps(const schedules::model::Cluster& cluster) {
  schedules::model::bind_ports(cluster, step_ports());
  const SensorId odometry = nodes::fusion::fused_odometry(cluster);
  Findings findings;
  check_detectors(cluster, findings);
  for (const schedules::model::Node& node : cluster.nodes) {
    const schedules::model::Task* fusion = nullptr;
    bool reads = false;
    for (const schedules::model::Task& task : node.tasks) {
      if (task.step == "fusion") {
        if (fusion == nullptr) fusion = &task;
        reads = reads || nodes::fusion::odometry_of(cluster, task) != kNoSensor;
      }
      if (!nodes::host::is_service(task.step) || odometry != kNoSensor) continue;
      for (const schedules::model::PortBinding& binding : task.reads)
        if (binding.port == "odometry")
          findings.add(cluster.finding(
              binding.line, fmt::format("nodes.{}.tasks.{}.reads.odometry", node.name, task.name),
              cluster.pdu(binding.pdu).name,
              "must be read by the fusion, too: without odometry there, the image's velocities are relative "
              "to the vehicle already"));
    }
    if (fusion != nullptr && !reads && odometry != kNoSensor)
      findings.add(cluster.finding(
          fusion->line, fmt::format("nodes.{}.tasks.{}.reads", node.name, fusion->name), "",
          fmt::format("must have {}, as another node's fusion has: all place their lists by it, or none does",
                      cluster.sensor(odometry).name)));
  }
  findings.throw_if_any();
}

bool is_recorded(const schedules::model::Cluster& cluster) {
  for (const schedules::model::Node& node : cluster.nodes)
    for (const schedules::model::Task& task : node.tasks)
      if (task.step == "recorded_source") return true;
  return false;
}

std::vector<std::shared_ptr<nodes::host::Step>> make_steps(const NodeSetConfig& config, NodeId id) {
  const schedules::model::Cluster& cluster = *config.cluster;
  const Scenario& scenario = *config.scenario;
  const schedules::model::Node& node = cluster.node(id);
  std::shared_ptr<nodes::fusion::FusionHost> host;
  const auto fusion_host = [&] {
    if (!host)
      host = std::make_shared<nodes::fusion::FusionHost>(cluster, config.strategy, tracker_of(scenario, cluster));
    return host;
  };
  std::vector<std::shared_ptr<nodes::host::Step>> steps;
  for (const schedules::model::Task& task : node.tasks) {
    const nodes::sensing::EmulatorConfig emulator{&cluster,     &task,       task.activation.sensor,
                                                  config.scene, config.seed, config.replication};
    if (task.step == "laser_emulator") {
      steps.push_back(std::make_shared<nodes::sensing::LaserEmulator>(
          emulator, scenario.sensors.lasers.of(name_of(cluster, emulator.sensor)).model));
    } else if (task.step == "camera_emulator") {
      steps.push_back(std::make_shared<nodes::sensing::CameraEmulator>(
          emulator, scenario.sensors.cameras.of(name_of(cluster, emulator.sensor)).model));
    } else if (task.step == "radar_emulator") {
      steps.push_back(std::make_shared<nodes::sensing::RadarEmulator>(
          emulator, scenario.sensors.radars.of(name_of(cluster, emulator.sensor)).model));
    } else if (task.step == "odometry_emulator") {
      steps.push_back(std::make_shared<nodes::sensing::OdometryEmulator>(
          emulator, scenario.sensors.odometries.of(name_of(cluster, emulator.sensor)).model));
    } else if (task.step == "recorded_source") {
      if (!config.recorded)
        throw InputError(cluster.finding(task.line, "nodes." + node.name + "." + task.name, task.step,
                                         "needs a recording: give one with --input"));
      steps.push_back(std::make_shared<nodes::sensing::RecordedSource>(
          cluster, task, task.activation.sensor, rows_of(scenario, cluster, *config.recorded, task.activation.sensor),
          drive_start(cluster)));
    } else if (task.step == "laser_preprocessing") {
      steps.push_back(std::make_shared<nodes::sensing::LaserPreprocessing>(
          cluster, task, scenario.sensors.lasers.preprocessing_of(name_read(cluster, task))));
    } else if (task.step == "camera_preprocessing") {
      steps.push_back(std::make_shared<nodes::sensing::CameraPreprocessing>(
          cluster, task, scenario.sensors.cameras.preprocessing_of(name_read(cluster, task))));
    } else if (task.step == "mono_camera_emulator" || task.step == "lane_camera_emulator") {
      steps.push_back(std::make_shared<nodes::sensing::MonoCameraEmulator>(
          emulator, scenario.sensors.mono_cameras.of(name_of(cluster, emulator.sensor)).model));
    } else if (task.step == "mono_camera_preprocessing" || task.step == "lane_camera_preprocessing") {
      steps.push_back(std::make_shared<nodes::sensing::MonoCameraPreprocessing>(
          cluster, task, scenario.sensors.mono_cameras.preprocessing_of(name_read(cluster, task))));
    } else if (task.step == "radar_preprocessing") {
      steps.push_back(std::make_shared<nodes::sensing::RadarPreprocessing>(
          cluster, task, scenario.sensors.radars.preprocessing_of(name_read(cluster, task))));
    } else if (task.step == "odometry_preprocessing") {
      steps.push_back(std::make_shared<nodes::sensing::OdometryPreprocessing>(
          cluster, task, scenario.sensors.odometries.preprocessing_of(name_read(cluster, task))));
    } else if (task.step == "recorded_preprocessing") {
      steps.push_back(std::make_shared<nodes::sensing::RecordedPreprocessing>(
          cluster, task, scenario.recorded_noises.of(name_read(cluster, task))));
    } else if (is_detector(task) && !task.modes.empty()) {
      steps.push_back(std::make_shared<nodes::vision::ModeCamera>(
          cluster, task, scenario.adaptive_camera, pictures_of(scenario, cluster, task),
          nodes::vision::DetectionKey{config.seed, config.replication}));
    } else if (is_detector(task)) {
      steps.push_back(std::make_shared<nodes::vision::AdaptiveCamera>(
          cluster, task, scenario.adaptive_camera, pictures_of(scenario, cluster, task),
          nodes::vision::DetectionKey{config.seed, config.replication}));
    } else if (task.step == "gateway") {
      steps.push_back(std::make_shared<nodes::sensing::Gateway>());
    } else if (task.step == "fusion") {
      steps.push_back(std::make_shared<nodes::fusion::FusionStep>(cluster, task, fusion_host()));
    } else if (task.step == "image_output") {
      steps.push_back(std::make_shared<nodes::fusion::ImageOutput>(cluster, task, fusion_host()));
    } else if (task.step == "feature_service") {
      steps.push_back(std::make_shared<nodes::service::FeatureService>(cluster, task, scenario.feature));
    } else if (task.step == "adaptive_cruise_control") {
      nodes::driving::CruiseConfig cruise = scenario.cruise;
      cruise.path.front_m = ego_of(scenario).front;
      if (ego_of(scenario).actuator) cruise.memory = ego_of(scenario).actuator->oldest;
      steps.push_back(std::make_shared<nodes::driving::AdaptiveCruiseControl>(cluster, task, cruise));
    } else if (task.step == "emergency_braking") {
      nodes::driving::EmergencyConfig emergency = scenario.emergency;
      emergency.path.front_m = ego_of(scenario).front;
      steps.push_back(std::make_shared<nodes::driving::EmergencyBraking>(cluster, task, emergency));
    } else if (task.step == "lane_keeping") {
      steps.push_back(std::make_shared<nodes::driving::steering::LaneKeeping>(
          cluster, task, lane_keeping_of(scenario, cluster, task)));
    } else if (task.step == "blind_spot_warning") {
      nodes::driving::BlindSpotConfig blind_spot = scenario.blind_spot;
      blind_spot.width_m = ego_of(scenario).width;
      steps.push_back(std::make_shared<nodes::driving::BlindSpotWarning>(cluster, task, blind_spot));
    } else if (task.step == "motion_planner") {
      nodes::driving::PlannerConfig planner = scenario.planner;
      planner.path.front_m = ego_of(scenario).front;
      planner.width_m = ego_of(scenario).width;
      steps.push_back(
          std::make_shared<nodes::driving::MotionPlanner>(cluster, task, planner, pictures_of(scenario, cluster)));
    } else if (task.step == "vehicle_control") {
      nodes::driving::ControlConfig control = scenario.control;
      control.wheelbase_m = ego_of(scenario).vehicle.wheelbase();
      steps.push_back(std::make_shared<nodes::driving::VehicleControl>(cluster, task, control));
    } else if (task.step == "actuator") {
      steps.push_back(std::make_shared<nodes::driving::Actuator>(
          cluster, task, ego_of(scenario).actuator.value_or(sim::world::vehicle::ActuatorConfig{})));
    } else if (schedules::model::names_library(task.step)) {
      steps.push_back(std::make_shared<nodes::foreign::ForeignStep>(cluster, node, task, config.steps));
    } else {
      TTF_CHECK(false, "step {} of {} is not in the catalog; names are checked before", task.step, node.name);
    }
  }
  return steps;
}

}  // namespace ttf::sim::drives
