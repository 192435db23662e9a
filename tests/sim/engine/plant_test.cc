// A plant's effects on controllers: supply, drift, and a different schedule for one node.
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <vector>

#include "bus/poc/event.h"
#include "core/random.h"
#include "sim/engine/bus_simulation.h"
#include "tests/sim/engine/bus_clusters.h"

namespace ttf::sim::engine {
namespace {

using bus::poc::PocKind;

constexpr std::int64_t kCycle_ns = 5'000'000;
constexpr TrueTime kSlotOne{1'000'000 + 7'000};  // cycle 0's action point of slot 1, about

// Counts by slot the problems that a controller saw.
struct Problems final : bus::controller::ControllerEvents {
  std::array<int, 65> syntax{}, content{}, missing{}, unexpected{};
  void slot_problem(std::int64_t, int slot, schedules::model::Channel, bus::controller::SlotStatus status,
                    Microticks) override {
    if (slot > 64) return;  // dynamic
    const auto s = static_cast<std::size_t>(slot);
    syntax[s] += has(status, bus::controller::kSyntaxError);
    content[s] += has(status, bus::controller::kContentError);
    missing[s] += status == bus::controller::kNoFrame;
    unexpected[s] += status == bus::controller::kUnexpectedFrame;
  }
};

struct Plant4 {
  schedules::model::Cluster cluster = bus_cluster(4, 3, 4);
  std::vector<Problems> seen{4};
  std::unique_ptr<BusSimulation> simulation;

  // All begin integrated on random clocks, cycle 0 at 1 ms.
  explicit Plant4(std::uint64_t seed, const schedules::model::Cluster* view_of_last = nullptr) {
    std::vector<BusNode> nodes;
    std::vector<bus::controller::ControllerEvents*> events;
    for (int n = 0; n < 4; ++n) {
      RandomStream draw({seed, 0, Purpose::kClockDrift, static_cast<std::uint16_t>(n), 0});
      const std::int64_t ppb = draw.integer(-1'000'000, 1'000'000);
      BusNode node{timebase::Oscillator(25'000, ppb, draw.integer(0, 24'999))};
      node.clock = bus::controller::InitialClock{node.oscillator.ticks_at(TrueTime{1'000'000}),
                                                 static_cast<int>(ppb * kMicroPerCycle / 1'000'000'000)};
      if (n == 3) node.view = view_of_last;
      nodes.push_back(node);
      events.push_back(&seen[static_cast<std::size_t>(n)]);
    }
    simulation = std::make_unique<BusSimulation>(cluster, std::move(nodes), std::move(events));
  }
  PocKind kind(int node) const { return simulation->controller(static_cast<NodeId>(node)).state().kind; }
  void run_to(Duration since_start) { simulation->run_until(TrueTime{} + since_start); }
};

TEST(Plant, NodesMayBeginIntegrated) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Plant4 plant(seed);
    for (int ms = 2; ms < 500; ms += 7) {
      plant.run_to(Duration::milliseconds(ms));
      for (int n = 0; n < 4; ++n) ASSERT_EQ(plant.kind(n), PocKind::kNormalActive);
      ASSERT_LE(plant.simulation->precision(), kAssumedPrecision);
    }
    for (const Problems& one : plant.seen)
      for (int slot = 0; slot <= 64; ++slot) {
        ASSERT_EQ(one.syntax[static_cast<std::size_t>(slot)], 0);
        ASSERT_EQ(one.missing[static_cast<std::size_t>(slot)], 0);
      }
  }
}

// In the middle of its frame the sender loses its supply. The others receive an undecodable signal, and then
// silence.
TEST(Plant, AFrameWhoseSenderLosesItsSupplyIsCutOff) {
  Plant4 plant(1);
  const std::int64_t cycle = 10;
  plant.simulation->run_until(kSlotOne + Duration{cycle * kCycle_ns + 10'000});
  ASSERT_TRUE(plant.simulation->medium().carrier(NodeId{1}, schedules::model::Channel::kA, plant.simulation->now()));
  plant.simulation->power_off(NodeId{0});
  EXPECT_FALSE(plant.simulation->powered(NodeId{0}));
  plant.run_to(Duration{(cycle + 5) * kCycle_ns});
  for (std::size_t n = 1; n < 4; ++n) {
    EXPECT_EQ(plant.seen[n].syntax[1], 2) << "both channels, once";
    EXPECT_EQ(plant.seen[n].missing[1], 2 * 4) << "both channels, four cycles";
    EXPECT_EQ(plant.kind(static_cast<int>(n)), PocKind::kNormalActive);
  }
  EXPECT_LE(plant.simulation->precision(), kAssumedPrecision);
}

TEST(Plant, TheCutEndsTheSignalAtOnce) {
  Plant4 plant(1);
  plant.simulation->run_until(kSlotOne + Duration{10'000});
  const medium::FlexRayMedium& medium = plant.simulation->medium();
  const Duration before = medium.busy(schedules::model::Channel::kA);
  plant.simulation->power_off(NodeId{0});
  EXPECT_LT(medium.busy(schedules::model::Channel::kA), before);
  const TrueTime cut = plant.simulation->now();
  for (int n = 1; n < 4; ++n) {
    const TrueTime end = cut + medium.delay(NodeId{0}, static_cast<NodeId>(n));
    plant.simulation->run_until(end - Duration{1});
    EXPECT_TRUE(medium.carrier(static_cast<NodeId>(n), schedules::model::Channel::kA, plant.simulation->now()));
    plant.simulation->run_until(end);
    EXPECT_FALSE(medium.carrier(static_cast<NodeId>(n), schedules::model::Channel::kA, plant.simulation->now()));
  }
}

// It was off for the first half of the frame. The rest counts as no frame, so the next one's schedule is
// taken.
TEST(Plant, ANodePoweredOnInTheMiddleOfAFrameDoesNotReceiveIt) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    Plant4 plant(seed);
    plant.run_to(Duration{20 * kCycle_ns});
    plant.simulation->power_off(NodeId{3});
    plant.run_to(Duration{30 * kCycle_ns});
    plant.simulation->power_on(NodeId{3}, kSlotOne + Duration{30 * kCycle_ns + 15'000});
    EXPECT_FALSE(plant.simulation->powered(NodeId{3}));
    plant.simulation->run_until(kSlotOne + Duration{31 * kCycle_ns - 100'000});
    EXPECT_EQ(plant.kind(3), PocKind::kInitialiseSchedule);
    EXPECT_EQ(plant.simulation->controller(NodeId{3}).state().reference, 2) << "slot 1 went by half heard";
    plant.run_to(Duration{42 * kCycle_ns});
    EXPECT_EQ(plant.kind(3), PocKind::kNormalActive);
    EXPECT_LE(plant.simulation->precision(), kAssumedPrecision);
  }
}

TEST(Plant, ADriftThatTheCorrectionReachesDoesNoHarm) {
  Plant4 plant(3);
  for (int step = 1; step <= 12; ++step) {  // to and fro, within +-1500 ppm
    plant.run_to(Duration{step * 20 * kCycle_ns});
    plant.simulation->change_drift(NodeId{0}, (step % 2 == 0 ? 1 : -1) * 700'000);
  }
  plant.run_to(Duration{300 * kCycle_ns});
  for (int n = 0; n < 4; ++n) EXPECT_EQ(plant.kind(n), PocKind::kNormalActive);
  EXPECT_LE(plant.simulation->precision(), kAssumedPrecision);
}

TEST(Plant, ADriftBeyondTheLimitTakesThatNodeOnlyOutOfTheCluster) {
  for (const std::int64_t ppb : {5'000'000, -5'000'000, 100'000'000, -100'000'000}) {
    Plant4 plant(4);
    plant.run_to(Duration{20 * kCycle_ns});
    EXPECT_EQ(plant.seen[1].missing[1] + plant.seen[1].syntax[1], 0);
    plant.simulation->change_drift(NodeId{0}, ppb);
    plant.run_to(Duration{60 * kCycle_ns});
    EXPECT_GT(plant.seen[1].missing[1] + plant.seen[1].syntax[1], 2 * 30) << ppb;
    EXPECT_LE(plant.simulation->precision(NodeId{1}), kAssumedPrecision) << ppb;
    for (int n = 1; n < 4; ++n) EXPECT_EQ(plant.kind(n), PocKind::kNormalActive) << ppb << " ppb, node " << n;
  }
}

TEST(Plant, AHostCommandsItsController) {
  Plant4 plant(5);
  plant.run_to(Duration{20 * kCycle_ns});
  const auto command = [&](NodeId node, bus::poc::PocEventKind what) {
    const TrueTime now = plant.simulation->now();
    plant.simulation->controller(node).command(what, plant.simulation->oscillator(node).ticks_at(now));
  };
  command(NodeId{3}, bus::poc::PocEventKind::kHalt);
  EXPECT_EQ(plant.kind(3), PocKind::kNormalActive);  // at the end of the cycle
  command(NodeId{2}, bus::poc::PocEventKind::kFreeze);
  EXPECT_EQ(plant.kind(2), PocKind::kHalt);
  plant.run_to(Duration{22 * kCycle_ns});
  EXPECT_EQ(plant.kind(3), PocKind::kHalt);
  EXPECT_EQ(plant.kind(0), PocKind::kNormalActive);
}

// Node 3's schedule gives it slot 9, which the cluster leaves unassigned.
TEST(Plant, ANodeMayBelieveInAnotherSchedule) {
  schedules::model::Cluster wrong = bus_cluster(4, 3, 4);
  wrong.frames.back().slot = 9;
  wrong.nodes.back().flexray->pKeySlotId = 9;
  Plant4 plant(6, &wrong);
  plant.run_to(Duration{1'000'000 + 10 * kCycle_ns});
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_EQ(plant.seen[n].missing[4], 20);
    EXPECT_EQ(plant.seen[n].unexpected[9], 20) << "a valid frame in a slot that has no owner";
    EXPECT_EQ(plant.kind(static_cast<int>(n)), PocKind::kNormalActive);
  }
}

// Under any acts, in any order, at any instants, the run goes on and is a function of its seed.
class Tormentor final : public medium::Disturbance {
 public:
  Tormentor(BusSimulation& plant, std::uint64_t seed) : plant_(plant), draw_({seed, 0, Purpose::kTest, 1, 0}) {}
  TrueTime next() const override { return next_; }
  void act(TrueTime now) override {
    const auto node = static_cast<NodeId>(draw_.integer(0, 3));
    switch (draw_.integer(0, 3)) {
      case 0: plant_.power_off(node); break;
      case 1: plant_.power_on(node, now + Duration{draw_.integer(0, 3) * draw_.integer(0, 1'000'000)}); break;
      case 2: plant_.change_drift(node, draw_.integer(-3'000'000, 3'000'000)); break;
      case 3: {
        const TrueTime start = now + Duration{draw_.integer(0, 1'000)};
        plant_.emit({node,
                     draw_.integer(0, 1) == 0 ? schedules::model::Channel::kA : schedules::model::Channel::kB,
                     static_cast<bus::ports::Signal>(draw_.integer(1, 3)),
                     start,
                     start + Duration{draw_.integer(1, 200'000)},
                     {}},
                    std::nullopt);
        break;
      }
    }
    next_ = now + Duration{draw_.integer(0, 2) * draw_.integer(0, 2'000'000)};
    ++acts;
  }
  int acts = 0;

 private:
  BusSimulation& plant_;
  RandomStream draw_;
  TrueTime next_{1'000'000};
};

std::vector<std::int64_t> tormented(std::uint64_t seed) {
  Plant4 plant(seed);
  Tormentor tormentor(*plant.simulation, seed);
  plant.simulation->set_disturbance(&tormentor);
  std::vector<std::int64_t> story;
  for (int ms = 5; ms < 1'000; ms += 5) {
    plant.run_to(Duration::milliseconds(ms));
    for (int n = 0; n < 4; ++n) story.push_back(static_cast<std::int64_t>(plant.kind(n)));
    story.push_back(plant.simulation->precision().ns);
    story.push_back(plant.simulation->medium().busy(schedules::model::Channel::kB).ns);
  }
  for (const Problems& one : plant.seen) {
    story.insert(story.end(), one.syntax.begin(), one.syntax.end());
    story.insert(story.end(), one.content.begin(), one.content.end());
  }
  EXPECT_GT(tormentor.acts, 300);
  return story;
}

TEST(Plant, ARunUnderTormentIsAFunctionOfItsSeed) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) EXPECT_EQ(tormented(seed), tormented(seed)) << "seed " << seed;
  EXPECT_NE(tormented(1), tormented(2));
}

}  // namespace
}  // namespace ttf::sim::engine
