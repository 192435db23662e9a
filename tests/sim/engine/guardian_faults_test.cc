// A running cluster on a star with one faulty node. With guardians the others notice only that node's own
// slot. Without them the same fault does the harm that the guardian prevents. Node 0 is faulty, in slot 1;
// node 4 is no sync node.
#include <gtest/gtest.h>

#include <functional>

#include "bus/wire/flexray_frame.h"
#include "tests/sim/engine/guarded.h"
#include "tests/sim/engine/start_spoiler.h"

namespace ttf::sim::engine {
namespace {

using bus::guardian::GuardianReason;
using bus::poc::PocKind;
using bus::ports::Signal;
using schedules::model::Channel;

constexpr NodeId kFaulty{0};

// Applies a given function to the faulty node's signals.
struct Doing final : medium::Disturbance {
  std::function<bool(ttf::sim::medium::Leaving&)> to_leaving;
  bool leaving(medium::Leaving& signal) override { return signal.sender != kFaulty || to_leaving(signal); }
};

struct Running {
  Guarded cluster;
  explicit Running(bool guardian, std::uint64_t seed, const schedules::model::Cluster* view = nullptr)
      : cluster(star_cluster(5, 3, 4, guardian), seed, Duration::milliseconds(9), view) {
    cluster.run_cycles(30);
    EXPECT_TRUE(!guardian || cluster.all_active(1));
    cluster.forget();
  }
  BusSimulation& simulation() { return *cluster.simulation; }
  void suffer(medium::Disturbance& fault, int cycles) {
    simulation().set_disturbance(&fault);
    cluster.run_cycles(cycles);
    simulation().set_disturbance(nullptr);
  }
  void expect_no_harm(const std::string& fault) {
    EXPECT_TRUE(cluster.all_active(1) && cluster.none_left_active(1)) << fault;
    EXPECT_EQ(cluster.problems(1), 0u) << fault;
    EXPECT_LE(simulation().precision(NodeId{1}), kAssumedPrecision) << fault;
  }
};

TEST(GuardianFaults, ABabblingIdiotReachesNoReceiver) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Running with(true, seed), without(false, seed);
    for (Running* run : {&with, &without}) {
      StartSpoiler babble(run->simulation(), run->cluster.cluster, StartSpoiler::Plan::kBabble, seed);
      run->suffer(babble, 60);
    }
    with.expect_no_harm("babbling, seed " + std::to_string(seed));
    EXPECT_GT(with.cluster.blocked(GuardianReason::kNotItsSlot), 1000u);
    EXPECT_GT(without.cluster.problems(1), 1000u) << "seed " << seed;
    EXPECT_NE(without.cluster.kind(4), PocKind::kNormalActive) << "seed " << seed;
  }
}

// All acts of start-up spoilers, in a running cluster: a lone coldstart node that receives nothing, wake-up
// patterns, ...
TEST(GuardianFaults, NobodyStartsAClusterThatRuns) {
  for (const auto plan : StartSpoiler::kPlans)
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      Running run(true, seed);
      run.simulation().power_off(kFaulty);
      run.cluster.run_cycles(1);
      run.cluster.forget();
      StartSpoiler spoiler(run.simulation(), run.cluster.cluster, plan, seed);
      run.suffer(spoiler, 60);
      run.expect_no_harm("plan " + std::to_string(static_cast<int>(plan)) + ", seed " + std::to_string(seed));
    }
  Running without(false, 1);
  StartSpoiler leader(without.simulation(), without.cluster.cluster, StartSpoiler::Plan::kFalseLeader, 1);
  without.suffer(leader, 200);
  EXPECT_GT(without.cluster.problems(1), 0u);
}

// The faulty node's frames carry node 1's id. One of them comes into node 1's slot, ahead of node 1's own.
struct Masquerade final : medium::Disturbance {
  Plant& plant;
  std::array<std::byte, bus::wire::kMaxFrameBytes> forged{};
  std::size_t size = 0;
  std::optional<medium::Leaving> due;
  explicit Masquerade(Plant& p) : plant(p) {}
  bool leaving(medium::Leaving& signal) override {
    if (signal.sender != kFaulty || signal.signal != Signal::kFrame) return true;
    bus::wire::DecodedFrame frame = bus::wire::decode_frame(signal.channel, signal.bytes);
    frame.header.frame_id = 2;
    size = bus::wire::encode_frame(frame.header, signal.channel, frame.payload, forged);
    const Duration earlier = Duration{43'000} - Duration{2'000};  // a slot, and two microseconds less
    due = medium::Leaving{kFaulty, signal.channel, Signal::kFrame, signal.start + earlier, signal.end + earlier, {}};
    signal.bytes = std::span(forged).first(size);
    return true;
  }
  TrueTime next() const override { return due ? due->start : kNever<TrueTime>; }
  void act(TrueTime) override {
    due->bytes = std::span(forged).first(size);
    plant.emit(*due, kFaulty);
    due.reset();
  }
};

TEST(GuardianFaults, NobodySendsInAnothersNameOrSlot) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Running with(true, seed), without(false, seed);
    for (Running* run : {&with, &without}) {
      Masquerade masquerade(run->simulation());
      run->suffer(masquerade, 40);
    }
    with.expect_no_harm("masquerading, seed " + std::to_string(seed));
    EXPECT_GE(with.cluster.blocked(GuardianReason::kWrongHeader), 80u);
    EXPECT_GE(with.cluster.blocked(GuardianReason::kNotItsSlot), 40u);
    EXPECT_GT(without.cluster.problems(1), 100u);
  }
}

// Frames that are a little early or late: some receivers find them in the slot, some do not. A coupler
// decides for all.
TEST(GuardianFaults, AFrameSlightlyOffIsTheSameForAll) {
  int disagreements = 0;
  for (std::uint64_t seed = 0; seed < 4; ++seed)
    for (std::int64_t shift = -9'000; shift <= 16'000; shift += 250)
      for (const bool guardian : {true, false}) {
        Running run(guardian, seed);
        Doing off;
        off.to_leaving = [&](medium::Leaving& signal) {
          signal.start = signal.start + Duration{shift};
          signal.end = signal.end + Duration{shift};
          return true;
        };
        run.suffer(off, 4);
        const bool agree = run.cluster.agree(1, 1);
        if (!guardian) {
          disagreements += !agree;
          continue;
        }
        EXPECT_TRUE(agree) << "shift " << shift << " ns, seed " << seed;
        run.expect_no_harm("shift " + std::to_string(shift) + " ns, seed " + std::to_string(seed));
      }
  EXPECT_GT(disagreements, 0);
}

// Its sender makes a signal that only some receivers can decode: through a coupler all get the same.
TEST(GuardianFaults, AMarginalValueIsTheSameForAll) {
  struct Marginal final : medium::Disturbance {
    std::uint32_t calls = 0;
    bool arriving(medium::Arriving& signal) override {
      if (signal.sender != kFaulty || signal.regenerated) return true;
      RandomStream draw({7, 0, Purpose::kTest, 0, calls++});
      if (draw.integer(0, 1) == 0) signal.signal = Signal::kUndecodable;
      return true;
    }
  };
  Running with(true, 1), without(false, 1);
  for (Running* run : {&with, &without}) {
    Marginal marginal;
    run->suffer(marginal, 40);
  }
  with.expect_no_harm("marginal");
  EXPECT_TRUE(with.cluster.agree(1, 1));
  EXPECT_GT(with.cluster.blocked(GuardianReason::kUndecodable), 20u);
  EXPECT_FALSE(without.cluster.agree(1, 1));
}

TEST(GuardianFaults, ANodeWithAWrongScheduleKeepsToTheRightOne) {
  schedules::model::Cluster wrong = star_cluster(5, 3, 4);
  for (const int slot : {2, 3, 30})
    wrong.frames.push_back({slot, schedules::model::Channels::kAB, 0, 2, kFaulty, kNoPdu, 0, 0});
  std::stable_sort(wrong.frames.begin(), wrong.frames.end(),
                   [](const auto& a, const auto& b) { return a.slot < b.slot; });
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    Running with(true, seed, &wrong), without(false, seed, &wrong);
    with.cluster.run_cycles(40);
    without.cluster.run_cycles(40);
    with.expect_no_harm("wrong schedule, seed " + std::to_string(seed));
    EXPECT_EQ(with.cluster.kind(0), PocKind::kNormalActive);
    EXPECT_GT(with.cluster.blocked(GuardianReason::kNotItsSlot), 100u);
    EXPECT_GT(without.cluster.problems(1), 100u);
  }
}

TEST(GuardianFaults, AFrameWithoutAnEndIsCut) {
  Running with(true, 1), without(false, 1);
  for (Running* run : {&with, &without}) {
    Doing endless;
    endless.to_leaving = [](medium::Leaving& signal) { return signal.end = signal.end + Duration{900'000}, true; };
    run->suffer(endless, 40);
  }
  with.expect_no_harm("endless frames");
  EXPECT_GE(with.cluster.coupler(Channel::kA).cut(), 40u);
  EXPECT_GT(without.cluster.problems(1), 100u);
}

TEST(GuardianFaults, AClockThatRunsAwayTakesNobodyAlong) {
  for (const std::int64_t ppb : {-20'000'000, -4'000'000, 4'000'000, 20'000'000})
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      Running run(true, seed);
      run.simulation().change_drift(kFaulty, ppb);
      run.cluster.run_cycles(80);
      run.expect_no_harm(std::to_string(ppb) + " ppb, seed " + std::to_string(seed));
    }
}

// A sync node's worst attack on clocks through couplers. The time differs on either channel, as far as it can
// pass, and is inverted in every other cycle.
TEST(GuardianFaults, AByzantineClockMovesNobodyBeyondThePrecision) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Running run(true, seed);
    std::int64_t sent = 0;
    Doing lie;
    lie.to_leaving = [&](medium::Leaving& signal) {
      const std::int64_t side = (sent++ / 2 + static_cast<std::int64_t>(index_of(signal.channel))) % 2 == 0 ? 1 : -1;
      signal.start = signal.start + Duration{side * 2'500};
      signal.end = signal.end + Duration{side * 2'500};
      return true;
    };
    run.simulation().set_disturbance(&lie);
    for (int step = 0; step < 200; ++step) {
      run.cluster.run(Duration{711'000});
      EXPECT_LE(run.simulation().precision(NodeId{1}), kAssumedPrecision) << "seed " << seed;
    }
    run.simulation().set_disturbance(nullptr);
    run.expect_no_harm("Byzantine, seed " + std::to_string(seed));
  }
}

// ---- a guardian's own faults

TEST(GuardianFaults, ASilentGuardianCostsItsChannelOnly) {
  for (const Channel channel : kBothChannels)
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      Running run(true, seed);
      run.cluster.coupler(channel).fail(medium::StarCoupler::Failure::kSilent);
      run.cluster.run_cycles(60);
      EXPECT_TRUE(run.cluster.all_active() && run.cluster.none_left_active()) << "seed " << seed;
      for (const auto& log : run.cluster.logs)
        for (const auto& [cycle, slot, wrong] : log->refused) EXPECT_EQ(wrong, channel) << "slot " << slot;
      EXPECT_LE(run.simulation().precision(), kAssumedPrecision);
    }
}

TEST(GuardianFaults, AClusterStartsWithOneGuardianSilentOrOpen) {
  for (const auto failure : {medium::StarCoupler::Failure::kSilent, medium::StarCoupler::Failure::kStuckOpen})
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
      Guarded started(star_cluster(5, 3, 5), seed, Duration::milliseconds(100));
      started.coupler(Channel::kA).fail(failure);
      started.run_cycles(50);
      EXPECT_TRUE(started.all_active()) << "seed " << seed;
      EXPECT_LE(started.simulation->precision(), kAssumedPrecision) << "seed " << seed;
    }
}

// Noise without a sender on one channel, then on both, for longer than the nodes stay active. Afterwards
// everything is as before, or starts again with the guardians.
TEST(GuardianFaults, AGuardianOutlivesNoise) {
  struct Noise final : medium::Disturbance {
    Plant& plant;
    std::vector<Channel> channels;
    TrueTime from{};
    Noise(Plant& p, std::vector<Channel> on) : plant(p), channels(std::move(on)), from(p.now()) {}
    TrueTime next() const override { return from; }
    void act(TrueTime now) override {
      for (const Channel channel : channels)
        plant.emit({kNoNode, channel, Signal::kUndecodable, now, now + Duration{7'000}, {}}, std::nullopt);
      from = now + Duration{10'000};
    }
  };
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    Running run(true, seed);
    Noise on_a(run.simulation(), {Channel::kA});
    run.suffer(on_a, 60);
    EXPECT_TRUE(run.cluster.all_active() && run.cluster.none_left_active()) << "seed " << seed;
    run.cluster.run_cycles(40);
    run.cluster.forget();
    run.cluster.run_cycles(10);
    EXPECT_EQ(run.cluster.problems(), 0u) << "seed " << seed;

    Noise everywhere(run.simulation(), {Channel::kA, Channel::kB});
    run.suffer(everywhere, 30);
    EXPECT_NE(run.cluster.kind(4), PocKind::kNormalActive);
    for (std::size_t n = 0; n < 5; ++n)  // the hosts
      run.simulation().power_on(static_cast<NodeId>(n), run.simulation().now() + Duration{1});
    run.cluster.run_cycles(40);
    EXPECT_TRUE(run.cluster.all_active()) << "seed " << seed;
  }
}

// Each intervention is reported with its node and reason.
TEST(GuardianFaults, EveryInterventionIsReported) {
  Running run(true, 3);
  std::vector<medium::StarCoupler::Intervention> reported;
  run.cluster.coupler(Channel::kB).on_intervention([&](const medium::StarCoupler::Intervention& one) {
    reported.push_back(one);
  });
  const std::uint64_t before = run.cluster.coupler(Channel::kB).blocked();
  StartSpoiler babble(run.simulation(), run.cluster.cluster, StartSpoiler::Plan::kBabble, 3);
  run.suffer(babble, 3);
  EXPECT_EQ(reported.size(),
            run.cluster.coupler(Channel::kB).blocked() - before + run.cluster.coupler(Channel::kB).cut());
  EXPECT_GT(reported.size(), 100u);
  TrueTime last{};
  for (const auto& one : reported) {
    EXPECT_EQ(one.branch, kFaulty);
    EXPECT_EQ(one.channel, Channel::kB);
    EXPECT_GE(one.at, last);
    last = one.at;
  }
}

}  // namespace
}  // namespace ttf::sim::engine
