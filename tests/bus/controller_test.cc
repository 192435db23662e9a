#include "bus/controller.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "bus/wire/flexray_frame.h"
#include "tests/bus/bus_rig.h"
#include "tests/recording/allocations.h"

namespace ttf::bus {
namespace {

using schedules::Channel;

struct NoPort final : FlexRayPort {
  void transmit(const Transmission&) override {}
};

// One controller by itself; cycle 0 starts at its microtick 1000, so macrotick m of cycle c is at 1000 + 40 * (1000 c + m).
struct Alone {
  schedules::Cluster cluster;
  NoPort port;
  Heard heard;
  FlexRayController controller;

  explicit Alone(int node = 0, schedules::Cluster made = small_cluster(4))
      : cluster(std::move(made)), controller(cluster, static_cast<NodeId>(node), {{1000}, 0}, port, heard) {}

  static Microticks at(std::int64_t cycle, std::int64_t macrotick) {
    return {1000 + 40 * (1000 * cycle + macrotick)};
  }
  void run_to(std::int64_t cycle, std::int64_t macrotick = 0) { controller.advance(at(cycle, macrotick)); }
  std::vector<Heard::Sent> sent_in(std::int64_t cycle) const {
    std::vector<Heard::Sent> frames;
    for (const auto& sent : heard.sent)
      if (sent.cycle == cycle) frames.push_back(sent);
    return frames;
  }
};

// A frame as another node would send it, arriving in cycle 0 or later of an Alone.
struct Frame {
  wire::FrameHeader header;
  Channel channel = Channel::kA;
  std::vector<std::byte> payload = std::vector<std::byte>(16);
  std::int64_t start = 0;      // microtick of arrival
  std::int64_t length = 1000;  // in microticks

  static Frame status(int slot, std::int64_t cycle, Channel channel = Channel::kA) {
    Frame frame;
    frame.header.frame_id = static_cast<std::uint16_t>(slot);
    frame.header.cycle = static_cast<std::uint8_t>(cycle % 64);
    frame.header.sync = frame.header.startup = slot <= 4;
    frame.channel = channel;
    frame.start = Alone::at(cycle, 84 * (slot - 1) + 7).value;
    return frame;
  }
  std::vector<std::byte> bytes() const {
    std::vector<std::byte> made(wire::kMaxFrameBytes);
    if (!header.startup || header.sync) {
      made.resize(wire::encode_frame(header, channel, payload, made));
      return made;
    }
    // A startup frame that is no sync frame: encode_frame refuses it, so the two CRCs are put in by hand.
    wire::FrameHeader sync = header;
    sync.sync = true;
    made.resize(wire::encode_frame(sync, channel, payload, made));
    const std::uint32_t crc =
        wire::header_crc(false, true, header.frame_id, static_cast<std::uint8_t>(payload.size() / 2));
    made[0] &= std::byte{0xEF};
    made[2] = (made[2] & std::byte{0xFE}) | static_cast<std::byte>(crc >> 10);
    made[3] = static_cast<std::byte>((crc >> 2) & 0xFF);
    made[4] = static_cast<std::byte>((crc & 3) << 6) | (made[4] & std::byte{0x3F});
    const std::uint32_t trailer = wire::frame_crc(channel, std::span(made).first(made.size() - 3));
    for (std::size_t i = 0; i < 3; ++i) made[made.size() - 3 + i] = static_cast<std::byte>((trailer >> (16 - 8 * i)) & 0xFF);
    return made;
  }
  void arrive(Alone& alone) const {
    const auto wire_bytes = bytes();
    alone.controller.advance({start + length - 1});
    alone.controller.receive({channel, {start}, {start + length}, wire_bytes});
  }
};

TEST(ControllerSends, L3_InItsSlotsOnlyAndAlways) {
  Alone node0(0), node1(1);
  node0.run_to(4);
  node1.run_to(4);
  for (std::int64_t cycle = 0; cycle < 4; ++cycle) {
    const auto zero = node0.sent_in(cycle), one = node1.sent_in(cycle);
    ASSERT_EQ(zero.size(), 10u);   // slots 1, 5..8 on A and B
    for (std::size_t i = 0; i < zero.size(); ++i) {
      const int slot = i < 2 ? 1 : 5 + static_cast<int>(i / 2) - 1;
      EXPECT_EQ(zero[i].slot, slot);
      EXPECT_EQ(zero[i].channel, i % 2 == 0 ? Channel::kA : Channel::kB);
      EXPECT_EQ(zero[i].start, Alone::at(cycle, 84 * (slot - 1) + 7));   // at the action point
    }
    // Slot 9 on channel A in odd cycles only.
    ASSERT_EQ(one.size(), cycle % 2 == 1 ? 3u : 2u);
    if (cycle % 2 == 1) {
      EXPECT_EQ(one[2].slot, 9);
      EXPECT_EQ(one[2].channel, Channel::kA);
    }
  }
}

TEST(ControllerSends, EveryFrameIsValidOnItsChannelWithTheClustersPayloadLength) {
  Alone node;
  node.run_to(70);
  ASSERT_FALSE(node.heard.sent.empty());
  for (const auto& sent : node.heard.sent) {
    const auto decoded = wire::decode_frame(sent.channel, sent.bytes);
    ASSERT_EQ(decoded.error, wire::FrameError::kNone);
    ASSERT_EQ(decoded.header.frame_id, sent.slot);
    ASSERT_EQ(decoded.header.payload_words, 8);
    ASSERT_EQ(decoded.header.cycle, sent.cycle % 64);   // the counter wraps
    ASSERT_EQ(decoded.header.sync, sent.slot == 1);     // the key slot
    ASSERT_EQ(decoded.header.startup, sent.slot == 1);
    ASSERT_FALSE(decoded.header.payload_preamble);
    ASSERT_TRUE(std::all_of(decoded.payload.begin(), decoded.payload.end(),
                            [](std::byte byte) { return byte == std::byte{0}; }));
  }
}

TEST(ControllerSends, AStatusFrameIsNoNullFrameAndAnUnwrittenListIsOne) {
  Alone node;
  node.run_to(1);
  for (const auto& sent : node.sent_in(0)) {
    EXPECT_EQ(sent.null_frame, sent.slot != 1) << sent.slot;
    EXPECT_EQ(wire::decode_frame(sent.channel, sent.bytes).header.null_frame, sent.null_frame);
  }
}

TEST(ControllerSends, FragmentsPaddedWithZerosAndNullFramesBeyondTheList) {
  Alone node;
  MadeList list(node.cluster.pdus[0], 1, 5, 0xABC0);   // two fragments of 8 bytes
  node.controller.outgoing(kList).write(list.view());
  node.run_to(1);
  for (const auto& sent : node.sent_in(0)) {
    if (sent.pdu != kList) continue;
    EXPECT_EQ(sent.fragment, sent.slot - 5);
    EXPECT_EQ(sent.null_frame, sent.fragment >= 2);
    const auto decoded = wire::decode_frame(sent.channel, sent.bytes);
    const auto head = decoded.payload.first(8), rest = decoded.payload.last(8);
    EXPECT_TRUE(std::all_of(rest.begin(), rest.end(), [](std::byte byte) { return byte == std::byte{0}; }));
    if (sent.fragment < 2) {
      const auto expected = list.fragment(sent.fragment);
      EXPECT_TRUE(std::equal(head.begin(), head.end(), expected.begin(), expected.end()));
      EXPECT_EQ(sent.sequence, 1u);
    }
  }
}

TEST(ControllerSends, AListWrittenWhileItsSlotsAreSentWaitsForTheNextCycle) {
  Alone node;
  MadeList old_list(node.cluster.pdus[0], 1, 10, 100), new_list(node.cluster.pdus[0], 2, 10, 200);
  node.controller.outgoing(kList).write(old_list.view());
  node.run_to(0, 84 * 5);   // slot 5 is out, slots 6..8 are not
  node.controller.outgoing(kList).write(new_list.view());
  node.run_to(2);
  for (const auto& sent : node.heard.sent) {
    if (sent.pdu != kList) continue;
    MadeList& expected = sent.cycle == 0 ? old_list : new_list;
    const auto payload = wire::decode_frame(sent.channel, sent.bytes).payload.first(8);
    const auto fragment = expected.fragment(sent.fragment);
    EXPECT_EQ(sent.sequence, expected.sequence);
    EXPECT_TRUE(std::equal(payload.begin(), payload.end(), fragment.begin(), fragment.end())) << sent.slot;
  }
}

TEST(ControllerSends, AListWrittenAtTheActionPointOfItsFirstSlotStillGoesOut) {
  Alone node;
  node.controller.advance(Alone::at(0, 84 * 4 + 7) - Microticks{1});
  MadeList list(node.cluster.pdus[0], 6, 10, 0);
  node.controller.outgoing(kList).write(list.view());
  node.run_to(0, 84 * 5);
  EXPECT_EQ(node.heard.sent.back().sequence, 6u);
  EXPECT_FALSE(node.heard.sent.back().null_frame);
}

TEST(ControllerSends, LastIsSaidOncePerListWithItsLastFragmentOnItsLastChannel) {
  Alone node;
  for (std::uint32_t sequence = 1; sequence <= 3; ++sequence) {
    MadeList list(node.cluster.pdus[0], sequence, 7, 0);   // three fragments
    node.controller.outgoing(kList).write(list.view());
    node.run_to(4 * sequence);   // four cycles each: sent again and again
  }
  std::vector<std::uint32_t> finished;
  for (const auto& sent : node.heard.sent) {
    if (!sent.last) continue;
    finished.push_back(sent.sequence);
    EXPECT_EQ(sent.fragment, 2);
    EXPECT_EQ(sent.channel, Channel::kB);
  }
  EXPECT_EQ(finished, (std::vector<std::uint32_t>{1, 2, 3}));
}

// Base cycle and repetition go by the cycle counter, which here wraps after 5: cycles 5 and 6 are counter 5 and 0.
TEST(ControllerSends, MultiplexingGoesByTheCycleCounter) {
  schedules::Cluster cluster = small_cluster(4);
  cluster.flexray.gCycleCountMax = 5;
  for (auto& frame : cluster.frames)
    if (frame.pdu == kOddList) frame.base_cycle = 1, frame.repetition = 4;
  Alone node(1, cluster);
  node.run_to(16);
  std::vector<std::int64_t> cycles;
  for (const auto& sent : node.heard.sent)
    if (sent.slot == 9) cycles.push_back(sent.cycle);
  EXPECT_EQ(cycles, (std::vector<std::int64_t>{1, 5, 7, 11, 13}));
}

TEST(Controller, L1_NextEventIsNeverInThePast) {
  Alone node;
  Microticks now{0};
  for (int step = 0; step < 3000; ++step) {
    const Microticks next = node.controller.next_event();
    ASSERT_GT(next, now);
    now = next + Microticks{step % 7 == 0 ? 5000 : 0};   // now and then late
    node.controller.advance(now);
  }
  EXPECT_GT(node.heard.cycles.size(), 100u);
  for (std::size_t i = 0; i < node.heard.cycles.size(); ++i)
    ASSERT_EQ(node.heard.cycles[i], static_cast<std::int64_t>(i) + 1);
}

TEST(Controller, L4_NothingAllocatesAfterConstruction) {
  struct Silent final : ControllerEvents {};
  const schedules::Cluster cluster = small_cluster(4);
  NoPort port;
  Silent events;
  FlexRayController controller(cluster, NodeId{1}, {{1000}, 0}, port, events);
  std::vector<std::vector<std::byte>> frames;
  MadeList list(cluster.pdus[0], 1, 10, 0), mine(cluster.pdus[1], 1, 3, 0);
  for (int fragment = 0; fragment < 4; ++fragment) {
    Frame frame = Frame::status(5 + fragment, 0);
    const auto payload = list.fragment(fragment);
    std::copy(payload.begin(), payload.end(), frame.payload.begin());
    frames.push_back(frame.bytes());
  }
  const auto sync = Frame::status(1, 0).bytes();
  const std::int64_t before = recording::allocations();
  controller.outgoing(kOddList).write(mine.view());
  controller.advance(Alone::at(0, 80));
  controller.receive({Channel::kA, Alone::at(0, 7), Alone::at(0, 33), sync});
  for (int fragment = 0; fragment < 4; ++fragment) {
    const int slot_start = 84 * (4 + fragment);
    controller.advance(Alone::at(0, slot_start + 80));
    controller.receive({Channel::kA, Alone::at(0, slot_start + 7), Alone::at(0, slot_start + 33),
                        frames[static_cast<std::size_t>(fragment)]});
  }
  const bool complete = controller.incoming(kList).latest().has_value();
  controller.advance(Alone::at(50, 0));
  EXPECT_EQ(recording::allocations(), before);
  EXPECT_TRUE(complete);
}

TEST(ControllerReceives, ListsFromBothChannels) {
  Rig rig(small_cluster(3), {0, 0, 0});
  MadeList list(rig.cluster().pdus[0], 1, 10, 500), odd(rig.cluster().pdus[1], 4, 2, 900);
  rig.controller(0).outgoing(kList).write(list.view());
  rig.controller(1).outgoing(kOddList).write(odd.view());
  rig.run_cycles(4);
  for (const std::size_t node : {1u, 2u}) {
    const auto latest = rig.controller(node).incoming(kList).latest();
    ASSERT_TRUE(latest.has_value());
    EXPECT_TRUE(std::equal(latest->bytes.begin(), latest->bytes.end(), list.bytes.begin(), list.bytes.end()));
    // Eight arrivals a cycle: one completes, three prepare it, all others repeat.
    int completed = 0, incomplete = 0, repeated = 0;
    for (const auto& arrived : rig.heard(node).arrived) {
      if (arrived.pdu != kList) continue;
      EXPECT_EQ(arrived.sequence, 1u);
      completed += arrived.effect == ArrivalEffect::kCompleted;
      incomplete += arrived.effect == ArrivalEffect::kIncomplete;
      repeated += arrived.effect == ArrivalEffect::kDuplicate;
    }
    EXPECT_EQ(completed, 1);
    EXPECT_EQ(incomplete, 3);
    EXPECT_EQ(repeated, 28);
    EXPECT_TRUE(rig.heard(node).problems.empty());
  }
  EXPECT_TRUE(rig.controller(2).incoming(kOddList).latest().has_value());
  EXPECT_TRUE(rig.controller(0).incoming(kOddList).latest().has_value());
}

// One frame each, wrong in one way each; what the controller reports for its slot in cycle 0.
int status_of(const Frame& frame, int slot, std::int64_t cycle = 0) {
  Alone node;
  frame.arrive(node);
  node.run_to(cycle + 1);
  for (const auto& problem : node.heard.problems)
    if (problem.cycle == cycle && problem.slot == slot && problem.channel == frame.channel) return problem.status;
  return kValidFrame;
}

TEST(ControllerJudges, ARightFrameIsNoProblem) {
  EXPECT_EQ(status_of(Frame::status(2, 0), 2), kValidFrame);
  EXPECT_EQ(status_of(Frame::status(2, 0, Channel::kB), 2), kValidFrame);
  EXPECT_EQ(status_of(Frame::status(4, 0), 4), kValidFrame);
}

TEST(ControllerJudges, SilenceInAnOwnedSlotPerChannel) {
  Alone node;
  Frame::status(2, 0).arrive(node);   // channel A only
  node.run_to(1);
  std::vector<std::pair<int, Channel>> silent;
  for (const auto& problem : node.heard.problems) {
    EXPECT_EQ(problem.status, kNoFrame);
    silent.emplace_back(problem.slot, problem.channel);
  }
  // Slots 1 and 5..8 are its own, 9 is sent in odd cycles, 10 is nobody's.
  EXPECT_EQ(silent, (std::vector<std::pair<int, Channel>>{{2, Channel::kB}, {3, Channel::kA}, {3, Channel::kB},
                                                          {4, Channel::kA}, {4, Channel::kB}}));
  node.run_to(2);
  const auto& last = node.heard.problems.back();
  EXPECT_EQ(last.slot, 9);
  EXPECT_EQ(last.channel, Channel::kA);   // B is not expected to carry it
}

TEST(ControllerJudges, SyntaxErrors) {
  for (const std::size_t byte : {1u, 7u, 22u}) {   // header, payload, trailer
    Alone node;
    const Frame frame = Frame::status(2, 0);
    auto bytes = frame.bytes();
    bytes[byte] ^= std::byte{0x10};
    node.controller.receive({Channel::kA, {frame.start}, {frame.start + 1000}, bytes});
    node.run_to(1);
    ASSERT_FALSE(node.heard.problems.empty());
    EXPECT_EQ(node.heard.problems[0].slot, 2);
    EXPECT_EQ(node.heard.problems[0].status, kSyntaxError);
  }
}

TEST(ControllerJudges, AFrameOfTheOtherChannelIsASyntaxError) {
  Alone node;
  const Frame frame = Frame::status(2, 0, Channel::kA);
  node.controller.receive({Channel::kB, {frame.start}, {frame.start + 1000}, frame.bytes()});
  node.run_to(1);
  const auto swapped = std::find_if(node.heard.problems.begin(), node.heard.problems.end(), [](const auto& problem) {
    return problem.slot == 2 && problem.channel == Channel::kB;
  });
  ASSERT_NE(swapped, node.heard.problems.end());
  EXPECT_EQ(swapped->status, kSyntaxError);
}

TEST(ControllerJudges, ContentErrors) {
  Frame other_id = Frame::status(2, 0);
  other_id.header.frame_id = 3;
  EXPECT_EQ(status_of(other_id, 2), kContentError);
  Frame other_cycle = Frame::status(2, 0);
  other_cycle.header.cycle = 1;
  EXPECT_EQ(status_of(other_cycle, 2), kContentError);
  Frame shorter = Frame::status(2, 0);
  shorter.payload.resize(14);
  EXPECT_EQ(status_of(shorter, 2), kContentError);
  Frame startup_only = Frame::status(2, 0);
  startup_only.header.sync = false;
  EXPECT_EQ(wire::decode_frame(Channel::kA, startup_only.bytes()).error, wire::FrameError::kNone);
  EXPECT_EQ(status_of(startup_only, 2), kContentError);
  EXPECT_EQ(status_of(Frame::status(10, 0), 10), kContentError);              // nobody's slot
  EXPECT_EQ(status_of(Frame::status(5, 0), 5), kContentError);                // the receiver's own
  EXPECT_EQ(status_of(Frame::status(9, 0), 9), kContentError);                // not in even cycles
  EXPECT_EQ(status_of(Frame::status(9, 1, Channel::kB), 9, 1), kContentError);   // not on B
  EXPECT_EQ(status_of(Frame::status(9, 1), 9, 1), kValidFrame);
}

// A frame must lie within the receiver's own slot, both ends included.
TEST(ControllerJudges, BoundaryViolations) {
  const std::int64_t begin = Alone::at(0, 84).value, end = Alone::at(0, 168).value;   // slot 2
  Frame frame = Frame::status(2, 0);
  frame.start = begin;
  EXPECT_EQ(status_of(frame, 2), kValidFrame);
  frame.start = end - frame.length;
  EXPECT_EQ(status_of(frame, 2), kValidFrame);
  frame.start = end - frame.length + 1;
  EXPECT_EQ(status_of(frame, 2), kBoundaryViolation);
  // One microtick early it begins in slot 1 and ends in slot 2: slot 1 is violated, slot 2 heard nothing.
  frame.start = begin - 1;
  EXPECT_EQ(status_of(frame, 1), kBoundaryViolation);
  EXPECT_EQ(status_of(frame, 2), kNoFrame);
}

TEST(ControllerJudges, ASecondFrameInASlotIsAConflict) {
  Alone node;
  Frame first = Frame::status(2, 0), second = Frame::status(2, 0);
  first.arrive(node);
  second.start = first.start + 1500;
  second.arrive(node);
  node.run_to(1);
  EXPECT_EQ(node.heard.problems[0].slot, 2);
  EXPECT_EQ(node.heard.problems[0].status, kTransmissionConflict);
}

TEST(ControllerJudges, WrongFramesReachNeitherTheHostNorTheClock) {
  Alone node(1);
  MadeList list(node.cluster.pdus[0], 1, 3, 0);
  Frame carrier = Frame::status(5, 0);
  std::copy(list.bytes.begin(), list.bytes.end(), carrier.payload.begin());
  carrier.header.cycle = 1;
  carrier.arrive(node);
  EXPECT_TRUE(node.heard.arrived.empty());
  for (const int slot : {1, 3, 4}) {
    Frame late = Frame::status(slot, 1);
    late.start += 100;
    late.header.cycle = 2;
    late.arrive(node);
  }
  node.run_to(2);
  ASSERT_EQ(node.heard.corrected.size(), 1u);
  EXPECT_EQ(node.heard.corrected[0].offset.value, 0);   // only its own sync frame counts
}

TEST(ControllerJudges, ANullFrameIsValidAndLeavesTheListAlone) {
  Alone node(1);
  Frame frame = Frame::status(5, 0);
  frame.header.null_frame = true;
  frame.arrive(node);
  node.run_to(1);
  EXPECT_TRUE(node.heard.arrived.empty());
  for (const auto& problem : node.heard.problems) EXPECT_FALSE(problem.slot == 5 && problem.channel == Channel::kA);
}

}  // namespace
}  // namespace ttf::bus
