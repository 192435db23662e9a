#include "evaluation/faults/causes.h"

#include <algorithm>
#include <utility>

#include "schedules/model/round.h"

namespace ttf::evaluation::faults {
namespace {

// No older act is needed: losses are settled two cycles after them.
constexpr int kCyclesRemembered = 5;
constexpr Duration kRounded{schedules::model::kGranularity_ns};

bool shares(schedules::model::Channels a, schedules::model::Channels b) {
  return (static_cast<unsigned>(a) & static_cast<unsigned>(b)) != 0;
}

}  // namespace

FaultCauses::FaultCauses(const ttf::faults::FaultPlan& plan, const schedules::model::Cluster& cluster)
    : cluster_(cluster), patience_(cluster.cycle() * 2 * (cluster.flexray.gMaxWithoutClockCorrectionFatal + 1)) {
  for (const ttf::faults::Fault& fault : plan.faults) {
    Suspect& suspect = suspects_.emplace_back();
    suspect.reach = reach_of(fault, cluster);
    suspect.channels = fault.channels;
    suspect.named = named_by(fault, cluster);
    suspect.out.resize(cluster.nodes.size());
  }
}

void FaultCauses::begins(std::size_t fault, TrueTime at) { suspects_[fault].began = at; }
void FaultCauses::ends(std::size_t fault, TrueTime at) { suspects_[fault].ended = at; }

void FaultCauses::acts(std::size_t fault, TrueTime at) {
  std::deque<TrueTime>& acts = suspects_[fault].acts;
  if (acts.empty() || acts.back() != at) acts.push_back(at);
  while (acts.size() > 1 && acts[1] + cluster_.cycle() * kCyclesRemembered < at) acts.pop_front();
}

void FaultCauses::left(NodeId node, std::size_t cause) { suspects_[cause].out[index_of(node)] = true; }
void FaultCauses::is_back(NodeId node) {
  for (Suspect& suspect : suspects_) suspect.out[index_of(node)] = false;
}

bool FaultCauses::begun(const Suspect& suspect, TrueTime by) {
  return suspect.began && *suspect.began <= by + kRounded;
}

bool FaultCauses::any_begun(TrueTime by) const {
  return std::any_of(suspects_.begin(), suspects_.end(), [&](const Suspect& suspect) { return begun(suspect, by); });
}

bool FaultCauses::owns(const Suspect& suspect, NodeId node, TrueTime since) {
  if (node == kNoNode) return false;
  return suspect.out[index_of(node)] || (suspect.named[index_of(node)] && acting(suspect, since));
}

TrueTime FaultCauses::last_act(const Suspect& suspect, TrueTime until) {
  const auto later = std::upper_bound(suspect.acts.begin(), suspect.acts.end(), until + kRounded);
  return later == suspect.acts.begin() ? *suspect.began : *std::prev(later);
}

bool FaultCauses::disturbs(const Suspect& suspect, const Signal& signal) const {
  if (!suspect.reach.channel || !shares(suspect.channels, signal.channels)) return false;
  const auto first = std::lower_bound(suspect.acts.begin(), suspect.acts.end(), signal.from - suspect.reach.lasts);
  return first != suspect.acts.end() && *first <= signal.until + kRounded;
}

// A fault that has never acted is the cause only if no other fits: its effect may be seen a moment before its
// record.
template <class Fits> FaultCauses::Cause FaultCauses::latest(TrueTime until, Fits fits) const {
  Cause cause;
  std::pair<bool, TrueTime> newest;
  for (std::size_t f = 0; f < suspects_.size(); ++f) {
    const Suspect& suspect = suspects_[f];
    if (!begun(suspect, until) || !fits(suspect)) continue;
    const std::pair act(!suspect.acts.empty(), last_act(suspect, until));
    if (cause && act < newest) continue;
    cause = f;
    newest = act;
  }
  return cause;
}

FaultCauses::Cause FaultCauses::of_signal(const Signal& signal) const {
  const auto its_own = [&](const Suspect& suspect) {
    return owns(suspect, signal.owner, signal.from) ||
           (suspect.reach.reception && owns(suspect, signal.receiver, signal.from));
  };
  const auto on_channel = [&](const Suspect& suspect) { return disturbs(suspect, signal); };
  const auto at_once = [&](const Suspect& suspect) { return its_own(suspect) || on_channel(suspect); };
  Cause cause = signal.silence ? latest(signal.until, its_own) : latest(signal.until, at_once);
  if (!cause && signal.silence) cause = latest(signal.until, on_channel);
  if (cause) return cause;
  return latest(signal.until, [&](const Suspect& suspect) {
    return suspect.reach.clocks && acting(suspect, signal.from - patience_);
  });
}

FaultCauses::Cause FaultCauses::of_node(NodeId node, TrueTime at) const {
  Cause cause = latest(at, [&](const Suspect& suspect) { return owns(suspect, node, at); });
  if (!cause && node == kNoNode)
    cause = latest(at, [&](const Suspect& suspect) { return suspect.reach.clocks && acting(suspect, at - patience_); });
  if (cause) return cause;
  return latest(at, [&](const Suspect& suspect) { return acting(suspect, at - patience_); });
}

}  // namespace ttf::evaluation::faults
