#include "bus/socketcan/flexray_on_can.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "bus/wire/flexray_crc.h"
#include "core/random.h"
#include "tests/bus/socketcan/frames.h"
#include "tests/support/allocation_counter.h"

namespace ttf::bus::socketcan {
namespace {

using schedules::model::Channel;

std::size_t at(RandomStream& draw, const Bytes& bytes) {
  return static_cast<std::size_t>(draw.integer(0, static_cast<std::int64_t>(bytes.size()) - 1));
}

TEST(CanFdLength, IsTheShortestThatHasRoom) {
  const std::vector<std::size_t> there_are{0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64};  // ISO 11898-1
  for (std::size_t bytes = 0; bytes <= 64; ++bytes) {
    const std::size_t length = can_fd_length(bytes);
    EXPECT_TRUE(std::count(there_are.begin(), there_are.end(), length) == 1 && length >= bytes) << bytes;
    for (const std::size_t shorter : there_are) EXPECT_FALSE(shorter >= bytes && shorter < length) << bytes;
  }
}

TEST(FlexRayOnCan, EveryLengthArrivesUnchanged) {
  Reassembly a(Channel::kA), b(Channel::kB);
  std::uint64_t fragments = 0;
  for (int words = 0; words <= 127; ++words)
    for (const int slot : {1, 60, 1023, 1024, 2047})
      for (const Channel channel : {Channel::kA, Channel::kB}) {
        const Bytes frame = drawn_frame(channel, slot, words % 64, words);
        const CanFrames can = frame_to_can(slot, frame);
        ASSERT_EQ(can.count == 1, words <= 28) << words;
        ASSERT_LE(can.count, kMaxFragments);
        Reassembly& receiver = channel == Channel::kA ? a : b;
        for (std::size_t i = 0; i < can.count; ++i) {
          const canfd_frame& one = can.frames[i];
          EXPECT_EQ(one.can_id, static_cast<canid_t>(slot));
          EXPECT_EQ(one.len, can_fd_length(one.len));
          const Arrival arrival = receiver.arrive(one);
          EXPECT_FALSE(arrival.abandoned);
          EXPECT_EQ(arrival.slot, slot);
          if (i + 1 < can.count) {
            ASSERT_EQ(arrival.outcome, Outcome::kFragment) << words;
            ++fragments;
            continue;
          }
          ASSERT_EQ(arrival.outcome, Outcome::kComplete) << words;
          EXPECT_EQ(arrival.signal, ports::Signal::kFrame);
          EXPECT_EQ(bytes_of(arrival.frame), frame) << words;
          EXPECT_EQ(wire::decode_frame(channel, arrival.frame).error, wire::FrameError::kNone);
        }
      }
  EXPECT_EQ(a.count(Outcome::kComplete), 128u * 5);
  EXPECT_EQ(a.count(Outcome::kFragment) + b.count(Outcome::kFragment), fragments);
  EXPECT_EQ(a.abandoned() + b.abandoned(), 0u);
}

// A frame of 28 words is, byte for byte, a CAN FD frame, without a prefix.
TEST(FlexRayOnCan, AFrameThatFitsHasNoPrefix) {
  const Bytes frame = drawn_frame(Channel::kA, 3, 7, 28);
  const CanFrames can = frame_to_can(3, frame);
  ASSERT_EQ(can.count, 1u);
  EXPECT_EQ(bytes_of(data_of(can.frames[0])), frame);
}

// A frame broken at its sender arrives as it was sent, at any length. Its receiver distinguishes it from a
// sound one.
TEST(FlexRayOnCan, BrokenFramesArriveAsTheyWereSent) {
  RandomStream draw({.seed = 7});
  for (std::size_t size = 8; size <= wire::kMaxFrameBytes; ++size)
    for (int kind = 0; kind < 4; ++kind) {
      Bytes frame = drawn_frame(Channel::kA, 9, 5, static_cast<int>(size - 8) / 2);
      if (kind == 0) frame[at(draw, frame)] ^= static_cast<std::byte>(draw.integer(1, 255));
      if (kind == 1) frame[0] |= std::byte{0x80};
      if (kind == 2) frame[3] ^= std::byte{0x10};
      frame.resize(kind == 3 ? std::max<std::size_t>(8, size - 1) : size);
      Reassembly receiver(Channel::kA);
      const CanFrames can = frame_to_can(9, frame);
      Arrival last;
      for (const canfd_frame& one : can.all()) last = receiver.arrive(one);
      ASSERT_EQ(last.outcome, Outcome::kComplete) << size << " " << kind;
      EXPECT_EQ(bytes_of(last.frame), frame) << size << " " << kind;
    }
}

// Sent in another slot than its header says: the receiver gets both.
TEST(FlexRayOnCan, AFrameInAnotherSlotKeepsItsHeader) {
  const Bytes frame = drawn_frame(Channel::kB, 12, 3, 8);
  const CanFrames can = frame_to_can(13, frame);
  ASSERT_EQ(can.count, 1u);
  Reassembly receiver(Channel::kB);
  const Arrival arrival = receiver.arrive(can.frames[0]);
  ASSERT_EQ(arrival.outcome, Outcome::kComplete);
  EXPECT_EQ(arrival.slot, 13);
  EXPECT_EQ(wire::decode_frame(Channel::kB, arrival.frame).header.frame_id, 12);
}

TEST(FlexRayOnCan, SymbolsArriveWithTheirDurations) {
  for (const Channel channel : {Channel::kA, Channel::kB})
    for (const ports::Signal symbol : {ports::Signal::kCas, ports::Signal::kWakeup, ports::Signal::kUndecodable})
      for (const std::int64_t ns : {std::int64_t{0}, std::int64_t{1}, std::int64_t{5'700}, std::int64_t{1'980'000},
                                    std::int64_t{0xffff'ffff}}) {
        const canfd_frame can = symbol_to_can(channel, symbol, Duration::nanoseconds(ns));
        EXPECT_EQ(can.can_id, 0u);
        Reassembly receiver(channel);
        const Arrival arrival = receiver.arrive(can);
        ASSERT_EQ(arrival.outcome, Outcome::kComplete);
        EXPECT_EQ(arrival.signal, symbol);
        EXPECT_EQ(arrival.duration.ns, ns);
        Reassembly other(channel == Channel::kA ? Channel::kB : Channel::kA);
        EXPECT_EQ(other.arrive(can).outcome, Outcome::kMalformed);
      }
}

TEST(FlexRayOnCan, ForeignFramesAreReportedAndDoNoHarm) {
  const Bytes frame = drawn_frame(Channel::kA, 70, 63, 40);
  const CanFrames can = frame_to_can(70, frame);
  ASSERT_EQ(can.count, 2u);
  Reassembly receiver(Channel::kA);
  ASSERT_EQ(receiver.arrive(can.frames[0]).outcome, Outcome::kFragment);
  for (canfd_frame foreign : {can.frames[0], can.frames[1]}) {
    foreign.flags = 0;  // classic
    foreign.len = 8;
    EXPECT_EQ(receiver.arrive(foreign).outcome, Outcome::kForeign);
    foreign.flags = CANFD_FDF;
    for (const canid_t flag : {canid_t{CAN_EFF_FLAG}, canid_t{CAN_RTR_FLAG}, canid_t{CAN_ERR_FLAG}}) {
      foreign.can_id = 70 | flag;
      EXPECT_EQ(receiver.arrive(foreign).outcome, Outcome::kForeign);
    }
    foreign.can_id = 2048;
    EXPECT_EQ(receiver.arrive(foreign).outcome, Outcome::kForeign);
  }
  const Arrival arrival = receiver.arrive(can.frames[1]);
  ASSERT_EQ(arrival.outcome, Outcome::kComplete);
  EXPECT_EQ(bytes_of(arrival.frame), frame);
  EXPECT_EQ(receiver.count(Outcome::kForeign), 10u);
  EXPECT_EQ(receiver.abandoned(), 0u);
}

// Tries every value of every byte of every CAN frame, including zeros behind the end. The result is refused
// here or by the FlexRay decoder, or equals the sent frame. It is never another frame.
TEST(FlexRayOnCan, NoCorruptedByteMakesAnotherFrame) {
  std::uint64_t refused = 0, broken = 0;
  for (const int words : {0, 1, 2, 9, 27, 28, 29, 30, 57, 58, 60, 127}) {
    const Bytes frame = drawn_frame(Channel::kA, 515, 21, words);
    const CanFrames can = frame_to_can(515, frame);
    for (std::size_t i = 0; i < can.count; ++i)
      for (std::size_t at = 0; at < can.frames[i].len; ++at)
        for (unsigned flip = 1; flip < 256; ++flip) {
          Reassembly receiver(Channel::kA);
          Arrival last;
          canfd_frame one{};  // `last` refers to the arrived frame
          for (std::size_t k = 0; k < can.count; ++k) {
            one = can.frames[k];
            if (k == i) one.data[at] = static_cast<std::uint8_t>(one.data[at] ^ flip);
            last = receiver.arrive(one);
            ASSERT_TRUE(k + 1 == can.count || last.outcome != Outcome::kComplete || !sound(Channel::kA, last, 515))
                << words << " words, frame " << i << " byte " << at << " flip " << flip;
          }
          if (last.outcome != Outcome::kComplete)
            ++refused;
          else if (!sound(Channel::kA, last, 515))
            ++broken;
          else
            ASSERT_EQ(bytes_of(last.frame), frame)
                << words << " words, frame " << i << " byte " << at << " flip " << flip;
        }
  }
  EXPECT_GT(refused, 0u);
  EXPECT_GT(broken, 0u);
}

TEST(FlexRayOnCan, NoOtherIdentifierOrLengthMakesAnotherFrame) {
  for (const int words : {0, 5, 28, 29, 127}) {
    const Bytes frame = drawn_frame(Channel::kB, 300, 21, words);
    const CanFrames can = frame_to_can(300, frame);
    for (std::size_t i = 0; i < can.count; ++i) {
      for (canid_t identifier = 0; identifier <= 2047; ++identifier)
        if (identifier != 300) {
          Reassembly receiver(Channel::kB);
          for (std::size_t k = 0; k < can.count; ++k) {
            canfd_frame one = can.frames[k];
            if (k == i) one.can_id = identifier;
            ASSERT_NE(receiver.arrive(one).outcome, Outcome::kComplete) << words << " as " << identifier;
          }
        }
      for (unsigned length = 0; length < 256; ++length)
        if (length != can.frames[i].len) {
          Reassembly receiver(Channel::kB);
          for (std::size_t k = 0; k < can.count; ++k) {
            canfd_frame one = can.frames[k];
            if (k == i) one.len = static_cast<std::uint8_t>(length);
            ASSERT_NE(receiver.arrive(one).outcome, Outcome::kComplete) << words << " with " << length;
          }
        }
    }
  }
}

TEST(FlexRayOnCan, ASymbolWithACorruptedByteIsNone) {
  const canfd_frame can = symbol_to_can(Channel::kA, ports::Signal::kWakeup, Duration::nanoseconds(1'980'000));
  Reassembly receiver(Channel::kA);
  for (std::size_t at = 0; at < can.len; ++at)
    for (unsigned flip = 1; flip < 256; ++flip) {
      canfd_frame one = can;
      one.data[at] = static_cast<std::uint8_t>(one.data[at] ^ flip);
      EXPECT_EQ(receiver.arrive(one).outcome, Outcome::kMalformed) << at;
    }
}

TEST(FlexRayOnCan, FollowUpsArriveAsTheyWereSaid) {
  for (const Channel channel : {Channel::kA, Channel::kB})
    for (const int slot : {1, 255, 256, 2047})
      for (const std::uint8_t cycle : {std::uint8_t{0}, std::uint8_t{63}})
        for (const std::int64_t ns : {std::int64_t{0}, std::int64_t{1}, std::int64_t{-1}, std::int64_t{1'234'567},
                                      std::int64_t{-0x8000'0000LL}, std::int64_t{0x7fff'ffff}}) {
          const canfd_frame can =
              follow_up_to_can(channel, {.slot = slot, .cycle_counter = cycle, .late = Duration::nanoseconds(ns)});
          EXPECT_EQ(can.can_id, 0u);
          EXPECT_EQ(can.len, 12);
          Reassembly receiver(channel);
          const Arrival arrival = receiver.arrive(can);
          ASSERT_EQ(arrival.outcome, Outcome::kComplete);
          ASSERT_TRUE(arrival.follow_up);
          EXPECT_EQ(arrival.follow_up->slot, slot);
          EXPECT_EQ(arrival.follow_up->cycle_counter, cycle);
          EXPECT_EQ(arrival.follow_up->late.ns, ns);
          Reassembly other(channel == Channel::kA ? Channel::kB : Channel::kA);
          EXPECT_EQ(other.arrive(can).outcome, Outcome::kMalformed);
        }
}

TEST(FlexRayOnCan, AFollowUpHasRoomForFourBytesOfNanoseconds) {
  EXPECT_TRUE(fits_follow_up(Duration::nanoseconds(0x7fff'ffff)));
  EXPECT_FALSE(fits_follow_up(Duration::nanoseconds(0x8000'0000LL)));
  EXPECT_TRUE(fits_follow_up(Duration::nanoseconds(-0x8000'0000LL)));
  EXPECT_FALSE(fits_follow_up(Duration::nanoseconds(-0x8000'0001LL)));
}

// The one zero behind the CRC included.
TEST(FlexRayOnCan, AFollowUpWithACorruptedByteIsNone) {
  const canfd_frame can =
      follow_up_to_can(Channel::kB, {.slot = 515, .cycle_counter = 21, .late = Duration::nanoseconds(-77)});
  for (std::size_t at = 0; at < can.len; ++at)
    for (unsigned flip = 1; flip < 256; ++flip) {
      canfd_frame one = can;
      one.data[at] = static_cast<std::uint8_t>(one.data[at] ^ flip);
      EXPECT_EQ(Reassembly(Channel::kB).arrive(one).outcome, Outcome::kMalformed) << at;
    }
  for (unsigned length = 0; length < 256; ++length)
    if (length != can.len) {
      canfd_frame one = can;
      one.len = static_cast<std::uint8_t>(length);
      EXPECT_EQ(Reassembly(Channel::kB).arrive(one).outcome, Outcome::kMalformed) << length;
    }
}

// Its CRC holds, but no sender of ours sends its content.
TEST(FlexRayOnCan, AFollowUpOfNoSlotOrNoCycleIsNone) {
  const auto says = [](unsigned slot, unsigned cycle) {
    canfd_frame can = follow_up_to_can(Channel::kA, {.slot = 1, .cycle_counter = 0, .late = {}});
    can.data[1] = static_cast<std::uint8_t>(slot >> 8);
    can.data[2] = static_cast<std::uint8_t>(slot & 0xff);
    can.data[3] = static_cast<std::uint8_t>(cycle);
    const std::uint32_t crc = wire::frame_crc(Channel::kA, data_of(can).first(8));
    for (unsigned i = 0; i < 3; ++i) can.data[8 + i] = static_cast<std::uint8_t>(crc >> (8 * (2 - i)));
    return Reassembly(Channel::kA).arrive(can).outcome;
  };
  EXPECT_EQ(says(1, 63), Outcome::kComplete);
  EXPECT_EQ(says(2047, 0), Outcome::kComplete);
  EXPECT_EQ(says(0, 0), Outcome::kMalformed);
  EXPECT_EQ(says(2048, 0), Outcome::kMalformed);
  EXPECT_EQ(says(1, 64), Outcome::kMalformed);
}

TEST(FlexRayOnCan, NothingIsAllocated) {
  const Bytes frame = drawn_frame(Channel::kA, 5, 1, 127);
  Reassembly receiver(Channel::kA);
  const std::int64_t before = support::allocations();
  for (int i = 0; i < 100; ++i) {
    const CanFrames can = frame_to_can(5, frame);
    for (const canfd_frame& one : can.all()) receiver.arrive(one);
    receiver.arrive(symbol_to_can(Channel::kA, ports::Signal::kCas, Duration::nanoseconds(5'700)));
    receiver.arrive(follow_up_to_can(Channel::kA, {.slot = 5, .cycle_counter = 1, .late = Duration::nanoseconds(i)}));
  }
  EXPECT_EQ(support::allocations(), before);
  EXPECT_EQ(receiver.count(Outcome::kComplete), 300u);
}

}  // namespace
}  // namespace ttf::bus::socketcan
