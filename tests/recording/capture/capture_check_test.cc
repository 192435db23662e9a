// Captures against the schedule: a correct bus, and one capture with each kind of contradiction.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/wire/flexray_crc.h"
#include "core/errors.h"
#include "tests/recording/capture/capture_verdict.h"

namespace ttf::recording::capture {
namespace {

using testing::ContainsRegex;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(CaptureCheck, ABusThatObeysItsScheduleContradictsNothing) {
  for (const int first : {0, 1, 60})
    for (const int ppm : {-1500, 0, 1500}) {
      const CaptureVerdict verdict = verdict_on(scheduled_frames(paper(), 130, first, ppm));
      EXPECT_EQ(verdict.contradictions(), 0u);
      EXPECT_THAT(texts(verdict), IsEmpty());
      EXPECT_EQ(verdict.cycles, 130);
      EXPECT_GT(verdict.frames, 130u * 42);
    }
}

TEST(CaptureCheck, EveryShippedScheduleHolds) {
  for (const char* name : {"paper_unsynchronised", "laser_radar", "laser_radar_synchronised"}) {
    const schedules::model::Cluster other = shipped_cluster(name);
    const Capture capture = capture_of(scheduled_frames(other, 70));
    EXPECT_EQ(check_capture(capture, "bus.pcapng", other, {}).contradictions(), 0u) << name;
  }
}

TEST(CaptureCheck, AWindowOfACaptureIsCheckedFromItsFirstToItsLastFrame) {
  std::vector<BusFrame> frames = scheduled_frames(paper(), 6);
  frames.erase(frames.begin(), frames.begin() + 17);
  frames.erase(frames.end() - 13, frames.end());
  EXPECT_THAT(texts(verdict_on(frames)), IsEmpty());
}

TEST(CaptureCheck, AMissingFrameIsNamedAfterThePacketBeforeIt) {
  std::vector<BusFrame> frames = scheduled_frames(paper(), 10);
  const std::size_t at = place_of(frames, 9, Channel::kB, 4);
  frames.erase(frames.begin() + static_cast<std::ptrdiff_t>(at));
  const CaptureVerdict verdict = verdict_on(frames);
  EXPECT_EQ(verdict.counts, counts({{Contradiction::kMissing, 1}}));
  // The pair of slot 8 comes before; the frame of slot 9 on A belongs to no earlier slot.
  EXPECT_THAT(texts(verdict), ElementsAre(packet(at - 2) + "slot 9 on B, cycle 4: has no frame"));
}

TEST(CaptureCheck, SilentCyclesAreMissingWhole) {
  std::vector<BusFrame> frames = scheduled_frames(paper(), 200, 62);
  const std::size_t before = frames.size();
  const std::int64_t start = frames[0].time_ns;
  std::erase_if(frames, [&](const BusFrame& frame) {
    const auto cycle = (frame.time_ns - start) / paper().cycle().ns;
    return cycle >= 3 && cycle < 3 + 100;
  });
  const CaptureVerdict verdict = verdict_on(frames);
  EXPECT_EQ(verdict.counts, counts({{Contradiction::kMissing, before - frames.size()}}));
  ASSERT_EQ(verdict.findings.size(), 1u);
  EXPECT_THAT(verdict.findings[0].text, HasSubstr("cycles from 1 on: 100 without a single frame"));
  EXPECT_EQ(verdict.cycles, 200);
}

TEST(CaptureCheck, AFrameInASlotNobodyOwns) {
  std::vector<BusFrame> frames = scheduled_frames(paper(), 4);
  const std::size_t at = place_of(frames, 1, Channel::kA, 2);
  BusFrame stray = frames[at - 1];
  stray.header.frame_id = 38;
  frames.insert(frames.begin() + static_cast<std::ptrdiff_t>(at), stray);
  EXPECT_THAT(texts(verdict_on(frames)), ElementsAre(packet(at) + "slot 38 on B, cycle 1: the slot has no owner"));
}

// Another tool's schedule: a dynamic frame that carries no list of ours.
TEST(CaptureCheck, AForeignFrameOfTheDynamicSegmentHasAnOwner) {
  schedules::model::Cluster foreign = paper();
  schedules::model::FrameSlot slot;
  slot.slot = foreign.flexray.gNumberOfStaticSlots + 5;
  slot.payload_bytes = 8;
  foreign.frames.push_back(slot);
  std::vector<BusFrame> frames = scheduled_frames(paper(), 4);
  const std::size_t at = place_of(frames, 1, Channel::kA, 2);
  BusFrame sent = frames[at - 1];
  sent.header.frame_id = static_cast<std::uint16_t>(slot.slot);
  sent.payload.resize(8);
  sent.time_ns = frames[at].time_ns - 1'000'000;
  frames.insert(frames.begin() + static_cast<std::ptrdiff_t>(at), sent);
  EXPECT_THAT(texts(verdict_on(frames)), ElementsAre(HasSubstr("the slot has no owner")));
  EXPECT_THAT(texts(check_capture(capture_of(frames), "bus.pcapng", foreign, {})), IsEmpty());
}

TEST(CaptureCheck, AFrameOnTheWrongChannel) {
  schedules::model::Cluster one_channel = paper();
  for (schedules::model::FrameSlot& frame : one_channel.frames)
    if (frame.slot == 3) frame.channels = schedules::model::Channels::kA;
  std::vector<BusFrame> frames = scheduled_frames(one_channel, 4);
  const std::size_t at = place_of(frames, 3, Channel::kA, 1);
  frames[at].channel = Channel::kB;
  const CaptureVerdict verdict = check_capture(capture_of(frames), "bus.pcapng", one_channel, {});
  EXPECT_THAT(texts(verdict), ElementsAre(packet(at - 1) + "slot 3 on A, cycle 1: has no frame",
                                          packet(at) + "slot 3 on B, cycle 1: the slot's owner sends on A only"));
}

TEST(CaptureCheck, AFrameInACycleThatIsNotItsOwn) {
  std::vector<BusFrame> frames = scheduled_frames(paper(), 4);
  const std::size_t at = place_of(frames, 1, Channel::kA, 3);
  BusFrame stray = frames[at - 1];  // from cycle 2; the image is sent in cycle 1, 9, ...
  stray.header.frame_id = 22;
  frames.insert(frames.begin() + static_cast<std::ptrdiff_t>(at), stray);
  const CaptureVerdict verdict = verdict_on(frames);
  EXPECT_EQ(verdict.counts, counts({{Contradiction::kWrongCycle, 1}}));
  EXPECT_EQ(verdict.findings.at(0).packet, at + 1);
}

TEST(CaptureCheck, OneWrongCycleCounterIsOneContradiction) {
  for (const int wrong : {0, 3, 5, 36, 63}) {
    std::vector<BusFrame> frames = scheduled_frames(paper(), 10);
    const std::size_t at = place_of(frames, 2, Channel::kB, 4);
    frames[at].header.cycle = static_cast<std::uint8_t>(wrong);
    EXPECT_THAT(texts(verdict_on(frames)), ElementsAre(packet(at) + "slot 2 on B, cycle " + std::to_string(wrong) +
                                                       ": the cycle counter should be 4"));
  }
}

TEST(CaptureCheck, ACounterThatJumpsForGoodIsInErrorForOneCycle) {
  std::vector<BusFrame> frames = scheduled_frames(paper(), 12, 8);
  std::uint64_t of_the_cycle = 0;
  const std::size_t at = place_of(frames, 1, Channel::kA, 12);
  const std::size_t next = place_of(frames, 1, Channel::kA, 13);
  for (std::size_t i = at; i < frames.size(); ++i) {
    frames[i].header.cycle = static_cast<std::uint8_t>(frames[i].header.cycle + 16);  // the same multiplexing
    of_the_cycle += i <= next ? 1 : 0;
  }
  const CaptureVerdict verdict = verdict_on(frames);
  EXPECT_EQ(verdict.counts, counts({{Contradiction::kCycleCounter, of_the_cycle}}));
  EXPECT_EQ(verdict.findings.at(0).packet, at + 1);
}

TEST(CaptureCheck, APayloadOfAnotherLength) {
  std::vector<BusFrame> frames = scheduled_frames(paper(), 4);
  frames[60].payload.resize(20);
  const CaptureVerdict verdict = verdict_on(frames);
  EXPECT_EQ(verdict.counts, counts({{Contradiction::kPayloadLength, 1}}));
  EXPECT_THAT(texts(verdict).at(0), HasSubstr("61: slot "));
  EXPECT_THAT(texts(verdict).at(0), HasSubstr("the payload has 10 words, not 28"));
}

TEST(CaptureCheck, APacketThatWasCutWhenCaptured) {
  std::string bytes;
  const exports::CaptureInterface interface { LinkType::kFlexRay, "" };
  exports::CaptureWriter writer(bytes, {&interface, 1}, "");
  const std::vector<BusFrame> frames = scheduled_frames(paper(), 2);
  for (std::size_t i = 0; i < frames.size(); ++i)
    writer.packet(0, frames[i].time_ns, frames[i].packet().substr(0, i == 10 ? 40 : i == 12 ? 5 : 400), "");
  const CaptureVerdict verdict = check_capture(parse_capture(bytes, "bus.pcapng"), "bus.pcapng", paper(), {});
  EXPECT_EQ(verdict.counts,
            counts({{Contradiction::kPayloadLength, 1}, {Contradiction::kMalformed, 1}, {Contradiction::kMissing, 1}}));
}

TEST(CaptureCheck, AFlaggedFrameWithoutAHeaderIsACodingErrorAndMissingInItsSlot) {
  std::vector<BusFrame> frames = scheduled_frames(paper(), 6);
  const std::size_t at = place_of(frames, 12, Channel::kB, 3);
  frames[at].errors = kCodingError;
  const exports::CaptureInterface interface { LinkType::kFlexRay, "FlexRay" };
  for (const std::size_t bytes_left : {2u, 4u, 6u}) {
    std::string bytes;
    exports::CaptureWriter writer(bytes, {&interface, 1}, "");
    for (std::size_t i = 0; i < frames.size(); ++i)
      writer.packet(0, frames[i].time_ns, frames[i].packet().substr(0, i == at ? bytes_left : 400), "");
    const CaptureVerdict verdict = check_capture(parse_capture(bytes, "bus.pcapng"), "bus.pcapng", paper(), {});
    EXPECT_EQ(verdict.counts, counts({{Contradiction::kCoding, 1}, {Contradiction::kMissing, 1}}));
    EXPECT_THAT(texts(verdict),
                testing::Contains(packet(at) + "on B: coding errors are flagged (0x02), and there is no header"));
  }
}

TEST(CaptureCheck, ADamagedHeaderIsFoundWithoutTheCapturesFlagAndNotMissingBesides) {
  const std::vector<BusFrame> frames = scheduled_frames(paper(), 6);
  for (const int slot : {1, 12}) {
    const std::size_t at = place_of(frames, slot, Channel::kA, 3);
    std::string bytes = capture_bytes(frames);
    const std::size_t packet_at = bytes.find(frames[at].packet());
    ASSERT_NE(packet_at, std::string::npos);
    bytes[packet_at + 5] ^= 0x40;  // in the header CRC
    const CaptureVerdict verdict = check_capture(parse_capture(bytes, "bus.pcapng"), "bus.pcapng", paper(), {});
    EXPECT_EQ(verdict.counts, counts({{Contradiction::kHeaderCrc, 1}}));
    EXPECT_EQ(verdict.findings.at(0).packet, at + 1);
    EXPECT_THAT(verdict.findings.at(0).text, ContainsRegex("the header CRC 0x[0-9a-f]+ does not hold"));
  }
}

TEST(CaptureCheck, ErrorsThatTheCaptureFlags) {
  std::vector<BusFrame> frames = scheduled_frames(paper(), 4);
  frames[5].errors = kFrameCrcError;
  frames[6].errors = kHeaderCrcError;
  frames[7].errors = kTssViolation;
  frames[8].errors = kCodingError | kFrameEndError;
  EXPECT_THAT(texts(verdict_on(frames)),
              ElementsAre(HasSubstr("6: slot 3 on B, cycle 0: the frame CRC is flagged as wrong"),
                          HasSubstr("7: slot 4 on A, cycle 0: the header CRC is flagged"),
                          HasSubstr("8: slot 4 on B, cycle 0: coding errors are flagged (0x01)"),
                          HasSubstr("9: slot 5 on A, cycle 0: coding errors are flagged (0x06)")));
}

TEST(CaptureCheck, AStartupFrameThatIsNoSyncFrame) {
  std::vector<BusFrame> frames = scheduled_frames(paper(), 4);
  const std::size_t at = place_of(frames, 2, Channel::kA, 1);
  std::string bytes = capture_bytes(frames);
  frames[at].header.sync = frames[at].header.startup = false;
  // The indicators 0 and 1 with the header CRC that goes with them.
  std::string header = frames[at].packet();
  const std::uint32_t crc =
      bus::wire::header_crc(false, true, 2, static_cast<std::uint8_t>(frames[at].payload.size() / 2));
  header[2] = static_cast<char>(header[2] | 0x08);
  header[4] = static_cast<char>((header[4] & 0xfe) | (crc >> 10));
  header[5] = static_cast<char>(crc >> 2);
  header[6] = static_cast<char>((header[6] & 0x3f) | (crc << 6));
  std::vector<BusFrame> sound = scheduled_frames(paper(), 4);
  bytes.replace(bytes.find(sound[at].packet()), header.size(), header);
  const CaptureVerdict verdict = check_capture(parse_capture(bytes, "bus.pcapng"), "bus.pcapng", paper(), {});
  EXPECT_THAT(texts(verdict), ElementsAre(packet(at) + "slot 2 on A, cycle 1: is a startup frame, but no sync frame"));
}

TEST(CaptureCheck, OneChannelAloneIsCheckedWhenAskedFor) {
  std::vector<BusFrame> frames = scheduled_frames(paper(), 4);
  const std::size_t of_b = std::erase_if(frames, [](const BusFrame& frame) { return frame.channel == Channel::kB; });
  // All except those beside the first and the last frame, where the capture may have begun and ended.
  EXPECT_EQ(verdict_on(frames).counts, counts({{Contradiction::kMissing, of_b - 2}}));
  CaptureCheckOptions options;
  options.channels = schedules::model::Channels::kA;
  EXPECT_THAT(texts(verdict_on(frames, options)), IsEmpty());
}

TEST(CaptureCheck, AWindowLeavesAStartUpOut) {
  std::vector<BusFrame> frames = scheduled_frames(paper(), 20);
  std::erase_if(frames, [&](const BusFrame& frame) { return frame.header.cycle < 6 && frame.header.frame_id > 1; });
  EXPECT_GT(verdict_on(frames).contradictions(), 0u);
  CaptureCheckOptions options;
  options.from_ns = 6 * paper().cycle().ns;
  options.to_ns = 16 * paper().cycle().ns;
  const CaptureVerdict verdict = verdict_on(frames, options);
  EXPECT_THAT(texts(verdict), IsEmpty());
  EXPECT_EQ(verdict.cycles, 10);
}

TEST(CaptureCheck, PacketsOutOfOrderAndWithoutStampsAreCheckedToo) {
  std::vector<BusFrame> frames = scheduled_frames(paper(), 20);
  std::ranges::reverse(frames);
  EXPECT_EQ(verdict_on(frames).contradictions(), 0u);
  std::ranges::reverse(frames);
  const CaptureVerdict verdict = check_capture(without_stamps(frames), "bus.pcapng", paper(), {});
  EXPECT_THAT(texts(verdict), IsEmpty());
  EXPECT_EQ(verdict.cycles, 20);
}

TEST(CaptureCheck, NothingIsSaidOfACaptureWithoutFlexRayFrames) {
  EXPECT_THROW(verdict_on({}), InputError);
  const exports::CaptureInterface interface { LinkType::kCan, "can0" };
  std::string bytes;
  exports::CaptureWriter writer(bytes, {&interface, 1}, "");
  writer.packet(0, 0, scheduled_frames(paper(), 1)[0].packet(), "");
  EXPECT_THROW(check_capture(parse_capture(bytes, "bus.pcapng"), "bus.pcapng", paper(), {}), InputError);
}

TEST(CaptureCheck, FindingsAreCountedBeyondThoseThatAreListed) {
  std::vector<BusFrame> frames = scheduled_frames(paper(), 60);
  for (BusFrame& frame : frames) frame.errors = kFrameCrcError;
  const CaptureVerdict verdict = verdict_on(frames);
  EXPECT_EQ(verdict.contradictions(), frames.size());
  EXPECT_EQ(verdict.findings.size(), kMostFindings);
}

}  // namespace
}  // namespace ttf::recording::capture
