#include <algorithm>
#include <map>
#include <set>

#include "report/timing/painter.h"

namespace ttf::report::timing {

std::vector<drawing::LegendEntry> timing_legend(const TimingData& data, const drawing::Names& names,
                                                const std::vector<Way>& ways, bool images, TrueTime from, TrueTime to) {
  const auto visible = [&](TrueTime start, TrueTime end) { return start < to && end >= from; };
  std::vector<drawing::LegendEntry> legend;
  using K = drawing::LegendEntry::Kind;
  bool any_late = false, any_waiting = false, any_dropped = false;
  for (const Way& way : ways) {
    if (way.legs.empty() || !visible(way.legs.front().from.at, way.last.at)) continue;
    any_late |= way.out_of_sequence;
    any_dropped |= way.dropped;
    for (const Leg& leg : way.legs) any_waiting |= leg.kind == Leg::Kind::kHeld;
  }
  std::set<SensorId> sensors;
  for (const auto& m : data.measurements) sensors.insert(m.id.sensor);
  for (const SensorId sensor : sensors)
    legend.push_back({K::kMarker, names.sensor(sensor) + " measures, its lists and their way",
                      sensor_colour(names, sensor), sensor_marker(names, sensor), true});
  std::map<PduId, bool> pdus;
  bool null_frames = false, status = false;
  for (const auto& f : data.slot_frames) {
    if (!visible(f.start, f.end)) continue;
    if (f.null_frame)
      null_frames = true;
    else if (f.pdu == kNoPdu)
      status = true;
    else if (names.sensor_of(f.pdu) == kNoSensor)
      pdus[f.pdu] = true;
  }
  for (const auto& [pdu, used] : pdus) legend.push_back({K::kBox, names.pdu(pdu), pdu_colour(names, pdu), {}, true});
  if (images) legend.push_back({K::kArrow, "way of the real-time image", std::string(drawing::kBlack)});
  if (status) legend.push_back({K::kBox, "status frame", std::string(drawing::kStatusFrame), {}, true});
  if (null_frames) legend.push_back({K::kBox, "null frame", std::string(drawing::kGrey), {}, false});
  if (any_late) legend.push_back({K::kArrow, "out of sequence", "#444444", {}, false, "5 3"});
  if (any_waiting) legend.push_back({K::kArrow, "held back", "#444444", {}, false, "1.5 2.5"});
  if (any_dropped) legend.push_back({K::kMarker, "dropped", std::string(drawing::kBlack), drawing::Marker::kCross});
  const auto any_run = [&](bool missed) {
    return std::ranges::any_of(data.executions, [&](const auto& r) {
      return !(missed && r.deadline_met) && visible(r.activated.true_time, r.end.true_time);
    });
  };
  if (any_run(false)) {
    legend.push_back({K::kBox, "task", std::string(kTaskFill), {}, true});
    legend.push_back({K::kLine, "activated, waiting", "#666666"});
    if (any_run(true)) legend.push_back({K::kBox, "task, deadline missed", std::string(kDeadlineMissed), {}, true});
  }
  return legend;
}

}  // namespace ttf::report::timing
