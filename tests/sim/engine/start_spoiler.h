// A coldstart node gone mad during start-up: it sends signals that may keep the others from starting, on its
// own branch. Node 0 has no supply; this makes the signals in its name.
#pragma once

#include <algorithm>
#include <array>
#include <initializer_list>
#include <vector>

#include "bus/wire/flexray_frame.h"
#include "core/random.h"
#include "sim/engine/bus_simulation.h"

namespace ttf::sim::engine {

class StartSpoiler final : public medium::Disturbance {
 public:
  enum class Plan {
    kBabble,         // noise, frames and symbols at all times
    kSymbols,        // one collision avoidance symbol after another
    kFalseLeader,    // leads properly, for some cycles
    kEvenCycles,     // startup frames without a derivable schedule
    kMasquerade,     // startup frames of others
    kReactive,       // a symbol or a header as soon as another leads
    kSplit,          // leads on one channel, then on the other
    kWakeup,         // wake-up patterns, and leads
    kNoSilentCycle,  // leads for five cycles, and restarts without the silent one
    kFromTheMiddle,  // startup frames of cycles 2, 3, 4, a silent cycle, and again
    kOneOfTwo,       // leads every other attempt properly, and ends those between early
    kAnything,
  };
  static constexpr std::array kPlans = {
      Plan::kBabble, Plan::kSymbols, Plan::kFalseLeader,   Plan::kEvenCycles,    Plan::kMasquerade, Plan::kReactive,
      Plan::kSplit,  Plan::kWakeup,  Plan::kNoSilentCycle, Plan::kFromTheMiddle, Plan::kOneOfTwo,   Plan::kAnything};

  StartSpoiler(BusSimulation& simulation, const schedules::model::Cluster& cluster, Plan plan, std::uint64_t seed)
      : simulation_(simulation), cluster_(cluster), plan_(plan), draw_({seed, 0, Purpose::kTest, 7, 0}) {
    next_ = TrueTime{draw_.integer(0, 10'000'000)};
    if (plan == Plan::kBabble) next_ = TrueTime{};
  }

  TrueTime next() const override { return next_; }
  bool leaving(medium::Leaving& signal) override {
    if (plan_ == Plan::kReactive && signal.sender != kSelf && signal.signal == bus::ports::Signal::kCas)
      next_ = std::min(next_, signal.start + Duration{draw_.integer(1, 6'000'000)});
    return true;
  }
  void act(TrueTime now) override {
    switch (plan_) {
      case Plan::kBabble: babble(now); break;
      case Plan::kSymbols:
        both_or_one([&](auto channel) { symbol(bus::ports::Signal::kCas, channel, now); });
        next_ = now + Duration{draw_.integer(10'000, 9'000'000)};
        break;
      case Plan::kFalseLeader: lead(now, 7); break;
      case Plan::kEvenCycles:
        both_or_one([&](auto channel) { frame(channel, now, 1, 2 * static_cast<int>(draw_.integer(0, 31))); });
        next_ = now + Duration{draw_.integer(1'000'000, 6'000'000)};
        break;
      case Plan::kMasquerade:
        both_or_one([&](auto channel) {
          frame(channel, now, static_cast<int>(draw_.integer(2, 3)), static_cast<int>(draw_.integer(0, 7)));
        });
        next_ = now + Duration{draw_.integer(100'000, 5'000'000)};
        break;
      case Plan::kReactive:
        both_or_one([&](auto channel) {
          if (draw_.integer(0, 1) == 0)
            symbol(bus::ports::Signal::kCas, channel, now);
          else
            frame(channel, now, 1, static_cast<int>(draw_.integer(0, 3)));
        });
        next_ = now + Duration{draw_.integer(1'000'000, 40'000'000)};
        break;
      case Plan::kSplit: lead(now, 3); break;
      case Plan::kWakeup:
        if (draw_.integer(0, 2) == 0) {
          both_or_one([&](auto channel) { symbol(bus::ports::Signal::kWakeup, channel, now); });
          next_ = now + Duration{draw_.integer(100'000, 9'000'000)};
        } else {
          lead(now, 5);
        }
        break;
      case Plan::kNoSilentCycle: follow_plan(now, {-1, 0, 1, 2, 3, 4}, kCycle / 50); break;
      case Plan::kFromTheMiddle: follow_plan(now, {2, 3, 4}, 2 * kCycle); break;
      case Plan::kOneOfTwo:
        follow_plan(now, {-1, 0, 1, 2, 3, 4, kPause, -1, 0, 1, 2}, draw_.integer(2, 4) * kCycle);
        break;
      case Plan::kAnything: anything(now); break;
    }
  }

 private:
  static constexpr NodeId kSelf{0};
  static constexpr std::int64_t kCycle = 5'000'000;
  static constexpr int kPause = -2;

  template <class Act> void both_or_one(Act act) {
    const auto which = draw_.integer(0, 3);
    if (which != 2) act(schedules::model::Channel::kA);
    if (which != 3) act(schedules::model::Channel::kB);
  }
  void symbol(bus::ports::Signal kind, schedules::model::Channel channel, TrueTime at, std::int64_t ns = 0) {
    if (ns == 0) ns = kind == bus::ports::Signal::kCas ? 3'900 : 48'000;
    simulation_.emit({kSelf, channel, kind, at, at + Duration{ns}, {}}, kSelf);
  }
  void frame(schedules::model::Channel channel, TrueTime at, int id, int cycle, bool startup = true) {
    bus::wire::FrameHeader header;
    header.null_frame = true;
    header.sync = header.startup = startup;
    header.frame_id = static_cast<std::uint16_t>(id);
    header.cycle = static_cast<std::uint8_t>(cycle);
    const std::vector<std::byte> payload(static_cast<std::size_t>(2 * cluster_.flexray.gPayloadLengthStatic));
    std::array<std::byte, bus::wire::kMaxFrameBytes> bytes{};
    const std::size_t size = bus::wire::encode_frame(header, channel, payload, bytes);
    const Duration length = bus::wire::frame_duration(cluster_.flexray, cluster_.flexray.gPayloadLengthStatic);
    simulation_.emit({kSelf, channel, bus::ports::Signal::kFrame, at, at + length, std::span(bytes).first(size)},
                     kSelf);
  }
  void babble(TrueTime now) {
    for (const auto channel : {schedules::model::Channel::kA, schedules::model::Channel::kB})
      switch (draw_.integer(0, 3)) {
        case 0: symbol(bus::ports::Signal::kUndecodable, channel, now, draw_.integer(1'000, 20'000)); break;
        case 1: symbol(bus::ports::Signal::kCas, channel, now, draw_.integer(3'000, 20'000)); break;
        case 2:
          frame(channel, now, static_cast<int>(draw_.integer(1, 5)), static_cast<int>(draw_.integer(0, 63)));
          break;
        default:
          frame(channel, now, static_cast<int>(draw_.integer(1, 5)), static_cast<int>(draw_.integer(0, 63)), false);
      }
    next_ = now + Duration{draw_.integer(1'000, 15'000)};
  }
  // A symbol, a cycle's worth of frames at a time, then a pause.
  void lead(TrueTime now, int most) {
    if (cycles_left_ == 0) {
      which_ = draw_.integer(0, 3);
      if (plan_ == Plan::kSplit) which_ = last_ = last_ == 2 ? 3 : 2;
      cycles_left_ = static_cast<int>(draw_.integer(1, most));
      cycle_ = 0;
      on_channels([&](auto channel) { symbol(bus::ports::Signal::kCas, channel, now); });
      next_ = now + Duration{3'900 + 1'000 + 7'000};
      return;
    }
    on_channels([&](auto channel) { frame(channel, now, 1, cycle_ % 64); });
    ++cycle_;
    next_ = now + Duration{--cycles_left_ > 0 ? kCycle : draw_.integer(1'000'000, 3 * kCycle)};
  }
  // Symbol (-1), frames of these cycles in a cycle's distance, and a pause behind the last.
  void follow_plan(TrueTime now, std::initializer_list<int> cycles, std::int64_t pause) {
    which_ = 0;
    const int what = cycles.begin()[cycle_];
    if (what == -1) on_channels([&](auto channel) { symbol(bus::ports::Signal::kCas, channel, now); });
    if (what >= 0) on_channels([&](auto channel) { frame(channel, now, 1, what); });
    cycle_ = (cycle_ + 1) % static_cast<int>(cycles.size());
    next_ = now + Duration{what == -1 ? 3'900 + 1'000 + 7'000 : cycle_ == 0 ? pause : kCycle};
  }
  template <class Act> void on_channels(Act act) {
    if (which_ != 2) act(schedules::model::Channel::kA);
    if (which_ != 3) act(schedules::model::Channel::kB);
  }
  void anything(TrueTime now) {
    both_or_one([&](auto channel) {
      switch (draw_.integer(0, 5)) {
        case 0: symbol(bus::ports::Signal::kUndecodable, channel, now, draw_.integer(100, 3'000'000)); break;
        case 1: symbol(bus::ports::Signal::kCas, channel, now); break;
        case 2: symbol(bus::ports::Signal::kWakeup, channel, now); break;
        case 3: frame(channel, now, 1, static_cast<int>(draw_.integer(0, 63))); break;
        case 4: frame(channel, now, 1, cycle_++ % 64); break;
        default:
          frame(channel, now, static_cast<int>(draw_.integer(1, 5)), static_cast<int>(draw_.integer(0, 63)),
                draw_.integer(0, 1) == 0);
      }
    });
    next_ = now + Duration{draw_.integer(0, 3) == 0 ? kCycle : draw_.integer(4'000, 6'000'000)};
  }

  BusSimulation& simulation_;
  const schedules::model::Cluster& cluster_;
  Plan plan_;
  RandomStream draw_;
  TrueTime next_{};
  int cycles_left_ = 0, cycle_ = 0;
  std::int64_t which_ = 0, last_ = 2;
};

}  // namespace ttf::sim::engine
