#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "report/timing/diagram.h"
#include "report/timing/transfers.h"
#include "report/timing/ways.h"
#include "tests/report/layout.h"
#include "tests/report/synthetic_drive.h"
#include "tests/support/patterns.h"

namespace ttf::report::timing {
namespace {

using recording::records::Disposition;

std::string timing_diagram(std::int64_t from_ms, std::int64_t to_ms) {
  TimingDiagram d(synthetic_names(), Duration::milliseconds(5), at_us(from_ms * 1000), at_us(to_ms * 1000));
  SyntheticDrive{}.drive(d, 1'500'000);
  return d.svg();
}

TEST(TimingDiagram, HasALaneForEverythingThatTakesPart) {
  const std::string svg = timing_diagram(200, 350);
  for (const char* lane :
       {"laser", "camera", "laser_can", "camera_can", "object_can", "laser_pc: extract", "camera_pc: extract",
        "gateway: forward_laser", "FlexRay A", "FlexRay B", "fusion: track", "fusion: image", "feature: serve"})
    EXPECT_EQ(count(svg, std::string(">") + lane + "</text>"), 1u) << lane;
  EXPECT_NE(svg.find("true time [ms]"), std::string::npos);
}

TEST(TimingDiagram, LanesFollowTheWayOfAMeasurement) {
  const std::string svg = timing_diagram(200, 350);
  std::size_t before = 0;
  for (const char* lane :
       {">laser</text>", ">laser_device: emulate<", ">laser_can<", ">laser_pc: extract<", ">object_can<",
        ">gateway: forward_laser<", ">FlexRay A<", ">FlexRay B<", ">fusion: track<", ">feature: serve<"}) {
    const std::size_t at = svg.find(lane);
    ASSERT_NE(at, std::string::npos) << lane;
    EXPECT_GT(at, before) << lane;
    before = at;
  }
}

TEST(TimingDiagram, NumbersTheCyclesOfTheWindow) {
  const std::string svg = timing_diagram(200, 350);
  for (int cycle = 40; cycle < 70; ++cycle)
    EXPECT_EQ(count(svg, fmt::format("fill=\"#444444\">{}</text>", cycle)), 1u) << cycle;
  EXPECT_EQ(count(svg, ">70</text>"), 0u);
}

// A startup frame of cycle 3, sent at 202 ms by a node without global time: its local time stands in.
TEST(TimingDiagram, FramesSentWithoutGlobalTimeSayNothingOfTheCycles) {
  TimingDiagram d(synthetic_names(), Duration::milliseconds(5), at_us(200'000), at_us(350'000));
  recording::records::SlotFrameSent early;
  early.stamp = {at_us(202'000), {202'000'000}, {202'000'000}, NodeId{5}};
  early.end = {at_us(202'074), {202'074'000}, {202'074'000}, NodeId{5}};
  early.cycle = 3;
  early.slot = 1;
  d.on(early);
  SyntheticDrive{}.drive(d, 1'500'000);
  const std::string svg = d.svg();
  for (int cycle = 40; cycle < 70; ++cycle)
    EXPECT_EQ(count(svg, fmt::format("fill=\"#444444\">{}</text>", cycle)), 1u) << cycle;
  EXPECT_EQ(count(svg, "fill=\"#444444\">3</text>"), 0u);
}

// Restarts nodes: from then on they count `rounds` less.
class Restarted final : public recording::records::Sink {
 public:
  Restarted(recording::records::Sink& out, std::vector<NodeId> nodes, TrueTime at, std::int64_t rounds,
            std::int64_t cycles = 64)
      : out_(out), nodes_(std::move(nodes)), at_(at), less_(rounds * cycles) {}
  using recording::records::Sink::on;
  void on(const recording::records::SlotFrameSent& r) override {
    recording::records::SlotFrameSent frame = r;
    if (r.stamp.true_time >= at_ && std::find(nodes_.begin(), nodes_.end(), r.stamp.node) != nodes_.end()) {
      frame.cycle -= less_;
      frame.stamp.global.ns -= less_ * 5'000'000;
    }
    out_.on(frame);
  }

 private:
  recording::records::Sink& out_;
  std::vector<NodeId> nodes_;
  TrueTime at_;
  std::int64_t less_;  // cycles
};

// Node 4 sends the first slot of every cycle; the numbers are still those of the others.
TEST(TimingDiagram, ARestartedNodeDoesNotNumberTheCycles) {
  for (const auto& nodes : {std::vector{NodeId{4}}, std::vector{NodeId{4}, NodeId{6}}})
    for (const int restarted_ms : {0, 100, 640, 720}) {
      SCOPED_TRACE(restarted_ms);
      TimingDiagram d(synthetic_names(), Duration::milliseconds(5), at_us(600'000), at_us(750'000));
      Restarted some(d, nodes, at_us(restarted_ms * 1000), 2);
      SyntheticDrive{}.drive(some, 1'500'000);
      const std::string svg = d.svg();
      for (int cycle = 120; cycle < 150; ++cycle)
        EXPECT_EQ(count(svg, fmt::format("fill=\"#444444\">{}</text>", cycle)), 1u) << cycle;
      EXPECT_EQ(count(svg, "fill=\"#444444\">0</text>"), 0u);
    }
}

TEST(TimingDiagram, ARoundMayBeOfSixtyCycles) {
  drawing::Names names = synthetic_names();
  names.cycles = 60;
  TimingDiagram d(names, Duration::milliseconds(5), at_us(600'000), at_us(750'000));
  Restarted some(d, {NodeId{4}}, at_us(100'000), 2, 60);
  SyntheticDrive{}.drive(some, 1'500'000);
  const std::string svg = d.svg();
  for (int cycle = 120; cycle < 150; ++cycle)
    EXPECT_EQ(count(svg, fmt::format("fill=\"#444444\">{}</text>", cycle)), 1u) << cycle;
}

// All restart: the old count is gone, and cycles before the new cycle 0 have no number.
TEST(TimingDiagram, WhereAllStartAnewTheNumbersAreTheirs) {
  TimingDiagram d(synthetic_names(), Duration::milliseconds(5), at_us(600'000), at_us(750'000));
  Restarted all(d, {NodeId{4}, NodeId{5}, NodeId{6}}, at_us(0), 2);
  SyntheticDrive{}.drive(all, 1'500'000);
  const std::string svg = d.svg();
  for (int cycle = 0; cycle < 22; ++cycle)  // 600 ms is 8 cycles before it
    EXPECT_EQ(count(svg, fmt::format("fill=\"#444444\">{}</text>", cycle)), 1u) << cycle;
  EXPECT_EQ(count(svg, ">-1</text>"), 0u);
}

TEST(TimingDiagram, FaultsHaveLanesAndWhatBecameOfFramesIsMarked) {
  TimingDiagram d(synthetic_names(), Duration::milliseconds(5), at_us(200'000), at_us(350'000));
  SyntheticDrive{}.drive(d, 1'500'000);
  const auto fault = [&](std::int64_t ms, std::uint32_t index, recording::records::FaultAct what, const char* kind,
                         const char* text) {
    d.on(
        recording::records::FaultActivity{at_us(ms * 1000), index, what, index == 1 ? kNoNode : NodeId{4}, kind, text});
  };
  fault(10, 0, recording::records::FaultAct::kBegins, "bit_flips", "bits flip");
  fault(20, 0, recording::records::FaultAct::kActs, "bit_flips", "long before");
  fault(210, 0, recording::records::FaultAct::kActs, "bit_flips", "bit 7 is inverted");
  fault(220, 1, recording::records::FaultAct::kBegins, "noise", "noise on channel A");
  fault(240, 1, recording::records::FaultAct::kEnds, "noise", "quiet again");
  fault(260, 2, recording::records::FaultAct::kBegins, "omission", "frames are lost");
  fault(30, 3, recording::records::FaultAct::kBegins, "crash", "off");
  fault(40, 3, recording::records::FaultAct::kEnds, "crash", "on again: before the window");
  fault(400, 4, recording::records::FaultAct::kBegins, "drift", "after the window");
  const auto channel = [&](std::int64_t us, recording::records::ChannelState state, NodeId sender, std::uint16_t slot) {
    d.on(recording::records::ChannelFrame{at_us(us), at_us(us + 74), sender, 0, state, slot, 1, at_us(us), 0, {}});
  };
  channel(210'004, recording::records::ChannelState::kFrameCrc, NodeId{4}, 1);
  channel(225'000, recording::records::ChannelState::kCoding, kNoNode, 0);
  channel(230'000, {}, NodeId{6}, 0);
  channel(265'004, recording::records::ChannelState::kNothing, NodeId{4}, 1);
  channel(500'000, recording::records::ChannelState::kNothing, NodeId{4}, 1);
  const std::string svg = d.svg();
  for (const char* lane : {"bit_flips, gateway", "noise", "omission, gateway"})
    EXPECT_EQ(count(svg, std::string(">") + lane + "</text>"), 1u) << lane;
  EXPECT_EQ(count(svg, ">crash, gateway</text>") + count(svg, ">drift, gateway</text>"), 0u);
  EXPECT_EQ(count_class(svg, "fault"), 3u);
  EXPECT_EQ(count_class(svg, "acts"), 1u);
  EXPECT_EQ(count_class(svg, "changed"), 3u);
  EXPECT_EQ(count_class(svg, "missing"), 1u);
  for (const char* words :
       {"bit 7 is inverted", "slot 1 of gateway: frame CRC wrong", "sent by no node: undecodable",
        "feature, but its controller did not send it: sound", "slot 1 of gateway: it reached no receiver"})
    EXPECT_EQ(count(svg, words), 1u) << words;
  for (const char* entry : {"fault, from begin to end", "the fault acts",
                            "frame damaged, displaced or sent by no controller", "frame that reached no receiver"})
    EXPECT_EQ(count(svg, std::string(">") + entry + "</text>"), 1u) << entry;
  expect_no_overlaps(svg);
  expect_renders(svg);
  const std::string clean = timing_diagram(200, 350);
  for (const char* shown : {"fault", "acts", "changed", "missing"}) EXPECT_EQ(count_class(clean, shown), 0u);
}

TEST(TimingDiagram, MarksMeasurementsAsOtherPicturesDo) {
  const std::string svg = timing_diagram(200, 350);
  static const support::Pattern cross("<path d=\"M[^M]*M[^M]*\" class=\"measured\" fill=\"#d55e00\""),
      triangle("<path d=\"M[^M]*Z\" class=\"measured\" fill=\"#0072b2\"");
  const auto found = [&](const support::Pattern& mark) { return support::matches(svg, mark).size(); };
  EXPECT_GT(found(cross), 0u) << "the laser's";
  EXPECT_GT(found(triangle), 0u) << "the camera's";
  EXPECT_EQ(found(cross) + found(triangle), count_class(svg, "measured"));
}

TEST(TimingDiagram, FitsOnPaper) {
  for (const auto& [width_mm, font_pt] : {std::pair{88.0, 8.0}, std::pair{180.0, 8.0}, std::pair{88.0, 5.0}}) {
    TimingDiagram d(synthetic_names(), Duration::milliseconds(5), at_us(200'000), at_us(260'000));
    SyntheticDrive{}.drive(d, 1'500'000);
    expect_on_paper(d.svg(drawing::Sheet(width_mm, font_pt)), width_mm, font_pt);
  }
}

TEST(TimingDiagram, NoLabelsOverlapInAnyWindow) {
  for (const auto& [from, to] :
       {std::pair{200, 350}, std::pair{0, 150}, std::pair{100, 110}, std::pair{0, 1500}, std::pair{640, 1000}}) {
    SCOPED_TRACE(fmt::format("{} to {} ms", from, to));
    const std::string svg = timing_diagram(from, to);
    expect_no_overlaps(svg);
    expect_inside(svg);
  }
}

TEST(TimingDiagram, IsWellFormedAndDeterministic) {
  EXPECT_EQ(timing_diagram(200, 350), timing_diagram(200, 350));
  expect_renders(timing_diagram(200, 350));
}

TEST(TimingDiagram, MarksDeadlinesNullFramesStatusFramesAndLateWays) {
  const std::string svg = timing_diagram(50, 250);
  EXPECT_EQ(count_class(svg, "task missed"), 1u);
  EXPECT_GT(count_class(svg, "null"), 0u);
  EXPECT_GT(count_class(svg, "status"), 0u);
  EXPECT_GT(count_class(svg, "arrow late"), 0u);
  for (const char* entry :
       {"task, deadline missed", "null frame", "status frame", "out of sequence", "way of the real-time image"})
    EXPECT_EQ(count(svg, std::string(">") + entry + "</text>"), 1u) << entry;
}

TEST(TimingDiagram, AnEmptyWindowSaysSo) {
  const std::string svg = timing_diagram(9000, 9100);
  EXPECT_NE(svg.find("no records between 9000 ms and 9100 ms"), std::string::npos);
  expect_renders(svg);
  EXPECT_NE(TimingDiagram({}, {}, {}, {}).svg().find("no records"), std::string::npos);
}

TEST(TimingDiagram, NamesAndTasksMayBeMissing) {
  TimingDiagram d({}, {}, at_us(0), at_us(100'000));
  d.on(recording::records::Measured{SyntheticDrive{}.stamp(5000, 0), {SensorId{1}, 0}, {}});
  d.on(recording::records::ListFused{
      SyntheticDrive{}.stamp(9000, 1), 1, {SensorId{1}, 0}, {5'000'000}, Disposition::kFused});
  const std::string svg = d.svg();
  EXPECT_NE(svg.find(">sensor 1</text>"), std::string::npos);
  EXPECT_EQ(count_class(svg, "arrow"), 1u);
  expect_renders(svg);
}

TEST(TimingDiagram, AFusedListAloneMakesNoLane) {
  TimingDiagram d(synthetic_names(), Duration::milliseconds(5), at_us(0), at_us(100'000));
  d.on(recording::records::ListFused{
      SyntheticDrive{}.stamp(9000, 1), 1, {SensorId{1}, 0}, {5'000'000}, Disposition::kFused});
  EXPECT_NE(d.svg().find("no records"), std::string::npos);
  expect_renders(d.svg());
}

// A damaged log may contain anything. Impossible times are left out, and the rest is drawn as before.
TEST(TimingDiagram, ImpossibleTimesChangeNothing) {
  constexpr std::int64_t kLowest = std::numeric_limits<std::int64_t>::min(),
                         kHighest = std::numeric_limits<std::int64_t>::max();
  TimingDiagram d(synthetic_names(), Duration::milliseconds(5), at_us(200'000), at_us(350'000));
  SyntheticDrive{}.drive(d, 1'500'000);
  for (const std::int64_t ns : {kLowest, kHighest}) {
    const recording::records::Stamp inside = SyntheticDrive{}.stamp(250'000, 1);
    const recording::records::Stamp beyond{{ns}, {ns}, {ns}, NodeId{1}};
    recording::records::SlotFrameSent frame;
    frame.stamp = inside;
    frame.end.true_time = at_us(250'074);
    frame.cycle = ns;
    d.on(frame);
    frame.cycle = 50;
    frame.stamp.global = {ns};
    d.on(frame);
    d.on(recording::records::Measured{beyond, {SensorId{0}, 0}, {}});
    d.on(recording::records::ListFused{inside, 1, {SensorId{0}, 3}, {ns}, Disposition::kFused});
    d.on(recording::records::ListFused{beyond, 1, {SensorId{0}, 3}, {0}, Disposition::kFused});
  }
  EXPECT_EQ(d.svg(), timing_diagram(200, 350));
}

// A frame claims a cycle other than its instant's: the cycles' lines stay in place, and end.
TEST(TimingDiagram, AFrameOfAnotherCycleMovesNoLine) {
  TimingDiagram d(synthetic_names(), Duration::milliseconds(5), at_us(200'000), at_us(350'000));
  SyntheticDrive{}.drive(d, 1'500'000);
  SyntheticDrive{}.slot(d, 45, 1, 5, kNoPdu, 0, 0, true);
  recording::records::SlotFrameSent frame;
  frame.stamp = SyntheticDrive{}.stamp(250'000, 5);
  frame.end.true_time = at_us(250'074);
  frame.cycle = 4000;
  d.on(frame);
  const std::string svg = d.svg();
  for (int cycle = 40; cycle < 70; ++cycle)
    EXPECT_EQ(count(svg, fmt::format("fill=\"#444444\">{}</text>", cycle)), 1u) << cycle;
}

TEST(TimingDiagram, CyclesNoBusCanHaveMakeNoGrid) {
  for (const Duration cycle : {Duration{1}, Duration{std::numeric_limits<std::int64_t>::max()}}) {
    TimingDiagram d(synthetic_names(), cycle, at_us(200'000), at_us(350'000));
    SyntheticDrive{}.drive(d, 1'500'000);
    EXPECT_EQ(count(d.svg(), "fill=\"#444444\">"), 0u) << cycle.ns;
  }
}

// Ways, checked stop by stop.
class Ways : public ::testing::Test {
 protected:
  static recording::records::Stamp stamp(std::int64_t us, int node) {
    return {at_us(us), {}, {}, static_cast<NodeId>(node)};
  }
  static recording::records::ListFused fused(std::int64_t us, std::uint32_t sequence, std::int64_t measured_us,
                                             Disposition what, std::uint8_t sensor = 0) {
    return {stamp(us, 5), 1, {SensorId{sensor}, sequence}, {measured_us * 1000}, what};
  }
  std::vector<Way> ways() const { return ways_of(data_).measurements; }
  TimingData data_;
};

TEST_F(Ways, LeadFromTheSensorThroughEveryHop) {
  // measured 0 -> CAN 1..3 -> task of node 2, 4..9 -> slots 10..11 on A and B -> fused at 13
  data_.measurements = {{at_us(0), {SensorId{0}, 7}}};
  data_.can_frames = {{0, at_us(1000), at_us(2000), PduId{0}, 7, 0, NodeId{0}, SensorId{0}},
                      {0, at_us(2500), at_us(3000), PduId{0}, 7, 1, NodeId{0}, SensorId{0}}};
  data_.hops = {{stamp(4000, 2), recording::records::Hop::kRead, PduId{}, SensorId{0}, 7}};
  data_.executions = {{stamp(4000, 2), 0, stamp(3000, 2), stamp(9000, 2), true},
                      {stamp(13000, 5), 0, stamp(13000, 5), stamp(14000, 5), true}};
  for (std::uint8_t channel : {0, 1})
    data_.slot_frames.push_back(
        {at_us(10000), at_us(11000), {}, NodeId{4}, 2, 3, channel, false, PduId{2}, 7, 0, SensorId{0}});
  data_.steps = {{stamp(13000, 5), 1}};
  data_.fused = {fused(13000, 7, 0, Disposition::kFused)};
  const auto all = ways();
  ASSERT_EQ(all.size(), 1u);
  ASSERT_EQ(all[0].legs.size(), 4u);
  using Kind = LaneKey::Kind;
  const std::vector<Stop> from{{{Kind::kSensor, 0, 0}, at_us(0)},
                               {{Kind::kCan, 0, 0}, at_us(3000)},
                               {{Kind::kTask, 2, 0}, at_us(9000)},
                               {{Kind::kChannel, 0, 0}, at_us(11000)}};
  const std::vector<Stop> to{{{Kind::kCan, 0, 0}, at_us(1000)},
                             {{Kind::kTask, 2, 0}, at_us(4000)},
                             {{Kind::kChannel, 0, 0}, at_us(10000)},
                             {{Kind::kTask, 5, 0}, at_us(13000)}};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(all[0].legs[i].from.lane, from[i].lane) << i;
    EXPECT_EQ(all[0].legs[i].from.at, from[i].at) << i;
    EXPECT_EQ(all[0].legs[i].to.lane, to[i].lane) << i;
    EXPECT_EQ(all[0].legs[i].to.at, to[i].at) << i;
  }
  EXPECT_FALSE(all[0].dropped);
  EXPECT_FALSE(all[0].out_of_sequence);
}

TEST_F(Ways, AListThatArrivesAfterANewerOneIsOutOfSequence) {
  data_.measurements = {{at_us(0), {SensorId{0}, 0}}, {at_us(5000), {SensorId{1}, 0}}};
  data_.fused = {fused(13000, 0, 5000, Disposition::kFused, 1), fused(23000, 0, 0, Disposition::kFused, 0)};
  const auto all = ways();
  EXPECT_TRUE(all[0].out_of_sequence);
  EXPECT_FALSE(all[1].out_of_sequence);
}

TEST_F(Ways, ListsOfOneStepArriveTogether) {
  data_.measurements = {{at_us(0), {SensorId{0}, 0}}, {at_us(5000), {SensorId{1}, 0}}};
  data_.fused = {fused(13000, 0, 5000, Disposition::kFused, 1), fused(13000, 0, 0, Disposition::kFused, 0)};
  EXPECT_FALSE(ways()[0].out_of_sequence);
}

TEST_F(Ways, AHeldListWaitsAndIsFusedLater) {
  data_.measurements = {{at_us(0), {SensorId{0}, 0}}};
  data_.fused = {fused(13000, 0, 0, Disposition::kHeld), fused(23000, 0, 0, Disposition::kFused)};
  const auto all = ways();
  ASSERT_EQ(all[0].legs.size(), 2u);
  EXPECT_EQ(all[0].legs[1].kind, Leg::Kind::kHeld);
  EXPECT_EQ(all[0].last.at, at_us(23000));
  EXPECT_FALSE(all[0].out_of_sequence);
}

TEST_F(Ways, ARepeatedStateMessageTravelsTheFirstTime) {
  // Fragments 0 and 1 in cycles 2 and 3, then both again every cycle until the next list.
  data_.measurements = {{at_us(0), {SensorId{0}, 0}}};
  for (std::int64_t cycle = 2; cycle < 8; ++cycle) {
    const std::uint8_t fragment = cycle % 2 == 0 ? 0 : 1;
    data_.slot_frames.push_back({at_us(cycle * 5000),
                                 at_us(cycle * 5000 + 70),
                                 {},
                                 NodeId{4},
                                 cycle,
                                 3,
                                 0,
                                 false,
                                 PduId{2},
                                 0,
                                 fragment,
                                 SensorId{0}});
  }
  const auto transfers = transfers_of(data_);
  ASSERT_EQ(transfers.size(), 1u);
  EXPECT_EQ(transfers[0].start, at_us(10000));
  EXPECT_EQ(transfers[0].end, at_us(15070)) << "complete with the first fragment 1";
}

TEST_F(Ways, HoweverManyStepsHoldAListItWaitsOnce) {
  data_.measurements = {{at_us(0), {SensorId{0}, 0}}};
  data_.fused = {fused(13000, 0, 0, Disposition::kHeld), fused(23000, 0, 0, Disposition::kHeld),
                 fused(33000, 0, 0, Disposition::kFused)};
  const auto all = ways();
  ASSERT_EQ(all[0].legs.size(), 2u);
  EXPECT_EQ(all[0].legs[1].from.at, at_us(13000));
  EXPECT_EQ(all[0].legs[1].to.at, at_us(33000));
}

TEST_F(Ways, ADroppedOrOverwrittenListEndsThere) {
  data_.measurements = {{at_us(0), {SensorId{0}, 0}}, {at_us(80000), {SensorId{0}, 1}}};
  data_.fused = {fused(13000, 0, 0, Disposition::kDroppedTooOld)};
  data_.hops = {{stamp(90000, 2), recording::records::Hop::kOverwritten, PduId{}, SensorId{0}, 1}};
  const auto all = ways();
  EXPECT_TRUE(all[0].dropped);
  EXPECT_TRUE(all[1].dropped);
}

TEST_F(Ways, AWrappedCounterIsNotMistakenForAnOldList) {
  // Sequence 3 and, 256 measurements later, 259 (3 on an eight-bit wire).
  data_.measurements = {{at_us(0), {SensorId{0}, 3}}, {at_us(20'480'000), {SensorId{0}, 259}}};
  data_.fused = {fused(13000, 3, 0, Disposition::kFused), fused(20'493'000, 259, 20'480'000, Disposition::kFused)};
  const auto all = ways();
  ASSERT_EQ(all[0].legs.size(), 1u);
  ASSERT_EQ(all[1].legs.size(), 1u);
  EXPECT_EQ(all[0].last.at, at_us(13000));
  EXPECT_EQ(all[1].last.at, at_us(20'493'000));
}

// Number 259 is no 3, however near: on an eight-bit wire they look equal.
TEST_F(Ways, AnotherNumberIsAnotherList) {
  data_.measurements = {{at_us(0), {SensorId{0}, 3}}};
  data_.can_frames = {{0, at_us(1000), at_us(2000), PduId{0}, 3, 0, NodeId{0}, SensorId{0}},
                      {1, at_us(3000), at_us(4000), PduId{1}, 3, 0, NodeId{1}, SensorId{1}},
                      {2, at_us(5000), at_us(6000), PduId{0}, 259, 0, NodeId{0}, SensorId{0}}};
  data_.fused = {fused(13000, 259, 0, Disposition::kFused)};
  const auto all = ways();
  ASSERT_EQ(all[0].legs.size(), 1u);
  EXPECT_EQ(all[0].last.lane, (LaneKey{LaneKey::Kind::kCan, 0, 0}));
}

// A task ends as the next begins: lists written then are the first one's.
TEST_F(Ways, AWrittenListBelongsToTheRunThatEndsThen) {
  data_.measurements = {{at_us(0), {SensorId{0}, 7}}};
  data_.executions = {{stamp(4000, 2), 0, stamp(4000, 2), stamp(9000, 2), true},
                      {stamp(9000, 2), 1, stamp(9000, 2), stamp(9500, 2), true}};
  data_.hops = {{stamp(9000, 2), recording::records::Hop::kWritten, PduId{}, SensorId{0}, 7}};
  const auto all = ways();
  ASSERT_EQ(all[0].legs.size(), 1u);
  EXPECT_EQ(all[0].last.lane, (LaneKey{LaneKey::Kind::kTask, 2, 0}));
  EXPECT_EQ(all[0].last.at, at_us(9000));
}

// As exports do (recording/exports/measurement_ways.h): for a second and a half.
TEST_F(Ways, AListThatIsHeldForLongIsFollowed) {
  data_.measurements = {{at_us(0), {SensorId{0}, 0}}, {at_us(1'000), {SensorId{0}, 1}}};
  data_.fused = {fused(13'000, 0, 0, Disposition::kHeld), fused(900'000, 0, 0, Disposition::kFused),
                 fused(1'600'000, 1, 1'000, Disposition::kFused)};
  const auto all = ways();
  EXPECT_EQ(all[0].last.at, at_us(900'000));
  EXPECT_TRUE(all[1].legs.empty());
}

TEST_F(Ways, AnImageGoesOverItsSlotsToTheFeatureService) {
  data_.images = {{stamp(1000, 5), 4, {}}};
  data_.executions = {{stamp(1000, 5), 1, stamp(1000, 5), stamp(1500, 5), true},
                      {stamp(30000, 6), 0, stamp(30000, 6), stamp(30300, 6), true}};
  data_.slot_frames = {{at_us(5000), at_us(5100), {}, NodeId{5}, 1, 12, 0, false, PduId{4}, 4, 0, kNoSensor},
                       {at_us(5100), at_us(5200), {}, NodeId{5}, 1, 13, 0, false, PduId{4}, 4, 1, kNoSensor}};
  data_.uses = {{stamp(30000, 6), 4}};
  const auto all = ways_of(data_).images;
  ASSERT_EQ(all.size(), 1u);
  ASSERT_EQ(all[0].legs.size(), 3u);
  EXPECT_EQ(all[0].legs[0].from.at, at_us(1500));
  EXPECT_EQ(all[0].legs[0].to.at, at_us(5000));
  EXPECT_EQ(all[0].legs[1].to.at, at_us(5200));
  EXPECT_EQ(all[0].legs[2].kind, Leg::Kind::kStored);
  EXPECT_EQ(all[0].legs[2].to.at, at_us(30000));
}

}  // namespace
}  // namespace ttf::report::timing
