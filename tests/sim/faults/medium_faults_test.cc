// Signals without a sender on the channels, and faults that destroy the channels' signals.
#include <gtest/gtest.h>

#include "tests/sim/faults/fault_bus.h"

namespace ttf::sim::faults {
namespace {

using bus::poc::PocKind;
using schedules::model::Channel;
using schedules::model::Channels;
using ttf::faults::FaultKind;

TEST(MediumFaults, AContinuousBabblingIdiotSilencesOneChannelAndNotTheOther) {
  ttf::faults::Fault fault = fault_of(FaultKind::kBabblingIdiot, 3, 10, 5);
  fault.channels = Channels::kA;
  fault.interval = Duration{};
  FaultBus bus(with({fault}));
  bus.run(5 * 30);
  for (const int n : {0, 1, 2}) {
    for (int slot = 1; slot <= 3; ++slot) {
      if (slot == n + 1) continue;
      EXPECT_GE(bus.said(n).count(slot, bus::controller::kSyntaxError | bus::controller::kBoundaryViolation), 5)
          << n << " slot " << slot;
      EXPECT_EQ(bus.said(n).count(slot, bus::controller::kNoFrame), 0)
          << n << " slot " << slot << " is anything but silent";
    }
    EXPECT_GE(bus.said(n).count(n + 1, bus::controller::kTransmissionConflict), 5) << "its own slot";
    EXPECT_GT(bus.said(n).count(0, bus::controller::kBoundaryViolation), 0) << "outside every slot";
    for (const Said::Problem& problem : bus.said(n).problems) EXPECT_EQ(problem.channel, Channel::kA);
    EXPECT_EQ(bus.state(n), PocKind::kNormalActive) << "there is a second channel";
  }
}

TEST(MediumFaults, ABabblingIdiotOnBothChannelsTakesTheClusterDown) {
  ttf::faults::Fault fault = fault_of(FaultKind::kBabblingIdiot, 3, 10);
  fault.interval = Duration{};
  FaultBusConfig config = with({fault});
  config.cluster = engine::bus_cluster(5, 2, 2);
  FaultBus bus(std::move(config));
  bus.run(5 * 40);
  for (const int n : {2, 4}) EXPECT_EQ(bus.state(n), PocKind::kHalt) << n;
  // A sync node alone misses no term of clock correction: its own frame is one.
  for (const int n : {0, 1}) EXPECT_EQ(bus.state(n), PocKind::kNormalActive) << n;
}

TEST(MediumFaults, FramesAtIntervalsAreContentErrorsOrCollisions) {
  ttf::faults::Fault fault = fault_of(FaultKind::kBabblingIdiot, 3, 10, 20);
  fault.signal = ttf::faults::FaultSignal::kFrame;
  fault.interval = Duration{630'000};  // 15 slots of 43 us less 15 us: every time elsewhere
  FaultBus bus(with({fault}));
  bus.run(5 * 40);
  EXPECT_EQ(bus.acts(), 2U * (20 * 5'000 / 630 + 1));
  int content = 0;
  for (const int slot : {20, 25, 30, 35, 40, 45, 50, 55, 60})
    content += bus.said(0).count(slot, bus::controller::kContentError);
  EXPECT_GT(content, 0) << "a frame with another slot's id";
  EXPECT_GT(bus.said(0).count(0, bus::controller::kBoundaryViolation), 0);
}

TEST(MediumFaults, NoiseIsSeenInSlotsThatAreNobodys) {
  ttf::faults::Fault fault = fault_of(FaultKind::kNoise, -1, 10, 20);
  fault.channels = Channels::kB;
  fault.interval = Duration{700'000};
  fault.jitter = Duration{300'000};
  FaultBus bus(with({fault}));
  bus.run(5 * 40);
  EXPECT_EQ(bus.activities()[0].node, kNoNode);
  for (int n = 0; n < 4; ++n) {
    EXPECT_FALSE(bus.said(n).problems.empty()) << n;
    for (const Said::Problem& problem : bus.said(n).problems) {
      EXPECT_EQ(problem.channel, Channel::kB);
      if (problem.slot == 0 || problem.slot > 4) {
        EXPECT_TRUE(has(problem.status, bus::controller::kSyntaxError | bus::controller::kBoundaryViolation));
      }
    }
  }
  // 100 ms at 850 us on average.
  EXPECT_NEAR(static_cast<double>(bus.acts()), 118.0, 12.0);
}

TEST(MediumFaults, NoiseDuringStartUpIsWaitedOutByTheNoiseTimer) {
  ttf::faults::Fault fault = fault_of(FaultKind::kNoise, -1, 0, 10);
  fault.interval = Duration::milliseconds(4);  // less than the listen timeout of two cycles
  FaultBusConfig config = with({fault});
  config.cold = true;
  FaultBus bus(std::move(config));
  bus.run(80);
  const bool noisy = bus.simulation().controller(NodeId{0}).state().coldstart_noise ||
                     bus.simulation().controller(NodeId{1}).state().coldstart_noise;
  EXPECT_TRUE(noisy);
  bus.run(300);
  for (int n = 0; n < 4; ++n) EXPECT_EQ(bus.state(n), PocKind::kNormalActive) << n;
}

TEST(MediumFaults, ATransientDestroysEverythingWhileItLastsAndNoLonger) {
  FaultBus bus(with({fault_of(FaultKind::kTransient, -1, 10, 1)}));
  bus.run(5 * 30);
  EXPECT_EQ(bus.acts(), 2U * 4);
  for (int n = 0; n < 4; ++n) {
    for (int slot = 1; slot <= 4; ++slot)
      EXPECT_EQ(bus.said(n).count(slot, bus::controller::kSyntaxError), slot == n + 1 ? 0 : 2);
    EXPECT_EQ(bus.state(n), PocKind::kNormalActive) << n;
  }
}

TEST(MediumFaults, ALongTransientTakesThoseWithoutASyncFrameToPassiveThenHalt) {
  // gMaxWithoutClockCorrectionPassive 2, -Fatal 4 double cycles.
  FaultBusConfig config = with({fault_of(FaultKind::kTransient, -1, 10, 20)});
  config.cluster = engine::bus_cluster(4, 2, 2);
  FaultBus bus(std::move(config));
  bus.run(5 * 16 + 1);
  for (const int n : {2, 3}) EXPECT_EQ(bus.state(n), PocKind::kNormalPassive) << n;
  bus.run(5 * 20 + 1);
  for (const int n : {2, 3}) EXPECT_EQ(bus.state(n), PocKind::kHalt) << n;
  bus.run(5 * 60);
  for (const int n : {0, 1}) EXPECT_EQ(bus.state(n), PocKind::kNormalActive) << n;
}

TEST(MediumFaults, ATransientIsOfItsChannels) {
  ttf::faults::Fault fault = fault_of(FaultKind::kTransient, -1, 10, 20);
  fault.channels = Channels::kA;
  FaultBus bus(with({fault}));
  bus.run(5 * 40);
  for (int n = 0; n < 4; ++n) {
    EXPECT_EQ(bus.state(n), PocKind::kNormalActive) << n;
    for (const Said::Problem& problem : bus.said(n).problems) EXPECT_EQ(problem.channel, Channel::kA);
  }
}

// Ten times as long as the fault, which begins and ends a macrotick before a cycle does.
TEST(MediumFaults, NoiseEndsWithItsFault) {
  for (const FaultKind kind : {FaultKind::kNoise, FaultKind::kBabblingIdiot}) {
    ttf::faults::Fault fault = fault_of(kind, 3, 10, 1);
    fault.length = fault.interval = Duration{10 * kCycleNs};
    fault.channels = Channels::kA;
    FaultBus bus(with({fault}));
    bus.run(5 * 30);
    EXPECT_EQ(bus.acts(), 1U);
    EXPECT_EQ(bus.said(0).count(2, bus::controller::kBoundaryViolation), 1) << ttf::faults::name_of(kind);
    EXPECT_EQ(bus.said(0).count(2, bus::controller::kNoFrame), 0) << ttf::faults::name_of(kind);
    for (const Said::Problem& problem : bus.said(0).problems)
      EXPECT_LE(problem.cycle, 10) << ttf::faults::name_of(kind);
    EXPECT_EQ(bus.simulation().medium().carrier(NodeId{0}, Channel::kA, bus.simulation().now()), false);
  }
}

// It can send no additional signals either, and time still goes on.
TEST(MediumFaults, ANodeWithoutSupplySendsNothing) {
  std::vector<ttf::faults::Fault> senders(5);
  for (ttf::faults::Fault& fault : senders) fault = fault_of(FaultKind::kBabblingIdiot, 1, 15, 5);
  senders[0].interval = Duration{};
  senders[1].signal = ttf::faults::FaultSignal::kFrame;
  senders[1].interval = Duration{};
  senders[2].kind = senders[3].kind = FaultKind::kDuplicateColdstart;
  senders[3].duplicate = ttf::faults::DuplicateMode::kStartupFrames;
  // From the middle of cycle 14 on: after its own frame, it crashes before the other's slot.
  ttf::faults::Fault& masquerade = senders[4];
  masquerade = fault_of(FaultKind::kMasquerading, 1, 14, 6);
  masquerade.slot = 40;
  ttf::faults::Fault crash = fault_of(FaultKind::kCrash, 1, 14);
  crash.from += Duration{20 * 43'000};
  for (std::size_t f = 0; f < senders.size(); ++f) {
    SCOPED_TRACE(f);
    FaultBus alone(with({senders[f]})), off(with({crash, senders[f]})), crashed(with({crash}));
    for (FaultBus* bus : {&alone, &off, &crashed}) bus->run(5 * 30);
    EXPECT_GT(alone.acts(), 0U);
    EXPECT_EQ(off.acts(1), 0U);
    for (const FaultBus::Activity& activity : off.activities())
      EXPECT_FALSE(activity.fault == 1 && activity.what == recording::records::FaultAct::kActs) << activity.text;
    for (const int n : {0, 2, 3}) EXPECT_EQ(off.said(n).all, crashed.said(n).all);
  }
}

}  // namespace
}  // namespace ttf::sim::faults
