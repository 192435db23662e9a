// Faults of a node's frames, and the check of each receiver that sees them. Integrated clusters of four: node
// n sends in slot n + 1, on both channels, in every cycle.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/sim/faults/fault_bus.h"

namespace ttf::sim::faults {
namespace {

using bus::poc::PocKind;
using schedules::model::Channel;
using schedules::model::Channels;
using ttf::faults::FaultKind;

// Expects reports of this slot only.
void expect_only_slot(const FaultBus& bus, int slot) {
  for (int n = 0; n < 4; ++n)
    for (const Said::Problem& problem : bus.said(n).problems) EXPECT_EQ(problem.slot, slot) << "at node " << n;
}

TEST(FrameFaults, WithoutAFaultNobodyHasAnythingToSay) {
  FaultBus bus{FaultBusConfig{}};
  bus.run(150);
  for (int n = 0; n < 4; ++n) {
    EXPECT_TRUE(bus.said(n).problems.empty());
    EXPECT_EQ(bus.state(n), PocKind::kNormalActive);
  }
  EXPECT_TRUE(bus.activities().empty());
}

// The log's and the run table's words for a fault's first act.
TEST(FrameFaults, SayInWordsWhatTheyDo) {
  const auto first_act = [](const ttf::faults::Fault& fault) {
    const FaultBus bus(fault, 15);
    for (const FaultBus::Activity& activity : bus.activities())
      if (activity.what == recording::records::FaultAct::kActs) return activity.text;
    return std::string("nothing");
  };
  ttf::faults::Fault flips = fault_of(FaultKind::kBitFlipPayload, 1);
  EXPECT_EQ(first_act(flips), "1 bit of a frame of node1 on A is inverted");
  flips.flips = 2;
  EXPECT_EQ(first_act(flips), "2 bits of a frame of node1 on A are inverted");
  ttf::faults::Fault timing = fault_of(FaultKind::kSosTiming, 1);
  timing.shift = Duration{2000};
  EXPECT_EQ(first_act(timing), "a frame of node1 on A is 2000 ns late");
  timing.shift = Duration{-2000};
  EXPECT_EQ(first_act(timing), "a frame of node1 on A is 2000 ns early");
  ttf::faults::Fault drift = fault_of(FaultKind::kDrift, 1);
  for (const auto& [ppb, words] :
       {std::pair{300'000, "300"}, std::pair{-1'500'250, "-1500.25"}, std::pair{123'457, "123.457"}}) {
    drift.drift_ppb = ppb;
    EXPECT_EQ(first_act(drift), fmt::format("node1 drifts by {} ppm from now on", words));
  }
}

TEST(FrameFaults, OmissionLeavesASlotEmptyForAllReceivers) {
  ttf::faults::Fault fault = fault_of(FaultKind::kOmission, 1, 10, 10);
  fault.channels = Channels::kA;
  const FaultBus bus(fault, 30);
  EXPECT_EQ(bus.acts(), 10U);
  expect_only_slot(bus, 2);
  for (const int n : {0, 2, 3}) {
    EXPECT_EQ(bus.said(n).count(2, bus::controller::kNoFrame), 10) << n;
    EXPECT_EQ(bus.said(n).problems.front().cycle, 10);
    EXPECT_EQ(bus.said(n).problems.front().channel, Channel::kA);
  }
  EXPECT_TRUE(bus.said(1).problems.empty());
}

TEST(FrameFaults, OmissionOfEveryThirdFrameTakesBothChannelsAlike) {
  ttf::faults::Fault fault = fault_of(FaultKind::kOmission, 1, 10, 9);
  fault.every = 3;
  const FaultBus bus(fault, 30);
  EXPECT_EQ(bus.acts(), 6U);
  EXPECT_EQ(bus.said(0).count(2, bus::controller::kNoFrame), 6);
  for (const Said::Problem& problem : bus.said(0).problems) EXPECT_EQ((problem.cycle - 10) % 3, 0);
}

TEST(FrameFaults, ReceiveOmissionIsOneReceiversOnly) {
  ttf::faults::Fault fault = fault_of(FaultKind::kOmission, 3, 10, 5);
  fault.direction = ttf::faults::FaultDirection::kReceive;
  const FaultBus bus(fault, 30);
  EXPECT_EQ(bus.acts(), 3U * 2 * 5);
  for (const int n : {0, 1, 2}) EXPECT_TRUE(bus.said(n).problems.empty()) << n;
  for (const int slot : {1, 2, 3}) EXPECT_EQ(bus.said(3).count(slot, bus::controller::kNoFrame), 2 * 5);
}

TEST(FrameFaults, OmissionByDrawsKeepsItsShare) {
  ttf::faults::Fault fault = fault_of(FaultKind::kOmission, 1, 0, 400);
  fault.probability = 0.3;
  const FaultBus bus(fault, 400);
  // 400 frames, 0.3 +- 4 sigma of 0.023.
  EXPECT_NEAR(static_cast<double>(bus.acts()) / 2.0 / 400.0, 0.3, 0.092);
  EXPECT_EQ(bus.said(0).count(2, bus::controller::kNoFrame), static_cast<int>(bus.acts()));
}

TEST(FrameFaults, BitFlipsAnywhereAreSyntaxErrorsAtEveryReceiver) {
  for (const FaultKind kind : {FaultKind::kBitFlipHeader, FaultKind::kBitFlipPayload, FaultKind::kBitFlipTrailer})
    for (const int flips : {1, 2, 5}) {
      ttf::faults::Fault fault = fault_of(kind, 2, 10, 10);
      fault.flips = flips;
      const FaultBus bus(fault, 30);
      EXPECT_EQ(bus.acts(), 20U);
      expect_only_slot(bus, 3);
      for (const int n : {0, 1, 3}) EXPECT_EQ(bus.said(n).count(3, bus::controller::kSyntaxError), 20) << n;
    }
}

TEST(FrameFaults, BitFlipsTowardsOneReceiverAreSeenThereOnly) {
  ttf::faults::Fault fault = fault_of(FaultKind::kBitFlipPayload, 2, 10, 10);
  fault.bits = {5};
  fault.receivers = {NodeId{1}};
  const FaultBus bus(fault, 30);
  EXPECT_EQ(bus.said(1).count(3, bus::controller::kSyntaxError), 20);
  EXPECT_TRUE(bus.said(0).problems.empty() && bus.said(3).problems.empty());
}

TEST(FrameFaults, SwappedChannelsFailTheFrameCrc) {
  const FaultBus bus(fault_of(FaultKind::kChannelSwap, 2, 10, 10), 30);
  EXPECT_EQ(bus.acts(), 20U);
  expect_only_slot(bus, 3);
  for (const int n : {0, 1, 3}) EXPECT_EQ(bus.said(n).count(3, bus::controller::kSyntaxError), 20) << n;
}

TEST(FrameFaults, AnothersFrameIdInItsOwnSlotIsAContentError) {
  ttf::faults::Fault fault = fault_of(FaultKind::kMasquerading, 2, 10, 10);
  fault.masquerade = ttf::faults::MasqueradeMode::kOwnSlot;
  fault.slot = 1;
  const FaultBus bus(fault, 30);
  EXPECT_EQ(bus.acts(), 20U);
  expect_only_slot(bus, 3);
  for (const int n : {0, 1, 3}) {
    EXPECT_EQ(bus.said(n).count(3, bus::controller::kContentError), 20) << n;
    EXPECT_EQ(bus.said(n).count(3, bus::controller::kSyntaxError), 0) << n;
  }
}

TEST(FrameFaults, MasqueradingInASlotInUseIsACollision) {
  ttf::faults::Fault fault = fault_of(FaultKind::kMasquerading, 2, 10, 10);
  fault.slot = 1;
  const FaultBus bus(fault, 30);
  // The key slot of the tenth cycle is the first: slot 1 comes in the eleventh, and the last is cut by the
  // end.
  EXPECT_EQ(bus.acts(), 18U);
  for (const int n : {1, 3}) EXPECT_EQ(bus.said(n).count(1, bus::controller::kSyntaxError), 18) << n;
  EXPECT_EQ(bus.said(0).count(1, bus::controller::kTransmissionConflict), 18);
}

TEST(FrameFaults, MasqueradingAsACrashedNodeIsNotSeen) {
  ttf::faults::Fault masquerade = fault_of(FaultKind::kMasquerading, 2, 20, 20);
  masquerade.slot = 4;
  FaultBusConfig config;
  config.faults = {fault_of(FaultKind::kCrash, 3, 10), masquerade};
  FaultBus bus(std::move(config));
  bus.run(5 * 50);
  for (const int n : {0, 1}) {
    EXPECT_EQ(bus.said(n).count(4, bus::controller::kNoFrame), 2 * (10 + 10)) << n;  // cycles 10 to 19, and 40 to 49
    EXPECT_EQ(bus.said(n).count(4, anything_but(bus::controller::kNoFrame)), 0) << n;
    EXPECT_EQ(bus.state(n), PocKind::kNormalActive);
  }
}

TEST(FrameFaults, MasqueradingInAFreeSlotIsAValidFrameThatIsUnexpected) {
  ttf::faults::Fault fault = fault_of(FaultKind::kMasquerading, 2, 10, 10);
  fault.slot = 40;
  const FaultBus bus(fault, 30);
  EXPECT_EQ(bus.acts(), 20U);
  expect_only_slot(bus, 40);
  for (const int n : {0, 1, 3}) {
    EXPECT_EQ(bus.said(n).count(40, bus::controller::kUnexpectedFrame), 20) << n;
    EXPECT_EQ(bus.said(n).count(40, anything_but(bus::controller::kUnexpectedFrame)), 0) << n;
  }
}

TEST(FrameFaults, SosTimingDividesTheReceivers) {
  // A frame of 26.3 us leaves 7 us into a slot of 43 us. It takes up to 2.5 us to the far end of the bus.
  ttf::faults::Fault fault = fault_of(FaultKind::kSosTiming, 0, 10, 10);
  fault.shift = Duration{8'900};
  const FaultBus bus(fault, 30);
  EXPECT_EQ(bus.acts(), 20U);
  EXPECT_EQ(bus.said(1).count(1, kAnything), 0) << "the near one is content";
  EXPECT_GT(bus.said(3).count(1, bus::controller::kBoundaryViolation), 0) << "the far one is not";
}

TEST(FrameFaults, SosTimingTowardsOneReceiver) {
  ttf::faults::Fault fault = fault_of(FaultKind::kSosTiming, 0, 10, 10);
  fault.shift = Duration::microseconds(-9);
  fault.receivers = {NodeId{1}};
  const FaultBus bus(fault, 30);
  EXPECT_TRUE(bus.said(2).problems.empty() && bus.said(3).problems.empty());
  // Begun before its slot, in the network idle time, where silence is required. Its slot is not silent, but
  // has no frame.
  EXPECT_EQ(bus.said(1).count(0, bus::controller::kBoundaryViolation), 20);
  EXPECT_EQ(bus.said(1).count(1, bus::controller::kBoundaryViolation), 20);
  EXPECT_EQ(bus.said(1).count(1, anything_but(bus::controller::kBoundaryViolation)), 0);
}

TEST(FrameFaults, SosValueIsLostAtTheNamedReceivers) {
  ttf::faults::Fault fault = fault_of(FaultKind::kSosValue, 0, 10, 10);
  fault.receivers = {NodeId{1}, NodeId{3}};
  const FaultBus bus(fault, 30);
  for (const int n : {1, 3}) EXPECT_EQ(bus.said(n).count(1, bus::controller::kSyntaxError), 20) << n;
  EXPECT_TRUE(bus.said(2).problems.empty());
}

TEST(FrameFaults, SosValueDrawnDividesTheReceiversFrameByFrame) {
  const FaultBus bus(fault_of(FaultKind::kSosValue, 0, 10, 100), 120);
  int disagreed = 0;
  std::vector<int> at_1(120, 0), at_2(120, 0);
  for (const Said::Problem& problem : bus.said(1).problems) at_1[static_cast<std::size_t>(problem.cycle)] += 1;
  for (const Said::Problem& problem : bus.said(2).problems) at_2[static_cast<std::size_t>(problem.cycle)] += 1;
  for (std::size_t cycle = 0; cycle < 120; ++cycle) disagreed += at_1[cycle] != at_2[cycle] ? 1 : 0;
  EXPECT_GT(disagreed, 30);
  // 200 signals, one half +- 4 sigma of 7.
  for (const int n : {1, 2, 3}) EXPECT_NEAR(bus.said(n).count(1, bus::controller::kSyntaxError), 100, 28) << n;
}

}  // namespace
}  // namespace ttf::sim::faults
