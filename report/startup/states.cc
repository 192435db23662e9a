#include "report/startup/states.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include "recording/records/records.h"
#include "report/drawing/axes.h"

namespace ttf::report::startup {
namespace {

using recording::records::PocKind;

std::string sentence(const StartupData::Change& c) {
  return c.consequence.empty() ? c.why : c.why + "; " + c.consequence;
}

}  // namespace

std::set<NodeId> active_from_the_start(const StartupData& data) {
  struct Sign {
    TrueTime at{};
    bool active = false;
  };
  std::map<NodeId, Sign> first;  // each node's first sign of state
  for (const auto& p : data.power) first.try_emplace(p.stamp.node, Sign{p.stamp.true_time, !p.on});
  for (const StartupData::Change& c : data.changes)
    if (const auto [sign, is_first] = first.try_emplace(c.node, Sign{c.at, false}); !is_first && c.at < sign->second.at)
      sign->second = {c.at, false};
  for (const StartupData::Frame& f : data.frames) first.try_emplace(f.node, Sign{f.start, true});
  std::set<NodeId> nodes;
  for (const auto& [node, sign] : first)
    if (sign.active) nodes.insert(node);
  return nodes;
}

std::vector<StateSpan> state_spans(const StartupData& data, TrueTime begin, TrueTime end) {
  std::vector<StateSpan> spans;
  std::map<NodeId, StateSpan> now;
  for (const NodeId node : active_from_the_start(data))
    now[node] = {node, PocKind::kNormalActive, begin,
                 end,  "normal active",        "integrated from the beginning of the drive"};
  const auto leave = [&](NodeId node, TrueTime at) {
    const auto found = now.find(node);
    if (found == now.end()) return;
    found->second.end = std::min(at, end);
    if (found->second.start < found->second.end) spans.push_back(found->second);
    now.erase(found);
  };
  // Both lists have the log's order; at one instant, the supply goes before the state.
  auto power = data.power.begin();
  const auto supply_until = [&](TrueTime at) {
    for (; power != data.power.end() && power->stamp.true_time <= at; ++power)
      if (!power->on) leave(power->stamp.node, power->stamp.true_time);
  };
  std::map<NodeId, bool> seen;
  for (const StartupData::Change& c : data.changes) {
    supply_until(c.at);
    if (!seen[c.node] && c.from != PocKind::kDefaultConfig) now[c.node] = {c.node, c.from, begin, end, c.from_name, ""};
    seen[c.node] = true;
    leave(c.node, c.at);
    now[c.node] = {c.node, c.to, c.at, end, c.to_name, sentence(c)};
  }
  supply_until(end);
  while (!now.empty()) leave(now.begin()->first, end);
  std::stable_sort(spans.begin(), spans.end(),
                   [](const StateSpan& a, const StateSpan& b) { return a.start < b.start; });
  return spans;
}

StatePhase phase_of(PocKind state) {
  switch (state) {
    case PocKind::kDefaultConfig:
    case PocKind::kConfig:
    case PocKind::kReady: return {"is configured", "#e2e2e2"};
    case PocKind::kWakeupListen:
    case PocKind::kWakeupSend:
    case PocKind::kWakeupDetect: return {"wakes the cluster", drawing::tint(drawing::kPurple, 0.35)};
    case PocKind::kColdstartListen:
    case PocKind::kIntegrationListen: return {"listens", drawing::tint(drawing::kSkyBlue, 0.6)};
    case PocKind::kColdstartCollisionResolution:
    case PocKind::kColdstartConsistencyCheck:
    case PocKind::kColdstartGap: return {"leads", drawing::tint(drawing::kOrange, 0.35)};
    case PocKind::kInitialiseSchedule:
    case PocKind::kIntegrationColdstartCheck:
    case PocKind::kColdstartJoin:
    case PocKind::kIntegrationConsistencyCheck: return {"joins", drawing::tint(drawing::kYellow, 0.35)};
    case PocKind::kNormalActive: return {"normal active", drawing::tint(drawing::kGreen, 0.45)};
    case PocKind::kNormalPassive: return {"normal passive", drawing::tint(drawing::kBlue, 0.45)};
    case PocKind::kHalt: return {"halt", drawing::tint(drawing::kVermilion, 0.25)};
  }
  return {"other state", "#ffffff"};
}

std::string_view short_name(PocKind state) {
  switch (state) {
    case PocKind::kWakeupListen:
    case PocKind::kColdstartListen:
    case PocKind::kIntegrationListen: return "listen";
    case PocKind::kColdstartCollisionResolution: return "resolution";
    case PocKind::kColdstartConsistencyCheck:
    case PocKind::kIntegrationColdstartCheck:
    case PocKind::kIntegrationConsistencyCheck: return "check";
    case PocKind::kColdstartGap: return "gap";
    case PocKind::kColdstartJoin: return "join";
    case PocKind::kInitialiseSchedule: return "initialise";
    case PocKind::kNormalActive: return "active";
    case PocKind::kNormalPassive: return "passive";
    case PocKind::kDefaultConfig:
    case PocKind::kConfig:
    case PocKind::kReady:
    case PocKind::kWakeupSend:
    case PocKind::kWakeupDetect:
    case PocKind::kHalt: break;
  }
  return "";
}

}  // namespace ttf::report::startup
