// Frames in another slot than their id's: only sufficiently precise stamps show them.
//
//   slot      4        5        6        7
//          |  4  |   [6]   |  dead  |   7  |      the owner of slot 5 bears slot 6's id
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/random.h"
#include "recording/capture/wrong_slots.h"
#include "tests/recording/capture/capture_verdict.h"

namespace ttf::recording::capture {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::int64_t kSlot = 84'000, kCycle = 5'000'000;  // of the paper's cluster [ns]

std::vector<BusFrame> without(std::vector<BusFrame> frames, int slot) {
  std::erase_if(frames, [&](const BusFrame& frame) { return frame.header.frame_id == slot; });
  return frames;
}

// Slot 6's owner is dead; slot 5's sends with id 6 in the cycles from 4 to 6.
std::vector<BusFrame> masquerade(int cycles = 12, std::int64_t ppm = 0) {
  std::vector<BusFrame> frames = without(scheduled_frames(paper(), cycles, 0, ppm), 6);
  for (BusFrame& frame : frames)
    if (frame.header.frame_id == 5 && frame.header.cycle >= 4 && frame.header.cycle <= 6) frame.header.frame_id = 6;
  return frames;
}

std::uint64_t missing_of_masquerade(int cycles) { return 2 * (static_cast<std::uint64_t>(cycles) + 3); }

std::uint64_t wrong_slots(const CaptureVerdict& verdict) {
  return verdict.counts[static_cast<std::size_t>(Contradiction::kWrongSlot)];
}

std::vector<BusFrame> stamped_by(std::vector<BusFrame> frames, const std::function<std::int64_t(std::int64_t)>& clock) {
  for (BusFrame& frame : frames) frame.time_ns = clock(frame.time_ns);
  return frames;
}

TEST(WrongSlot, AMasqueraderIsSeenInTheSlotItSendsIn) {
  const std::vector<BusFrame> frames = masquerade();
  const CaptureVerdict verdict = verdict_on(frames);
  EXPECT_EQ(verdict.counts,
            counts({{Contradiction::kWrongSlot, 6}, {Contradiction::kMissing, missing_of_masquerade(12)}}));
  std::vector<std::string> found;
  for (const CaptureFinding& finding : verdict.findings)
    if (finding.kind == Contradiction::kWrongSlot)
      found.push_back(std::to_string(finding.packet) + ": " + finding.text);
  std::vector<std::string> due;
  for (const int cycle : {4, 5, 6})
    for (const Channel channel : {Channel::kA, Channel::kB})
      due.push_back(packet(place_of(frames, 6, channel, cycle)) + "slot 6 on " + letter(channel) + ", cycle " +
                    std::to_string(cycle) + ": was sent in slot 5");
  EXPECT_EQ(found, due);
}

TEST(WrongSlot, AFrameInAnotherSlotIsMissingInItsOwnAndNoSecondOneHere) {
  std::vector<BusFrame> frames = scheduled_frames(paper(), 4);
  const std::size_t at = place_of(frames, 7, Channel::kA, 2);
  frames[at].header.frame_id = 6;
  EXPECT_THAT(texts(verdict_on(frames)), ElementsAre(packet(at - 1) + "slot 7 on A, cycle 2: has no frame",
                                                     packet(at) + "slot 6 on A, cycle 2: was sent in slot 7"));
  // The counter alone does not give its time.
  EXPECT_EQ(check_capture(without_stamps(frames), "bus.pcapng", paper(), {}).counts,
            counts({{Contradiction::kMissing, 1}, {Contradiction::kTwice, 1}}));
}

TEST(WrongSlot, AnIdFromTheOtherEndOfTheCycleIsNoErrorOfTheCycleCounter) {
  for (const auto& [slot, id] : {std::pair{21, 1}, std::pair{1, 21}}) {
    std::vector<BusFrame> frames = scheduled_frames(paper(), 8);
    const std::size_t at = place_of(frames, slot, Channel::kB, 4);
    frames[at].header.frame_id = static_cast<std::uint16_t>(id);
    const CaptureVerdict verdict = verdict_on(frames);
    EXPECT_EQ(verdict.counts, counts({{Contradiction::kWrongSlot, 1}, {Contradiction::kMissing, 1}})) << slot;
    EXPECT_THAT(texts(verdict), testing::Contains(HasSubstr("was sent in slot " + std::to_string(slot))));
  }
}

TEST(WrongSlot, TheCycleCounterOfAFrameInAWrongSlotIsCheckedToo) {
  std::vector<BusFrame> frames = without(scheduled_frames(paper(), 8), 6);
  const std::size_t at = place_of(frames, 21, Channel::kB, 4);
  frames[at].header.frame_id = 6;
  frames[at].header.cycle = 9;
  const std::string frame = packet(at) + "slot 6 on B, cycle 9: ";
  EXPECT_THAT(texts(verdict_on(frames)),
              testing::IsSupersetOf({frame + "was sent in slot 21", frame + "the cycle counter should be 4"}));
}

TEST(WrongSlot, AStaticFrameOutsideOfItsSegmentAndADynamicOneInItAreWrong) {
  std::vector<BusFrame> frames = scheduled_frames(paper(), 8);
  frames[place_of(frames, 21, Channel::kB, 4)].time_ns += 20 * kSlot;
  EXPECT_THAT(texts(verdict_on(frames)),
              testing::Contains(HasSubstr("slot 21 on B, cycle 4: was sent outside of the static segment")));

  frames = scheduled_frames(paper(), 8);
  const std::size_t at = place_of(frames, 21, Channel::kB, 4);
  frames[at].header.frame_id = 60;
  EXPECT_EQ(verdict_on(frames).counts,
            counts({{Contradiction::kWrongSlot, 1}, {Contradiction::kUnownedSlot, 1}, {Contradiction::kMissing, 1}}));
  frames[at].time_ns += 20 * kSlot;  // in the dynamic segment
  EXPECT_EQ(verdict_on(frames).counts, counts({{Contradiction::kUnownedSlot, 1}, {Contradiction::kMissing, 1}}));
}

TEST(WrongSlot, ASmallClusterIsEnough) {
  const schedules::model::Cluster demo = shipped_cluster("flexray_demo");  // six senders, some dynamic frames
  std::vector<BusFrame> frames = without(scheduled_frames(demo, 12), 6);
  for (BusFrame& frame : frames)
    if (frame.header.frame_id == 5 && frame.header.cycle >= 4 && frame.header.cycle <= 6) frame.header.frame_id = 6;
  EXPECT_EQ(wrong_slots(check_capture(capture_of(frames), "bus.pcapng", demo, {})), 6u);
}

// Either of two senders may be in the wrong slot.
TEST(WrongSlot, TwoSendersDoNotDecide) {
  schedules::model::Cluster two = paper();
  std::erase_if(two.frames, [](const schedules::model::FrameSlot& frame) { return frame.slot > 2; });
  std::vector<BusFrame> frames = scheduled_frames(two, 40);
  for (BusFrame& frame : frames)
    if (frame.header.frame_id == 2 && frame.header.cycle > 10) frame.time_ns += kSlot;
  EXPECT_EQ(wrong_slots(check_capture(capture_of(frames), "bus.pcapng", two, {})), 0u);
}

TEST(WrongSlot, ClocksMayDifferByWhatTwoClocksMay) {
  for (const std::int64_t ppm : {-3000, -1500, -100, 100, 1500, 3000}) {
    EXPECT_THAT(texts(verdict_on(scheduled_frames(paper(), 130, 0, ppm))), IsEmpty()) << ppm;
    EXPECT_EQ(verdict_on(masquerade(40, ppm)).counts,
              counts({{Contradiction::kWrongSlot, 6}, {Contradiction::kMissing, missing_of_masquerade(40)}}))
        << ppm;
  }
}

TEST(WrongSlot, AClockThatIsSetTripsNothing) {
  for (const std::int64_t by : {-kCycle / 3, -kSlot, kSlot, kSlot * 7 / 2, kCycle / 3}) {
    std::vector<BusFrame> frames = scheduled_frames(paper(), 20);
    const std::int64_t when = frames.front().time_ns + 7 * kCycle + kCycle / 2;
    frames = stamped_by(frames, [&](std::int64_t time) { return time < when ? time : time + by; });
    EXPECT_EQ(wrong_slots(verdict_on(frames)), 0u) << by;
  }
}

// Microseconds suffice for slots of 84 us. Milliseconds do not: the verdict is then that without stamps.
TEST(WrongSlot, CoarseStampsResolveWhatTheyCan) {
  const auto resolved = [](std::int64_t unit) { return [unit](std::int64_t time) { return time / unit * unit; }; };
  for (const std::int64_t ppm : {-1500, 0, 700}) {
    EXPECT_THAT(texts(verdict_on(stamped_by(scheduled_frames(paper(), 130, 0, ppm), resolved(1'000)))), IsEmpty());
    EXPECT_EQ(wrong_slots(verdict_on(stamped_by(masquerade(40, ppm), resolved(1'000)))), 6u);
    for (const std::int64_t unit : {100'000, 1'000'000, 10'000'000}) {
      const std::vector<BusFrame> sound = scheduled_frames(paper(), 130, 0, ppm);
      EXPECT_EQ(wrong_slots(verdict_on(stamped_by(sound, resolved(unit)))), 0u) << unit;
      EXPECT_EQ(wrong_slots(verdict_on(stamped_by(masquerade(40, ppm), resolved(unit)))), 0u) << unit;
    }
  }
}

TEST(WrongSlot, JitterOfAnySizeTripsNothing) {
  RandomStream stream({4, 0, Purpose::kTest, 3, 0});
  const std::vector<BusFrame> frames = scheduled_frames(paper(), 130);
  for (const double slots : {0.01, 0.03, 0.06, 0.08, 0.1, 0.12, 0.15, 0.2, 0.3, 0.5, 1.0, 3.0}) {
    const double most = slots * kSlot;
    const auto normal = [&](std::int64_t time) { return time + std::llround(most * stream.normal()); };
    EXPECT_EQ(wrong_slots(verdict_on(stamped_by(frames, normal))), 0u) << slots;
    const auto uniform = [&](std::int64_t time) { return time + std::llround(most * stream.uniform(-1.0, 1.0)); };
    EXPECT_EQ(wrong_slots(verdict_on(stamped_by(frames, uniform))), 0u) << slots;
  }
}

TEST(WrongSlot, AMasqueraderIsSeenInSpiteOfALittleJitter) {
  RandomStream stream({4, 0, Purpose::kTest, 4, 0});
  const auto jitter = [&](std::int64_t time) { return time + std::llround(0.05 * kSlot * stream.normal()); };
  EXPECT_EQ(wrong_slots(verdict_on(stamped_by(masquerade(), jitter))), 6u);
}

// One stamp in twenty is late by a slot or two, as from a busy program: at another frame's time.
TEST(WrongSlot, AStampAtAnotherFramesTimeIsAWrongStamp) {
  RandomStream stream({4, 0, Purpose::kTest, 5, 0});
  std::vector<BusFrame> frames = scheduled_frames(paper(), 130);
  for (std::size_t i = 0; i + 8 < frames.size(); i += static_cast<std::size_t>(stream.integer(10, 30)))
    if (frames[i].header.frame_id < 20) frames[i].time_ns += kSlot * stream.integer(1, 2);
  EXPECT_EQ(wrong_slots(verdict_on(frames)), 0u);
}

// ---- the pure judgement

std::vector<StampedFrame> stamped(const std::vector<BusFrame>& frames) {
  std::vector<StampedFrame> all;
  for (const BusFrame& frame : frames) all.push_back({frame.time_ns, frame.header.frame_id, frame.channel});
  return all;
}

TEST(WrongSlot, S1HalfASlotIsTheLimit) {
  const std::vector<StampedFrame> sound = stamped(without(scheduled_frames(paper(), 8), 10));
  const auto of_slot_9 = [](const StampedFrame& frame) { return frame.slot == 9; };
  const auto nth = static_cast<std::size_t>(std::find_if(sound.begin() + 100, sound.end(), of_slot_9) - sound.begin());
  for (std::int64_t late = -kSlot / 2 + 1'000; late <= 3 * kSlot / 2 - 1'000; late += 1'000) {
    std::vector<StampedFrame> frames = sound;
    frames[nth].time_ns += late;
    std::ranges::stable_sort(frames, {}, &StampedFrame::time_ns);
    const auto found = frames_in_wrong_slots(paper().flexray, frames);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const bool is_late = frames[i].time_ns == sound[nth].time_ns + late && frames[i].slot == 9 &&
                           frames[i].channel == sound[nth].channel;
      EXPECT_EQ(found[i], is_late && late >= kSlot / 2 ? std::optional(10) : std::nullopt) << late << " " << i;
    }
  }
}

TEST(WrongSlot, S3FewOrDisagreeingWitnessesSayNothing) {
  const std::vector<StampedFrame> all = stamped(masquerade(12));
  const auto first = std::find_if(all.begin(), all.end(), [](const StampedFrame& frame) { return frame.slot == 6; });
  for (const std::size_t around : {1u, 2u, 3u, 4u, 5u, 8u}) {
    const auto reach = static_cast<std::ptrdiff_t>(around);
    const std::vector<StampedFrame> few(first - reach, first + reach + 2);  // the pair itself is no witness
    const auto found = frames_in_wrong_slots(paper().flexray, few);
    EXPECT_EQ(found[around], 2 * around >= kLeastWitnesses ? std::optional(5) : std::nullopt) << around;
  }
  // Every third one is off by a fifth of a slot.
  std::vector<StampedFrame> apart = all;
  for (std::size_t i = 0; i < apart.size(); i += 3) apart[i].time_ns += kSlot / 5;
  EXPECT_THAT(frames_in_wrong_slots(paper().flexray, apart), Each(std::nullopt));
  EXPECT_THAT(frames_in_wrong_slots(paper().flexray, {}), IsEmpty());
}

}  // namespace
}  // namespace ttf::recording::capture
