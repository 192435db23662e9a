#include "sim/medium/star_coupler.h"

#include <algorithm>
#include <numeric>

#include "core/check.h"

namespace ttf::sim::medium {
namespace {

using bus::guardian::GuardianReason;
using bus::poc::PocKind;
using bus::ports::Signal;

// One signal is forwarded, but many may be emitted. Those beyond this module are handled at once.
constexpr std::size_t kIncomingRoom = 16;
// A leading coldstart node is alone in its first cycles (bus/poc/poc.h).
constexpr std::int64_t kLeaderAlone = 4;

NodeId guardian_of(const schedules::model::Cluster& with_guardian) {
  return static_cast<NodeId>(with_guardian.nodes.size() - 1);
}

}  // namespace

// Receives the controller's events, and is its port, which it never uses.
struct StarCoupler::Watch final : bus::controller::ControllerEvents, bus::ports::FlexRayPort {
  StarCoupler& coupler;
  TrueTime now{};
  explicit Watch(StarCoupler& c) : coupler(c) {}
  void transmit(const bus::ports::Transmission& sent) override {
    TTF_CHECK(false, "the guardian sends in slot {}", sent.slot);
  }
  bool carrier(schedules::model::Channel channel) const override {
    return channel == coupler.channel_ && std::any_of(coupler.incoming_.begin(), coupler.incoming_.end(),
                                                      [&](const Incoming& incoming) { return incoming.start <= now; });
  }
  void state_changed(PocKind from, const bus::poc::PocStep& step, Microticks at) override {
    if (from == PocKind::kIntegrationConsistencyCheck && step.next.kind == PocKind::kIntegrationListen)
      coupler.turns_.schedule_dropped(at);
    if (step.next.kind == PocKind::kNormalActive) coupler.turns_.synchronised();
  }
};

bool StarCoupler::needed(const schedules::model::Cluster& cluster, schedules::model::Channel channel) {
  return cluster.guardian &&
         std::any_of(cluster.nodes.begin(), cluster.nodes.end(), [&](const schedules::model::Node& node) {
           return node.flexray && includes(node.flexray->pChannels, channel);
         });
}

std::int64_t StarCoupler::microtick_ps(const schedules::model::Cluster& cluster, schedules::model::Channel channel) {
  return bus::guardian::guardian_cluster(cluster, channel).nodes.back().microtick_ps;
}

StarCoupler::StarCoupler(const schedules::model::Cluster& cluster, schedules::model::Channel channel,
                         const timebase::Oscillator& oscillator, TrueTime on)
    : cluster_(bus::guardian::guardian_cluster(cluster, channel)), channel_(channel), oscillator_(oscillator),
      guardian_(cluster_, channel, *cluster_.nodes.back().flexray),
      turns_(cluster_, channel, *cluster_.nodes.back().flexray), watch_(std::make_unique<Watch>(*this)),
      controller_(
          std::make_unique<bus::controller::FlexRayController>(cluster_, guardian_of(cluster_), *watch_, *watch_)),
      dynamic_(cluster_.flexray) {
  TTF_CHECK(oscillator.nominal_period_ps() == cluster_.nodes.back().microtick_ps, "microticks of {} and {} ps",
            oscillator.nominal_period_ps(), cluster_.nodes.back().microtick_ps);
  incoming_.reserve(kIncomingRoom);
  power_on(oscillator_.ticks_at(on));
}

StarCoupler::~StarCoupler() = default;

std::uint64_t StarCoupler::blocked() const {
  return std::accumulate(count_.begin() + 1, count_.end(), std::uint64_t{0});
}

void StarCoupler::power_on(Microticks now) {
  turns_.reset();
  counted_cycle_ = -1;
  controller_->start_cold(now);
}

void StarCoupler::start_integrated(TrueTime first, Duration cycle) {
  constexpr int kCycles = 1000;  // so that rounding to one microtick per cycle is the only error
  const Microticks begin = oscillator_.ticks_at(first);
  const std::int64_t ticks = (oscillator_.ticks_at(first + cycle * kCycles) - begin).value;
  const std::int64_t per_cycle = (ticks + kCycles / 2) / kCycles;
  bus::controller::InitialClock clock{begin + Microticks{1}, 0};
  if (cluster_.synchronisation)
    clock.rate = static_cast<int>(per_cycle - cluster_.nodes.back().flexray->pMicroPerCycle);
  controller_->start_integrated(clock);
}

void StarCoupler::advance(Microticks to) {
  controller_->advance(to);
  const PocKind kind = controller_->state().kind;
  if (kind == PocKind::kNormalPassive || kind == PocKind::kHalt) power_on(to);
  const auto& clock = controller_->clock();
  if (clock && clock->cycle() != counted_cycle_) {
    counted_cycle_ = clock->cycle();
    dynamic_.start();
  }
}

void StarCoupler::deliver(const Incoming& incoming) {
  bus::ports::Reception reception{
      channel_, incoming.signal, oscillator_.ticks_at(incoming.start), oscillator_.ticks_at(incoming.end), {}};
  if (incoming.signal == Signal::kFrame) {
    reception.frame = incoming.frame;
    reception.frame.payload = std::span(incoming.bytes).subspan(bus::wire::kHeaderBytes, incoming.frame.payload.size());
  }
  // The controller's work at that very instant is done with the reception (sim/medium/event_queue.h).
  advance(reception.end - Microticks{1});
  watch_->now = incoming.end;
  controller_->receive(reception);
  if (controller_->clock() && controller_->clock()->cycle() == counted_cycle_)
    guardian_.count(*controller_->clock(), dynamic_, reception.start, reception.end);
}

void StarCoupler::catch_up(TrueTime now) {
  while (true) {
    const auto first = std::min_element(incoming_.begin(), incoming_.end(),
                                        [](const Incoming& a, const Incoming& b) { return a.end < b.end; });
    if (first == incoming_.end() || first->end > now) break;
    const Incoming incoming = *first;
    *first = incoming_.back();
    incoming_.pop_back();
    deliver(incoming);
  }
  advance(oscillator_.ticks_at(now));
}

// Takes in a signal. Overlapping signals are undecodable, as for any receiver.
void StarCoupler::receive(NodeId branch, const Leaving& signal, const bus::wire::DecodedFrame* frame) {
  Incoming incoming{branch, signal.start, signal.end, signal.signal, {}, {}};
  if (frame != nullptr && signal.signal == Signal::kFrame) {
    incoming.frame = *frame;
    std::copy(signal.bytes.begin(), signal.bytes.end(), incoming.bytes.begin());
  }
  for (std::size_t i = 0; i < incoming_.size();) {
    const Incoming& other = incoming_[i];
    if (other.start >= incoming.end || incoming.start >= other.end) {
      ++i;
      continue;
    }
    incoming.signal = Signal::kUndecodable;
    incoming.branch = kNoNode;
    incoming.start = std::min(incoming.start, other.start);
    incoming.end = std::max(incoming.end, other.end);
    incoming_[i] = incoming_.back();
    incoming_.pop_back();
    i = 0;
  }
  incoming_.push_back(incoming);
}

bus::guardian::GuardianAnswer StarCoupler::judge(const bus::guardian::GuardianSignal& signal) const {
  const auto& clock = controller_->clock();
  if (!clock) return turns_.judge(signal);
  const bool alone = !controller_->synchronised() && clock->cycle() < kLeaderAlone;
  if (alone && signal.branch != turns_.leader()) return {GuardianReason::kOtherLeads, {}};
  return guardian_.judge(*clock, dynamic_, signal);
}

// Returns the end of the forwarded signal.
TrueTime StarCoupler::end_of(TrueTime start, TrueTime end, Microticks until) const {
  const auto& clock = controller_->clock();
  const Microticks sent = oscillator_.ticks_at(end - Duration{1}) + Microticks{1};  // the first at or after `end`
  const Microticks ends =
      clock ? guardian_.end_of(*clock, oscillator_.ticks_at(start), sent, until) : std::min(sent, until);
  return ends == sent ? end : oscillator_.time_of(ends);
}

// The controller may still wait for the second frame of a node whose lead has failed.
void StarCoupler::lead_begins() {
  if (controller_->state().kind != PocKind::kInitialiseSchedule) return;
  const Microticks now = oscillator_.ticks_at(watch_->now);
  controller_->command(bus::poc::PocEventKind::kReady, now);
  controller_->command(bus::poc::PocEventKind::kRun, now);
}

bool StarCoupler::pass(Leaving& signal, const bus::wire::DecodedFrame* frame) {
  if (failure_ == Failure::kSilent) return false;
  if (failure_ == Failure::kStuckOpen) return true;
  watch_->now = signal.start;
  catch_up(signal.start);
  const bus::guardian::GuardianSignal asked{signal.sender, signal.signal, oscillator_.ticks_at(signal.start), frame};
  bus::guardian::GuardianAnswer answer{GuardianReason::kOtherForwarded, {}};
  if (signal.start >= taken_until_) answer = judge(asked);
  ++count_[static_cast<std::size_t>(answer.reason)];
  const TrueTime until = answer.forwards() ? end_of(signal.start, signal.end, answer.until) : signal.start;
  const bool cut = answer.forwards() && signal.end > until;
  cut_ += cut ? 1 : 0;
  held_ += until > signal.end ? 1 : 0;
  if (report_ && (cut || !answer.forwards()))
    report_({signal.start, signal.sender, channel_, signal.signal, answer.reason, until});
  if (!answer.forwards()) return false;
  if (turns_.forwarded(asked, controller_->clock().has_value())) lead_begins();
  signal.end = until;
  if (cut) {
    signal.signal = Signal::kUndecodable;
    signal.bytes = {};
  }
  taken_until_ = signal.end;
  receive(signal.sender, signal, frame);
  return true;
}

void StarCoupler::disturbed(const Leaving& signal) {
  if (failure_ != Failure::kNone) return;
  if (incoming_.size() >= kIncomingRoom) catch_up(signal.start);
  Leaving noise = signal;
  noise.signal = signal.signal == Signal::kFrame ? Signal::kUndecodable : signal.signal;
  receive(kNoNode, noise, nullptr);
}

TrueTime StarCoupler::fell_silent(NodeId branch, TrueTime at) {
  // Only the forwarded signal has a branch.
  const auto incoming = std::find_if(incoming_.begin(), incoming_.end(),
                                     [&](const Incoming& one) { return one.branch == branch && one.end > at; });
  if (failure_ != Failure::kNone || incoming == incoming_.end()) return at;
  // The clock is still in the cycle in which the signal began: it has not been delivered yet.
  const TrueTime silent = std::max(at, incoming->start + Duration{1});
  const TrueTime ends = std::max(silent, end_of(incoming->start, silent, oscillator_.ticks_at(incoming->end)));
  held_ += ends > silent ? 1 : 0;
  incoming->signal = Signal::kUndecodable;
  incoming->end = taken_until_ = ends;
  return ends;
}

}  // namespace ttf::sim::medium
