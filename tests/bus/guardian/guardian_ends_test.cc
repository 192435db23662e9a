// A guardian ends forwarded frames in the dynamic segment (bus/guardian/guardian.h G9). Here it is a pure
// rule; running clusters: tests/sim/engine/guardian_ends_test.cc.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "bus/guardian/guardian.h"
#include "core/random.h"
#include "tests/bus/dynamic_cluster.h"

namespace ttf::bus::guardian {
namespace {

constexpr std::int64_t kDelay = 25;  // to the coupler, as compensated: half of two nodes'
constexpr int kMicroPerMacro = 40;

// Minislots of 7 macroticks with the action point 3 in, of 25 ns microticks.
schedules::model::Cluster ends_cluster() {
  schedules::model::Cluster cluster = dynamic_cluster(4);
  cluster.flexray.gdMinislot = 7;
  cluster.flexray.gNumberOfMinislots = 18;
  cluster.flexray.gdMinislotActionPointOffset = 3;
  for (schedules::model::Node& node : cluster.nodes) {
    node.flexray->pDelayCompensationA = node.flexray->pDelayCompensationB = 2 * kDelay;
    node.flexray->pLatestTx = 12;
  }
  return cluster;
}

struct Ends {
  schedules::model::Cluster cluster = ends_cluster(), with = guardian_cluster(cluster, Channel::kA);
  const schedules::model::GlobalParameters& g = cluster.flexray;
  Guardian guardian{with, Channel::kA, *with.nodes.back().flexray};
  controller::MinislotGrid grid{g};
  timebase::CycleClock clock = at_cycle(0, 0);
  Microticks tolerance{3 * kMicroPerMacro / 2};
  std::vector<Microticks> action_points;  // at the coupler

  Ends() {
    for (int minislot = 1; minislot <= grid.count(); ++minislot) action_points.push_back(action_point(minislot));
  }
  timebase::CycleClock at_cycle(std::int64_t later, int rate) const {
    return {{1000, 1'000'000, 40'000, g.gOffsetCorrectionStart}, Microticks{1000 + later}, rate, 0};
  }
  Microticks action_point(int minislot) const {
    return clock.start_of(grid.action_point(minislot)) + Microticks{kDelay};
  }
  Microticks last() const { return action_points.back(); }
  bool near_one(Microticks at) const {
    return std::any_of(action_points.begin(), action_points.end(),
                       [&](Microticks point) { return std::abs((at - point).value) <= tolerance.value; });
  }
  // The frame of node n's dynamic slot 11 + n.
  static wire::DecodedFrame frame(std::size_t node, int words) {
    wire::DecodedFrame made;
    made.header.frame_id = static_cast<std::uint16_t>(11 + node);
    made.header.payload_words = static_cast<std::uint8_t>(words);
    return made;
  }
};

TEST(GuardianEnds, G9_WhatEndsNearAnActionPointIsLeftAloneWhatEndsElsewhereGoesOnToTheNext) {
  const Ends ends;
  const Microticks segment_end = ends.clock.start_of(ends.grid.start_of(ends.grid.count() + 1));
  int alone = 0, held = 0;
  for (int minislot = 1; minislot <= ends.grid.count(); ++minislot) {
    const Microticks start = ends.action_point(minislot);
    for (Microticks end = start + Microticks{1}; end <= segment_end; end = end + Microticks{1}) {
      const Microticks made = ends.guardian.end_of(ends.clock, start, end, ends.last());
      if (ends.near_one(end)) {
        ASSERT_EQ(made, end) << "begun in minislot " << minislot;
        ++alone;
      } else if (end < ends.last()) {
        ASSERT_EQ(made, *std::upper_bound(ends.action_points.begin(), ends.action_points.end(), end));
        ++held;
      } else {
        ASSERT_EQ(made, ends.last());
      }
    }
  }
  EXPECT_GT(alone, 10'000);
  EXPECT_GT(held, 10'000);
}

// The minislot has 3 macroticks before its action point and 4 behind it. G9 takes 1.5; the rest is for the
// receivers.
TEST(GuardianEnds, G9_ReceiversThatAreOffByTheRestOfAMinislotCountAlike) {
  const Ends ends;
  const int room = 3 * kMicroPerMacro - static_cast<int>(ends.tolerance.value);
  RandomStream draw({1, 0, Purpose::kTest, 0, 0});
  for (int n = 0; n < 20'000; ++n) {
    const Microticks start = ends.action_point(static_cast<int>(draw.integer(1, 12)));
    const Microticks end =
        ends.guardian.end_of(ends.clock, start, start + Microticks{draw.integer(1, 3000)}, ends.last());
    const int counted = ends.grid.minislot_at(ends.clock, end - Microticks{kDelay});
    for (const std::int64_t late : {-static_cast<std::int64_t>(room), draw.integer(-room, room), std::int64_t{room}})
      ASSERT_EQ(ends.grid.minislot_at(ends.at_cycle(late, 0), end - Microticks{kDelay}), counted)
          << "from " << start.value << " to " << end.value << ", a receiver late by " << late;
  }
}

TEST(GuardianEnds, G9_NoFrameOfAFaultFreeNodeIsTouched) {
  const Ends ends;
  RandomStream draw({2, 0, Purpose::kTest, 0, 0});
  constexpr int kWords = 5;  // the layout's, and a message id
  const Microticks close{ends.tolerance.value - 4};
  for (int n = 0; n < 50'000; ++n) {
    const auto sender = static_cast<std::size_t>(draw.integer(0, 3));
    // A slot's minislot without and with transmissions before it.
    controller::DynamicSlotCounter counter(ends.g);
    if (sender > 0 && draw.integer(0, 1) == 1) counter.occupied(1, static_cast<int>(draw.integer(1, 8)));
    const int minislot = counter.minislot_of(static_cast<int>(11 + sender));
    if (minislot < 1 || minislot > 12) continue;
    // By the sender's clock, with errors in its offset, in the rest of its rate and in its crystal.
    const auto clock = ends.at_cycle(draw.integer(-close.value, close.value), static_cast<int>(draw.integer(-3, 3)));
    const auto frame = Ends::frame(sender, static_cast<int>(draw.integer(0, kWords)));
    const Microticks begin = clock.start_of(ends.grid.action_point(minislot));
    const std::int64_t bits = 4 * schedules::model::frame_bits(ends.g, frame.header.payload_words);
    const Microticks frame_end = begin + Microticks{bits + bits * draw.integer(-3000, 3000) / 1'000'000};
    const int last = ends.grid.dts_end(clock, frame_end, Microticks{4});
    ASSERT_LE(last, ends.grid.count());
    const Microticks delay{kDelay}, start = begin + delay;
    const Microticks end = clock.start_of(ends.grid.action_point(last)) + delay;
    const GuardianAnswer answer =
        ends.guardian.judge(ends.clock, counter, {static_cast<NodeId>(sender), ports::Signal::kFrame, start, &frame});
    ASSERT_EQ(answer.reason, GuardianReason::kForwarded);
    ASSERT_EQ(ends.guardian.end_of(ends.clock, start, end, answer.until), end)
        << "minislots " << minislot << " to " << last << ", " << int{frame.header.payload_words} << " words";
  }
}

TEST(GuardianEnds, G9_WhatLastsTooLongIsCutAtAnActionPointOfTheSegment) {
  const Ends ends;
  for (int taken = 0; taken <= 9; ++taken)
    for (int words = 0; words <= 5; ++words) {
      controller::DynamicSlotCounter counter(ends.g);
      if (taken > 0) counter.occupied(1, taken);
      const std::size_t sender = taken > 0 ? 1 : 0;
      const Microticks start = ends.action_point(counter.minislot_of(static_cast<int>(11 + sender)));
      const auto frame = Ends::frame(sender, words);
      const auto answer =
          ends.guardian.judge(ends.clock, counter, {static_cast<NodeId>(sender), ports::Signal::kFrame, start, &frame});
      ASSERT_TRUE(answer.forwards());
      EXPECT_TRUE(std::binary_search(ends.action_points.begin(), ends.action_points.end(), answer.until));
      const std::int64_t too_long = ends.tolerance.value + 1;
      for (const std::int64_t more : {too_long, 4 * too_long, 1000 * too_long})
        EXPECT_EQ(ends.guardian.end_of(ends.clock, start, answer.until + Microticks{more}, answer.until), answer.until);
    }
}

TEST(GuardianEnds, G9_WhatDoesNotBeginInTheDynamicSegmentHasNoGrid) {
  const Ends ends;
  const Microticks segment_end = ends.clock.start_of(ends.grid.start_of(ends.grid.count() + 1)) + Microticks{kDelay};
  for (const Microticks start :
       {Microticks{1000 + 7 * kMicroPerMacro}, Microticks{1000 + 800 * kMicroPerMacro}, segment_end})
    for (std::int64_t length = 1; length < 1000; ++length)
      ASSERT_EQ(ends.guardian.end_of(ends.clock, start, start + Microticks{length}, start + Microticks{600}),
                start + Microticks{std::min<std::int64_t>(length, 600)});
}

}  // namespace
}  // namespace ttf::bus::guardian
