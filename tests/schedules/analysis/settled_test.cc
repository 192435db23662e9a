// Until when a list is waited for, in the cluster of tests/schedules/small_cluster.h.
#include "schedules/analysis/settled.h"

#include <gtest/gtest.h>

#include "schedules/analysis/age_stages.h"
#include "schedules/check/checker.h"
#include "tests/schedules/cluster_file.h"
#include "tests/schedules/small_cluster.h"

namespace ttf::schedules::analysis {
namespace {

constexpr std::int64_t kStamp = 1'000 + 500;                               // a macrotick old, rounded to 1 us
constexpr std::int64_t kToSlot = 1'000'000 + kRounding + kApart + kStamp;  // from the stamp, at the latest
constexpr std::int64_t kRound = 320'000'000;
constexpr std::int64_t ms_in_ns(std::int64_t n) { return n * 1'000'000; }

// The first instant from which on a list of this stamp is no longer awaited.
GlobalTime waited_until(const SettledRound& round, GlobalTime stamp) {
  for (std::int64_t shift = -10 * round.round.ns;; shift += round.round.ns)
    for (const Settled& settled : round.instants)
      if (stamp <= settled.measured + Duration{shift}) return settled.at + Duration{shift};
}

// Slot 3 begins at 168 us of every cycle and ends at 252 us; fusion is at 1 ms of odd cycles. A list written
// before slot 3 of an odd cycle is fused in it.
TEST(Settled, OneStepPerFusionInstant) {
  const auto round = settled_round(small(false), SensorId{0});
  ASSERT_TRUE(round.has_value());
  EXPECT_EQ(round->round.ns, kRound);
  ASSERT_EQ(round->instants.size(), 32u);
  for (const Settled& settled : round->instants) {
    EXPECT_EQ(settled.at.ns % ms_in_ns(10), ms_in_ns(6));
    EXPECT_EQ((settled.at - settled.measured).ns, 832'000 + kToSlot);
  }
  for (std::size_t i = 1; i < 32; ++i) EXPECT_EQ((round->instants[i].at - round->instants[i - 1].at).ns, ms_in_ns(10));
}

// For any stamp, by enumeration. The list takes the first slot that begins once it is there. The first fusion
// instant after that slot's end, later by at least the clocks' distance, settles it.
TEST(Settled, IsTheFirstFusionInstantAfterTheLatestWay) {
  for (const std::int64_t offset_us : {255, 259, 260, 1000, 4999}) {
    model::Cluster cluster = small(false);
    cluster.nodes[1].tasks[0].activation.at.offset = Macroticks{offset_us};
    const auto round = settled_round(cluster, SensorId{0});
    ASSERT_TRUE(round.has_value());
    const auto latest = [&](std::int64_t stamp) {
      std::int64_t slot = 168'000;
      while (slot < stamp + kToSlot) slot += ms_in_ns(5);
      std::int64_t fusion = ms_in_ns(5) + offset_us * 1'000;
      while (fusion < slot + 84'000 + kApart) fusion += ms_in_ns(10);
      return fusion;
    };
    for (std::int64_t stamp = 0; stamp < kRound; stamp += 77'777)
      ASSERT_EQ(waited_until(*round, GlobalTime{stamp}).ns, latest(stamp)) << "stamp " << stamp;
    // To the nanosecond at every slot.
    for (int cycle = 1; cycle < 64; ++cycle)
      for (const std::int64_t off : {-1, 0, 1}) {
        const std::int64_t stamp = cycle * ms_in_ns(5) + 168'000 - kToSlot + off;
        ASSERT_EQ(waited_until(*round, GlobalTime{stamp}).ns, latest(stamp)) << "stamp " << stamp;
      }
  }
}

// Between two of a list's slots, only the first fusion instant settles anything.
TEST(Settled, SlotsOfFewCycles) {
  model::Cluster cluster = small(false);
  cluster.frames[0].base_cycle = 2;
  cluster.frames[0].repetition = 8;
  const auto round = settled_round(cluster, SensorId{0});
  ASSERT_TRUE(round.has_value());
  ASSERT_EQ(round->instants.size(), 8u);
  for (const Settled& settled : round->instants) {
    EXPECT_EQ(settled.at.ns % ms_in_ns(40), ms_in_ns(16));
    EXPECT_EQ((settled.at - settled.measured).ns, 6'000'000 - 168'000 + kToSlot);
  }
}

// Read from the slots of the earlier of two groups of cycles.
TEST(Settled, SlotsOfTwoGroupsOfCycles) {
  model::Cluster cluster = small(false);
  cluster.frames[0].base_cycle = 1;
  cluster.frames[0].repetition = 8;
  cluster.frames.push_back(cluster.frames[0]);
  cluster.frames.back().base_cycle = 4;
  const auto round = settled_round(cluster, SensorId{0});
  ASSERT_TRUE(round.has_value());
  ASSERT_EQ(round->instants.size(), 16u);
  for (const Settled& settled : round->instants) {
    const bool first = settled.at.ns % ms_in_ns(40) == ms_in_ns(6);
    EXPECT_TRUE(first || settled.at.ns % ms_in_ns(40) == ms_in_ns(26)) << settled.at.ns;
    EXPECT_EQ((settled.at - settled.measured).ns, (first ? 832'000 : 5'832'000) + kToSlot);
  }
}

// Over a CAN to the fusing task: only that task is on the grid.
TEST(Settled, WithoutSlots) {
  model::Cluster cluster = small(false);
  model::CanBus bus;
  bus.nominal_bit_rate = bus.data_bit_rate = 1'000'000;
  bus.flexible_data_rate = true;
  bus.messages = {{PduId{0}, 16, NodeId{0}, Duration::milliseconds(10), 0}};
  cluster.can_buses = {bus};
  cluster.nodes[0].tasks[0].writes[0].medium = model::MediumId::can(0);
  cluster.nodes[1].tasks[0].reads[0].medium = model::MediumId::can(0);
  cluster.frames.erase(cluster.frames.begin());
  const Path path = path_of(cluster, SensorId{0});
  ASSERT_EQ(path.available, 2u);
  const auto round = settled_round(cluster, SensorId{0});
  ASSERT_TRUE(round.has_value());
  ASSERT_EQ(round->instants.size(), 32u);
  for (const Settled& settled : round->instants) {
    EXPECT_EQ(settled.at.ns % ms_in_ns(10), ms_in_ns(6));
    EXPECT_EQ(settled.at - settled.measured, path.stages[0].worst + path.stages[1].worst + Duration{kApart + kStamp});
  }
}

TEST(Settled, NothingWhereNothingIsFusedByTime) {
  model::Cluster message = small(false);
  message.nodes[1].tasks[0].activation.kind = model::ActivationKind::kMessage;
  EXPECT_EQ(settled_round(message, SensorId{0}), std::nullopt);
  model::Cluster unread = small(false);
  unread.nodes[1].tasks[0].reads.clear();
  EXPECT_EQ(settled_round(unread, SensorId{0}), std::nullopt);
}

// The shipped synchronised cluster, fusion at 1.8 ms + n 10 ms. The laser of 27.7 ms has its slots in the
// cycle at 80 ms, the camera of 5.9 ms in that at 40 ms. Each is fused in the cycle of its slots, and awaited
// until then.
TEST(SettledShipped, ScheduledListsAreDueInTheCycleOfTheirSlots) {
  const model::Cluster cluster = check::load_checked_cluster(shipped_path("paper_synchronised"));
  const auto laser = settled_round(cluster, *cluster.find_sensor("laser"));
  const auto camera = settled_round(cluster, *cluster.find_sensor("camera"));
  ASSERT_TRUE(laser.has_value() && camera.has_value());
  for (std::int64_t n = 0; n < 8; ++n) {
    EXPECT_EQ(waited_until(*laser, GlobalTime{ms_in_ns(80 * n) + 27'700'000}).ns, ms_in_ns(80 * n) + 81'800'000);
    EXPECT_EQ(waited_until(*camera, GlobalTime{ms_in_ns(40 * n) + 5'900'000}).ns, ms_in_ns(40 * n) + 41'800'000);
  }
}

}  // namespace
}  // namespace ttf::schedules::analysis
