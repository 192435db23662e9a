// The same faults in a star with a guardian: the harm stays with the faulty node.
#include <gtest/gtest.h>

#include "tests/sim/faults/fault_bus.h"

namespace ttf::sim::faults {
namespace {

using bus::poc::PocKind;
using ttf::faults::FaultKind;

FaultBusConfig star(ttf::faults::Fault fault) {
  FaultBusConfig config;
  config.cluster.topology = schedules::model::Topology::kStar;
  config.cluster.guardian = true;
  config.faults = {std::move(fault)};
  return config;
}

// Expects all others to report the same about a slot.
void expect_agreement(const FaultBus& bus, int slot) {
  for (const bus::controller::SlotStatus status : {bus::controller::kSyntaxError, bus::controller::kContentError,
                                                   bus::controller::kBoundaryViolation, bus::controller::kNoFrame}) {
    std::vector<int> counts;
    for (int n = 0; n < 4; ++n)
      if (n != slot - 1) counts.push_back(bus.said(n).count(slot, status));
    for (const int count : counts) EXPECT_EQ(count, counts[0]) << to_text(status);
  }
}

TEST(GuardianFaults, ABabblingIdiotIsKeptFromTheOthers) {
  ttf::faults::Fault fault = fault_of(FaultKind::kBabblingIdiot, 3, 10, 20);
  fault.interval = Duration{};
  FaultBus bus(star(fault));
  bus.run(5 * 50);
  EXPECT_GT(bus.acts(), 1'000U);
  for (const int n : {0, 1, 2}) {
    for (int slot = 1; slot <= 3; ++slot) EXPECT_EQ(bus.said(n).count(slot, kAnything), 0) << n << " slot " << slot;
    EXPECT_EQ(bus.state(n), PocKind::kNormalActive) << n;
  }
}

TEST(GuardianFaults, MasqueradingIsKeptFromTheOthers) {
  ttf::faults::Fault fault = fault_of(FaultKind::kMasquerading, 2, 10, 20);
  fault.slot = 40;
  FaultBus bus(star(fault));
  bus.run(5 * 50);
  EXPECT_EQ(bus.acts(), 2U * 20);
  for (int n = 0; n < 4; ++n) EXPECT_EQ(bus.said(n).count(40, kAnything), 0) << n;
}

TEST(GuardianFaults, AMisshapenFrameIsSoForAllOrForNone) {
  FaultBus bus(star(fault_of(FaultKind::kSosValue, 0, 10, 100)));
  bus.run(5 * 120);
  EXPECT_EQ(bus.acts(), 200U);
  expect_agreement(bus, 1);
  // Half of them, +- 4 sigma of 7: the coupler makes out the others.
  EXPECT_NEAR(bus.said(1).count(1, bus::controller::kSyntaxError | bus::controller::kNoFrame), 100, 28);
}

TEST(GuardianFaults, TheCouplerMakesOutFramesThatNamedReceiversWouldMistake) {
  ttf::faults::Fault fault = fault_of(FaultKind::kSosValue, 0, 10, 20);
  fault.receivers = {NodeId{2}};
  FaultBus bus(star(fault));
  bus.run(5 * 50);
  for (const int n : {1, 2, 3}) EXPECT_EQ(bus.said(n).count(1, kAnything), 0) << n;
}

TEST(GuardianFaults, BitsInvertedTowardsOneReceiverAreSoBehindTheCoupler) {
  ttf::faults::Fault fault = fault_of(FaultKind::kBitFlipPayload, 0, 10, 20);
  fault.receivers = {NodeId{2}};
  FaultBus bus(star(fault));
  bus.run(5 * 50);
  EXPECT_EQ(bus.said(2).count(1, bus::controller::kSyntaxError), 2 * 20);
  for (const int n : {1, 3}) EXPECT_EQ(bus.said(n).count(1, kAnything), 0) << n;
}

TEST(GuardianFaults, AByzantineClockSaysTheSameToAll) {
  ttf::faults::Fault fault = fault_of(FaultKind::kByzantineClock, 0, 10);
  fault.shift = Duration{4'000};
  fault.pattern = ttf::faults::ByzantinePattern::kPullRates;
  FaultBusConfig config = star(fault);
  config.cluster.nodes.pop_back();  // three sync nodes, of which one lies
  config.cluster.frames.pop_back();
  FaultBus bus(std::move(config));
  bus.run(5 * 20);
  Duration most{};
  for (int ms = 100; ms < 500; ++ms) {
    bus.run(ms);
    most = std::max(most, bus.simulation().precision(NodeId{1}));
  }
  EXPECT_GT(bus.acts(), 100U);
  EXPECT_LT(most.ns, 2'500) << "on a bus it is beyond 6.85 us";
  for (const int n : {1, 2}) EXPECT_EQ(bus.state(n), PocKind::kNormalActive) << n;
}

TEST(GuardianFaults, ATransientAtTheCouplerIsOneForAll) {
  FaultBus bus(star(fault_of(FaultKind::kTransient, -1, 10, 2)));
  bus.run(5 * 40);
  for (int slot = 1; slot <= 4; ++slot) {
    expect_agreement(bus, slot);
    EXPECT_EQ(bus.said(slot % 4).count(slot, bus::controller::kSyntaxError | bus::controller::kNoFrame), 2 * 2);
  }
  for (int n = 0; n < 4; ++n) EXPECT_EQ(bus.state(n), PocKind::kNormalActive) << n;
}

}  // namespace
}  // namespace ttf::sim::faults
