// The rules of error confinement, one after the other (Bosch CAN Specification 2.0, part B, chapter 8).
#include "bus/can/confinement.h"

#include <gtest/gtest.h>

#include "core/random.h"

namespace ttf::bus::can {
namespace {

using E = ConfinementEvent;
using S = CanState;

Confinement with(int transmit_errors, int receive_errors) {
  const bool passive = transmit_errors >= 128 || receive_errors >= 128;
  return {transmit_errors >= 256 ? S::kBusOff : passive ? S::kPassive : S::kActive, transmit_errors, receive_errors, 0};
}
Confinement after(Confinement at, E event, int times = 1) {
  for (int i = 0; i < times; ++i) at = step(at, event);
  return at;
}

TEST(Confinement, Rules1To6CountErrors) {
  EXPECT_EQ(step(with(0, 0), E::kReceiverError), with(0, 1));
  EXPECT_EQ(step(with(0, 0), E::kReceiverOutlasted), with(0, 8));
  EXPECT_EQ(step(with(0, 0), E::kTransmitterError), with(8, 0));
  EXPECT_EQ(step(with(0, 0), E::kTransmitterFlagError), with(8, 0));
  EXPECT_EQ(step(with(0, 0), E::kReceiverFlagError), with(0, 8));
  EXPECT_EQ(step(with(0, 0), E::kTransmitterDominant), with(8, 0));
  EXPECT_EQ(step(with(0, 0), E::kReceiverDominant), with(0, 8));
}

TEST(Confinement, Rule3ExceptsALonePassiveTransmitterAndOverwrittenStuffBits) {
  EXPECT_EQ(step(with(120, 0), E::kLoneTransmitter), with(128, 0));  // error active yet
  EXPECT_EQ(after(with(128, 0), E::kLoneTransmitter, 1000), with(128, 0));
  for (const int errors : {0, 8, 128, 255}) EXPECT_EQ(step(with(errors, 3), E::kStuffBitOverwritten), with(errors, 3));
}

TEST(Confinement, Rule7ForgivesOneErrorAFrameSent) {
  EXPECT_EQ(step(with(8, 5), E::kSent), with(7, 5));
  EXPECT_EQ(step(with(0, 5), E::kSent), with(0, 5));
  EXPECT_EQ(step(with(128, 5), E::kSent), with(127, 5));
}

TEST(Confinement, Rule8ForgivesOneErrorAFrameReceivedAndAllAbove127) {
  EXPECT_EQ(step(with(5, 1), E::kReceived), with(5, 0));
  EXPECT_EQ(step(with(5, 0), E::kReceived), with(5, 0));
  EXPECT_EQ(step(with(5, 127), E::kReceived), with(5, 126));
  for (const int errors : {128, 129, 255}) {
    const Confinement next = step(with(5, errors), E::kReceived);
    EXPECT_GE(next.receive_errors, 119);
    EXPECT_LE(next.receive_errors, 127);
    EXPECT_EQ(next.state, S::kActive);
  }
}

TEST(Confinement, Rules9To11JudgeByBothCounters) {
  EXPECT_EQ(after(with(0, 0), E::kTransmitterError, 15).state, S::kActive);   // 120
  EXPECT_EQ(after(with(0, 0), E::kTransmitterError, 16).state, S::kPassive);  // 128
  EXPECT_EQ(after(with(0, 0), E::kTransmitterError, 31).state, S::kPassive);  // 248
  EXPECT_EQ(after(with(0, 0), E::kTransmitterError, 32).state, S::kBusOff);   // 256
  EXPECT_EQ(after(with(0, 0), E::kReceiverError, 127).state, S::kActive);
  EXPECT_EQ(after(with(0, 0), E::kReceiverError, 128).state, S::kPassive);
  EXPECT_EQ(after(with(0, 0), E::kReceiverDominant, 1000), with(0, 255));  // reception alone never ends in bus off
  EXPECT_EQ(step(with(128, 128), E::kSent).state, S::kPassive);            // the other counter is still above
  EXPECT_EQ(step(step(with(128, 128), E::kSent), E::kReceived).state, S::kActive);
}

TEST(Confinement, Rule12RecoversAfter128TimesElevenRecessiveBits) {
  const Confinement off = with(256, 17);
  Confinement at = after(off, E::kElevenRecessive, 127);
  EXPECT_EQ(at.state, S::kBusOff);
  EXPECT_EQ(at.sequences, 127);
  // No other event counts while it is off.
  for (std::size_t e = 0; e < kConfinementEvents; ++e) {
    if (static_cast<E>(e) == E::kElevenRecessive) continue;
    EXPECT_EQ(step(at, static_cast<E>(e)), at) << e;
  }
  EXPECT_EQ(step(at, E::kElevenRecessive), Confinement{});
  EXPECT_EQ(after(with(8, 8), E::kElevenRecessive, 500), with(8, 8));  // on the bus they do not count
}

TEST(Confinement, AHostMayTakeAControllerOffTheBus) {
  EXPECT_EQ(bus_off(with(3, 4)), (Confinement{S::kBusOff, 256, 4, 0}));
  EXPECT_EQ(after(bus_off(with(3, 4)), E::kElevenRecessive, 128), Confinement{});
}

// The state always follows from the counters, and these keep their ranges.
TEST(Confinement, DrawnEventsKeepTheInvariants) {
  RandomStream stream({12, 0, Purpose::kTest, 1, 0});
  Confinement at;
  int offs = 0;
  for (int i = 0; i < 200'000; ++i) {
    const Confinement before = at;
    at = step(at, static_cast<E>(stream.integer(0, static_cast<std::int64_t>(kConfinementEvents) - 1)));
    const bool off = at.transmit_errors >= kBusOffFrom;
    ASSERT_EQ(at.state == S::kBusOff, off);
    ASSERT_EQ(at.state == S::kPassive, !off && (at.transmit_errors >= 128 || at.receive_errors >= 128));
    ASSERT_GE(at.receive_errors, 0);
    ASSERT_LE(at.receive_errors, kMostReceiveErrors);
    ASSERT_GE(at.transmit_errors, 0);
    ASSERT_LT(at.transmit_errors, kBusOffFrom + 8);
    ASSERT_LT(at.sequences, kRecoverySequences);
    if (before.state != S::kBusOff && off) ++offs;
  }
  EXPECT_GT(offs, 10);
}

}  // namespace
}  // namespace ttf::bus::can
