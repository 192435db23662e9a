#include <limits>
#include <utility>

#include "cli/drive_progress.h"
#include "cli/exports/formats.h"
#include "cli/exports/reported_uses.h"
#include "cli/logs/viewed_sensors.h"
#include "core/counted.h"
#include "recording/records/tee.h"

namespace ttf::cli::exports {
namespace {

using recording::exports::viewer::FoxgloveExport;
using recording::exports::viewer::ObjectErrors;
using recording::exports::viewer::SceneCounts;

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
  FoxgloveExport scene(out, logs::viewed_sensors(drive, result.warnings));
  ReportedUses uses(
      [&](const ReportedUses::Use& use, ReportedUses::Ages ages) {
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

}  // namespace ttf::cli::exports
