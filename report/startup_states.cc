#include "report/startup_states.h"

#include <algorithm>
#include <map>

#include "report/axes.h"

namespace ttf::report {
namespace {

std::string sentence(const StartupData::Change& c) {
  return c.consequence.empty() ? c.why : c.why + "; " + c.consequence;
}

}  // namespace

std::vector<StateSpan> state_spans(const StartupData& data, TrueTime begin, TrueTime end) {
  std::vector<StateSpan> spans;
  std::map<NodeId, StateSpan> now;
  const auto leave = [&](NodeId node, TrueTime at) {
    const auto found = now.find(node);
    if (found == now.end()) return;
    found->second.end = std::min(at, end);
    if (found->second.start < found->second.end) spans.push_back(found->second);
    now.erase(found);
  };
  // Both lists are in the order of the log; the supply goes before the state of an instant.
  auto power = data.power.begin();
  const auto supply_until = [&](TrueTime at) {
    for (; power != data.power.end() && power->at <= at; ++power)
      if (!power->on) leave(power->node, power->at);
  };
  std::map<NodeId, bool> seen;
  for (const StartupData::Change& c : data.changes) {
    supply_until(c.at);
    if (!seen[c.node] && c.from != kStateDefaultConfig) now[c.node] = {c.node, c.from, begin, end, c.from_name, ""};
    seen[c.node] = true;
    leave(c.node, c.at);
    now[c.node] = {c.node, c.to, c.at, end, c.to_name, sentence(c)};
  }
  supply_until(end);
  while (!now.empty()) leave(now.begin()->first, end);
  std::stable_sort(spans.begin(), spans.end(), [](const StateSpan& a, const StateSpan& b) { return a.start < b.start; });
  return spans;
}

StatePhase phase_of(std::uint8_t state) {
  switch (state) {
    case kStateDefaultConfig:
    case kStateConfig:
    case kStateReady: return {"is configured", "#e2e2e2"};
    case kStateWakeupListen:
    case kStateWakeupSend:
    case kStateWakeupDetect: return {"wakes the cluster", tint(kPurple, 0.35)};
    case kStateColdstartListen:
    case kStateIntegrationListen: return {"listens", tint(kSkyBlue, 0.6)};
    case kStateCollisionResolution:
    case kStateConsistencyCheck:
    case kStateColdstartGap: return {"leads", tint(kOrange, 0.35)};
    case kStateInitialiseSchedule:
    case kStateIntegrationColdstartCheck:
    case kStateColdstartJoin:
    case kStateIntegrationConsistencyCheck: return {"joins", tint(kYellow, 0.35)};
    case kStateNormalActive: return {"normal active", tint(kGreen, 0.45)};
    case kStateNormalPassive: return {"normal passive", tint(kBlue, 0.45)};
    case kStateHalt: return {"halt", tint(kVermilion, 0.25)};
    default: return {"other state", "#ffffff"};
  }
}

std::string_view short_name(std::uint8_t state) {
  switch (state) {
    case kStateWakeupListen:
    case kStateColdstartListen:
    case kStateIntegrationListen: return "listen";
    case kStateCollisionResolution: return "resolution";
    case kStateConsistencyCheck:
    case kStateIntegrationColdstartCheck:
    case kStateIntegrationConsistencyCheck: return "check";
    case kStateColdstartGap: return "gap";
    case kStateColdstartJoin: return "join";
    case kStateInitialiseSchedule: return "initialise";
    case kStateNormalActive: return "active";
    case kStateNormalPassive: return "passive";
    default: return "";
  }
}

}  // namespace ttf::report
