// A small cluster on a small medium, for tests of the controller and of the port: 1 ms cycles of ten static slots.
//
//   slots 1..4   key slots of nodes 0..3: sync status frames on A and B
//   slots 5..8   list "list", four fragments, node 0, A and B
//   slot 9       list "odd", one fragment, node 1, channel A, odd cycles
//   slot 10      unassigned
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "bus/controller/controller.h"
#include "bus/ports/flexray_port.h"
#include "bus/wire/symbols.h"
#include "schedules/model/cluster.h"
#include "tests/bus/layouts.h"
#include "timebase/oscillator.h"

namespace ttf::bus {

inline constexpr PduId kList{0}, kOddList{1};
inline constexpr int kMicroPerCycle = 40'000;  // of 25 ns
// (34 + 20 * gClusterDriftDamping) * gdMaxMicrotick: the assumed precision without propagation delay.
inline constexpr Duration kAssumedPrecision{(34 + 20 * 2) * 25};

inline schedules::model::Cluster small_cluster(int nodes) {
  schedules::model::Cluster cluster;
  cluster.name = "small";
  schedules::model::GlobalParameters& g = cluster.flexray;
  g.gMacroPerCycle = 1000;
  g.gdCycle_ps = 1'000'000'000;
  g.gNumberOfStaticSlots = 10;
  g.gPayloadLengthStatic = 8;
  g.gdNIT = 160;
  g.gOffsetCorrectionStart = 900;
  for (int n = 0; n < nodes; ++n) {
    schedules::model::Node node;
    node.name = "node" + std::to_string(n);
    node.flexray.emplace();
    node.flexray->pMicroPerCycle = kMicroPerCycle;
    node.flexray->pKeySlotId = n + 1;
    node.flexray->pKeySlotUsedForSync = node.flexray->pKeySlotUsedForStartup = true;
    node.flexray->pOffsetCorrectionOut = 400;
    node.flexray->pRateCorrectionOut = 121;  // 40'000 * 0.003 / 0.9985
    cluster.nodes.push_back(node);
    cluster.frames.push_back({n + 1, schedules::model::Channels::kAB, 0, 1, static_cast<NodeId>(n), kNoPdu, 0, 0});
  }
  cluster.pdus = {list_layout(4, 10, 3), list_layout(4, 3, 3)};
  for (int f = 0; f < 4; ++f)
    cluster.frames.push_back({5 + f, schedules::model::Channels::kAB, 0, 1, NodeId{0}, kList, f, 0});
  if (nodes > 1) cluster.frames.push_back({9, schedules::model::Channels::kA, 1, 2, NodeId{1}, kOddList, 0, 0});
  return cluster;
}

// All of a controller's reports.
struct Reports final : controller::ControllerEvents {
  struct Problem {
    std::int64_t cycle;
    int slot;
    schedules::model::Channel channel;
    controller::SlotStatus status;
  };
  struct Sent {
    std::int64_t cycle;
    int slot;
    schedules::model::Channel channel;
    Microticks start;
    bool null_frame;
    PduId pdu;
    std::uint32_t sequence;
    int fragment;
    bool last;
    std::vector<std::byte> bytes;
  };
  struct Arrived {
    PduId pdu;
    cni::ArrivalEffect effect;
    std::uint32_t sequence;
    Microticks at;
    std::optional<std::uint32_t> torn;
  };
  struct Corrected {
    std::int64_t cycle;
    timebase::Correction offset, rate;
  };
  std::vector<Problem> problems;
  std::vector<Sent> sent;
  std::vector<Arrived> arrived;
  std::vector<Corrected> corrected;
  std::vector<std::int64_t> static_segments;  // cycles whose static segment has ended
  std::function<void(std::int64_t)> on_static_segment_ended;
  struct Changed {
    poc::PocKind from, to;
    poc::PocReason reason, consequence;
    Microticks at;
  };
  std::vector<std::int64_t> cycles;
  std::vector<Changed> changed;

  std::vector<std::pair<std::int64_t, Microticks>> cycle_starts;
  void cycle_started(std::int64_t cycle, Microticks at) override {
    cycles.push_back(cycle);
    cycle_starts.emplace_back(cycle, at);
  }
  void slot_problem(std::int64_t cycle, int slot, schedules::model::Channel channel, controller::SlotStatus status,
                    Microticks) override {
    problems.push_back({cycle, slot, channel, status});
  }
  void static_segment_ended(std::int64_t cycle, Microticks) override {
    static_segments.push_back(cycle);
    if (on_static_segment_ended) on_static_segment_ended(cycle);
  }
  void frame_sent(const ports::Transmission& t, std::int64_t cycle, bool null_frame, PduId pdu, std::uint32_t sequence,
                  int fragment, bool last) override {
    sent.push_back({cycle,
                    t.slot,
                    t.channel,
                    t.start,
                    null_frame,
                    pdu,
                    sequence,
                    fragment,
                    last,
                    {t.bytes.begin(), t.bytes.end()}});
  }
  void list_arrived(PduId pdu, cni::ArrivalEffect effect, std::uint32_t sequence, std::optional<std::uint32_t> torn,
                    Microticks at) override {
    arrived.push_back({pdu, effect, sequence, at, torn});
  }
  void clock_corrected(std::int64_t cycle, const timebase::Correction& offset, const timebase::Correction& rate,
                       Microticks) override {
    corrected.push_back({cycle, offset, rate});
  }
  void state_changed(poc::PocKind from, const poc::PocStep& step, Microticks at) override {
    changed.push_back({from, step.next.kind, step.reason, step.consequence, at});
  }
};

// Two channels on which every signal arrives everywhere after one and the same delay. Overlapping signals are merged by
// comparing all with all.
class TestMedium {
 public:
  struct Arrival {
    TrueTime start, end;
    schedules::model::Channel channel;
    std::size_t sender, receiver;
    ports::Signal signal = ports::Signal::kFrame;
    std::vector<std::byte> bytes;
    std::vector<wire::WakeupPattern> patterns = {};  // they overlap here
    auto order() const { return std::tuple(end, channel, sender, receiver); }
  };

  TestMedium(std::vector<timebase::Oscillator> oscillators, Duration delay)
      : oscillators_(std::move(oscillators)), delay_(delay) {
    for (std::size_t n = 0; n < oscillators_.size(); ++n) ports_.push_back(std::make_unique<Port>(*this, n));
  }
  ports::FlexRayPort& port(std::size_t node) { return *ports_[node]; }
  const timebase::Oscillator& oscillator(std::size_t node) const { return oscillators_[node]; }
  void set_now(TrueTime now) { now_ = now; }  // the time of carrier()

  std::optional<TrueTime> next() const {
    if (pending_.empty()) return std::nullopt;
    return first()->end;
  }
  Arrival pop() {
    const auto at = first();
    Arrival arrival = *at;
    pending_.erase(at);
    return arrival;
  }
  ports::Reception reception(const Arrival& arrival) const {
    const timebase::Oscillator& clock = oscillators_[arrival.receiver];
    ports::Reception made{
        arrival.channel, arrival.signal, clock.ticks_at(arrival.start), clock.ticks_at(arrival.end), {}};
    if (arrival.signal == ports::Signal::kFrame) made.frame = wire::decode_frame(arrival.channel, arrival.bytes);
    return made;
  }
  // An arrival at one receiver, or at all except its sender.
  void put(Arrival arrival) {
    if (arrival.signal == ports::Signal::kWakeup)
      arrival.patterns = {{arrival.start - TrueTime{}, arrival.end - TrueTime{}}};
    for (auto other = pending_.begin(); other != pending_.end();) {
      if (other->receiver != arrival.receiver || other->channel != arrival.channel || other->end <= arrival.start ||
          other->start >= arrival.end) {
        ++other;
        continue;
      }
      arrival.patterns.insert(arrival.patterns.end(), other->patterns.begin(), other->patterns.end());
      const bool symbols = arrival.signal == other->signal && arrival.signal != ports::Signal::kFrame;
      const bool wakes = arrival.signal != ports::Signal::kWakeup || wire::wakes(flexray_, arrival.patterns);
      if (!symbols || !wakes) arrival.signal = ports::Signal::kUndecodable;
      arrival.start = std::min(arrival.start, other->start);
      arrival.end = std::max(arrival.end, other->end);
      arrival.sender = std::min(arrival.sender, other->sender);
      arrival.bytes.clear();
      other = pending_.erase(other);
    }
    pending_.push_back(std::move(arrival));
  }

 private:
  struct Port final : ports::FlexRayPort {
    TestMedium& medium;
    std::size_t node;
    Port(TestMedium& m, std::size_t n) : medium(m), node(n) {}
    void transmit(const ports::Transmission& transmission) override { medium.transmit(node, transmission); }
    bool carrier(schedules::model::Channel channel) const override {
      return std::any_of(medium.pending_.begin(), medium.pending_.end(), [&](const Arrival& arrival) {
        return arrival.receiver == node && arrival.channel == channel && arrival.start <= medium.now_;
      });
    }
  };

  void transmit(std::size_t sender, const ports::Transmission& t) {
    const TrueTime start = oscillators_[sender].time_of(t.start) + delay_;
    const TrueTime end = oscillators_[sender].time_of(t.end) + delay_;
    for (std::size_t receiver = 0; receiver < ports_.size(); ++receiver)
      if (receiver != sender)
        put({start, end, t.channel, sender, receiver, t.signal, {t.bytes.begin(), t.bytes.end()}});
  }
  std::vector<Arrival>::const_iterator first() const {
    return std::min_element(pending_.begin(), pending_.end(),
                            [](const Arrival& a, const Arrival& b) { return a.order() < b.order(); });
  }

  schedules::model::GlobalParameters flexray_;  // the defaults of wake-up, as in all clusters of these tests
  std::vector<timebase::Oscillator> oscillators_;
  Duration delay_;
  TrueTime now_{};
  std::vector<std::unique_ptr<Port>> ports_;
  std::vector<Arrival> pending_;
};

// Controllers on a test medium in virtual time. They are integrated: all cycles 0 start within a microtick of
// 1 ms, with uncorrected rates. Or they are powered on one after the other.
class Rig {
 public:
  Rig(schedules::model::Cluster cluster, const std::vector<std::int64_t>& drifts_ppb, Duration delay = {})
      : Rig(std::move(cluster), drifts_ppb, delay, std::vector<TrueTime>(drifts_ppb.size(), kNoPower)) {
    for (std::size_t n = 0; n < drifts_ppb.size(); ++n)
      controllers_[n]->start_integrated({medium_.oscillator(n).ticks_at(kStart) + Microticks{1}, 0});
  }
  Rig(schedules::model::Cluster cluster, const std::vector<std::int64_t>& drifts_ppb, Duration delay,
      std::vector<TrueTime> power_on)
      : cluster_(std::move(cluster)), medium_(oscillators(drifts_ppb), delay), power_on_(std::move(power_on)) {
    for (std::size_t n = 0; n < drifts_ppb.size(); ++n) {
      reports_.push_back(std::make_unique<Reports>());
      controllers_.push_back(std::make_unique<controller::FlexRayController>(cluster_, static_cast<NodeId>(n),
                                                                             medium_.port(n), *reports_[n]));
    }
  }

  // False drops the arrival; it may be changed on the way.
  std::function<bool(ttf::bus::TestMedium::Arrival&)> on_the_way;

  void run_until(TrueTime end) {
    while (true) {
      std::size_t node = 0;
      for (std::size_t n = 1; n < controllers_.size(); ++n)
        if (due(n) < due(node)) node = n;
      const auto arrival = medium_.next();
      // Arrivals first where they coincide.
      if (arrival && *arrival <= due(node)) {
        if (*arrival > end) return;
        medium_.set_now(*arrival);
        TestMedium::Arrival frame = medium_.pop();
        if (!on_the_way || on_the_way(frame)) controllers_[frame.receiver]->receive(medium_.reception(frame));
      } else {
        const TrueTime now = due(node);
        if (now > end) return;
        medium_.set_now(now);
        const Microticks ticks = medium_.oscillator(node).ticks_at(now);
        if (power_on_[node] == now) {
          power_on_[node] = kNoPower;
          controllers_[node]->start_cold(ticks);
        }
        controllers_[node]->advance(ticks);
      }
    }
  }
  void run_cycles(std::int64_t cycles) { run_until(kStart + Duration::milliseconds(cycles)); }

  GlobalTime global_time(std::size_t node, TrueTime at) const {
    return controllers_[node]->clock()->global_time(medium_.oscillator(node).ticks_at(at));
  }
  Duration precision(TrueTime at) const {
    GlobalTime low = global_time(0, at), high = low;
    for (std::size_t n = 1; n < controllers_.size(); ++n) {
      low = std::min(low, global_time(n, at));
      high = std::max(high, global_time(n, at));
    }
    return high - low;
  }
  controller::FlexRayController& controller(std::size_t node) { return *controllers_[node]; }
  Reports& reports(std::size_t node) { return *reports_[node]; }
  const schedules::model::Cluster& cluster() const { return cluster_; }

  TestMedium& medium() { return medium_; }
  void power_on(std::size_t node, TrueTime at) { power_on_[node] = at; }

  static constexpr TrueTime kStart{1'000'000};
  static constexpr TrueTime kNoPower = kNever<TrueTime>;

 private:
  TrueTime due(std::size_t node) const {
    const Microticks next = controllers_[node]->next_event();
    const bool never = next == kNever<Microticks>;
    return std::min(never ? kNoPower : medium_.oscillator(node).time_of(next), power_on_[node]);
  }
  static std::vector<timebase::Oscillator> oscillators(const std::vector<std::int64_t>& drifts_ppb) {
    std::vector<timebase::Oscillator> made;
    for (std::size_t n = 0; n < drifts_ppb.size(); ++n)
      made.emplace_back(25'000, drifts_ppb[n], static_cast<std::int64_t>(n) * 6'100 % 25'000);
    return made;
  }

  schedules::model::Cluster cluster_;
  TestMedium medium_;
  std::vector<TrueTime> power_on_;
  std::vector<std::unique_ptr<Reports>> reports_;
  std::vector<std::unique_ptr<controller::FlexRayController>> controllers_;
};

}  // namespace ttf::bus
