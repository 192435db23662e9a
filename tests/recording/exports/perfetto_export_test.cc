// Perfetto traces from records with an exactly known result, and from records that no run can have.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "recording/exports/perfetto.h"
#include "tests/recording/exports/perfetto_trace.h"
#include "tests/recording/record_text.h"

namespace ttf::recording::exports {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

constexpr NodeId kLaser{0}, kFusion{1}, kFeature{2};
constexpr PduId kList{0}, kImage{1};
constexpr SensorId kSensor{0};
constexpr std::int64_t kMs = 1'000'000;

// Two sensors' worth of names; every instant is the same on all clocks.
struct Drive {
  std::string bytes;
  PerfettoExport trace{LogNames(manifest()), [this](std::string_view more) { bytes += more; }};
  TraceCounts counts;

  static log::LogManifest manifest() {
    log::LogManifest names;
    names.node_names = {"laser", "fusion", "feature"};
    names.task_names = {{"preprocess"}, {"fuse", "predict"}, {"assess"}};
    names.pdu_names = {"laser_objects", "image"};
    names.sensor_names = {"laser"};
    names.can_bus_names = {"laser_can"};
    return names;
  }
  static records::Stamp at(NodeId node, std::int64_t ns) { return {{ns}, {ns}, {ns}, node}; }

  void measured(std::uint32_t sequence, std::int64_t ns) {
    trace.on(records::Measured{at(kLaser, ns), {kSensor, sequence}, {}});
  }
  void can(std::uint32_t sequence, int fragment, std::int64_t start, std::int64_t end) {
    records::CanFrameSent sent;
    sent.start = at(kLaser, start);
    sent.end = at(kLaser, end);
    sent.pdu = kList;
    sent.sensor = kSensor;
    sent.sequence = sequence;
    sent.fragment = static_cast<std::uint8_t>(fragment);
    trace.on(sent);
  }
  void slot(NodeId node, PduId pdu, SensorId sensor, std::uint32_t sequence, std::uint8_t channel, std::int64_t start) {
    records::SlotFrameSent sent;
    sent.stamp = at(node, start);
    sent.end = at(node, start + 50'000);
    sent.slot = 7;
    sent.channel = channel;
    sent.pdu = pdu;
    sent.sensor = sensor;
    sent.sequence = sequence;
    trace.on(sent);
  }
  void hop(NodeId node, records::Hop hop, std::uint32_t sequence, std::int64_t ns) {
    trace.on(records::ListHop{at(node, ns), hop, kList, kSensor, sequence, -1});
  }
  void run(NodeId node, std::uint8_t task, std::int64_t start, std::int64_t end, bool in_time = true) {
    trace.on(records::TaskRun{at(node, start), task, at(node, start), at(node, end), in_time});
  }
  void fused(std::uint32_t sequence, records::Disposition what, std::int64_t ns) {
    trace.on(records::ListFused{at(kFusion, ns), 1, {kSensor, sequence}, {}, what});
  }
  void image(std::uint32_t number, std::uint32_t newest, std::int64_t measured_ns, std::int64_t ns) {
    const MeasurementId ids[]{{kSensor, newest}};
    trace.on(records::ImageWritten{at(kFusion, ns), number, {ns}, {measured_ns}, {}, ids});
  }
  void used(std::uint32_t number, std::int64_t ns) {
    records::FeatureUsed used;
    used.stamp = at(kFeature, ns);
    used.image_sequence = number;
    trace.on(used);
  }
  PerfettoTrace finished() {
    counts = trace.finish();
    return PerfettoTrace(bytes);
  }
};

// measured - two CAN frames - preprocessing - a slot, and again, on A and B - held - fused - image - its slot
// - used, twice
void drive_one_way(Drive& drive) {
  drive.measured(3, 1 * kMs);
  drive.can(3, 0, 2 * kMs, 2 * kMs + 100);
  drive.can(3, 1, 2 * kMs + 100, 2 * kMs + 300);
  drive.hop(kLaser, records::Hop::kRead, 3, 3 * kMs);
  drive.run(kLaser, 0, 3 * kMs, 5 * kMs);
  drive.hop(kLaser, records::Hop::kWritten, 3, 5 * kMs);
  drive.run(kLaser, 0, 5 * kMs, 6 * kMs);  // for another list: lists written then are not its output
  for (const std::int64_t when : {6, 8})
    for (const std::uint8_t channel : {0, 1}) drive.slot(kLaser, kList, kSensor, 3, channel, when * kMs);
  drive.fused(3, records::Disposition::kHeld, 10 * kMs);
  drive.run(kFusion, 0, 10 * kMs, 12 * kMs);
  drive.fused(3, records::Disposition::kFused, 20 * kMs);
  drive.run(kFusion, 0, 20 * kMs, 22 * kMs);
  drive.image(9, 3, 1 * kMs, 22 * kMs);
  drive.run(kFusion, 1, 22 * kMs, 23 * kMs);
  drive.slot(kFusion, kImage, kNoSensor, 9, 0, 23 * kMs + 100);
  for (const std::int64_t when : {30, 40}) {
    drive.used(9, when * kMs);
    drive.run(kFeature, 0, when * kMs, when * kMs + 1000, when == 30);
  }
}

TEST(PerfettoExport, AMeasurementsWayIsAFlowFromSensorToFeatureService) {
  Drive drive;
  drive_one_way(drive);
  const PerfettoTrace trace = drive.finished();
  EXPECT_THAT(trace.problems, IsEmpty());
  ASSERT_EQ(trace.flows.size(), 1u);
  EXPECT_THAT(trace.way(1),
              ElementsAre("measurements: laser 3", "laser_can: laser_objects 3", "laser_can: laser_objects 3",
                          "preprocess: preprocess", "channel A: laser_objects 3", "fuse: fuse", "fuse: fuse",
                          "predict: predict", "channel A: image 9", "assess: assess"));
  EXPECT_EQ(trace.slices[trace.flows.at(1).back()].begin, 30u * kMs);
  EXPECT_EQ(drive.counts.flows, 1u);
}

TEST(PerfettoExport, SlicesSayWhatTheyDidAndWhose) {
  Drive drive;
  drive_one_way(drive);
  const PerfettoTrace trace = drive.finished();
  std::map<std::string, std::map<std::string, std::string>> notes;
  for (const auto& slice : trace.slices)
    notes[slice.lane + " " + std::to_string(slice.begin)].insert(slice.notes.begin(), slice.notes.end());
  EXPECT_THAT(notes["preprocess 3000000"], Contains(Pair("reads", "laser 3")));
  EXPECT_THAT(notes["preprocess 3000000"], Contains(Pair("writes", "laser 3")));
  EXPECT_THAT(notes["preprocess 5000000"], IsEmpty());
  EXPECT_THAT(notes["fuse 10000000"], Contains(Pair("holds back", "laser 3")));
  EXPECT_THAT(notes["fuse 20000000"], Contains(Pair("fuses", "laser 3")));
  EXPECT_THAT(notes["predict 22000000"], Contains(Pair("writes image", "9")));
  EXPECT_THAT(notes["assess 40000000"], Contains(Pair("uses image", "9")));
  EXPECT_THAT(notes["channel B 6000000"], Contains(Pair("measurement", "laser 3")));
  EXPECT_THAT(notes["channel B 6000000"], Contains(Pair("slot", "7")));
}

TEST(PerfettoExport, AgesAndCorrectionsAreCounters) {
  Drive drive;
  drive_one_way(drive);
  records::ClockCorrected corrected;
  corrected.stamp = Drive::at(kFusion, 50 * kMs);
  corrected.offset_microticks = -3;
  corrected.rate_microticks = 2;
  corrected.rate_limited = true;
  drive.trace.on(corrected);
  drive.trace.on(records::PrecisionSample{{50 * kMs}, 5, Duration{250}});
  const PerfettoTrace trace = drive.finished();
  EXPECT_THAT(trace.problems, IsEmpty());
  std::vector<std::string> values;
  for (const auto& value : trace.values)
    values.push_back(fmt::format("{}: {} {}", value.group, value.counter, value.value));
  EXPECT_THAT(values, ElementsAre("feature: age of the newest measurement when used [ms] 29",
                                  "feature: age of the newest measurement when used [ms] 39",
                                  "fusion: offset correction [microticks] -3", "fusion: rate correction [microticks] 2",
                                  "FlexRay: precision [us] 0.25"));
  EXPECT_EQ(trace.count("clock synchronisation"), 1u);
}

TEST(PerfettoExport, AListsWayEndsWhereItIsLostAndMissesAreMarked) {
  Drive drive;
  drive.measured(3, 1 * kMs);
  drive.can(3, 0, 2 * kMs, 3 * kMs);
  drive.hop(kLaser, records::Hop::kOverwritten, 3, 4 * kMs);
  drive.measured(4, 5 * kMs);  // without further steps
  drive.run(kFeature, 0, 6 * kMs, 7 * kMs, false);
  const PerfettoTrace trace = drive.finished();
  EXPECT_THAT(trace.problems, IsEmpty());
  ASSERT_EQ(trace.flows.size(), 1u);
  EXPECT_EQ(trace.way(1).back(), "lost lists: laser_objects 3 overwritten");
  EXPECT_THAT(trace.slices.back().name, "deadline missed");
}

// ISO 11898-1, 12.1.4: a transmitter counts 8 for each error. With the 16th it has 128 and is error passive, with the 32nd
// 256 and is bus off. A receiver counts 1. In a damaged log an error may have no words.
TEST(PerfettoExport, ErrorFramesAndStatesOfACanAreMarkedInItsLane) {
  Drive drive;
  drive.can(3, 0, 1 * kMs, 2 * kMs);
  using records::CanError, records::CanState;
  drive.trace.on(records::CanErrorFrame{Drive::at(kLaser, 3 * kMs), 0, CanError::kBit, true, 8 * 16, 0});
  drive.trace.on(
      records::CanStateChanged{Drive::at(kLaser, 3 * kMs), 0, CanState::kActive, CanState::kPassive, 128, 0});
  drive.trace.on(records::CanErrorFrame{Drive::at(kFusion, 4 * kMs), 0, CanError::kCrc, false, 0, 1});
  drive.trace.on(
      records::CanStateChanged{Drive::at(kLaser, 5 * kMs), 0, CanState::kPassive, CanState::kBusOff, 256, 0});
  drive.trace.on(records::CanErrorFrame{Drive::at(kFusion, 6 * kMs), 1, static_cast<CanError>(9), false, 0, 2});
  const PerfettoTrace trace = drive.finished();
  EXPECT_THAT(trace.problems, IsEmpty());
  EXPECT_EQ(drive.counts.instants, 5u);
  std::vector<std::string> marks;
  for (const auto& slice : trace.slices) {
    std::string notes;
    for (const auto& [name, value] : slice.notes) notes += fmt::format("; {} {}", name, value);
    if (slice.begin == slice.end)
      marks.push_back(
          fmt::format("{}, {}, {} ms: {}{}", slice.group, slice.lane, slice.begin / kMs, slice.name, notes));
  }
  EXPECT_THAT(
      marks,
      ElementsAre(
          "CAN, laser_can, 3 ms: bit error; detected as transmitter; node laser; receive errors 0; transmit errors 128",
          "CAN, laser_can, 3 ms: laser: error passive; from error active; node laser; receive errors 0; transmit "
          "errors 128",
          "CAN, laser_can, 4 ms: CRC error; detected as receiver; node fusion; receive errors 1; transmit errors 0",
          "CAN, laser_can, 5 ms: laser: bus off; from error passive; node laser; receive errors 0; transmit errors 256",
          "CAN, can 1, 6 ms: error 9; detected as receiver; node fusion; receive errors 2; transmit errors 0"));
}

TEST(PerfettoExport, FaultsLastFromTheirBeginToTheirEndOrThatOfTheRun) {
  Drive drive;
  const auto fault = [&](std::uint32_t number, records::FaultAct what, std::int64_t at) {
    drive.trace.on(records::FaultActivity{{at}, number, what, kLaser, "omission", "leaves out a frame"});
  };
  fault(0, records::FaultAct::kBegins, 10 * kMs);
  fault(1, records::FaultAct::kBegins, 10 * kMs);
  fault(0, records::FaultAct::kActs, 12 * kMs);
  fault(0, records::FaultAct::kEnds, 9'000 * kMs);
  drive.measured(1, 20'000 * kMs);
  const PerfettoTrace trace = drive.finished();
  EXPECT_THAT(trace.problems, IsEmpty());
  EXPECT_EQ(trace.count("fault 0: omission"), 2u);
  EXPECT_EQ(trace.slices[0].end, 9'000u * kMs + 1);
  EXPECT_GT(trace.slices[1].end, 20'000u * kMs);
}

TEST(PerfettoExport, AnOverlappingRunGoesBesideTheOthers) {
  Drive drive;
  drive.run(kFusion, 0, 10 * kMs, 20 * kMs);
  drive.run(kFusion, 0, 15 * kMs, 25 * kMs);
  drive.run(kFusion, 0, 20 * kMs, 21 * kMs);
  drive.run(kFusion, 0, 30 * kMs, 30 * kMs);      // no length
  drive.run(kFusion, 0, 31 * kMs, 31'000 * kMs);  // none that a task can have
  const PerfettoTrace trace = drive.finished();
  EXPECT_THAT(trace.problems, IsEmpty());
  EXPECT_EQ(trace.count("fuse"), 4u);
  EXPECT_EQ(trace.count("fuse (2)"), 1u);
}

TEST(PerfettoExport, ASensorThatCountsAnewBeginsNewWays) {
  Drive drive;
  for (const std::int64_t when : {0, 200}) {
    drive.measured(0, when * kMs + 1);
    drive.can(0, 0, (when + 1) * kMs, (when + 2) * kMs);
  }
  const PerfettoTrace trace = drive.finished();
  EXPECT_THAT(trace.problems, IsEmpty());
  ASSERT_EQ(trace.flows.size(), 2u);
  EXPECT_EQ(trace.way(1).size(), 2u);
  EXPECT_EQ(trace.way(2).size(), 2u);
}

// Memory keeps only the last seconds.
TEST(PerfettoExport, IsWrittenWhileTheDriveGoesOn) {
  Drive drive;
  for (std::uint32_t n = 0; n < 2000; ++n) {
    drive.measured(n, n * 20 * kMs);
    drive.can(n, 0, n * 20 * kMs + 1000, n * 20 * kMs + 9000);
  }
  const std::size_t before = drive.bytes.size();
  const PerfettoTrace trace = drive.finished();
  EXPECT_THAT(trace.problems, IsEmpty());
  EXPECT_EQ(trace.flows.size(), 2000u);
  EXPECT_GT(static_cast<double>(before), 0.95 * static_cast<double>(drive.bytes.size()));
}

// Any damaged log, in any order, makes a valid trace.
TEST(PerfettoExport, RecordsNoRunCanHaveStillMakeATrace) {
  Drive drive;
  std::uint32_t n = 0;
  for (const Values values : {Values::kSmallest, Values::kZero, Values::kDrawn, Values::kLargest, Values::kDrawn})
    for (int round = 0; round < 20; ++round)
      for (int kind = 1; kind <= static_cast<int>(records::kKindCount); ++kind, ++n)
        emit(drive.trace, kind, values, n, std::int64_t{n} * 3 * kMs);
  const PerfettoTrace trace = drive.finished();
  EXPECT_THAT(trace.problems, IsEmpty());
  EXPECT_GT(trace.slices.size(), 500u);
}

}  // namespace
}  // namespace ttf::recording::exports
