// Whole node sets in real time, by a clock that the test turns. Kernels are late by a given time; nodes stand
// still, come late or start together.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "tests/nodes/runner/live_node_set.h"
#include "tests/nodes/runner/turned_host.h"

namespace ttf::nodes::runner {
namespace {

using SlotOfCycle = Recorded::SlotOfCycle;

class TurnedNodeSet : public LiveNodeSet {
 protected:
  // The wake-ups of a node's process; all in time by default.
  using WakesOf = std::function<Wakes(NodeId)>;
  void drive(const Drive& how, const WakesOf& wakes_of = {}) {
    TurnedHost host(kOrigin - ms(50));
    const std::size_t nodes = cluster_.nodes.size();
    recorded_.assign(nodes, {});
    health_.assign(nodes, {});
    const DriveClock clock(kOrigin, how.scale_ppm);
    const auto media = this->media(how, clock, [&host] { return host.now(); });
    std::vector<std::function<void()>> bodies;
    for (std::size_t n = 0; n < nodes; ++n) {
      const auto node = static_cast<NodeId>(n);
      auto& process = host.process(wakes_of ? wakes_of(node) : late_by({}));
      bodies.emplace_back([&, n, node] {
        Runner runner(config_of(how, clock, node), steps_of(node), *media[n], process, recorded_[n]);
        EXPECT_EQ(runner.run(), RunnerEnd::kDone);
        health_[n] = runner.health();
      });
    }
    host.run(bodies);
    for (std::size_t n = 0; n < nodes; ++n) expect_counted_once(recorded_[n], health_[n]);
    expect_nothing_vanished(media);
  }
  // By the unstretched clock, from the start of cycle 0.
  static bus::ports::MachineTime at(Duration drive) {
    return kOrigin + (sim::engine::kFirstCycle + drive - TrueTime{});
  }
  WakesOf only(const char* node, Wakes wakes) const {
    return [id = id_of(node), wakes](NodeId other) { return other == id ? wakes : late_by({}); };
  }
  void expect_all_active() {
    for (const char* node : kOnFlexRay) EXPECT_EQ(health_of(node).state, bus::poc::PocKind::kNormalActive) << node;
  }
  std::set<SlotOfCycle> missed(const char* node) {
    std::set<SlotOfCycle> missed;
    for (const Recorded::Reported& problem : of(node).problems)
      if (problem.what == recording::records::TimingFault::kSlotMissed) missed.insert(problem.slot);
    return missed;
  }
  // The frames that a node did not send in each slot, between the first and the last sent one.
  std::uint64_t withheld(const char* node) {
    std::map<std::pair<int, int>, std::pair<std::int64_t, std::int64_t>> sent;  // by slot and channel: first, last
    for (const auto& [cycle, slot, channel] : of(node).frames) {
      const auto [one, is_new] = sent.try_emplace({slot, channel}, cycle, cycle);
      one->second.second = std::max(one->second.second, cycle);
    }
    std::uint64_t count = 0;
    for (const auto& [cycle, slot, channel] : missed(node))
      if (const auto one = sent.find({slot, channel}); one != sent.end())
        count += one->second.first < cycle && cycle < one->second.second;
    return count;
  }
};

// 600 ms: a laser scan every 80 ms, a camera frame every 40, an image every 40, the first without tracks.
TEST_F(TurnedNodeSet, ANodeSetDrivesInRealTime) {
  for (const std::int64_t scale : {1'000'000, 4'000'000}) {
    SCOPED_TRACE(scale);
    drive({.scale_ppm = scale});
    expect_all_active();
    EXPECT_EQ(of("laser").measured.size(), 8u);
    EXPECT_EQ(of("camera").measured.size(), 15u);
    EXPECT_EQ(of("feature").fresh, 15);
    EXPECT_EQ(of("laser_pre").discarded + of("camera_pre").discarded, 0) << "every list has its strobe";
    for (std::size_t n = 0; n < recorded_.size(); ++n) {
      EXPECT_TRUE(recorded_[n].problems.empty()) << cluster_.nodes[n].name;
      EXPECT_LT(health_[n].wakeup_longest.ns, 25 * scale / 1'000'000) << cluster_.nodes[n].name << ": a microtick";
      EXPECT_EQ(recorded_[n].lateness[recording::records::LatenessOf::kTransits].count, health_[n].medium.received);
    }
    for (const char* node : kOnFlexRay)
      EXPECT_GT(of(node).lateness[recording::records::LatenessOf::kArrivals].count, 100u) << node;
  }
}

TEST_F(TurnedNodeSet, TheSameDriveGivesTheSameRecords) {
  const auto drawn = [](NodeId node) { return drawn_late(us(900), static_cast<std::uint16_t>(index_of(node))); };
  drive({.lasts = ms(200)}, drawn);
  const std::vector<Recorded> first = std::exchange(recorded_, {});
  drive({.lasts = ms(200)}, drawn);
  for (std::size_t n = 0; n < first.size(); ++n) {
    EXPECT_EQ(recorded_[n].frames, first[n].frames);
    EXPECT_EQ(recorded_[n].problems, first[n].problems);
    EXPECT_EQ(recorded_[n].lateness, first[n].lateness);
    EXPECT_EQ(recorded_[n].measured, first[n].measured);
  }
}

// As late as the window allows every time, without effect.
TEST_F(TurnedNodeSet, WithinTheWindowNothingIsMissedOrLost) {
  const Duration most = cluster_.arrival_window->late - us(10);  // clocks differ by microticks
  drive({}, [&](NodeId node) { return drawn_late(most, static_cast<std::uint16_t>(index_of(node))); });
  expect_all_active();
  EXPECT_EQ(of("feature").fresh, 15);
  for (std::size_t n = 0; n < recorded_.size(); ++n) {
    EXPECT_TRUE(recorded_[n].problems.empty()) << cluster_.nodes[n].name;
    EXPECT_GT(health_[n].wakeup_longest, most - us(100));
    EXPECT_EQ(health_[n].drops(), 0u);
  }
}

// Beyond it, every frame that a node withholds as too late is reported lost by each of the others.
TEST_F(TurnedNodeSet, WithheldFramesAreLostToAllOthers) {
  drive({}, [](NodeId node) { return drawn_late(us(700), static_cast<std::uint16_t>(index_of(node))); });
  expect_all_active();
  for (const char* node : kOnFlexRay) {
    EXPECT_GT(missed(node).size(), 0u) << node;
    std::uint64_t lost = 0;
    for (const char* other : kOnFlexRay)
      if (other != node) lost += withheld(other);
    EXPECT_EQ(health_of(node).timing.frames_lost, lost) << node;
    EXPECT_EQ(health_of(node).timing.late_frames + health_of(node).timing.early_frames, 0u)
        << node << ": what would be late is not sent";
  }
}

// Two of the five sync nodes are always late, within the window, and no clock follows them. Their lateness
// alone would shift it by 8000 microticks.
TEST_F(TurnedNodeSet, LatenessIsNotTakenForTheClock) {
  drive({});
  std::vector<Recorded> in_time = std::exchange(recorded_, {});
  for (const auto& [reported, scale] : {std::pair(test::Reported::kWithTheFrame, 1'000'000),
                                        {test::Reported::kInAFollowUp, 1'000'000},
                                        {test::Reported::kWithTheFrame, 4'000'000}}) {
    drive({.scale_ppm = scale, .reported = reported},
          [](NodeId node) { return late_by(index_of(node) % 2 == 1 ? us(200) : Duration{}); });
    expect_all_active();
    for (const char* node : kOnFlexRay) {
      const auto& expected = in_time[index_of(id_of(node))].corrections;
      ASSERT_EQ(of(node).corrections.size(), expected.size());
      for (const auto& [cycle, correction] : of(node).corrections) {
        EXPECT_LE(std::abs(correction.offset - expected.at(cycle).offset), 2) << node << ", cycle " << cycle;
        EXPECT_LE(std::abs(correction.rate - expected.at(cycle).rate), 2) << node << ", cycle " << cycle;
      }
    }
  }
}

// Clocks that are off by up to 1500 ppm (the cluster's draws) stay together. Uncorrected they would be
// hundreds of microticks apart within a cycle. The first cycles correct the initial clocks' distance.
TEST_F(TurnedNodeSet, ClocksThatDriftStayTogether) {
  drive({.lasts = ms(400)});
  for (const char* node : kOnFlexRay) EXPECT_LE(of(node).largest_offset(8), 8) << node;
}

// True time is the clock's instant, not the later instant at which the process runs.
TEST_F(TurnedNodeSet, ClocksShowOneInstant) {
  drive({.lasts = ms(400)},
        [](NodeId node) { return drawn_late(us(400), static_cast<std::uint16_t>(index_of(node))); });
  int compared = 0;
  for (const auto& [cycle, first] : of("laser_pre").corrections) {
    if (cycle <= 8) continue;
    for (const char* node : {"camera_pre", "gateway", "fusion", "feature"}) {
      const recording::records::Stamp& second = of(node).corrections.at(cycle).stamp;
      const Duration apart = (second.global - GlobalTime{}) - (second.true_time - TrueTime{}) -
                             ((first.stamp.global - GlobalTime{}) - (first.stamp.true_time - TrueTime{}));
      EXPECT_LE(std::abs(apart.ns), 1'000) << node << ", cycle " << cycle;
      ++compared;
    }
  }
  EXPECT_EQ(compared, 4 * 36);
}

TEST_F(TurnedNodeSet, AClusterStartsUp) {
  const auto one_by_one = [](NodeId node) {
    return std::optional(sim::engine::kFirstCycle + ms(3) * static_cast<std::int64_t>(index_of(node)));
  };
  for (const Duration late : {Duration{}, us(400)}) {
    drive({.lasts = ms(300), .power_on = one_by_one},
          [&](NodeId node) { return drawn_late(late, static_cast<std::uint16_t>(index_of(node))); });
    expect_all_active();
    for (const char* node : kOnFlexRay) EXPECT_EQ(of(node).states.back(), "normal active") << node;
  }
}

// The nodes cannot receive each other until all coldstart attempts are exhausted. Only the hosts can help then:
// a cluster of listeners stays silent for good.
TEST_F(TurnedNodeSet, AClusterWhoseColdstartAttemptsAreExhaustedStartsUpAllTheSame) {
  cluster_.flexray.gColdStartAttempts = 2;
  drive({.lasts = ms(1000),
         .power_on = [](NodeId) { return std::optional(sim::engine::kFirstCycle); },
         .deaf_for = ms(200)});
  expect_all_active();
  int exhausted = 0;
  for (const char* node : kOnFlexRay) {
    const auto& states = of(node).states;
    const auto first_active = std::find(states.begin(), states.end(), "normal active");
    exhausted += std::count(states.begin(), first_active, "integration listen") > 0 &&
                 std::count(states.begin(), first_active, "coldstart listen") > 1;
  }
  EXPECT_GE(exhausted, 2) << "too few had used up their attempts";
}

TEST_F(TurnedNodeSet, ANodeThatComesLaterIntegrates) {
  const TrueTime comes = sim::engine::kFirstCycle + ms(200);
  drive({.lasts = ms(500),
         .power_on = [&](NodeId node) { return node == id_of("feature") ? std::optional(comes) : std::nullopt; }});
  expect_all_active();
  EXPECT_GE(of("feature").fresh, 3);
  EXPECT_GE(of("feature").changes.front().true_time + us(1), comes) << "it has heard what came before its power did";
  for (const char* node : {"laser_pre", "camera_pre", "gateway", "fusion"})
    EXPECT_TRUE(of(node).states.empty()) << node << " has noticed";
}

// Two cycles and a half: it catches up with its own clock and all received frames, and rejoins the others.
TEST_F(TurnedNodeSet, ANodeThatWasStoppedForShortIsBackInTime) {
  drive({}, only("camera_pre", stopped(at(ms(200)), at(ms(212)))));
  EXPECT_THAT(missed("camera_pre"),
              testing::ElementsAre(SlotOfCycle{40, 2, 0}, SlotOfCycle{40, 2, 1}, SlotOfCycle{41, 2, 0},
                                   SlotOfCycle{41, 2, 1}, SlotOfCycle{42, 2, 0}, SlotOfCycle{42, 2, 1}));
  for (const char* node : kOnFlexRay) {
    EXPECT_TRUE(of(node).states.empty()) << node;
    EXPECT_EQ(health_of(node).timing.late_frames + health_of(node).timing.early_frames, 0u) << node;
    const bool itself = node == std::string("camera_pre");
    EXPECT_EQ(health_of(node).timing.frames_lost, itself ? 0u : 6u) << node;
    EXPECT_EQ(health_of(node).drops(), 0u) << node;
  }
  EXPECT_EQ(of("feature").fresh, 15);
}

// Twenty cycles, with room for the frames of five: it receives no others when it catches up, and its clock goes
// astray. It halts, as FlexRay specifies, and integrates anew. Until then it hardly disturbs the others.
TEST_F(TurnedNodeSet, ANodeThatWasStoppedForLongIntegratesAnew) {
  drive({.lasts = ms(600), .room = 64}, only("camera_pre", stopped(at(ms(200)), at(ms(300)))));
  expect_all_active();
  EXPECT_THAT(of("camera_pre").states, testing::IsSupersetOf({"halt", "initialise schedule", "normal active"}));
  EXPECT_GT(health_of("camera_pre").timing.slots_missed, 10u);
  EXPECT_GT(health_of("camera_pre").medium.lost, 0u);
  for (const char* node : {"laser_pre", "gateway", "fusion", "feature"}) {
    EXPECT_TRUE(of(node).states.empty()) << node;
    EXPECT_LE(health_of(node).timing.early_frames, 20u) << node;
  }
}

}  // namespace
}  // namespace ttf::nodes::runner
