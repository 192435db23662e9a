#include "cli/logs/export_foxglove.h"

#include <fmt/format.h>

#include <limits>
#include <optional>
#include <utility>

#include "cli/drive_progress.h"
#include "cli/logs/told_uses.h"
#include "core/counted.h"
#include "core/errors.h"
#include "core/file_kind.h"
#include "drives/scenario.h"
#include "drives/step_catalog.h"
#include "recording/records/tee.h"
#include "report/drawing/names.h"
#include "schedules/file/loader.h"

namespace ttf::cli::logs {
namespace {

using recording::exports::viewer::FoxgloveExport;
using recording::exports::viewer::ObjectErrors;
using recording::exports::viewer::Place;
using recording::exports::viewer::SceneCounts;
using recording::exports::viewer::ViewedField;
using recording::exports::viewer::ViewedSensor;

// The drive's descriptions, as its log has them.
struct Attached {
  std::optional<drives::Scenario> scenario;
  std::optional<schedules::model::Cluster> cluster;
};

Attached attached_to(const recording::merge::MergedLogs& drive, std::vector<std::string>& warnings) {
  Attached found;
  for (const recording::log::Attachment& one : drive.attachments()) {
    if (one.media_type != "application/yaml") continue;
    try {
      const std::optional<FileKind> kind = kind_of(StrictYaml::parse(one.bytes, one.name));
      if (kind == FileKind::kScenario) found.scenario = drives::parse_scenario(one.bytes, one.name);
      if (kind == FileKind::kCluster) found.cluster = schedules::file::parse_cluster(one.bytes, one.name);
    } catch (const InputError& error) {
      // An older version's scenario, or a damaged one.
      warnings.push_back(fmt::format("the sensors' places are left out: {}", error.findings().front().sentence()));
    }
  }
  return found;
}

// A sensor that the world emulates, as it is. The knowledge of the fusion may differ.
template <class Model> void place_emulated(const Model& model, ViewedSensor& sensor) {
  sensor.mounting = Place{model.device.placement.x, model.device.placement.y, model.device.placement.heading};
  sensor.field = ViewedField{model.half_field_rad, 0.0, model.max_range_m};
}

// A recorded sensor, as the fusion knows it.
void place_known(const fusion::sensors::KnownSensor& known, ViewedSensor& sensor) {
  sensor.mounting = Place{known.mounting.position.x(), known.mounting.position.y(), known.mounting.yaw};
  if (known.field && known.field->max_range < fusion::sensors::Field::kUnbounded)
    sensor.field = ViewedField{known.field->half_angle, known.field->min_range, known.field->max_range};
}

void place_in(const Attached& attached, std::size_t index, ViewedSensor& sensor) {
  if (!attached.scenario || !attached.cluster || index >= attached.cluster->sensors.size()) return;
  const schedules::model::Sensor& of = attached.cluster->sensors[index];
  if (!drives::is_recorded(*attached.cluster)) {
    switch (of.kind) {
      case schedules::model::SensorKind::kLaser:
        return place_emulated(attached.scenario->sensors.lasers.of(of.name).model, sensor);
      case schedules::model::SensorKind::kCamera:
        return place_emulated(attached.scenario->sensors.cameras.of(of.name).model, sensor);
      case schedules::model::SensorKind::kRadar: break;
    }
  }
  for (const fusion::sensors::KnownSensor& known : attached.scenario->tracker.sensors)
    if (known.name == of.name) place_known(known, sensor);
}

std::vector<ViewedSensor> sensors_of(const recording::merge::MergedLogs& drive, std::vector<std::string>& warnings) {
  const report::drawing::Names names = report::drawing::names_of(drive.manifest());
  const Attached attached = attached_to(drive, warnings);
  std::vector<ViewedSensor> sensors(names.sensors.size());
  for (std::size_t s = 0; s < sensors.size(); ++s) {
    const auto id = static_cast<SensorId>(s);
    sensors[s].name = names.sensor(id);
    sensors[s].colour = recording::exports::viewer::colour_of(report::drawing::sensor_colour(names, id));
    place_in(attached, s, sensors[s]);
  }
  return sensors;
}

std::vector<std::string> missing(const SceneCounts& counts) {
  std::vector<std::string> none;
  const std::pair<std::uint64_t, const char*> parts[] = {
      {counts.fields, "sensors' fields"}, {counts.truths, "truth"}, {counts.observations, "observations"},
      {counts.images, "tracks"},          {counts.ages, "ages"},    {counts.errors, "errors"}};
  for (const auto& [count, name] : parts)
    if (count == 0) none.emplace_back(name);
  return none;
}

}  // namespace

FoxgloveResult export_foxglove(const recording::merge::MergedLogs& drive, const std::string& out) {
  FoxgloveResult result;
  FoxgloveExport scene(out, sensors_of(drive, result.warnings));
  ToldUses uses(
      [&](const ToldUses::Use& use, ToldUses::Ages ages) {
        for (const evaluation::accuracy::SensorAge& one : ages) scene.age(use.stamp.true_time, one.sensor, one.age);
      },
      [&](const evaluation::accuracy::JudgedUse& use) {
        std::vector<ObjectErrors> objects;
        for (const evaluation::accuracy::UsedObject& one : use.objects)
          objects.push_back({one.object, one.error[0], one.error[1], one.error[2], one.error[3],
                             one.belief ? one.belief->nees : std::numeric_limits<double>::quiet_NaN()});
        scene.errors(use.at, objects, use.missed, use.spurious);
      });
  recording::records::Tee both({&scene, &uses});
  read_shown(drive, both);
  uses.finish();
  result.counts = scene.finish();
  result.left_out = missing(result.counts);
  if (result.counts.unnamed > 0)
    result.warnings.push_back(counted(result.counts.unnamed, "message") +
                              " about sensors that the log does not name are left out");
  return result;
}

}  // namespace ttf::cli::logs
