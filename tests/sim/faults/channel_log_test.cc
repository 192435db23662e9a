// The log's records of frames on the channels, for every fault and its affected frames. Integrated clusters
// of four: node n sends 8 words in slot n + 1, on both channels, in every cycle.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "sim/medium/channel_log.h"
#include "tests/sim/faults/fault_bus.h"

namespace ttf::sim::faults {
namespace {

using schedules::model::Channel;
using ttf::faults::FaultKind;

constexpr auto kCrcs = recording::records::ChannelState::kHeaderCrc | recording::records::ChannelState::kFrameCrc;

struct Received final : recording::records::Sink {
  struct Frame {
    recording::records::ChannelFrame record;
    std::vector<std::byte> bytes;
  };
  std::vector<Frame> frames;
  using recording::records::Sink::on;
  void on(const recording::records::ChannelFrame& record) override {
    frames.push_back({record, {record.bytes.begin(), record.bytes.end()}});
  }
  std::size_t count(recording::records::ChannelState state) const {
    return static_cast<std::size_t>(
        std::count_if(frames.begin(), frames.end(), [&](const Frame& frame) { return frame.record.state == state; }));
  }
};

struct LoggedBus {
  Received received;
  FaultBus bus;
  medium::ChannelLog log;

  LoggedBus(FaultBusConfig config, int cycles)
      : bus(config), log(config.cluster.flexray, medium::FlexRayMedium::kMostLogged, received) {
    bus.simulation().medium().set_log(&log);
    bus.run(5 * cycles);
  }
  LoggedBus(const ttf::faults::Fault& fault, int cycles) : LoggedBus(with({fault}), cycles) {}
  const std::vector<Received::Frame>& frames() const { return received.frames; }
};

FaultBusConfig star_of(std::vector<ttf::faults::Fault> faults) {
  FaultBusConfig config = with(std::move(faults));
  config.cluster.topology = schedules::model::Topology::kStar;
  config.cluster.guardian = true;
  return config;
}

Channel channel_of(const Received::Frame& frame) { return static_cast<Channel>(frame.record.channel); }

bus::wire::FrameError error_of(const Received::Frame& frame) {
  return bus::wire::decode_frame(channel_of(frame), frame.bytes).error;
}

void expect_sent_by(const Received::Frame& frame, int node) {
  EXPECT_EQ(index_of(frame.record.sender), static_cast<std::size_t>(node));
  EXPECT_EQ(frame.record.slot, node + 1);
}

TEST(ChannelLog, WhereNothingGoesWrongThereIsNothingToReport) {
  for (const bool star : {false, true}) EXPECT_TRUE(LoggedBus(star ? star_of({}) : with({}), 100).frames().empty());
}

TEST(ChannelLog, ItChangesNothing) {
  for (const bool star : {false, true}) {
    std::vector<ttf::faults::Fault> faults = {
        fault_of(FaultKind::kBitFlipHeader, 0, 10, 10), fault_of(FaultKind::kSosValue, 1, 10, 40),
        fault_of(FaultKind::kCrash, 2, 20, 5), fault_of(FaultKind::kBabblingIdiot, 3, 30, 5)};
    const FaultBusConfig config = star ? star_of(faults) : with(faults);
    FaultBus alone(config);
    alone.run(5 * 60);
    const LoggedBus logged(config, 60);
    EXPECT_EQ(alone.everything(), logged.bus.everything());
    EXPECT_GT(logged.frames().size(), 20U);
  }
}

TEST(ChannelLog, AnInvertedBitFailsTheChecksThatCoverIt) {
  const auto region = [](FaultKind kind) {
    return kind == FaultKind::kBitFlipHeader ? 0 : kind == FaultKind::kBitFlipPayload ? 40 : 40 + 128;
  };
  for (const FaultKind kind : {FaultKind::kBitFlipHeader, FaultKind::kBitFlipPayload, FaultKind::kBitFlipTrailer})
    for (const int bit : {0, 2, 3, 15, 23}) {
      ttf::faults::Fault fault = fault_of(kind, 2, 10, 4);
      fault.bits = {bit};
      const LoggedBus logged(fault, 20);
      ASSERT_EQ(logged.frames().size(), 8U);
      const int at = region(kind) + bit;
      for (Received::Frame frame : logged.frames()) {
        expect_sent_by(frame, 2);
        EXPECT_EQ(frame.record.sent, frame.record.start);
        EXPECT_EQ(frame.record.sent_channel, frame.record.channel);
        EXPECT_GE(frame.record.cycle_counter, 10);
        // Sync, startup, frame id, length and the header CRC itself.
        EXPECT_EQ(frame.record.state, at >= 3 && at <= 33 ? kCrcs : recording::records::ChannelState::kFrameCrc)
            << "bit " << at;
        frame.bytes[static_cast<std::size_t>(at / 8)] ^= static_cast<std::byte>(0x80 >> at % 8);
        EXPECT_EQ(error_of(frame), bus::wire::FrameError::kNone) << "but for that bit it is the frame that was sent";
      }
      for (const int n : {0, 1, 3}) EXPECT_EQ(logged.bus.said(n).count(3, bus::controller::kSyntaxError), 8);
    }
}

TEST(ChannelLog, AFrameThatOnlySomeReceiversMistakeIsOnTheChannelAsSent) {
  ttf::faults::Fault fault = fault_of(FaultKind::kBitFlipPayload, 2, 10, 4);
  fault.receivers = {NodeId{0}, NodeId{3}};
  EXPECT_TRUE(LoggedBus(fault, 20).frames().empty());
  fault.receivers.push_back(NodeId{1});
  const LoggedBus all(fault, 20);
  EXPECT_EQ(all.frames().size(), 8U);
  EXPECT_EQ(all.received.count(recording::records::ChannelState::kFrameCrc), 8U);

  fault = fault_of(FaultKind::kSosValue, 2, 10, 4);
  fault.receivers = {NodeId{0}, NodeId{1}};
  EXPECT_TRUE(LoggedBus(fault, 20).frames().empty());
  fault.receivers.push_back(NodeId{3});
  EXPECT_EQ(LoggedBus(fault, 20).received.count(recording::records::ChannelState::kCoding), 8U);

  fault = fault_of(FaultKind::kOmission, 2, 10, 4);
  fault.direction = ttf::faults::FaultDirection::kReceive;
  EXPECT_TRUE(LoggedBus(fault, 20).frames().empty()) << "a deaf receiver";
}

// Node 1's frame of cycle 10 on A and B: TSS of 9 bits, FSS, ten bits a byte, FES.
TEST(ChannelLog, OfAFrameThatBreaksOffThereAreTheBytesThatHadLeft) {
  std::size_t before = 0;
  for (int microseconds = 1; microseconds < 25; ++microseconds) {
    ttf::faults::Fault fault = fault_of(FaultKind::kCrash, 1, 10);
    fault.from = Duration{10 * kCycleNs + (43 + 7 + microseconds) * 1'000};
    const LoggedBus logged(fault, 15);
    ASSERT_EQ(logged.frames().size(), 2U) << microseconds;
    for (const Received::Frame& frame : logged.frames()) {
      expect_sent_by(frame, 1);
      const std::int64_t left = (frame.record.end - frame.record.start).ns;
      EXPECT_NEAR(static_cast<double>(left), microseconds * 1'000.0, 1'000.0) << "clocks agree to a microsecond";
      const std::int64_t whole = left < 1'000 ? 0 : (left - 1'000) / 1'000;  // 100 ns a bit
      EXPECT_EQ(frame.bytes.size(), static_cast<std::size_t>(whole));
      EXPECT_EQ(frame.record.state, recording::records::ChannelState::kCoding | recording::records::ChannelState::kCut)
          << "no CRC that is there is wrong";
      const auto header = bus::wire::header_of(frame.bytes);
      EXPECT_EQ(header ? header->frame_id : 2, 2);
      EXPECT_GE(frame.bytes.size() + 1, before);
      before = frame.bytes.size();
    }
  }
  EXPECT_GT(before, 20U);
}

TEST(ChannelLog, OfWhatCollidesNothingIsLeft) {
  ttf::faults::Fault fault = fault_of(FaultKind::kMasquerading, 2, 10, 5);
  fault.slot = 2;
  const LoggedBus logged(fault, 20);
  // The node notices a cycle in its own slot, which comes after that one: its first additional frame is in
  // the next.
  ASSERT_EQ(logged.bus.acts(), 8U);
  ASSERT_EQ(logged.frames().size(), 16U);
  int of_the_owner = 0;
  for (const Received::Frame& frame : logged.frames()) {
    EXPECT_EQ(frame.record.state, recording::records::ChannelState::kCoding);
    EXPECT_TRUE(frame.bytes.empty());
    const bool of_nobody = frame.record.slot == 0;
    EXPECT_EQ(frame.record.sender, of_nobody ? NodeId{2} : NodeId{1});
    of_the_owner += of_nobody ? 0 : 1;
  }
  EXPECT_EQ(of_the_owner, 8);
  for (const int n : {0, 3}) EXPECT_EQ(logged.bus.said(n).count(2, bus::controller::kSyntaxError), 8);
}

TEST(ChannelLog, SignalsThatNoControllerSentAreThereToo) {
  ttf::faults::Fault fault = fault_of(FaultKind::kMasquerading, 2, 10, 5);
  fault.slot = 40;
  const LoggedBus logged(fault, 20);
  ASSERT_EQ(logged.frames().size(), 10U);
  for (const Received::Frame& frame : logged.frames()) {
    EXPECT_EQ(frame.record.sender, NodeId{2});
    EXPECT_EQ(frame.record.slot, 0);
    EXPECT_EQ(frame.record.state, recording::records::ChannelState::kSound);
    EXPECT_EQ(error_of(frame), bus::wire::FrameError::kNone);
    EXPECT_EQ(bus::wire::header_of(frame.bytes)->frame_id, 40);
  }
  ttf::faults::Fault noise = fault_of(FaultKind::kNoise, 0, 10, 5);
  noise.channels = schedules::model::Channels::kB;
  const LoggedBus noisy(noise, 20);
  EXPECT_GE(noisy.received.count(recording::records::ChannelState::kCoding), noisy.bus.acts());
  const auto bursts = std::count_if(noisy.frames().begin(), noisy.frames().end(), [&](const Received::Frame& frame) {
    return frame.record.sender == kNoNode && frame.record.slot == 0 && channel_of(frame) == Channel::kB &&
           frame.record.end - frame.record.start == noise.length;
  });
  EXPECT_EQ(static_cast<std::uint64_t>(bursts), noisy.bus.acts());
}

TEST(ChannelLog, FramesThatDoNotLeaveWereNowhere) {
  const LoggedBus logged(fault_of(FaultKind::kOmission, 1, 10, 5), 20);
  ASSERT_EQ(logged.frames().size(), 10U);
  for (const Received::Frame& frame : logged.frames()) {
    expect_sent_by(frame, 1);
    EXPECT_EQ(frame.record.state, recording::records::ChannelState::kNothing);
    EXPECT_TRUE(frame.bytes.empty());
  }
}

TEST(ChannelLog, AFrameOnTheOtherChannelFailsItsCrcThere) {
  const LoggedBus logged(fault_of(FaultKind::kChannelSwap, 1, 10, 5), 20);
  ASSERT_EQ(logged.frames().size(), 10U);
  for (const Received::Frame& frame : logged.frames()) {
    expect_sent_by(frame, 1);
    EXPECT_NE(frame.record.channel, frame.record.sent_channel);
    EXPECT_EQ(frame.record.state, recording::records::ChannelState::kFrameCrc);
    EXPECT_EQ(bus::wire::decode_frame(static_cast<Channel>(frame.record.sent_channel), frame.bytes).error,
              bus::wire::FrameError::kNone);
  }
}

TEST(ChannelLog, AFrameThatIsLateIsSoundAndLate) {
  ttf::faults::Fault fault = fault_of(FaultKind::kSosTiming, 1, 10, 5);
  fault.shift = Duration::microseconds(6);
  for (const bool star : {false, true}) {
    const LoggedBus logged(star ? star_of({fault}) : with({fault}), 20);
    ASSERT_EQ(logged.frames().size(), 10U);
    for (const Received::Frame& frame : logged.frames()) {
      expect_sent_by(frame, 1);
      // The guardian refuses a frame that is late by more than half an action point offset.
      EXPECT_EQ(frame.record.state,
                star ? recording::records::ChannelState::kNothing : recording::records::ChannelState::kSound);
      EXPECT_EQ(frame.record.start, frame.record.sent + fault.shift);
    }
  }
}

TEST(ChannelLog, ATransientLeavesNothingThatAnybodyMakesOut) {
  const LoggedBus logged(fault_of(FaultKind::kTransient, 0, 10, 3), 20);
  EXPECT_EQ(logged.frames().size(), 3U * 2 * 4);
  EXPECT_EQ(logged.received.count(recording::records::ChannelState::kCoding), 3U * 2 * 4);
}

TEST(ChannelLog, SignalsThatAGuardianBlocksReachNoNodeAndThoseItMakesOutAreSound) {
  ttf::faults::Fault own = fault_of(FaultKind::kMasquerading, 1, 10, 5);
  own.slot = 40;
  own.masquerade = ttf::faults::MasqueradeMode::kOwnSlot;
  const LoggedBus masked(star_of({own}), 20);
  EXPECT_EQ(masked.frames().size(), 10U);
  EXPECT_EQ(masked.received.count(recording::records::ChannelState::kNothing), 10U);

  ttf::faults::Fault babble = fault_of(FaultKind::kBabblingIdiot, 3, 10, 5);
  EXPECT_TRUE(LoggedBus(star_of({babble}), 8).frames().empty());
  const LoggedBus babbling(star_of({babble}), 20);
  for (const Received::Frame& frame : babbling.frames()) expect_sent_by(frame, 3);  // with which its own noise collides

  const LoggedBus misshapen(star_of({fault_of(FaultKind::kSosValue, 1, 10, 100)}), 120);
  EXPECT_EQ(misshapen.frames().size(), misshapen.received.count(recording::records::ChannelState::kNothing));
  EXPECT_EQ(misshapen.frames().size(), static_cast<std::size_t>(misshapen.bus.said(0).count(
                                           2, bus::controller::kSyntaxError | bus::controller::kNoFrame)));
}

// A coupler forwards everything, and a node crashes while its frame passes.
TEST(ChannelLog, ThroughAStarAFrameBreaksOffWhereItsSenderDoes) {
  ttf::faults::Fault fault = fault_of(FaultKind::kCrash, 1, 10);
  fault.from = Duration{10 * kCycleNs + (43 + 7 + 12) * 1'000};
  const LoggedBus logged(star_of({fault}), 15);
  ASSERT_EQ(logged.frames().size(), 2U);
  for (const Received::Frame& frame : logged.frames()) {
    expect_sent_by(frame, 1);
    EXPECT_EQ(frame.record.start, frame.record.sent) << "as at the sender, not at the coupler";
    EXPECT_EQ(frame.record.state, recording::records::ChannelState::kCoding | recording::records::ChannelState::kCut);
    EXPECT_NEAR(static_cast<double>(frame.bytes.size()), 11.0, 3.0);
  }
}

// 100 ms of noise with a burst of 10 us in every 100 us, beside the frames of four nodes.
TEST(ChannelLog, SignalsDrawnIntoALongNoiseAreReportedAsTheyEnd) {
  ttf::faults::Fault noise = fault_of(FaultKind::kNoise, -1, 10, 20);
  noise.length = noise.interval = Duration::milliseconds(100);
  ttf::faults::Fault babble = fault_of(FaultKind::kBabblingIdiot, 3, 10, 20);
  babble.length = Duration::microseconds(10);
  babble.interval = Duration::microseconds(100);
  noise.channels = babble.channels = schedules::model::Channels::kA;
  const LoggedBus logged(with({noise, babble}), 40);
  // The noise, 1000 bursts, four frames in each of 20 cycles.
  ASSERT_EQ(logged.frames().size(), 1U + 1000U + 4U * 20U);
  EXPECT_EQ(logged.received.count(recording::records::ChannelState::kCoding), logged.frames().size())
      << "nobody can make any of it out";
  for (std::size_t f = 1; f < logged.frames().size(); ++f)
    EXPECT_LE(logged.frames()[f - 1].record.end, logged.frames()[f].record.end + Duration::microseconds(3)) << "delays";
  for (int n = 0; n < 4; ++n)
    EXPECT_EQ(logged.bus.state(n), bus::poc::PocKind::kNormalActive) << "on the other channel";
}

TEST(ChannelLog, AFrameDrawnIntoALongNoiseBreaksOffWithItsSender) {
  ttf::faults::Fault noise = fault_of(FaultKind::kNoise, -1, 10, 10);
  noise.length = noise.interval = Duration::milliseconds(50);
  noise.channels = schedules::model::Channels::kA;
  ttf::faults::Fault crash = fault_of(FaultKind::kCrash, 2, 12);
  crash.from = Duration{12 * kCycleNs + 2 * 43'000 + 7'000 + 12'000};  // in its slot, the third
  const LoggedBus logged(with({noise, crash}), 40);
  const TrueTime breaks_off = TrueTime{1'000'000} + crash.from;
  std::size_t cut = 0;
  for (const Received::Frame& frame : logged.frames()) {
    if (frame.record.sender != NodeId{2} || frame.record.start < breaks_off - Duration{40'000}) continue;
    EXPECT_EQ(frame.record.end, breaks_off) << "channel " << static_cast<int>(frame.record.channel);
    ++cut;
  }
  EXPECT_EQ(cut, 2U) << "on both channels";
}

}  // namespace
}  // namespace ttf::sim::faults
