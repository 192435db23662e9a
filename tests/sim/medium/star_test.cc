// The simulated star: its delays, and the reception and decisions of its coupler. The laws of a FlexRay port
// hold for it with a coupler that forwards everything.
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "sim/medium/flexray_medium.h"
#include "tests/sim/medium/simulated_flexray.h"

namespace ttf::laws {
namespace {

using sim::medium::Leaving;

constexpr std::size_t kNodes = 5;

schedules::model::Cluster star(std::int64_t min_delay_ps, std::int64_t max_delay_ps) {
  schedules::model::Cluster cluster;
  cluster.topology = schedules::model::Topology::kStar;
  cluster.flexray.gdMinPropagationDelay_ps = min_delay_ps;
  cluster.flexray.gdMaxPropagationDelay_ps = max_delay_ps;
  cluster.nodes.resize(kNodes);
  for (schedules::model::Node& node : cluster.nodes) node.flexray.emplace();
  return cluster;
}

struct TestCoupler final : sim::medium::Coupler {
  std::vector<Leaving> received, out_of_nothing;
  bool open = true;
  std::optional<TrueTime> cut, hold;
  bool pass(Leaving& signal, const bus::wire::DecodedFrame* frame) override {
    EXPECT_EQ(frame != nullptr, signal.signal == bus::ports::Signal::kFrame);
    received.push_back(signal);
    if (cut) signal.signal = bus::ports::Signal::kUndecodable, signal.end = *cut;
    return open;
  }
  void disturbed(const Leaving& signal) override { out_of_nothing.push_back(signal); }
  TrueTime fell_silent(NodeId, TrueTime at) override { return hold.value_or(at); }
};

// All branches are equal, so that the laws' nodes have the required distances.
class StarBench final : public SimulatedFlexRay {
 public:
  StarBench() : SimulatedFlexRay(star(2'000'000, 2'000'000)) {
    for (const Channel channel : {Channel::kA, Channel::kB})
      medium().set_coupler(channel, &couplers_[index_of(channel)]);
  }

 private:
  std::array<TestCoupler, 2> couplers_;
};

INSTANTIATE_TYPED_TEST_SUITE_P(Star, FlexRayPortLaws, StarBench);

}  // namespace
}  // namespace ttf::laws

namespace ttf::sim::medium {
namespace {

using bus::ports::Signal;
using schedules::model::Channel;

struct Bench {
  schedules::model::Cluster cluster = laws::star(100'000, 2'500'000);
  MediumQueue queue{64};
  FramePool pool{64};
  FlexRayMedium medium{cluster, queue, pool};
  laws::TestCoupler coupler;
  struct Reached {
    std::size_t node;
    Signal signal;
    TrueTime start, end;
  };

  Bench() { medium.set_coupler(Channel::kA, &coupler); }
  void send(std::size_t node, Signal signal, TrueTime start, TrueTime end) {
    medium.transmit(static_cast<NodeId>(node), {Channel::kA, signal, {}, {}, 0, {}}, start, end);
  }
  std::vector<Reached> run(TrueTime until = kNever<TrueTime>) {
    std::vector<Reached> reached;
    while (!queue.empty() && queue.next().time <= until) {
      const TrueTime now = queue.next().time;
      const MediumEvent event = queue.pop();
      if (const auto arrival = medium.arrive(event, now)) {
        reached.push_back({event.node, arrival->signal, arrival->start, arrival->end});
        medium.release(*arrival);
      }
    }
    return reached;
  }
};

TEST(Star, TheTwoFarthestBranchesTogetherHaveTheLargestDelay) {
  const Bench bench;
  Duration largest{};
  for (std::size_t a = 0; a < laws::kNodes; ++a)
    for (std::size_t b = 0; b < laws::kNodes; ++b) {
      if (a == b) continue;
      const auto from = static_cast<NodeId>(a), to = static_cast<NodeId>(b);
      const Duration delay = bench.medium.delay(from, to);
      EXPECT_EQ(delay, bench.medium.delay(to, from));
      EXPECT_GE(delay.ns, 100);
      EXPECT_LE(delay.ns, 2500);
      EXPECT_NEAR(static_cast<double>(delay.ns),
                  static_cast<double>((bench.medium.branch(from) + bench.medium.branch(to)).ns), 1.0);
      largest = std::max(largest, delay);
    }
  EXPECT_EQ(largest, Duration{2500});
}

TEST(Star, TheCouplerReceivesASignalAfterItsBranchAndTheOthersAfterTheirs) {
  Bench bench;
  bench.send(3, Signal::kCas, TrueTime{10'000}, TrueTime{14'000});
  const auto reached = bench.run();
  ASSERT_EQ(bench.coupler.received.size(), 1u);
  const Leaving& received = bench.coupler.received[0];
  EXPECT_EQ(received.sender, NodeId{3});
  EXPECT_EQ(received.start, TrueTime{10'000} + bench.medium.branch(NodeId{3}));
  EXPECT_EQ(received.end - received.start, Duration{4000});
  ASSERT_EQ(reached.size(), laws::kNodes - 1);
  for (const auto& one : reached) {
    EXPECT_NE(one.node, 3u);
    EXPECT_EQ(one.start, received.start + bench.medium.branch(static_cast<NodeId>(one.node)));
    EXPECT_EQ(one.end - one.start, Duration{4000});
  }
}

TEST(Star, SignalsThatTheCouplerBlocksReachNoNodeAndThoseItCutsEndThere) {
  Bench bench;
  bench.coupler.open = false;
  bench.send(0, Signal::kCas, TrueTime{10'000}, TrueTime{14'000});
  EXPECT_TRUE(bench.run().empty());
  bench.coupler.open = true;
  bench.coupler.cut = TrueTime{23'000};
  bench.send(0, Signal::kWakeup, TrueTime{20'000}, TrueTime{90'000});
  const auto reached = bench.run();
  ASSERT_EQ(reached.size(), laws::kNodes - 1);
  for (const auto& one : reached) {
    EXPECT_EQ(one.signal, Signal::kUndecodable);
    EXPECT_EQ(one.end, TrueTime{23'000} + bench.medium.branch(static_cast<NodeId>(one.node)));
  }
}

TEST(Star, ASignalWhoseSenderFallsSilentEndsForAllWhereTheCouplerEndsIt) {
  for (const bool held : {false, true}) {
    Bench bench;
    const NodeId sender{1};
    const TrueTime silent{30'000};
    const TrueTime ends = held ? TrueTime{41'000} : silent + bench.medium.branch(sender);
    if (held) bench.coupler.hold = ends;
    bench.send(1, Signal::kWakeup, TrueTime{10'000}, TrueTime{60'000});
    EXPECT_TRUE(bench.run(silent).empty());
    bench.medium.power_off(sender, silent);
    const auto reached = bench.run();
    ASSERT_EQ(reached.size(), laws::kNodes - 1);
    for (const auto& one : reached) {
      EXPECT_EQ(one.signal, Signal::kUndecodable);
      EXPECT_EQ(one.end, ends + bench.medium.branch(static_cast<NodeId>(one.node)));
    }
  }
}

TEST(Star, NoiseOfANodeGoesThroughTheCouplerAndNoiseOutOfNothingPastIt) {
  Bench bench;
  bench.coupler.open = false;
  const Leaving noise{NodeId{0}, Channel::kA, Signal::kUndecodable, TrueTime{5'000}, TrueTime{6'000}, {}};
  bench.medium.emit(noise, NodeId{2});
  EXPECT_TRUE(bench.run().empty());
  EXPECT_EQ(bench.coupler.received.at(0).sender, NodeId{2});
  bench.medium.emit(noise, std::nullopt);
  EXPECT_EQ(bench.coupler.out_of_nothing.size(), 1u);
  EXPECT_EQ(bench.run().size(), laws::kNodes);
}

// A disturbance of a signal on its branch reaches all nodes.
TEST(Star, ADisturbanceIsAskedOnTheWayToTheCouplerAndOnTheWayFromIt) {
  struct Marginal final : Disturbance {
    int to_coupler = 0, from_coupler = 0;
    bool leaving(Leaving& signal) override { return signal.start = signal.start - Duration{3'000}, true; }
    bool arriving(Arriving& signal) override {
      ++(signal.regenerated ? from_coupler : to_coupler);
      if (!signal.regenerated) {
        EXPECT_EQ(signal.receiver, kNoNode);
        signal.signal = Signal::kUndecodable;
      } else {
        EXPECT_NE(signal.receiver, kNoNode);
        EXPECT_EQ(signal.signal, Signal::kUndecodable);
      }
      return true;
    }
  } marginal;
  Bench bench;
  bench.medium.set_disturbance(&marginal);
  bench.send(1, Signal::kCas, TrueTime{50'000}, TrueTime{54'000});
  ASSERT_FALSE(bench.queue.empty());
  EXPECT_GE(bench.queue.next().time, TrueTime{50'000});  // never in the past
  EXPECT_EQ(bench.run().size(), laws::kNodes - 1);
  EXPECT_EQ(marginal.to_coupler, 1);
  EXPECT_EQ(marginal.from_coupler, static_cast<int>(laws::kNodes - 1));
  EXPECT_EQ(bench.coupler.received.at(0).start, TrueTime{47'000} + bench.medium.branch(NodeId{1}));
}

TEST(Star, BothLegsSayWhetherAFaultSentIt) {
  struct Asked final : Disturbance {
    std::vector<bool> emitted;
    bool arriving(Arriving& signal) override { return emitted.push_back(signal.emitted), true; }
  };
  for (const bool emitted : {false, true}) {
    Asked asked;
    Bench bench;
    bench.medium.set_disturbance(&asked);
    const Leaving noise{NodeId{1}, Channel::kA, Signal::kCas, TrueTime{50'000}, TrueTime{54'000}, {}};
    if (emitted)
      bench.medium.emit(noise, noise.sender);
    else
      bench.send(1, noise.signal, noise.start, noise.end);
    EXPECT_EQ(bench.run().size(), laws::kNodes - 1);
    EXPECT_EQ(asked.emitted, std::vector<bool>(1 + laws::kNodes - 1, emitted)) << "to the coupler, then to all others";
  }
}

}  // namespace
}  // namespace ttf::sim::medium
