// One node of the paper's cluster with a runner, by a turned clock; a script plays the others.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bus/wire/can_timing.h"
#include "bus/wire/flexray_frame.h"
#include "tests/nodes/runner/live_node_set.h"
#include "tests/nodes/runner/turned_host.h"

namespace ttf::nodes::runner {

// Computes for this long before its action.
class Slow final : public host::Step {
 public:
  Slow(std::shared_ptr<host::Step> step, MachineClock& host, Duration computes)
      : step_(std::move(step)), host_(host), computes_(computes) {}
  void run(host::StepContext& context) override {
    host_.sleep(computes_);
    step_->run(context);
  }

 private:
  std::shared_ptr<host::Step> step_;
  MachineClock& host_;
  Duration computes_;
};

class RunnerTest : public LiveNodeSet {
 protected:
  using SlotOfCycle = Recorded::SlotOfCycle;
  // Integrated from cycle 0 on by default.
  class Alone {
   public:
    Alone(const RunnerTest& set, const char* node, Drive how)
        : set_(set), node_(set.id_of(node)), how_(std::move(how)), clock_(kOrigin, how_.scale_ppm) {
      test::MemoryLiveBusOptions options;
      for (const schedules::model::CanBus& can : set.cluster_.can_buses)
        options.can_buses.push_back(can.flexible_data_rate);
      options.now = [this] { return host.now(); };
      bus_ = std::make_unique<test::MemoryLiveBus>(options);
      own_ = bus_->join();
      others_ = bus_->join();
    }
    RunnerEnd run(bus::ports::LiveMedium* instead = nullptr) {
      RunnerConfig config = set_.config_of(how_, clock_, node_);
      config.stop_descriptor = stop_descriptor;
      bus::ports::LiveMedium& medium = instead != nullptr ? *instead : *own_;
      TurnedHost::Process& process = host.process(wakes);
      process.stated_floor = floor;
      auto steps = set_.steps_of(node_);
      if (computes > Duration{}) steps.front() = std::make_shared<Slow>(std::move(steps.front()), process, computes);
      Runner runner(config, std::move(steps), medium, process, out);
      runner.on_health([this](const Health&) { reported_health.push_back(host.now()); });
      const RunnerEnd end = runner.run();
      health = runner.health();
      counts = runner.counts();
      wake_ups = runner.timing().wake_ups.count();
      sleeps = process.sleeps;
      waits_for_nothing = process.waits_for_nothing;
      return end;
    }

    // So long behind the begin of cycle 0.
    bus::ports::MachineTime at(Duration drive) const { return clock_.machine_time(sim::engine::kFirstCycle + drive); }
    bus::ports::MachineTime action_point(std::int64_t cycle, int slot) const {
      return at(ms(5 * cycle) + us((slot - 1) * 84 + 7));
    }
    void others_send(int slot, std::int64_t cycle, bool startup = false) {
      bus::wire::FrameHeader header;
      header.sync = header.startup = startup;
      header.frame_id = static_cast<std::uint16_t>(slot);
      header.cycle = static_cast<std::uint8_t>(cycle % 64);
      const std::array<std::byte, 56> payload{};
      std::array<std::byte, bus::wire::kMaxFrameBytes> bytes{};
      const std::size_t size = bus::wire::encode_frame(header, schedules::model::Channel::kA, payload, bytes);
      bus::ports::LiveSignal signal;
      signal.slot = slot;
      signal.bytes = std::span<const std::byte>(bytes).first(size);
      signal.states_late = startup;
      (void)others_->send(signal, host.now());
    }
    void others_send_noise(Duration lasts) {
      bus::ports::LiveSignal signal;
      signal.signal = bus::ports::Signal::kUndecodable;
      signal.duration = lasts;
      (void)others_->send(signal, host.now());
    }
    std::vector<Duration> received_symbols() {
      std::vector<Duration> lengths;
      while (const auto arrival = others_->receive())
        if (arrival->kind == bus::ports::LiveArrival::Kind::kFlexRay &&
            arrival->signal.signal != bus::ports::Signal::kFrame)
          lengths.push_back(arrival->signal.duration);
      return lengths;
    }
    // The first time.
    std::optional<recording::records::Stamp> came_into(const std::string& state) const {
      const auto found = std::find(out.states.begin(), out.states.end(), state);
      if (found == out.states.end()) return std::nullopt;
      return out.changes[static_cast<std::size_t>(found - out.states.begin())];
    }
    void others_send_can(std::size_t can_bus, std::uint32_t identifier, std::span<const std::byte> data = {}) {
      (void)others_->send_can(can_bus, {identifier, false, data});
    }
    void report_on_can(std::size_t can_bus, const bus::ports::CanReport& report) { bus_->report(can_bus, report); }
    struct CanArrival {
      std::size_t can_bus = 0;
      std::uint32_t identifier = 0;
      bus::ports::MachineTime at{};
      Duration duration{};  // the frame's on a real bus, in the drive's time
    };
    std::vector<CanArrival> received_on_can() {
      std::vector<CanArrival> received;
      while (const auto arrival = others_->receive())
        if (arrival->kind == bus::ports::LiveArrival::Kind::kCan)
          received.push_back({arrival->can_bus, arrival->can.identifier, arrival->at,
                              bus::wire::can_frame_duration(set_.cluster_.can_buses[arrival->can_bus],
                                                            arrival->can.identifier, arrival->can.data)});
      return received;
    }
    std::set<SlotOfCycle> missed() const {
      std::set<SlotOfCycle> missed;
      for (const Recorded::Reported& problem : out.problems) {
        if (problem.what != recording::records::TimingFault::kSlotMissed) continue;
        EXPECT_TRUE(missed.insert(problem.slot).second) << "told twice";
      }
      return missed;
    }
    std::set<SlotOfCycle> sent() const {
      const std::set<SlotOfCycle> sent(out.frames.begin(), out.frames.end());
      EXPECT_EQ(sent.size(), out.frames.size()) << "a slot was sent in twice";
      return sent;
    }
    // Each slot that there was is in one of the two.
    std::set<SlotOfCycle> sent_or_missed() const {
      std::set<SlotOfCycle> all = sent();
      for (const SlotOfCycle& slot : missed()) EXPECT_TRUE(all.insert(slot).second) << "sent, and told as missed";
      return all;
    }

    TurnedHost host{kOrigin - ms(10)};
    Wakes wakes = late_by({});
    recording::records::BinnedDurations floor;
    Duration computes{};  // its first task, on the node's own thread
    int stop_descriptor = -1;
    Recorded out;
    std::vector<bus::ports::MachineTime> reported_health;
    // At the end:
    Health health;
    host::ExecutiveCounts counts;
    std::uint64_t wake_ups = 0;
    std::vector<Duration> sleeps;
    int waits_for_nothing = 0;

   private:
    const RunnerTest& set_;
    const NodeId node_;
    const Drive how_;
    const DriveClock clock_;
    std::unique_ptr<test::MemoryLiveBus> bus_;
    std::unique_ptr<bus::ports::LiveMedium> own_, others_;
  };

  // The gateway sends in these, on both channels.
  static std::set<SlotOfCycle> gateway_slots(std::int64_t cycles) {
    std::set<SlotOfCycle> all;
    for (std::int64_t cycle = 0; cycle < cycles; ++cycle)
      for (const int channel : {0, 1}) {
        all.emplace(cycle, 3, channel);
        for (int slot = 6; slot <= 21; ++slot) all.emplace(cycle, slot, channel);
      }
    return all;
  }
};

}  // namespace ttf::nodes::runner
