// In a star with guardians, a node's dynamic frame breaks off, or its clock jumps within one. All others and
// the guardians still count the same slots to the segment's end (bus/guardian/guardian.h G9). Node 0 is
// faulty; its frame is the segment's first, and the others' come behind it.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "tests/bus/layouts.h"
#include "tests/sim/engine/guarded.h"

namespace ttf::sim::engine {
namespace {

using schedules::model::Channel;

constexpr NodeId kBreaksOff{0};
constexpr int kEndsNodes = 5, kFirstSlot = 65, kFirstSequence = 3;
constexpr TrueTime kEndsBegin{1'000'000};
constexpr Duration kLongFrame = Duration::microseconds(75);        // node 0's, and some more
constexpr Duration kSegmentIsOver = Duration::microseconds(4900);  // in its cycle

// As schedules/flexray_demo.yaml has it: 0.6 us between the farthest, minislots of 7 us with their action point 3 us
// in.
schedules::model::Cluster breaking_off_cluster() {
  schedules::model::Cluster cluster = star_cluster(kEndsNodes, 3, 4);
  schedules::model::GlobalParameters& g = cluster.flexray;
  g.gdMinPropagationDelay_ps = 0;
  g.gdMaxPropagationDelay_ps = 600'000;
  g.gdMinislot = 7;
  g.gNumberOfMinislots = 100;
  g.gdMinislotActionPointOffset = 3;
  g.gdNIT = 5000 - 64 * 43 - 4 - 100 * 7;
  for (int n = 0; n < kEndsNodes; ++n) {
    schedules::model::NodeParameters& p = *cluster.nodes[static_cast<std::size_t>(n)].flexray;
    p.pDelayCompensationA = p.pDelayCompensationB = 12;
    p.pLatestTx = 80;
    const int elements = n == 0 ? 25 : 3;
    cluster.pdus.push_back(bus::list_layout(4, elements, elements));
    cluster.frames.push_back(
        {kFirstSlot + n, schedules::model::Channels::kAB, 0, 1, static_cast<NodeId>(n), static_cast<PduId>(n), 0, 0});
  }
  return cluster;
}

// A node's received dynamic frames.
struct DynamicReceived final : bus::controller::ControllerEvents {
  using Frame = std::tuple<std::int64_t, int, Channel>;  // cycle, slot
  std::map<Frame, Microticks> frames;                    // when it was over
  std::uint64_t problems = 0;
  void frame_received(std::int64_t cycle, int slot, Channel channel, const bus::wire::DecodedFrame&,
                      Microticks at) override {
    if (slot >= kFirstSlot) frames[{cycle, slot, channel}] = at;
  }
  void slot_problem(std::int64_t, int, Channel, bus::controller::SlotStatus, Microticks) override { ++problems; }
};

// Begins integrated, cycle 0 at kEndsBegin; every node sends one dynamic frame in every cycle.
struct BreakingOff {
  schedules::model::Cluster cluster = breaking_off_cluster();
  std::vector<std::unique_ptr<DynamicReceived>> received;
  std::unique_ptr<BusSimulation> simulation;
  int cycle = 0;

  explicit BreakingOff(std::uint64_t seed) {
    std::vector<BusNode> nodes;
    std::vector<bus::controller::ControllerEvents*> events;
    for (std::size_t n = 0; n < kEndsNodes; ++n) {
      const timebase::Oscillator crystal = Guarded::oscillator(seed, n);
      const Microticks begin = crystal.ticks_at(kEndsBegin);
      const std::int64_t thousand = (crystal.ticks_at(kEndsBegin + cluster.cycle() * 1000) - begin).value;
      nodes.push_back({crystal});
      nodes.back().clock = {begin + Microticks{1}, static_cast<int>((thousand + 500) / 1000 - kMicroPerCycle)};
      received.push_back(std::make_unique<DynamicReceived>());
      events.push_back(received.back().get());
    }
    simulation = std::make_unique<BusSimulation>(
        cluster, std::move(nodes), std::move(events),
        std::vector{Guarded::oscillator(seed, kEndsNodes), Guarded::oscillator(seed, kEndsNodes + 1)});
    run_to(Duration::microseconds(10));
  }
  // Into the present cycle.
  void run_to(Duration into) { simulation->run_until(kEndsBegin + cluster.cycle() * cycle + into); }
  void write_all() {
    for (std::size_t n = 0; n < kEndsNodes; ++n) {
      const bus::MadeList list(cluster.pdus[n], static_cast<std::uint32_t>(kFirstSequence + cycle), n == 0 ? 25 : 3, 0);
      simulation->controller(static_cast<NodeId>(n)).outgoing(static_cast<PduId>(n)).write(list.view());
    }
  }
  void whole_cycles(int count) {
    for (int n = 0; n < count; ++n) {
      write_all();
      ++cycle;
      run_to(Duration::microseconds(10));
    }
  }
  // Where the first dynamic frame begins in every cycle.
  Duration first_action_point() const {
    return Duration::microseconds(bus::controller::MinislotGrid(cluster.flexray).action_point(1).value);
  }
  medium::StarCoupler& coupler(Channel channel) { return *simulation->coupler(channel); }
  // Expects that all others received the others' frames of this cycle.
  void expect_everything_received(const std::string& when) {
    for (int receiver = 1; receiver < kEndsNodes; ++receiver)
      for (int sender = 1; sender < kEndsNodes; ++sender)
        for (const Channel channel : kBothChannels)
          ASSERT_TRUE(sender == receiver || received[static_cast<std::size_t>(receiver)]->frames.contains(
                                                {cycle, kFirstSlot + sender, channel}))
              << when << ": node " << receiver << " lacks node " << sender << "'s frame on "
              << (channel == Channel::kA ? "A" : "B");
  }
};

TEST(GuardianEnds, WhereverADynamicFrameBreaksOffAllGoOnCountingAlike) {
  constexpr int kDraws = 1500;
  std::uint64_t held = 0, kept_from_others = 0;
  for (std::uint64_t n = 0; n < kDraws; ++n) {
    RandomStream draw({n, 0, Purpose::kTest, 0, 0});
    BreakingOff run(n);
    run.whole_cycles(2);
    run.write_all();
    const Duration at = run.first_action_point() + Duration{draw.integer(0, kLongFrame.ns)};
    run.run_to(at);
    run.simulation->power_off(kBreaksOff);
    run.run_to(kSegmentIsOver);
    run.expect_everything_received("draw " + std::to_string(n) + ", at " + std::to_string(at.ns) + " ns");
    if (HasFatalFailure()) return;
    for (const Channel channel : kBothChannels) {
      held += run.coupler(channel).held();
      kept_from_others += run.coupler(channel).blocked();
    }
  }
  EXPECT_GT(held, kDraws / 2);
  EXPECT_EQ(kept_from_others, 0u) << "a guardian counts otherwise than a sender";
}

// As from a sender whose clock has jumped.
TEST(GuardianEnds, WhereverATrailingSequenceEndsAllGoOnCountingAlike) {
  struct Stretched final : medium::Disturbance {
    Duration by{};
    bool leaving(medium::Leaving& signal) override {
      const bool dynamic = signal.sender == kBreaksOff && signal.end - signal.start > Duration::microseconds(60);
      if (dynamic) signal.end = signal.end + by;
      return true;
    }
  };
  std::uint64_t held = 0, cut = 0;
  for (std::uint64_t n = 0; n < 1500; ++n) {
    RandomStream draw({n, 0, Purpose::kTest, 1, 0});
    BreakingOff run(n);
    Stretched stretched;
    stretched.by = Duration{draw.integer(-6'500, 20'000)};  // the bits are whole; may exceed the allowed length
    run.whole_cycles(2);
    run.simulation->set_disturbance(&stretched);
    run.write_all();
    run.run_to(kSegmentIsOver);
    run.simulation->set_disturbance(nullptr);
    run.expect_everything_received("draw " + std::to_string(n) + ", by " + std::to_string(stretched.by.ns) + " ns");
    if (HasFatalFailure()) return;
    for (const Channel channel : kBothChannels) {
      held += run.coupler(channel).held();
      cut += run.coupler(channel).cut();
      // Longer or shorter, it is the same frame unless it was cut.
      for (std::size_t receiver = 1; receiver < kEndsNodes; ++receiver)
        ASSERT_EQ(run.received[receiver]->frames.contains({run.cycle, kFirstSlot, channel}),
                  run.coupler(channel).cut() == 0)
            << "draw " << n << ", by " << stretched.by.ns << " ns";
    }
  }
  EXPECT_GT(held, 500u);
  EXPECT_GT(cut, 100u);
}

TEST(GuardianEnds, WithoutAFaultNothingIsOtherThanWithoutAGuardian) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    BreakingOff with(seed), without(seed);
    for (const Channel channel : kBothChannels) without.coupler(channel).fail(medium::StarCoupler::Failure::kStuckOpen);
    for (BreakingOff* run : {&with, &without}) run->whole_cycles(12);
    for (std::size_t n = 0; n < kEndsNodes; ++n) {
      EXPECT_EQ(with.received[n]->frames, without.received[n]->frames) << "node " << n << " seed " << seed;
      EXPECT_EQ(with.received[n]->frames.size(), 2u * (kEndsNodes - 1) * 12);
      EXPECT_EQ(with.received[n]->problems, 0u);
    }
    for (const Channel channel : kBothChannels) {
      EXPECT_EQ(with.coupler(channel).held(), 0u);
      EXPECT_EQ(with.coupler(channel).cut(), 0u);
    }
  }
}

}  // namespace
}  // namespace ttf::sim::engine
