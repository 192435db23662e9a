// The laws of bus/ports/flexray_port.h as a suite for every medium:
//
//   class MyBench : public laws::FlexRayBench { ... };
//   INSTANTIATE_TYPED_TEST_SUITE_P(MyMedium, FlexRayPortLaws, MyBench);     // in namespace ttf::laws
//
// A bench is a medium with at least three controllers in a row, controller 1 as far from 0 as from 2. All
// clocks run at the nominal rate with tick 0 at the start of the run. Only the test transmits.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <tuple>
#include <vector>

#include "bus/ports/flexray_port.h"
#include "bus/wire/flexray_frame.h"

namespace ttf::laws {

using schedules::model::Channel;

struct Reached {
  std::size_t controller = 0;
  Channel channel{};
  bus::ports::Signal signal{};
  Microticks start{};
  Microticks end{};
  std::vector<std::byte> bytes;  // of a frame
};

class FlexRayBench {
 public:
  virtual ~FlexRayBench() = default;
  virtual const schedules::model::GlobalParameters& parameters() const = 0;
  virtual std::int64_t microtick_ps() const = 0;
  virtual std::size_t controllers() const = 0;
  virtual bus::ports::FlexRayPort& port(std::size_t controller) = 0;
  // Delivers all receptions due up to and including microtick `now`, which never decreases.
  virtual void run_until(Microticks now) = 0;
  // All receptions so far, in the order in which they were delivered.
  virtual const std::vector<Reached>& reached() const = 0;
};

template <class Bench> class FlexRayPortLaws : public testing::Test {
 protected:
  // A frame that identifies its sender and number.
  std::vector<std::byte> frame(std::size_t sender, int number, int words, Channel channel) const {
    std::vector<std::byte> payload(static_cast<std::size_t>(2 * words));
    for (std::size_t i = 0; i < payload.size(); ++i)
      payload[i] = static_cast<std::byte>(number * 31 + static_cast<int>(i));
    bus::wire::FrameHeader header;
    header.frame_id = static_cast<std::uint16_t>(number + 1);
    header.cycle = static_cast<std::uint8_t>(sender);
    std::vector<std::byte> bytes(bus::wire::kMaxFrameBytes);
    bytes.resize(bus::wire::encode_frame(header, channel, payload, bytes));
    return bytes;
  }
  void transmit(std::size_t sender, Channel channel, std::int64_t start, const std::vector<std::byte>& bytes) {
    const auto bits = bench_.parameters().gdTSSTransmitter + 3 + 10 * static_cast<std::int64_t>(bytes.size());
    const std::int64_t end = start + ticks(bits * bench_.parameters().gdBit_ps);
    bench_.port(sender).transmit({channel, bus::ports::Signal::kFrame, Microticks{start}, Microticks{end}, 1, bytes});
  }
  void transmit_cas(std::size_t sender, Channel channel, std::int64_t start, std::int64_t end) {
    bench_.port(sender).transmit({channel, bus::ports::Signal::kCas, Microticks{start}, Microticks{end}, 0, {}});
  }
  static std::size_t sender_of(const Reached& reached) {
    return bus::wire::decode_frame(reached.channel, reached.bytes).header.cycle;
  }
  std::int64_t ticks(std::int64_t ps) const { return (ps + bench_.microtick_ps() - 1) / bench_.microtick_ps(); }
  std::int64_t length(int words) const { return ticks(bus::wire::frame_duration_ps(bench_.parameters(), words)); }
  std::int64_t longest_delay() const { return ticks(bench_.parameters().gdMaxPropagationDelay_ps); }
  std::vector<Reached> at(std::size_t controller) const {
    std::vector<Reached> mine;
    for (const Reached& reached : bench_.reached())
      if (reached.controller == controller) mine.push_back(reached);
    return mine;
  }

  Bench bench_;
  static constexpr std::int64_t kFirst = 10'000;  // microticks
};

TYPED_TEST_SUITE_P(FlexRayPortLaws);

TYPED_TEST_P(FlexRayPortLaws, L1_EveryTransmissionReachesEveryOtherControllerOnceUnchanged) {
  const std::size_t controllers = this->bench_.controllers();
  std::map<std::pair<Channel, std::vector<std::byte>>, std::size_t> sent;
  std::int64_t start = this->kFirst;
  for (int number = 0; number < 60; ++number) {
    const std::size_t sender = static_cast<std::size_t>(number) % controllers;
    const int words = number * 2 % 128;
    for (const Channel channel : {Channel::kA, Channel::kB}) {
      if (number % 3 == (channel == Channel::kA ? 0 : 1)) continue;  // some on one channel only
      const auto bytes = this->frame(sender, number, words, channel);
      this->transmit(sender, channel, start, bytes);
      sent[{channel, bytes}] = sender;
    }
    start += this->length(words) + this->longest_delay() + 100;
    this->bench_.run_until(Microticks{start});
  }
  for (std::size_t controller = 0; controller < controllers; ++controller) {
    std::map<std::pair<Channel, std::vector<std::byte>>, int> times;
    for (const Reached& reached : this->at(controller)) ++times[{reached.channel, reached.bytes}];
    std::size_t expected = 0;
    for (const auto& [frame, sender] : sent) {
      if (sender == controller) continue;
      ++expected;
      EXPECT_EQ((times[{frame.first, frame.second}]), 1) << "controller " << controller << " sender " << sender;
    }
    EXPECT_EQ(this->at(controller).size(), expected);
  }
}

TYPED_TEST_P(FlexRayPortLaws, L2_AControllerDoesNotReceiveItself) {
  for (std::size_t sender = 0; sender < this->bench_.controllers(); ++sender) {
    const std::int64_t start = this->kFirst + static_cast<std::int64_t>(sender) * 20'000;
    for (const Channel channel : {Channel::kA, Channel::kB})
      this->transmit(sender, channel, start, this->frame(sender, 1, 8, channel));
    this->bench_.run_until(Microticks{start + 20'000});
  }
  EXPECT_FALSE(this->bench_.reached().empty());
  for (const Reached& reached : this->bench_.reached()) EXPECT_NE(this->sender_of(reached), reached.controller);
}

// The shorter frame ends first though it was handed over and begun later.
TYPED_TEST_P(FlexRayPortLaws, L3_ReceptionsComeInTheOrderOfTheirEnd) {
  this->transmit(0, Channel::kA, this->kFirst, this->frame(0, 1, 127, Channel::kA));
  this->transmit(0, Channel::kB, this->kFirst + 400, this->frame(0, 2, 4, Channel::kB));
  this->bench_.run_until(Microticks{this->kFirst + 100'000});
  for (std::size_t controller = 1; controller < this->bench_.controllers(); ++controller) {
    const auto mine = this->at(controller);
    ASSERT_EQ(mine.size(), 2u);
    EXPECT_EQ(mine[0].channel, Channel::kB);
    EXPECT_LT(mine[0].end, mine[1].end);
  }
}

// Handed over as B before A, and by controller 2 before controller 0: received as A before B.
TYPED_TEST_P(FlexRayPortLaws, L3_TiesGoByChannel) {
  this->transmit(2, Channel::kB, this->kFirst, this->frame(2, 3, 8, Channel::kB));
  this->transmit(0, Channel::kA, this->kFirst, this->frame(0, 3, 8, Channel::kA));
  this->bench_.run_until(Microticks{this->kFirst + 100'000});
  const auto mine = this->at(1);
  ASSERT_EQ(mine.size(), 2u);
  ASSERT_EQ(mine[0].end, mine[1].end) << "the bench is not symmetric";
  EXPECT_EQ(mine[0].channel, Channel::kA);
  EXPECT_EQ(mine[1].channel, Channel::kB);
}

TYPED_TEST_P(FlexRayPortLaws, L4_AFrameIsDeliveredAtItsEnd) {
  for (const int words : {0, 28, 127}) {
    const std::int64_t start = this->kFirst + words * 1'000;
    const std::size_t before = this->bench_.reached().size();
    this->transmit(0, Channel::kA, start, this->frame(0, words, words, Channel::kA));
    this->bench_.run_until(Microticks{start + this->length(words) - 1});
    EXPECT_EQ(this->bench_.reached().size(), before) << "delivered before it had left";
    this->bench_.run_until(Microticks{start + this->length(words) + this->longest_delay() + 1});
    EXPECT_EQ(this->bench_.reached().size(), before + this->bench_.controllers() - 1);
    for (std::size_t i = before; i < this->bench_.reached().size(); ++i) {
      const Reached& reached = this->bench_.reached()[i];
      // Both instants are rounded to a microtick of the receiver.
      EXPECT_NEAR(static_cast<double>((reached.end - reached.start).value), static_cast<double>(this->length(words)),
                  1.0);
      EXPECT_GE(reached.start.value, start - 1);
      EXPECT_LE(reached.start.value, start + this->longest_delay() + 1);
    }
  }
}

TYPED_TEST_P(FlexRayPortLaws, L5_TheMediumKeepsNoReferenceToTheBytes) {
  auto bytes = this->frame(0, 4, 20, Channel::kA);
  const auto original = bytes;
  this->transmit(0, Channel::kA, this->kFirst, bytes);
  std::fill(bytes.begin(), bytes.end(), std::byte{0xEE});
  this->bench_.run_until(Microticks{this->kFirst + 100'000});
  ASSERT_EQ(this->bench_.reached().size(), this->bench_.controllers() - 1);
  for (const Reached& reached : this->bench_.reached()) EXPECT_EQ(reached.bytes, original);
}

TYPED_TEST_P(FlexRayPortLaws, L6_SignalsThatOverlapArriveAsOneUndecodable) {
  const std::int64_t second = this->kFirst + this->length(8) / 2;
  this->transmit(0, Channel::kA, this->kFirst, this->frame(0, 1, 8, Channel::kA));
  this->transmit(2, Channel::kA, second, this->frame(2, 2, 8, Channel::kA));
  this->transmit(2, Channel::kB, second, this->frame(2, 3, 8, Channel::kB));  // the other channel is not concerned
  this->bench_.run_until(Microticks{this->kFirst + 100'000});
  const auto mine = this->at(1);
  ASSERT_EQ(mine.size(), 2u);
  EXPECT_EQ(mine[0].channel, Channel::kA);
  EXPECT_EQ(mine[0].signal, bus::ports::Signal::kUndecodable);
  EXPECT_EQ(mine[1].signal, bus::ports::Signal::kFrame);
  EXPECT_NEAR(static_cast<double>((mine[0].end - mine[0].start).value),
              static_cast<double>(second - this->kFirst + this->length(8)), 1.0);
  // The senders receive the other's signal only. Whether they can decode it is their controllers' business.
  EXPECT_EQ(this->at(0).size(), 2u);
  EXPECT_EQ(this->at(0)[0].signal, bus::ports::Signal::kFrame);
}

TYPED_TEST_P(FlexRayPortLaws, L6_ABridgeBetweenTwoSignalsMakesThemOne) {
  this->transmit_cas(0, Channel::kA, this->kFirst, this->kFirst + 400);
  this->transmit(0, Channel::kA, this->kFirst + 1000, this->frame(0, 1, 8, Channel::kA));
  this->transmit(2, Channel::kA, this->kFirst + 300, this->frame(2, 2, 8, Channel::kA));
  this->bench_.run_until(Microticks{this->kFirst + 100'000});
  ASSERT_EQ(this->at(1).size(), 1u);
  EXPECT_EQ(this->at(1)[0].signal, bus::ports::Signal::kUndecodable);
}

TYPED_TEST_P(FlexRayPortLaws, L6_OverlappingCollisionAvoidanceSymbolsRemainOne) {
  this->transmit_cas(0, Channel::kA, this->kFirst, this->kFirst + 160);
  this->transmit_cas(2, Channel::kA, this->kFirst + 40, this->kFirst + 200);
  this->bench_.run_until(Microticks{this->kFirst + 100'000});
  ASSERT_EQ(this->at(1).size(), 1u);
  EXPECT_EQ(this->at(1)[0].signal, bus::ports::Signal::kCas);
  EXPECT_NEAR(static_cast<double>((this->at(1)[0].end - this->at(1)[0].start).value), 200.0, 1.0);
}

// Two patterns of two symbols each, apart by anything up to twice their length. No shift of two makes them unreadable,
// and any noise does.
TYPED_TEST_P(FlexRayPortLaws, L6_OverlappingWakeupPatternsRemainOne) {
  const bus::ports::Signal kWakeup = bus::ports::Signal::kWakeup;
  const auto& g = this->bench_.parameters();
  const std::int64_t symbol = this->ticks((g.gdWakeupSymbolTxLow + g.gdWakeupSymbolTxIdle) * g.gdBit_ps);
  const std::int64_t pause = 4 * symbol + this->longest_delay();
  std::int64_t start = this->kFirst;
  std::vector<Reached> before;
  for (std::int64_t shift = 1; shift < 2 * symbol; shift += symbol / 37, start += 2 * pause) {
    const auto send = [&](std::size_t sender, bus::ports::Signal signal, std::int64_t from, std::int64_t to) {
      this->bench_.port(sender).transmit({Channel::kA, signal, Microticks{from}, Microticks{to}, 0, {}});
    };
    before = this->at(1);
    send(0, kWakeup, start, start + 2 * symbol);
    send(2, kWakeup, start + shift, start + shift + 2 * symbol);
    this->bench_.run_until(Microticks{start + pause});
    ASSERT_EQ(this->at(1).size(), before.size() + 1) << "shift " << shift;
    EXPECT_EQ(this->at(1).back().signal, kWakeup) << "shift " << shift;
    EXPECT_NEAR(static_cast<double>((this->at(1).back().end - this->at(1).back().start).value),
                static_cast<double>(shift + 2 * symbol), 1.0);
  }
  this->bench_.port(0).transmit({Channel::kA, kWakeup, Microticks{start}, Microticks{start + 2 * symbol}, 0, {}});
  this->transmit_cas(2, Channel::kA, start + 10, start + 20);
  this->bench_.run_until(Microticks{start + pause});
  EXPECT_EQ(this->at(1).back().signal, bus::ports::Signal::kUndecodable);
}

TYPED_TEST_P(FlexRayPortLaws, L7_TheCarrierIsSensedFromStartToDelivery) {
  this->transmit(0, Channel::kA, this->kFirst, this->frame(0, 1, 8, Channel::kA));
  EXPECT_FALSE(this->bench_.port(1).carrier(Channel::kA)) << "before anything has arrived";
  const std::int64_t middle = this->kFirst + this->longest_delay() + 10;
  this->bench_.run_until(Microticks{middle});
  EXPECT_TRUE(this->bench_.port(1).carrier(Channel::kA));
  EXPECT_FALSE(this->bench_.port(1).carrier(Channel::kB));
  EXPECT_FALSE(this->bench_.port(0).carrier(Channel::kA)) << "a controller does not hear itself";
  this->bench_.run_until(Microticks{middle + this->length(8)});
  EXPECT_FALSE(this->bench_.port(1).carrier(Channel::kA));
}

REGISTER_TYPED_TEST_SUITE_P(FlexRayPortLaws, L1_EveryTransmissionReachesEveryOtherControllerOnceUnchanged,
                            L2_AControllerDoesNotReceiveItself, L3_ReceptionsComeInTheOrderOfTheirEnd,
                            L3_TiesGoByChannel, L4_AFrameIsDeliveredAtItsEnd, L5_TheMediumKeepsNoReferenceToTheBytes,
                            L6_SignalsThatOverlapArriveAsOneUndecodable, L6_ABridgeBetweenTwoSignalsMakesThemOne,
                            L6_OverlappingCollisionAvoidanceSymbolsRemainOne, L6_OverlappingWakeupPatternsRemainOne,
                            L7_TheCarrierIsSensedFromStartToDelivery);

}  // namespace ttf::laws
