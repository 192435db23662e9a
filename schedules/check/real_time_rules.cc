#include "schedules/check/real_time_rules.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/decimal.h"
#include "core/int128.h"
#include "schedules/check/checker.h"
#include "schedules/model/sensor_lines.h"

namespace ttf::schedules::check {
namespace {

std::int64_t room_ps(const model::Cluster& cluster) {
  const model::GlobalParameters& g = cluster.flexray;
  const std::int64_t slots = g.gNumberOfStaticSlots - std::max(last_static_slot(cluster), 1) + 1;
  return (slots * g.gdStaticSlot - g.gdActionPointOffset) * g.gdMacrotick_ps;
}

// The unit is picoseconds times parts per million: all values are whole in it.
Int128 scaled_ps(Duration duration) { return static_cast<Int128>(duration.ns) * 1'000 * kTimeScaleOne; }

std::string us_text(Duration duration) { return scaled_text(duration.ns, 1'000) + " us"; }

// Returns for example "; --time-scale 1.2 or more suffices".
std::string remedy(const model::Cluster& cluster) {
  const std::int64_t needed = smallest_time_scale(cluster, *cluster.arrival_window);
  if (needed > kLargestTimeScale)
    return fmt::format("; no --time-scale up to {} suffices", time_scale_text(kLargestTimeScale));
  return fmt::format("; --time-scale {} or more suffices", time_scale_text(needed));
}

void check_window(const model::Cluster& cluster, std::int64_t time_scale_ppm, ClusterFindings& findings) {
  const model::ArrivalWindow& window = *cluster.arrival_window;
  if (const Duration room = arrival_room(cluster, time_scale_ppm); window.late > room)
    findings.parameter(
        "real_time.late", us_text(window.late),
        fmt::format("must be at most {} at time scale {}: the time from the action point of slot {}, the last one in "
                    "use, to the end of the static segment{}",
                    us_text(room), time_scale_text(time_scale_ppm), last_static_slot(cluster), remedy(cluster)));
  if (scaled_ps(window.early + window.late) >= static_cast<Int128>(cluster.flexray.cycle_ps()) * time_scale_ppm)
    findings.parameter("real_time.early", us_text(window.early),
                       fmt::format("must be less than a cycle together with late ({}), {} at time scale {}: otherwise "
                                   "the arrival windows of a slot in two cycles overlap{}",
                                   us_text(window.late), us_text(stretched(cluster.cycle(), time_scale_ppm)),
                                   time_scale_text(time_scale_ppm), remedy(cluster)));
}

void check_sensor_lines(const model::Cluster& cluster, ClusterFindings& findings) {
  for (std::size_t s = 0; s < cluster.sensors.size(); ++s) {
    const auto sensor = static_cast<SensorId>(s);
    const auto can = can_of_lines(cluster, sensor);
    if (!can) {
      const std::string& device = cluster.node(cluster.sensor(sensor).device).name;
      findings.at(cluster.sensor(sensor).line, fmt::format("sensors.{}.device", cluster.sensor(sensor).name), device,
                  fmt::format("must write to a CAN in a task that the sensor activates: in real time trigger and "
                              "strobe use the CAN of {}'s raw data",
                              device));
      continue;
    }
    const model::CanBus& bus = cluster.can_buses[*can];
    for (const model::CanMessage& message : bus.messages) {
      const bool strobe = message.identifier == model::strobe_identifier(sensor);
      if (!strobe && message.identifier != model::trigger_identifier(sensor)) continue;
      findings.at(
          message.line, message_path(bus, message), fmt::format("identifier {}", message.identifier),
          fmt::format("must be another identifier in real time: {0} uses {1} for its strobe and {2} for its trigger",
                      cluster.sensor(sensor).name, model::strobe_identifier(sensor),
                      model::trigger_identifier(sensor)));
    }
  }
}

}  // namespace

std::string time_scale_text(std::int64_t time_scale_ppm) { return scaled_text(time_scale_ppm, kTimeScaleOne); }

Duration stretched(Duration scheduled, std::int64_t time_scale_ppm) {
  return {static_cast<std::int64_t>(static_cast<Int128>(scheduled.ns) * time_scale_ppm / kTimeScaleOne)};
}

int last_static_slot(const model::Cluster& cluster) {
  int last = 0;
  for (const model::FrameSlot& frame : cluster.frames)
    if (!is_dynamic(cluster.flexray, frame)) last = std::max(last, frame.slot);
  return last;
}

Duration arrival_room(const model::Cluster& cluster, std::int64_t time_scale_ppm) {
  return {static_cast<std::int64_t>(static_cast<Int128>(room_ps(cluster)) * time_scale_ppm / (1'000 * kTimeScaleOne))};
}

std::int64_t smallest_time_scale(const model::Cluster& cluster, const model::ArrivalWindow& window) {
  const Int128 room = room_ps(cluster), cycle = cluster.flexray.cycle_ps();
  const Int128 for_late = (scaled_ps(window.late) + room - 1) / room;
  const Int128 for_both = scaled_ps(window.early + window.late) / cycle + 1;
  return static_cast<std::int64_t>(std::max({for_late, for_both, static_cast<Int128>(kSmallestTimeScale)}));
}

std::vector<Finding> check_real_time(const model::Cluster& cluster, std::int64_t time_scale_ppm) {
  ClusterFindings findings(cluster);
  if (!cluster.arrival_window)
    findings.parameter("real_time", "",
                       "is missing: without an arrival window {early, late} a cluster is for virtual time only");
  else
    check_window(cluster, time_scale_ppm, findings);
  const auto dynamic = std::ranges::find_if(
      cluster.frames, [&](const model::FrameSlot& frame) { return is_dynamic(cluster.flexray, frame); });
  if (dynamic != cluster.frames.end())
    findings.at(
        dynamic->line, frame_path(*dynamic), cluster.node(dynamic->sender).name,
        fmt::format("must be a static slot, 1..{}, in real time: frames of the dynamic segment are for virtual time "
                    "only, as its minislots of {} pass between two wake-ups",
                    cluster.flexray.gNumberOfStaticSlots,
                    us_text({cluster.flexray.gdMinislot * cluster.flexray.gdMacrotick_ps / 1'000})));
  if (cluster.topology != model::Topology::kBus)
    findings.parameter("topology", "star",
                       "must be bus in real time: stars, and guardians in them, are simulated in virtual time only");
  check_sensor_lines(cluster, findings);
  return findings.take();
}

}  // namespace ttf::schedules::check
