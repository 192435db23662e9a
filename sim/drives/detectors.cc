#include "sim/drives/detectors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/counted.h"
#include "core/nearest.h"
#include "schedules/model/ports.h"
#include "schedules/sequence/history.h"
#include "sim/drives/step_catalog.h"

namespace ttf::sim::drives {
namespace {

using schedules::model::Cluster;
using schedules::model::PortBinding;
using schedules::model::Task;

constexpr std::string_view kRegions = "regions";

bool has_port(const std::vector<PortBinding>& bindings, std::string_view port) {
  return std::ranges::any_of(bindings, [&](const PortBinding& one) { return one.port == port; });
}

void check_ports(const Cluster& cluster, const Task& task, const std::string& path, Findings& findings) {
  std::size_t cameras = 0;
  for (const PortBinding& read : task.reads) {
    if (read.port == kRegions) continue;
    ++cameras;
    const auto fail = [&](std::string expected) {
      findings.add(
          cluster.finding(read.line, path + ".reads." + read.port, cluster.pdu(read.pdu).name, std::move(expected)));
    };
    if (!schedules::model::row_of(cluster.sensor(cluster.pdu(read.pdu).sensor).kind).pictures)
      fail("must be a list of a mono_camera: the detector looks at pictures");
    const std::string written = schedules::model::written_port(read.port);
    if (!has_port(task.writes, written))
      fail(fmt::format("needs a port {} among writes: the objects of these pictures leave there", written));
  }
  for (const PortBinding& written : task.writes)
    if (std::ranges::none_of(task.reads, [&](const PortBinding& read) {
          return schedules::model::written_port(read.port) == written.port;
        }))
      findings.add(cluster.finding(written.line, path + ".writes." + written.port, cluster.pdu(written.pdu).name,
                                   "must be absent: no pictures of this camera are read"));
  if (cameras == 0)
    findings.add(cluster.finding(task.line, path + ".reads", "",
                                 "must have a list of a camera: an adaptive camera without one sees nothing"));
  if (cameras > schedules::sequence::kMostSensors)
    findings.add(cluster.finding(task.line, path + ".reads", std::to_string(cameras),
                                 fmt::format("must be at most {} cameras", schedules::sequence::kMostSensors)));
}

int line_of_holds(const Cluster& cluster, const Task& task, const std::string& path) {
  const auto line = cluster.parameter_lines.find(path + ".holds");
  return line == cluster.parameter_lines.end() ? task.line : line->second;
}

Duration step_of(const Cluster& cluster, const Task& task) { return cluster.cycle() * task.activation.at.repetition; }

void check_times(const Cluster& cluster, const Task& task, const std::string& path, Findings& findings) {
  if (!task.modes.empty()) return;  // the rules about modes hold (schedules/modes)
  if (task.activation.kind != schedules::model::ActivationKind::kTime) {
    findings.add(
        cluster.finding(task.line, path + ".activation", "",
                        "must be of kind time or modes: a detection takes whole steps, and an execution is one"));
    return;
  }
  const Duration step = step_of(cluster, task);
  if (task.holds < step * 2)
    findings.add(cluster.finding(
        line_of_holds(cluster, task, path), path + ".holds", fmt::format("{:g} ms", in_ms(task.holds)),
        fmt::format("must be at least {:g} ms: a detection takes at least two executions", in_ms(step * 2))));
}

// Checks the same where modes say how long detections last.
void check_whole_pictures(const Scenario& scenario, const Cluster& cluster, const Task& task, const std::string& path,
                          Findings& findings) {
  const Duration picture = nodes::vision::whole_picture(scenario.adaptive_camera);
  for (const schedules::model::TaskMode& mode : task.modes)
    for (std::size_t i = 0; i < mode.instants.size(); ++i) {
      const schedules::model::ModeInstant& one = mode.instants[i];
      if (one.secondary || one.lasts >= picture) continue;
      findings.add(cluster.finding(
          one.line, fmt::format("{}.modes.{}.detections[{}].lasts", path, mode.name, i),
          fmt::format("{:g} ms", in_ms(one.lasts)),
          fmt::format("must be at least {:g} ms: a whole picture takes that by adaptive_camera.picture_time "
                      "and hardware_factor of {}",
                      in_ms(picture), scenario.file)));
    }
}

std::vector<std::string> camera_names(const Cluster& cluster, const Task& task) {
  std::vector<std::string> names;
  for (const SensorId camera : cameras_of(cluster, task)) names.push_back(cluster.sensor(camera).name);
  return names;
}

// Checks that the scenario's modes and their cameras are the detector's.
void check_modes_named(const Scenario& scenario, const Cluster& cluster, const Task& task, Findings& findings) {
  const std::vector<std::string> cameras = camera_names(cluster, task);
  std::vector<std::string> modes;
  for (const schedules::model::TaskMode& mode : task.modes) modes.push_back(mode.name);
  for (const nodes::vision::ModeOfRegions& row : scenario.adaptive_camera.modes) {
    const auto fail = [&](const char* key, const std::string& value, std::string expected) {
      findings.add({scenario.file, row.line, std::string("adaptive_camera.modes.") + key, value, std::move(expected)});
    };
    if (modes.empty())
      return fail("mode", row.mode, fmt::format("must be absent: the detector of {} has no modes", cluster.file));
    if (std::ranges::find(modes, row.mode) == modes.end())
      fail("mode", row.mode,
           fmt::format("must be a mode of the detector of {}: {}{}", cluster.file, joined(modes, " or "),
                       did_you_mean(row.mode, modes)));
    for (const std::string& camera : row.cameras)
      if (std::ranges::find(cameras, camera) == cameras.end())
        fail("regions", camera,
             fmt::format("must be cameras of the detector of {}: {}{}", cluster.file, joined(cameras, " or "),
                         did_you_mean(camera, cameras)));
  }
}

// A detector that is cut off at each whole picture would take less than the scenario says.
void check_whole_picture(const Scenario& scenario, const Cluster& cluster, const Task& task, const std::string& path,
                         Findings& findings) {
  if (!task.modes.empty()) return check_whole_pictures(scenario, cluster, task, path, findings);
  const Duration step = step_of(cluster, task), picture = nodes::vision::whole_picture(scenario.adaptive_camera);
  const Duration needed = schedules::sequence::occupied(picture, step);
  if (task.holds < needed)
    findings.add(
        cluster.finding(line_of_holds(cluster, task, path), path + ".holds", fmt::format("{:g} ms", in_ms(task.holds)),
                        fmt::format("must be at least {:g} ms, in steps of {:g} ms: a whole picture takes {:g} ms by "
                                    "adaptive_camera.picture_time and hardware_factor of {}",
                                    in_ms(needed), in_ms(step), in_ms(picture), scenario.file)));
}

// A fixed region shows something of its camera's picture, and is no list's.
void check_regions(const Scenario& scenario, const Cluster& cluster, const schedules::model::Node& node,
                   const Task& task, Findings& findings) {
  const std::vector<std::string> names = camera_names(cluster, task);
  const std::vector<nodes::vision::SharedCamera> pictures = pictures_of(scenario, cluster, task);
  for (std::size_t i = 0; i < scenario.adaptive_camera.regions.size(); ++i) {
    const nodes::vision::FixedRegion& fixed = scenario.adaptive_camera.regions[i];
    const std::string key = fmt::format("adaptive_camera.regions[{}]", i);
    const auto camera = std::ranges::find(names, fixed.camera);
    if (camera == names.end()) {
      findings.add({scenario.file, fixed.line, key + ".camera", fixed.camera,
                    fmt::format("must be a camera of the node {} of {}: {}{}", node.name, cluster.file,
                                joined(names, " or "), did_you_mean(fixed.camera, names))});
    } else {
      const nodes::vision::SharedCamera& picture = pictures[static_cast<std::size_t>(camera - names.begin())];
      const auto check = [&](std::string_view axis, double low, double size, double half) {
        if (low < half && low + size > -half) return;
        findings.add({scenario.file, fixed.line, fmt::format("{}.{}", key, axis), fmt::format("{:g} px", low),
                      fmt::format("must be from {:g} to {:g} px: the picture of {} reaches {:g} px from its middle",
                                  -half - size, half, fixed.camera, half)});
      };
      check("x", fixed.region.x, fixed.region.width, picture.half_width_px);
      check("y", fixed.region.y, fixed.region.height, picture.half_height_px);
    }
    if (has_port(task.reads, kRegions))
      findings.add({scenario.file, fixed.line, "adaptive_camera.regions", "",
                    fmt::format("must be absent: in {} the detector reads its regions from the bus", cluster.file)});
  }
}

}  // namespace

std::vector<SensorId> cameras_of(const Cluster& cluster, const Task& task) {
  std::vector<SensorId> cameras;
  for (const PortBinding& read : task.reads)
    if (read.port != kRegions) cameras.push_back(cluster.pdu(read.pdu).sensor);
  return cameras;
}

bool looks_at_regions(const Cluster& cluster, SensorId camera) {
  const std::vector<PlacedTask> detectors = tasks_with(cluster, StepRole::kDetector);
  return detectors.empty() || std::ranges::count(cameras_of(cluster, *detectors.front().task), camera) > 0;
}

void check_detectors(const Cluster& cluster, Findings& findings) {
  std::string first;
  for (const schedules::model::Node& node : cluster.nodes)
    for (const Task& task : node.tasks) {
      const std::string path = PlacedTask{&node, &task}.path();
      const bool detects = has_role(task, StepRole::kDetector);
      if (detects) {
        if (!first.empty())
          findings.add(cluster.finding(
              task.line, path + ".step", task.step,
              fmt::format("must be another step: {} is the detector already, and a scenario describes one", first)));
        else
          first = path;
        check_ports(cluster, task, path, findings);
        check_times(cluster, task, path, findings);
      } else if (task.holds > Duration{}) {
        findings.add(cluster.finding(
            line_of_holds(cluster, task, path), path + ".holds", fmt::format("{:g} ms", in_ms(task.holds)),
            fmt::format("must be absent: step {} writes at the end of the execution that reads", task.step)));
      }
      if (!task.modes.empty() && !detects)
        findings.add(cluster.finding(task.line, path + ".activation", "modes",
                                     fmt::format("must be of another kind: step {} knows no modes", task.step)));
    }
}

void check_detection(const Scenario& scenario, const Cluster& cluster, const schedules::model::Node& node,
                     const Task& task, Findings& findings) {
  check_whole_picture(scenario, cluster, task, PlacedTask{&node, &task}.path(), findings);
  check_modes_named(scenario, cluster, task, findings);
  check_regions(scenario, cluster, node, task, findings);
}

std::vector<nodes::vision::SharedCamera> pictures_of(const Scenario& scenario, const Cluster& cluster,
                                                     const Task& task) {
  const auto& described = scenario.sensors.of<sensors::mono_camera::Kind>();
  std::vector<nodes::vision::SharedCamera> pictures;
  for (const SensorId camera : cameras_of(cluster, task)) {
    const std::string& name = cluster.sensor(camera).name;
    const auto& model = described.of(name).model;
    pictures.push_back(
        {model.focal_px * std::tan(model.half_field_rad), model.half_height_px, described.preprocessing_of(name)});
  }
  return pictures;
}

}  // namespace ttf::sim::drives
