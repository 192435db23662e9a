// The paper's node set on the memory live medium, each node with its own runner and clock. Shared by the
// tests with a turned clock and with the kernel's.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "nodes/runner/runner.h"
#include "recording/records/records.h"
#include "schedules/file/loader.h"
#include "schedules/model/ports.h"
#include "sim/drives/scenario.h"
#include "sim/drives/step_catalog.h"
#include "sim/drives/surroundings.h"
#include "sim/engine/cluster_simulation.h"
#include "tests/support/memory_live_medium.h"

namespace ttf::nodes::runner {

constexpr Duration ms(std::int64_t n) { return Duration::milliseconds(n); }
constexpr Duration us(std::int64_t n) { return Duration::microseconds(n); }
inline constexpr bus::ports::MachineTime kOrigin{1'000'000'000'000};  // for drives by a turned clock

// A node's records, as far as the tests need them.
struct Recorded final : recording::records::Sink {
  using recording::records::Sink::on;
  using SlotOfCycle = std::tuple<std::int64_t, int, int>;  // cycle, slot, channel
  struct Histogram {
    std::uint64_t count = 0;
    Duration longest{};
    bool operator==(const Histogram&) const = default;
  };
  struct Reported {
    recording::records::TimingFault what{};
    Duration late{};
    SlotOfCycle slot;
    std::uint32_t count = 0;
    bool operator==(const Reported&) const = default;
  };
  struct Correction {
    recording::records::Stamp stamp;
    int offset = 0, rate = 0;
  };

  void on(const recording::records::FeatureUsed& used) override { fresh += used.fresh && !used.stale; }
  void on(const recording::records::ListHop& hop) override {
    discarded += hop.hop == recording::records::Hop::kDiscarded;
  }
  void on(const recording::records::Measured& measurement) override { measured.push_back(measurement.stamp.true_time); }
  void on(const recording::records::CanFrameSent&) override { ++can_frames; }
  void on(const recording::records::SymbolSent&) override { ++symbols; }
  void on(const recording::records::CanErrorFrame& error) override { can_errors.push_back(error); }
  void on(const recording::records::CanStateChanged& change) override { can_states.push_back(change); }
  void on(const recording::records::SlotFrameSent& frame) override {
    frames.emplace_back(frame.cycle, frame.slot, frame.channel);
    ordered = ordered && frame.stamp.local >= last_frame;
    last_frame = frame.stamp.local;
  }
  void on(const recording::records::TimingProblem& problem) override {
    problems.push_back({problem.what, problem.late, {problem.cycle, problem.slot, problem.channel}, problem.count});
  }
  void on(const recording::records::ClockCorrected& corrected) override {
    corrections[corrected.cycle] = {corrected.stamp, corrected.offset_microticks, corrected.rate_microticks};
  }
  void on(const recording::records::StateChanged& changed) override {
    states.emplace_back(changed.to_name);
    changes.push_back(changed.stamp);
  }
  void on(const recording::records::LatenessHistogram& histogram) override {
    std::uint64_t sum = 0;
    for (const std::uint64_t count : histogram.counts) sum += count;
    lateness[histogram.of] = {sum, histogram.longest};
  }
  void on(const recording::records::MediumCounts& counts) override {
    medium = counts;
    ++accounts;
  }

  // The number of problems, or the sum of their counts.
  std::uint64_t reported(recording::records::TimingFault what) const {
    std::uint64_t sum = 0;
    for (const Reported& problem : problems)
      if (problem.what == what) sum += problem.count;
    return sum;
  }
  int largest_offset(std::int64_t behind_cycle) const {
    int largest = 0;
    for (const auto& [cycle, correction] : corrections)
      if (cycle > behind_cycle) largest = std::max(largest, std::abs(correction.offset));
    return largest;
  }

  std::vector<recording::records::CanErrorFrame> can_errors;
  std::vector<recording::records::CanStateChanged> can_states;
  int fresh = 0, discarded = 0, can_frames = 0, symbols = 0, accounts = 0;
  std::vector<TrueTime> measured;
  std::vector<SlotOfCycle> frames;
  bool ordered = true;  // frames, by when they were due
  LocalTime last_frame{std::numeric_limits<std::int64_t>::min()};
  std::vector<Reported> problems;
  std::map<std::int64_t, Correction> corrections;  // by cycle
  std::vector<std::string> states;                 // the controller's, in order
  std::vector<recording::records::Stamp> changes;
  std::map<recording::records::LatenessOf, Histogram> lateness;  // the last, by its subject
  recording::records::MediumCounts medium;                       // the last
};

// Receives nothing at first.
class Deaf final : public bus::ports::LiveMedium {
 public:
  Deaf(std::unique_ptr<bus::ports::LiveMedium> medium, bus::ports::MachineTime until,
       std::function<bus::ports::MachineTime()> now)
      : medium_(std::move(medium)), until_(until), now_(std::move(now)) {}
  bus::ports::LiveStatus send(const bus::ports::LiveSignal& signal, bus::ports::MachineTime due) override {
    return medium_->send(signal, due);
  }
  bus::ports::LiveStatus send_can(std::size_t can_bus, const bus::ports::CanFrame& frame) override {
    return medium_->send_can(can_bus, frame);
  }
  std::optional<bus::ports::LiveArrival> receive() override {
    while (now_() < until_)
      if (!medium_->receive()) return std::nullopt;
    return medium_->receive();
  }
  int descriptor(bus::ports::Line line) const override { return medium_->descriptor(line); }
  void watch(bus::ports::Line line, bool on) override { medium_->watch(line, on); }
  bus::ports::LiveCounts counts() const override { return medium_->counts(); }
  const std::string& failure() const override { return medium_->failure(); }

 private:
  std::unique_ptr<bus::ports::LiveMedium> medium_;
  bus::ports::MachineTime until_;
  std::function<bus::ports::MachineTime()> now_;
};

// Holds for any lateness of a node: every report is counted, every count is reported.
inline void expect_counted_once(const Recorded& recorded, const Health& health) {
  const TimingCounts& timing = health.timing;
  EXPECT_TRUE(recorded.ordered);
  EXPECT_EQ(recorded.reported(recording::records::TimingFault::kLateWakeUp), timing.late_wakeups);
  EXPECT_EQ(recorded.reported(recording::records::TimingFault::kSlotMissed), timing.slots_missed);
  EXPECT_EQ(recorded.reported(recording::records::TimingFault::kLateFrame), timing.late_frames);
  EXPECT_EQ(recorded.reported(recording::records::TimingFault::kEarlyFrame), timing.early_frames);
  EXPECT_EQ(recorded.reported(recording::records::TimingFault::kFramesLost), timing.frames_lost);
  EXPECT_EQ(recorded.medium.sent, health.medium.sent);
  EXPECT_EQ(recorded.medium.received, health.medium.received);
  EXPECT_EQ(recorded.medium.lost, health.medium.lost);
  EXPECT_EQ(recorded.medium.dropped, health.dropped);
  const auto histogram = [&](recording::records::LatenessOf of) {
    const auto one = recorded.lateness.find(of);
    return one == recorded.lateness.end() ? Recorded::Histogram{} : one->second;
  };
  EXPECT_EQ(histogram(recording::records::LatenessOf::kWakeUps).longest, health.wakeup_longest);
  EXPECT_LE(histogram(recording::records::LatenessOf::kArrivals).count, health.medium.received);
}

// All on FlexRay; the sensors' devices are not.
inline constexpr const char* kOnFlexRay[] = {"laser_pre", "camera_pre", "gateway", "fusion", "feature"};

class LiveNodeSet : public testing::Test {
 protected:
  LiveNodeSet() {
    schedules::model::bind_ports(cluster_, sim::drives::step_ports());
    around_ = sim::drives::surroundings_of(scenario_, cluster_, 1, 0, nullptr);
  }
  struct Drive {
    Duration lasts = Duration::milliseconds(600);
    std::int64_t scale_ppm = 1'000'000;
    test::Reported reported = test::Reported::kWithTheFrame;
    std::function<std::optional<TrueTime>(NodeId)> power_on = {};
    std::size_t room = 1024;
    Duration deaf_for{};  // all nodes, in the drive's time
  };
  // A medium for each node.
  std::vector<std::unique_ptr<bus::ports::LiveMedium>> media(
      const Drive& how, const DriveClock& clock, const std::function<bus::ports::MachineTime()>& now) const {
    test::MemoryLiveBusOptions options;
    for (const schedules::model::CanBus& can : cluster_.can_buses) options.can_buses.push_back(can.flexible_data_rate);
    options.reported = how.reported;
    options.room = how.room;
    options.now = now;
    test::MemoryLiveBus bus(options);
    std::vector<std::unique_ptr<bus::ports::LiveMedium>> media;
    for (std::size_t n = 0; n < cluster_.nodes.size(); ++n)
      media.push_back(
          std::make_unique<Deaf>(bus.join(), clock.machine_time(sim::engine::kFirstCycle + how.deaf_for), now));
    return media;
  }
  // After the drive, every sent frame is at each other member: received, counted as lost, or still to be
  // found.
  void expect_nothing_vanished(const std::vector<std::unique_ptr<bus::ports::LiveMedium>>& media) {
    std::uint64_t sent = 0;
    for (const auto& medium : media) sent += medium->counts().sent;
    for (std::size_t n = 0; n < media.size(); ++n) {
      while (media[n]->receive()) {
      }
      const bus::ports::LiveCounts counts = media[n]->counts();
      EXPECT_EQ(counts.received + counts.lost, sent - counts.sent) << cluster_.nodes[n].name;
    }
  }
  RunnerConfig config_of(const Drive& how, const DriveClock& clock, NodeId node) const {
    RunnerConfig config;
    config.cluster = &cluster_;
    config.node = node;
    config.clock = clock;
    config.seed = 1;
    config.first_cycle = sim::engine::kFirstCycle;
    config.end = sim::engine::kFirstCycle + how.lasts;
    if (how.power_on) config.power_on = how.power_on(node);
    return config;
  }
  std::vector<std::shared_ptr<host::Step>> steps_of(NodeId node) const {
    return sim::drives::make_steps(
        {&scenario_, &cluster_, ttf::fusion::strategies::StrategyKind::kTt, 1, 0, around_.scene, nullptr}, node);
  }
  NodeId id_of(const char* node) const { return *cluster_.find_node(node); }
  Recorded& of(const char* node) { return recorded_[index_of(id_of(node))]; }
  Health& health_of(const char* node) { return health_[index_of(id_of(node))]; }

  const sim::drives::Scenario scenario_ = sim::drives::load_scenario(TTF_SOURCE_DIR "/scenarios/paper_scenario1.yaml");
  schedules::model::Cluster cluster_ =
      schedules::file::load_cluster(TTF_SOURCE_DIR "/schedules/paper_synchronised.yaml");
  sim::drives::Surroundings around_;
  std::vector<Recorded> recorded_;  // by node, of the last drive; so are these
  std::vector<Health> health_;
};

}  // namespace ttf::nodes::runner
