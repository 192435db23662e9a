#include "evaluation/faults/fault_account.h"

#include <algorithm>
#include <utility>

#include "bus/wire/flexray_frame.h"
#include "evaluation/faults/reach.h"
#include "schedules/model/wire_times.h"

namespace ttf::evaluation::faults {
namespace {

using recording::records::PocKind;

Duration macroticks(const schedules::model::GlobalParameters& g, std::int64_t count) {
  return {count * g.gdMacrotick_ps / 1000};
}

schedules::model::Channels only(std::uint8_t channel) {
  return channel == 0 ? schedules::model::Channels::kA : schedules::model::Channels::kB;
}

// Returns whether a change leads from start-up back to its beginning, or to an end without success.
bool falls_back(const recording::records::StateChanged& change) {
  const PocKind from = change.from;
  switch (change.to) {
    case PocKind::kHalt:
    case PocKind::kWakeupDetect:  // another node is on the channel
    case PocKind::kColdstartGap: return true;
    case PocKind::kColdstartListen:
    case PocKind::kIntegrationListen:
      return from != PocKind::kReady && from != PocKind::kColdstartListen && from != PocKind::kIntegrationListen;
    case PocKind::kReady:
      return from != PocKind::kConfig && from != PocKind::kWakeupListen && from != PocKind::kWakeupSend &&
             from != PocKind::kWakeupDetect;
    case PocKind::kDefaultConfig:
    case PocKind::kConfig:
    case PocKind::kWakeupListen:
    case PocKind::kWakeupSend:
    case PocKind::kColdstartCollisionResolution:
    case PocKind::kColdstartConsistencyCheck:
    case PocKind::kInitialiseSchedule:
    case PocKind::kIntegrationColdstartCheck:
    case PocKind::kColdstartJoin:
    case PocKind::kIntegrationConsistencyCheck:
    case PocKind::kNormalActive:
    case PocKind::kNormalPassive: return false;
  }
  return false;
}

}  // namespace

bool FaultEffects::harmed() const {
  return std::any_of(harms.begin(), harms.end(), [](const auto& nodes) { return !nodes.empty(); });
}

bool FaultEffects::nothing() const {
  const auto seen = [](const CheckSeen& check) { return check.cycles > 0; };
  return !harmed() && states.empty() && guardians.empty() && std::none_of(by_others.begin(), by_others.end(), seen) &&
         std::none_of(by_faulty.begin(), by_faulty.end(), seen);
}

bool FaultFindings::harmed() const {
  return unattributed.harmed() ||
         std::any_of(faults.begin(), faults.end(), [](const FaultSeen& fault) { return fault.harmed(); });
}

FaultAccount::FaultAccount(const schedules::model::Cluster& cluster, ttf::faults::FaultPlan plan,
                           bool begins_integrated)
    : cluster_(cluster), plan_(std::move(plan)), cycle_(cluster.cycle()),
      slot_(macroticks(cluster.flexray, cluster.flexray.gdStaticSlot)),
      action_point_(macroticks(cluster.flexray, cluster.flexray.gdActionPointOffset)),
      assumed_precision_(assumed_precision(cluster.flexray)), standings_(cluster, begins_integrated),
      cut_off_(cluster.nodes.size()), causes_(plan_, cluster), clocks_(cluster),
      ledger_(cluster, standings_, [this](const SlotLoss& loss) { lost(loss); }), place_(plan_.faults.size()),
      counted_(plan_.faults.size() + 1) {}

void FaultAccount::finish(TrueTime at) {
  ledger_.finish(at);
  for (std::size_t n = 0; n < standings_.size(); ++n) {
    const auto node = static_cast<NodeId>(n);
    if (standings_.never_started(node)) harm(causes_.of_node(node, at), Harm::kNotStarted, at, node);
  }
}

FaultEffects& FaultAccount::effects(Cause cause) {
  return cause ? static_cast<FaultEffects&>(findings_.faults[*place_[*cause]]) : findings_.unattributed;
}

// Returns the running cycle, counted on from the newest known one.
std::int64_t FaultAccount::cycle_at(TrueTime at) const {
  const auto [began, cycle] = cycle_began_.value_or(std::pair(TrueTime{}, std::int64_t{0}));
  return cycle + std::max<std::int64_t>(0, (at - began).ns / cycle_.ns);
}

void FaultAccount::on(const recording::records::FaultActivity& activity) {
  if (activity.fault >= place_.size()) return;  // from another plan
  const ttf::faults::Fault& fault = plan_.faults[activity.fault];
  auto& place = place_[activity.fault];
  if (!place) {
    place = findings_.faults.size();
    findings_.faults.emplace_back();
    causes_.begins(activity.fault, activity.at);
    const std::vector<bool> named = named_by(fault, cluster_);
    for (std::size_t n = 0; n < named.size(); ++n) {
      if (!named[n]) continue;
      const auto node = static_cast<NodeId>(n);
      standings_.becomes_faulty(node);
      if (takes_supply(fault, node)) cut_off_[n] = true;
      clocks_.forget(node);
    }
  }
  findings_.faults[*place].take(activity);
  if (activity.what == recording::records::FaultAct::kActs) causes_.acts(activity.fault, activity.at);
  if (activity.what == recording::records::FaultAct::kEnds) causes_.ends(activity.fault, activity.at);
}

void FaultAccount::on(const recording::records::StateChanged& change) {
  const NodeId node = change.stamp.node;
  const TrueTime at = change.stamp.true_time;
  if (!has(node)) return;
  const Cause cause = causes_.of_node(node, at);
  if (!starts_as_planned(node) || falls_back(change))
    changed(cause, node, change.from_name, change.to_name, change.why, at);
  for_each_check(change, [&](Check check) { notice(cause, check, node, cycle_at(at), at); });
  if (standings_.leaves_by(change)) left_active(cause, node, at);
  if (standings_.active(node)) causes_.is_back(node);
}

void FaultAccount::on(const recording::records::PowerChanged& power) {
  const NodeId node = power.stamp.node;
  const TrueTime at = power.stamp.true_time;
  if (!has(node)) return;
  const Cause cause = causes_.of_node(node, at);
  const std::string_view off = "without supply", on = "with supply";
  if (!power.on || !starts_as_planned(node)) changed(cause, node, power.on ? off : on, power.on ? on : off, "", at);
  if (power.on) return;
  if (cause) causes_.left(node, *cause);
  if (standings_.leaves_by(power)) left_active(cause, node, at);
}

void FaultAccount::left_active(Cause cause, NodeId node, TrueTime at) {
  clocks_.forget(node);
  if (!standings_.faulty(node)) harm(cause, Harm::kLeftActive, at, node);
  if (cause) causes_.left(node, *cause);
}

void FaultAccount::on(const recording::records::SlotProblem& problem) {
  const NodeId node = problem.stamp.node;
  const TrueTime at = problem.stamp.true_time;
  if (!has(node)) return;
  ledger_.on(problem);
  const schedules::model::GlobalParameters& g = cluster_.flexray;
  FaultCauses::Signal signal;
  signal.receiver = node;
  signal.channels = only(problem.channel);
  signal.owner =
      owner_of(cluster_, problem.slot, static_cast<schedules::model::Channel>(problem.channel & 1), problem.cycle);
  if (problem.slot >= 1 && problem.slot <= g.gNumberOfStaticSlots) {
    // Reported at the end of the static segment. Frames begin an action point offset into their slots, and
    // clocks differ by less.
    signal.until = at - slot_ * (g.gNumberOfStaticSlots - problem.slot);
    signal.from = signal.until - slot_;
  } else {
    signal.until = at;
    signal.from = at - bus::wire::frame_duration(g, static_cast<int>(bus::wire::kMaxPayloadBytes / 2));
  }
  for_each_check(problem, [&](Check check) {
    signal.silence = check == Check::kNoFrame;
    notice(causes_.of_signal(signal), check, node, problem.cycle, at);
  });
}

void FaultAccount::on(const recording::records::ClockCorrected& corrected) {
  const NodeId node = corrected.stamp.node;
  const TrueTime at = corrected.stamp.true_time;
  if (!has(node)) return;
  for_each_check(corrected, [&](Check check) { notice(causes_.of_node(node, at), check, node, corrected.cycle, at); });
}

void FaultAccount::on(const recording::records::SlotFrameSent& frame) {
  if (!has(frame.stamp.node)) return;
  ledger_.on(frame);
  if (!standings_.counts(frame.stamp.node)) return;
  const TrueTime at = frame.stamp.true_time;
  cycle_began_ = std::pair(at - Duration{(frame.stamp.global - GlobalTime{}).ns % cycle_.ns}, frame.cycle);
  const auto apart = clocks_.sent(frame);
  if (apart && *apart > assumed_precision_) harm(causes_.of_node(kNoNode, at), Harm::kPrecision, at, kNoNode);
}

void FaultAccount::on(const recording::records::GuardianIntervention& kept) {
  if (!causes_.any_begun(kept.at)) return;
  const Cause cause = causes_.of_signal({kept.branch, kNoNode, only(kept.channel), kept.at, kept.at, false});
  const std::int64_t cycle = cycle_at(kept.at);
  notice(cause, Check::kGuardian, false, cycle, kept.at).guardians[kept.channel & 1] = true;
  std::vector<GuardianSeen>& guardians = effects(cause).guardians;
  const auto known = std::find_if(guardians.begin(), guardians.end(), [&](const GuardianSeen& seen) {
    return seen.cut == kept.cut && seen.why == kept.why;
  });
  if (known != guardians.end())
    ++known->signals;
  else
    guardians.push_back({kept.cut, std::string(kept.why), 1, cycle, kept.at});
}

// Returns null before the first fault has begun.
CanSeen* FaultAccount::can_seen(std::uint8_t bus, const recording::records::Stamp& stamp) {
  if (!causes_.any_begun(stamp.true_time)) return nullptr;
  const auto key = [](const CanSeen& seen) { return std::pair(seen.bus, seen.node); };
  const std::pair sought(bus, stamp.node);
  const auto place = std::ranges::lower_bound(findings_.cans, sought, {}, key);
  if (place != findings_.cans.end() && key(*place) == sought) return &*place;
  return &*findings_.cans.insert(place, CanSeen{.bus = bus, .node = stamp.node, .first = stamp.true_time});
}

void FaultAccount::on(const recording::records::CanErrorFrame& error) {
  CanSeen* const seen = can_seen(error.bus, error.stamp);
  if (seen != nullptr && index_of(error.error) < CanSeen::kErrors) ++seen->errors[index_of(error.error)];
}

void FaultAccount::on(const recording::records::CanStateChanged& change) {
  CanSeen* const seen = can_seen(change.bus, change.stamp);
  if (seen == nullptr) return;
  seen->passive += change.to == recording::records::CanState::kPassive ? 1 : 0;
  seen->bus_off += change.to == recording::records::CanState::kBusOff ? 1 : 0;
}

CheckSeen& FaultAccount::notice(Cause cause, Check check, bool faulty, std::int64_t cycle, TrueTime at) {
  const auto c = static_cast<std::size_t>(check);
  FaultEffects& effects = this->effects(cause);
  CheckSeen& seen = (faulty ? effects.by_faulty : effects.by_others)[c];
  if (seen.cycles == 0) seen.first = at;
  auto& counted = counted_[cause.value_or(place_.size())][2 * c + (faulty ? 1 : 0)]
                          [static_cast<std::size_t>(counter_in(cluster_.flexray, cycle))];
  if (!counted || at - *counted > cycle_ * (cycles_per_round(cluster_.flexray) / 2)) ++seen.cycles;
  counted = at;
  return seen;
}

void FaultAccount::notice(Cause cause, Check check, NodeId node, std::int64_t cycle, TrueTime at) {
  if (!causes_.any_begun(at)) return;
  CheckSeen& seen = notice(cause, check, standings_.faulty(node), cycle, at);
  if (std::find(seen.nodes.begin(), seen.nodes.end(), node) == seen.nodes.end()) seen.nodes.push_back(node);
}

void FaultAccount::changed(Cause cause, NodeId node, std::string_view from, std::string_view to, std::string_view why,
                           TrueTime at) {
  if (!causes_.any_begun(at)) return;
  std::vector<StateSeen>& states = effects(cause).states;
  const auto known = std::find_if(states.begin(), states.end(), [&](const StateSeen& state) {
    return state.node == node && state.from == from && state.to == to;
  });
  if (known != states.end())
    ++known->times;
  else
    states.push_back({node, std::string(from), std::string(to), std::string(why), at, 1});
}

// The frame came on none of the channels that receiver and sender share, so a fault on either may be the cause.
void FaultAccount::lost(const SlotLoss& loss) {
  unsigned channels = 0;
  for (const auto channel : {schedules::model::Channel::kA, schedules::model::Channel::kB})
    if (owner_of(cluster_, loss.slot, channel, loss.cycle) == loss.sender) channels |= 1u << index_of(channel);
  const FaultCauses::Signal signal{loss.sender,
                                   loss.receiver,
                                   static_cast<schedules::model::Channels>(channels),
                                   loss.at - action_point_,
                                   loss.at - action_point_ + slot_,
                                   false};
  harm(causes_.of_signal(signal), loss.forged ? Harm::kFrameForged : Harm::kFrameLost, loss.at, loss.receiver,
       loss.sender, loss.slot);
}

void FaultAccount::harm(Cause cause, Harm harm, TrueTime at, NodeId node, NodeId sender, int slot) {
  // The first fault may destroy a frame that was under way when it began.
  if (!causes_.any_begun(at + slot_)) return;
  std::vector<HarmSeen>& harms = effects(cause).harms[static_cast<std::size_t>(harm)];
  const auto known = std::find_if(harms.begin(), harms.end(), [&](const HarmSeen& seen) { return seen.node == node; });
  if (known != harms.end())
    ++known->times;
  else
    harms.push_back({node, at, sender, slot, 1});
}

}  // namespace ttf::evaluation::faults
