#include "cli/launch/verdict.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "core/counted.h"
#include "schedules/analysis/ages.h"

namespace ttf::cli::launch {
namespace {

std::string ms(Duration d) { return fmt::format("{:.1f} ms", in_ms(d)); }

// Returns all that was counted, without zeros: "39 late wake-ups, 12 late frames".
std::string counted_text(const DriveFacts& facts) {
  std::uint64_t late_wake_ups = 0, missed = 0, late = 0, early = 0, lost = 0;
  for (const auto& [node, timing] : facts.real_time->timing) {
    late_wake_ups += timing.late_wake_ups;
    missed += timing.slots_missed;
    late += timing.late_frames;
    early += timing.early_frames;
    lost += timing.lost_on_the_way();
  }
  std::vector<std::string> parts;
  const auto add = [&](std::uint64_t count, const char* one) {
    if (count > 0) parts.push_back(counted(count, one));
  };
  add(late_wake_ups, "late wake-up");
  add(missed, "missed slot");
  add(late, "late frame");
  add(early, "early frame");
  add(lost, "lost frame");
  add(facts.restarts, "restart");
  const std::string counted_here = joined(parts);
  if (facts.external.empty()) return counted_here;
  return counted_here.empty() ? facts.external : counted_here + "; " + facts.external;
}

std::string older_text(const std::string& sensor, const evaluation::accuracy::ServiceFindings::Older& older,
                       const std::string& images) {
  if (older.missing == older.uses)
    return fmt::format("{} of {} had no measurement of {} for up to {}, and the schedule promises one within {}",
                       older.uses, images, sensor, ms(older.worst), ms(older.bound));
  return fmt::format("the newest measurement of {} was up to {} old in {} of {}, and the schedule promises {}", sensor,
                     ms(older.worst), older.uses, images, ms(older.bound));
}

// Returns the harm to the service, in its words.
std::string harm_text(const DriveFacts& facts) {
  const evaluation::accuracy::ServiceFindings& service = facts.service;
  std::vector<std::string> parts;
  if (service.uses == 0) parts.emplace_back("no image was used");
  if (service.refused > 0)
    parts.push_back(
        fmt::format("{} of {} were refused: too old", service.refused, counted(service.uses, "used image")));
  for (const auto& [sensor, older] : service.older)
    parts.push_back(older_text(facts.cluster->sensor(sensor).name, older, counted(service.uses, "used image")));
  if (service.gap) parts.push_back(fmt::format("no image was used for {}", ms(*service.gap)));
  if (!facts.absent.empty()) parts.push_back(facts.absent);
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : "; ") + part;
  return text;
}

}  // namespace

std::map<SensorId, Duration> promised_ages(const schedules::model::Cluster& cluster,
                                           fusion::strategies::StrategyKind strategy, std::int64_t time_scale_ppm) {
  const std::int64_t real_ns = cluster.arrival_window ? cluster.arrival_window->late.ns : 0;
  const Duration late{real_ns * 1'000'000 / time_scale_ppm};
  std::map<SensorId, Duration> ages;
  for (const schedules::analysis::AgePath& path : schedules::analysis::measurement_ages(cluster)) {
    if (!path.reaches_use || path.chosen) continue;
    const bool held = strategy == fusion::strategies::StrategyKind::kBuff;
    ages.emplace(path.sensor, (held ? path.buffered_newest_worst : path.newest_worst) + late);
  }
  return ages;
}

Verdict verdict_of(const DriveFacts& facts) {
  const std::string happened = counted_text(facts), harm = harm_text(facts);
  if (!harm.empty())
    return {true, fmt::format("this matters: {}{}", harm, happened.empty() ? "" : " (" + happened + ")")};
  const std::string as_promised =
      fmt::format("each of {} was as fresh as the schedule promises", counted(facts.service.uses, "used image"));
  if (happened.empty()) return {false, "nothing was late or lost, and " + as_promised};
  return {false, fmt::format("{}: this does not matter, {}", happened, as_promised)};
}

}  // namespace ttf::cli::launch
