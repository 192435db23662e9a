// The steps that drive the vehicle or warn its driver.
#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "nodes/driving/actuator.h"
#include "nodes/driving/adaptive_cruise_control.h"
#include "nodes/driving/blind_spot_warning.h"
#include "nodes/driving/emergency_braking.h"
#include "nodes/driving/motion_planner.h"
#include "nodes/driving/steering/lane_keeping.h"
#include "nodes/driving/vehicle_control.h"
#include "nodes/host/signals.h"
#include "sim/drives/detectors.h"
#include "sim/drives/drive.h"
#include "sim/drives/step_catalog.h"

namespace ttf::sim::drives {
namespace {

using nodes::host::Step;
using schedules::model::Cluster;
using schedules::model::Task;

// Returns the sensors' vehicle; the usual one, where the scenario has none that drives.
const sim::world::vehicle::EgoConfig& ego_of(const StepSite& site) {
  static const sim::world::vehicle::EgoConfig kUsual;
  return site.scenario().world.ego ? *site.scenario().world.ego : kUsual;
}

// Returns the pictures of the cluster's cameras with one lens, as far as they measure and their regions are looked at.
std::vector<nodes::driving::Picture> pictures_of(const Scenario& scenario, const Cluster& cluster) {
  std::vector<nodes::driving::Picture> pictures;
  for (std::size_t s = 0; s < cluster.sensors.size(); ++s) {
    if (!schedules::model::row_of(cluster.sensors[s].kind).pictures) continue;
    const sensors::mono_camera::MonoCameraConfig& camera =
        scenario.sensors.of<sensors::mono_camera::Kind>().of(cluster.sensors[s].name).model;
    if (!camera.device.enabled || !looks_at_regions(cluster, static_cast<SensorId>(s))) continue;
    const sensors::Placement& at = camera.device.placement;
    pictures.push_back({static_cast<SensorId>(s), at.x, at.y, at.heading, camera.height_m, camera.focal_px,
                        camera.focal_px * std::tan(camera.half_field_rad), camera.half_height_px});
  }
  return pictures;
}

const Task* writer_of(const Cluster& cluster, PduId list) {
  for (const schedules::model::Node& node : cluster.nodes)
    for (const Task& task : node.tasks)
      for (const schedules::model::PortBinding& out : task.writes)
        if (out.pdu == list) return &task;
  return nullptr;
}

// Returns the name of the camera that measures these marks, empty if a library's step hides it.
std::string_view camera_of(const Cluster& cluster, PduId marks) {
  for (std::size_t hops = 0; hops < cluster.pdus.size(); ++hops) {
    const Task* const writer = writer_of(cluster, marks);
    if (writer == nullptr) break;
    if (has_role(*writer, StepRole::kPreprocessing)) return raw_sensor_name(cluster, *writer);
    if (!has_role(*writer, StepRole::kGateway)) break;
    marks = nodes::host::binding_of(writer->reads, "in").pdu;
  }
  return {};
}

std::shared_ptr<Step> adaptive_cruise_control(const StepSite& site) {
  nodes::driving::CruiseConfig cruise = site.scenario().cruise;
  cruise.path.front_m = ego_of(site).front;
  if (ego_of(site).actuator) cruise.memory = ego_of(site).actuator->oldest;
  return std::make_shared<nodes::driving::AdaptiveCruiseControl>(site.cluster(), site.task, cruise);
}

std::shared_ptr<Step> emergency_braking(const StepSite& site) {
  nodes::driving::EmergencyConfig emergency = site.scenario().emergency;
  emergency.path.front_m = ego_of(site).front;
  return std::make_shared<nodes::driving::EmergencyBraking>(site.cluster(), site.task, emergency);
}

std::shared_ptr<Step> lane_keeping(const StepSite& site) {
  nodes::driving::steering::LaneKeepingConfig config = site.scenario().lane_keeping;
  const sim::world::vehicle::EgoConfig& ego = ego_of(site);
  const sim::world::vehicle::Parameters& vehicle = ego.vehicle;
  config.wheelbase_m = vehicle.wheelbase();
  config.width_m = ego.width;
  // At rest the front axle has its share of the weight.
  constexpr double kGravity = 9.81;
  config.load = {
      vehicle.mass, vehicle.front_axle, vehicle.rear_axle,
      vehicle.friction * vehicle.front_stiffness * kGravity * vehicle.mass * vehicle.rear_axle / vehicle.wheelbase()};
  const PduId marks = nodes::host::binding_of(site.task.reads, "marks").pdu;
  config.lane.ahead_m =
      site.scenario().sensors.of<sensors::mono_camera::Kind>().of(camera_of(site.cluster(), marks)).model.marks.ahead_m;
  return std::make_shared<nodes::driving::steering::LaneKeeping>(site.cluster(), site.task, config);
}

// A lane is kept where commands drive the vehicle.
void check_lane(const Scenario& scenario, const Cluster& cluster, const schedules::model::Node& node, const Task& task,
                Findings& findings) {
  if (actuator_node(cluster) && !scenario.world.road)
    findings.add(cluster.finding(task.line, "nodes." + node.name + ".tasks." + task.name + ".step", task.step,
                                 fmt::format("needs a lane: {} has no world.road", scenario.file)));
}

std::shared_ptr<Step> blind_spot_warning(const StepSite& site) {
  nodes::driving::BlindSpotConfig blind_spot = site.scenario().blind_spot;
  blind_spot.width_m = ego_of(site).width;
  return std::make_shared<nodes::driving::BlindSpotWarning>(site.cluster(), site.task, blind_spot);
}

std::shared_ptr<Step> motion_planner(const StepSite& site) {
  nodes::driving::PlannerConfig planner = site.scenario().planner;
  planner.path.front_m = ego_of(site).front;
  planner.width_m = ego_of(site).width;
  return std::make_shared<nodes::driving::MotionPlanner>(site.cluster(), site.task, planner,
                                                         pictures_of(site.scenario(), site.cluster()));
}

std::shared_ptr<Step> vehicle_control(const StepSite& site) {
  nodes::driving::ControlConfig control = site.scenario().control;
  control.wheelbase_m = ego_of(site).vehicle.wheelbase();
  return std::make_shared<nodes::driving::VehicleControl>(site.cluster(), site.task, control);
}

std::shared_ptr<Step> actuator(const StepSite& site) {
  return std::make_shared<nodes::driving::Actuator>(
      site.cluster(), site.task, ego_of(site).actuator.value_or(sim::world::vehicle::ActuatorConfig{}));
}

constexpr StepRow kDrivingSteps[] = {
    {{.step = "adaptive_cruise_control", .reads = {"image", "odometry"}, .writes = {"command"}},
     StepRole::kCruise,
     &adaptive_cruise_control},
    {{.step = "emergency_braking", .reads = {"image", "odometry"}, .writes = {"command"}},
     StepRole::kEmergencyBraking,
     &emergency_braking},
    {{.step = "lane_keeping", .reads = {"marks", "odometry"}, .writes = {"command"}},
     StepRole::kLaneKeeping,
     &lane_keeping,
     &check_lane},
    {{.step = "blind_spot_warning", .reads = {"image"}}, StepRole::kBlindSpotWarning, &blind_spot_warning},
    {{.step = "motion_planner", .reads = {"image", "odometry"}, .writes = {"plan"}, .may_write = {"regions"}},
     StepRole::kPlanner,
     &motion_planner},
    {{.step = "vehicle_control", .reads = {"plan", "odometry"}, .writes = {"command"}},
     StepRole::kControl,
     &vehicle_control},
    {{.step = nodes::driving::Actuator::kName, .reads = {"command"}, .may_read = {"emergency", "lateral"}},
     StepRole::kActuator,
     &actuator},
};
static_assert(complete(kDrivingSteps));

}  // namespace

std::span<const StepRow> driving_steps() { return kDrivingSteps; }

}  // namespace ttf::sim::drives
