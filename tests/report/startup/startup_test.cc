#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>

#include "report/startup/cycles.h"
#include "report/startup/diagram.h"
#include "report/startup/states.h"
#include "tests/report/layout.h"

namespace ttf::report::startup {
namespace {

using recording::records::PocKind;

// A start-up by the book, in milliseconds: 5 ms cycles, cycle 0 from 20 ms on. Node 0 leads, node 1 follows,
// node 2 integrates; node 3 begins integrated and only sends.
struct SyntheticStartup {
  static constexpr std::int64_t kCycle0_us = 20'000;

  static recording::records::Stamp stamp(std::int64_t us, int node) {
    return {{us * 1000}, {us * 1000}, {us * 1000}, static_cast<NodeId>(node)};
  }
  static std::int64_t cycle(int c) { return kCycle0_us + 5'000 * c; }

  static void change(recording::records::Sink& sink, std::int64_t us, int node, int from, const char* from_name, int to,
                     const char* to_name, const char* why, const char* consequence = "") {
    sink.on(recording::records::StateChanged{stamp(us, node), static_cast<PocKind>(from), static_cast<PocKind>(to),
                                             from_name, to_name, why, consequence});
  }
  static void frame(recording::records::Sink& sink, int c, int slot, int node, bool startup, bool null) {
    const std::array<std::byte, 5> header{startup ? std::byte{0x18} : std::byte{}};
    recording::records::SlotFrameSent f;
    f.stamp = stamp(cycle(c) + 84 * (slot - 1) + 7, node);
    f.end = stamp(cycle(c) + 84 * (slot - 1) + 74, node);
    f.cycle = c;
    f.slot = static_cast<std::uint16_t>(slot);
    f.null_frame = null;
    f.bytes = header;
    for (f.channel = 0; f.channel < 2; ++f.channel) sink.on(f);
  }
  static void powered(recording::records::Sink& sink, std::int64_t us, int node) {
    sink.on(recording::records::PowerChanged{stamp(us, node), true});
    change(sink, us, node, 0x00, "default config", 0x0F, "config", "the host commanded CONFIG");
    change(sink, us, node, 0x0F, "config", 0x01, "ready", "the host completed the configuration");
  }

  static void drive(recording::records::Sink& sink) {
    powered(sink, 3'000, 0);
    change(sink, 3'000, 0, 0x01, "ready", 0x21, "coldstart listen", "RUN", "it may start the cluster");
    powered(sink, 5'000, 1);
    change(sink, 5'000, 1, 0x01, "ready", 0x21, "coldstart listen", "RUN", "it may start the cluster");
    powered(sink, 12'000, 2);
    change(sink, 12'000, 2, 0x01, "ready", 0x27, "integration listen", "RUN", "it is not a coldstart node");
    for (std::uint8_t channel = 0; channel < 2; ++channel)
      sink.on(recording::records::SymbolSent{stamp(cycle(0) - 4, 0), stamp(cycle(0), 0), channel,
                                             recording::records::Symbol::kCas});
    change(sink, cycle(0) - 4, 0, 0x21, "coldstart listen", 0x22, "coldstart collision resolution", "silence");
    for (int c = 0; c < 10; ++c) {
      if (c == 0)
        for (const int node : {1, 2})
          change(sink, cycle(0) + 100, node, node == 1 ? 0x21 : 0x27,
                 node == 1 ? "coldstart listen" : "integration listen", 0x29, "initialise schedule",
                 "a startup frame was heard");
      if (c == 2) {
        change(sink, cycle(2), 1, 0x29, "initialise schedule", 0x26, "integration coldstart check", "pair");
        change(sink, cycle(2), 2, 0x29, "initialise schedule", 0x28, "integration consistency check", "pair");
      }
      if (c == 4) {
        change(sink, cycle(4), 0, 0x22, "coldstart collision resolution", 0x23, "coldstart consistency check", "alone");
        change(sink, cycle(4), 1, 0x26, "integration coldstart check", 0x25, "coldstart join", "confirmed");
      }
      if (c == 6)
        change(sink, cycle(6), 0, 0x23, "coldstart consistency check", 0x02, "normal active", "joined by <others>");
      if (c == 7) change(sink, cycle(7), 1, 0x25, "coldstart join", 0x02, "normal active", "joined");
      if (c == 8) change(sink, cycle(8), 2, 0x28, "integration consistency check", 0x02, "normal active", "integrated");
      frame(sink, c, 1, 0, true, c < 6);
      if (c >= 4) frame(sink, c, 2, 1, true, c < 7);
      if (c >= 8) frame(sink, c, 3, 2, false, true);
      if (c >= 8) frame(sink, c, 4, 3, false, false);
    }
  }
};

drawing::Names four() {
  drawing::Names names;
  names.drive = "cold_start, tt";
  names.nodes = {"laser_pc", "camera_pc", "gateway", "fusion & co"};
  return names;
}

std::string startup_diagram(std::int64_t from_ms, std::int64_t to_ms, Duration cycle = Duration::milliseconds(5)) {
  StartupDiagram d(four(), cycle, {from_ms * 1'000'000}, {to_ms * 1'000'000});
  SyntheticStartup::drive(d);
  return d.svg();
}

TEST(StartupDiagram, HasALaneForEveryNodeThatTookPart) {
  const std::string svg = startup_diagram(2, 68);
  for (const char* lane : {"laser_pc", "camera_pc", "gateway", "fusion &amp; co"})
    EXPECT_EQ(count(svg, std::string("text-anchor=\"end\">") + lane + "</text>"), 1u) << lane;
}

TEST(StartupDiagram, ShowsEveryStateThatLastsAndSaysWhy) {
  const std::string svg = startup_diagram(2, 68);
  // Nodes 0..2: listening, then two or three states, and active; node 3 was active from the start.
  EXPECT_EQ(count_class(svg, "state"), 4u + 5u + 4u + 1u);
  for (const auto& [name, times] :
       {std::pair{"coldstart listen", 2u}, std::pair{"integration listen", 1u},
        std::pair{"coldstart collision resolution", 1u}, std::pair{"coldstart consistency check", 1u},
        std::pair{"initialise schedule", 2u}, std::pair{"integration coldstart check", 1u},
        std::pair{"coldstart join", 1u}, std::pair{"integration consistency check", 1u}})
    EXPECT_EQ(count(svg, std::string(">") + name + "</text>"), times) << name;
  EXPECT_NE(svg.find("coldstart listen from 3 ms on: RUN; it may start the cluster"), std::string::npos);
  EXPECT_NE(svg.find("normal active from 50 ms on: joined by &lt;others&gt;"), std::string::npos);
  EXPECT_EQ(count(svg, ">config</text>"), 0u) << "it lasts no time";
}

TEST(StartupDiagram, NumbersTheCyclesOfTheLeadingNode) {
  const std::string svg = startup_diagram(2, 68);
  for (int cycle = 0; cycle <= 9; ++cycle)
    EXPECT_EQ(count(svg, fmt::format("fill=\"#444444\">{}</text>", cycle)), 1u) << cycle;
  EXPECT_NE(svg.find("collision avoidance symbol of laser_pc, which leads"), std::string::npos);
}

TEST(StartupDiagram, DrawsFramesSymbolsAndPower) {
  const std::string svg = startup_diagram(2, 72);
  EXPECT_EQ(count_class(svg, "startup"), 2u * (10 + 6));
  EXPECT_EQ(count_class(svg, "null"), 2u * 2);
  EXPECT_EQ(count_class(svg, "frame"), 2u * 2);
  EXPECT_EQ(count_class(svg, "symbol"), 2u);
  EXPECT_EQ(count_class(svg, "power"), 3u);
  EXPECT_EQ(count(svg, ">CAS</text>"), 1u) << "one note for both channels";
  for (const char* entry :
       {"startup frame", "null frame", "other frame", "symbol", "power on", "listens", "leads", "joins"})
    EXPECT_EQ(count(svg, std::string(">") + entry + "</text>"), 1u) << entry;
  EXPECT_EQ(count(svg, ">power off</text>"), 0u) << "only what occurs is explained";
}

TEST(StartupDiagram, AFaultHasALaneFromItsBeginToItsEnd) {
  StartupDiagram d(four(), Duration::milliseconds(5), {}, {70'000'000});
  SyntheticStartup::drive(d);
  d.on(recording::records::FaultActivity{
      {10'000'000}, 0, recording::records::FaultAct::kBegins, NodeId{1}, "babbling_idiot", "camera_pc babbles"});
  d.on(recording::records::FaultActivity{
      {11'000'000}, 0, recording::records::FaultAct::kActs, NodeId{1}, "babbling_idiot", "it sends in slot 3"});
  d.on(recording::records::FaultActivity{
      {30'000'000}, 0, recording::records::FaultAct::kEnds, NodeId{1}, "babbling_idiot", "camera_pc is quiet again"});
  d.on(recording::records::FaultActivity{
      {40'000'000}, 1, recording::records::FaultAct::kBegins, kNoNode, "noise", "noise on channel A"});
  const std::string svg = d.svg();
  EXPECT_EQ(count(svg, ">babbling_idiot, camera_pc</text>"), 1u);
  EXPECT_EQ(count(svg, ">noise</text>"), 1u);
  EXPECT_EQ(count_class(svg, "fault"), 2u) << "the second has no end: to the end of the window";
  EXPECT_EQ(count_class(svg, "acts"), 1u);
  EXPECT_NE(svg.find("it sends in slot 3"), std::string::npos);
  expect_no_overlaps(svg);
}

TEST(StartupDiagram, FitsOnPaper) {
  for (const double width_mm : {70.0, 88.0, 180.0}) {
    StartupDiagram d(four(), Duration::milliseconds(5), {2'000'000}, {68'000'000});
    SyntheticStartup::drive(d);
    expect_on_paper(d.svg(drawing::Sheet(width_mm, 8)), width_mm, 8);
  }
}

TEST(StartupDiagram, NoLabelsOverlapInAnyWindow) {
  for (const auto& [from, to] :
       {std::pair{2, 68}, std::pair{0, 20}, std::pair{19, 21}, std::pair{0, 600}, std::pair{0, 60'000}}) {
    SCOPED_TRACE(fmt::format("{} to {} ms", from, to));
    const std::string svg = startup_diagram(from, to);
    expect_no_overlaps(svg);
    expect_inside(svg);
  }
  const std::string svg = startup_diagram(2, 68, {});
  expect_no_overlaps(svg);
  EXPECT_EQ(count_class(svg, "cycle"), 0u) << "no grid without a cycle";
}

TEST(StartupDiagram, IsWellFormedAndDeterministic) {
  EXPECT_EQ(startup_diagram(2, 68), startup_diagram(2, 68));
  expect_renders(startup_diagram(2, 68));
}

TEST(StartupDiagram, ALogWithoutAStartupSaysSo) {
  StartupDiagram d(four(), Duration::milliseconds(5), {}, {70'000'000});
  SyntheticStartup::frame(d, 0, 1, 0, true, false);
  EXPECT_NE(d.svg().find("No node changed its state: all nodes were integrated from begin to end."), std::string::npos);
}

//   node 0    normal active ---------------------------------------------------------------->
//   node 1    normal active ---| 120 off      300 on | ready, listen --| 330 active --------->
void integrated_drive(recording::records::Sink& sink, bool comes_back) {
  using S = SyntheticStartup;
  for (int c = 0; c < 80; ++c) {
    S::frame(sink, c, 1, 0, true, false);
    if (S::cycle(c) < 120'000 || (comes_back && S::cycle(c) >= 330'000)) S::frame(sink, c, 2, 1, true, false);
  }
  sink.on(recording::records::PowerChanged{S::stamp(120'000, 1), false});
  if (!comes_back) return;
  sink.on(recording::records::PowerChanged{S::stamp(300'000, 1), true});
  S::powered(sink, 300'000, 1);
  S::change(sink, 300'000, 1, 0x01, "ready", 0x27, "integration listen", "RUN");
  S::change(sink, 330'000, 1, 0x27, "integration listen", 0x02, "normal active", "integrated");
}

std::string integrated_diagram(bool comes_back, std::int64_t from_ms, std::int64_t to_ms) {
  StartupDiagram d(four(), Duration::milliseconds(5), {from_ms * 1'000'000}, {to_ms * 1'000'000});
  integrated_drive(d, comes_back);
  d.on(recording::records::FaultActivity{
      {120'000'000}, 0, recording::records::FaultAct::kBegins, NodeId{1}, "crash", "camera_pc goes off"});
  d.on(recording::records::FaultActivity{
      {300'000'000}, 0, recording::records::FaultAct::kEnds, NodeId{1}, "crash", "camera_pc comes on"});
  d.on(recording::records::FaultActivity{
      {20'000'000}, 1, recording::records::FaultAct::kBegins, kNoNode, "noise", "noise"});
  d.on(recording::records::FaultActivity{
      {40'000'000}, 1, recording::records::FaultAct::kEnds, kNoNode, "noise", "no noise"});
  d.on(recording::records::FaultActivity{
      {390'000'000}, 2, recording::records::FaultAct::kBegins, kNoNode, "transient", "a transient"});
  return d.svg();
}

TEST(StartupDiagram, ARunThatBeganIntegratedShowsWhoWasActiveFromTheStart) {
  const std::string svg = integrated_diagram(true, 100, 350);
  EXPECT_EQ(count_class(svg, "state"), 4u) << "one of node 0; of node 1 active, listening, active";
  EXPECT_EQ(count(svg, ">normal active</text>"), 4u) << "in three bars and in the legend";
  EXPECT_NE(svg.find("integrated from the beginning of the drive"), std::string::npos);
  EXPECT_NE(svg.find("cold_start, tt: changes of state, 100 ms to 350 ms"), std::string::npos);
  EXPECT_EQ(count(svg, ">crash, camera_pc</text>"), 1u);
  expect_no_overlaps(svg);
  for (const char* elsewhere : {">noise</text>", ">transient</text>"})
    EXPECT_EQ(count(svg, elsewhere), 0u) << "no lane for what is not there in the window";
  const std::string later = integrated_diagram(true, 310, 350);
  EXPECT_EQ(count(later, "crash"), 0u);
  EXPECT_EQ(count(later, "fault, from begin"), 0u);
}

TEST(StartupDiagram, ANodeThatIsLostForGoodIsDrawn) {
  const std::string svg = integrated_diagram(false, 100, 350);
  EXPECT_EQ(count_class(svg, "state"), 2u);
  EXPECT_EQ(count_class(svg, "power"), 1u);
}

TEST(StartupExtent, IsTheStartUpOrTheReturnOfANodeOrItsLoss) {
  const Duration cycle = Duration::milliseconds(5);
  const auto window = [&](const auto& drive) {
    StartupExtent extent;
    drive(extent);
    return extent.window(cycle);
  };
  using Window = std::pair<TrueTime, TrueTime>;
  const auto ms = [](std::int64_t from, std::int64_t to) { return Window{{from * 1'000'000}, {to * 1'000'000}}; };
  EXPECT_EQ(window([](recording::records::Sink& sink) { SyntheticStartup::drive(sink); }), ms(2, 60 + 11));
  EXPECT_EQ(window([](recording::records::Sink& sink) { integrated_drive(sink, true); }), ms(299, 330 + 11));
  EXPECT_EQ(window([](recording::records::Sink& sink) { integrated_drive(sink, false); }), ms(119, 120 + 11));
  EXPECT_FALSE(window([](recording::records::Sink& sink) { SyntheticStartup::frame(sink, 0, 1, 0, true, false); }));
}

// ---- its parts

StartupData::Change change(std::int64_t at, int node, PocKind from, PocKind to) {
  return {{at}, static_cast<NodeId>(node), from, to, "from", "to", "why", ""};
}
recording::records::Stamp stamp(std::int64_t at, int node) { return {{at}, {}, {}, static_cast<NodeId>(node)}; }
recording::records::SymbolSent symbol(std::int64_t at, int node, recording::records::Symbol kind) {
  return {stamp(at, node), stamp(at + 10, node), 0, kind};
}

//   node 0     ready 10 |===| 20 listen |======| 40 off     60 on, listen |====| 100
TEST(StartupStates, AStateLastsUntilItIsLeftOrItsNodeLosesItsSupply) {
  StartupData data;
  data.changes = {change(10, 0, PocKind::kDefaultConfig, PocKind::kReady),
                  change(20, 0, PocKind::kReady, PocKind::kColdstartListen),
                  change(60, 0, PocKind::kDefaultConfig, PocKind::kColdstartListen)};
  data.power = {{stamp(10, 0), true}, {stamp(40, 0), false}, {stamp(60, 0), true}};
  const auto spans = state_spans(data, {0}, {100});
  ASSERT_EQ(spans.size(), 3u);
  EXPECT_EQ(spans[0].start.ns, 10);
  EXPECT_EQ(spans[0].end.ns, 20);
  EXPECT_EQ(spans[1].start.ns, 20);
  EXPECT_EQ(spans[1].end.ns, 40);
  EXPECT_EQ(spans[2].start.ns, 60);
  EXPECT_EQ(spans[2].end.ns, 100);
}

TEST(StartupStates, ANodeThatLosesAnUngivenSupplyOrOnlySendsIsActiveFromTheStart) {
  StartupData data;
  data.power = {
      {stamp(10, 0), false}, {stamp(10, 1), true}, {stamp(20, 1), false}, {stamp(30, 2), false}, {stamp(50, 0), true}};
  data.changes = {change(10, 1, PocKind::kDefaultConfig, PocKind::kReady),
                  change(25, 2, PocKind::kNormalActive, PocKind::kHalt),
                  change(50, 0, PocKind::kDefaultConfig, PocKind::kReady)};
  data.frames = {{{5}, {6}, NodeId{3}, 0, 4, 0, false, false}, {{5}, {6}, NodeId{2}, 0, 4, 0, false, false}};
  EXPECT_EQ(active_from_the_start(data), (std::set<NodeId>{NodeId{0}, NodeId{3}}));
  const auto spans = state_spans(data, {0}, {100});
  EXPECT_EQ(std::count_if(spans.begin(), spans.end(), [](const StateSpan& s) { return s.node == NodeId{0}; }), 2);
  EXPECT_EQ(spans.at(0).start.ns, 0);
}

TEST(StartupStates, ANodeThatBeganIntegratedWasInItsFirstStateFromTheBeginningOn) {
  StartupData data;
  data.changes = {change(30, 2, PocKind::kNormalActive, PocKind::kHalt)};
  const auto spans = state_spans(data, {5}, {100});
  ASSERT_EQ(spans.size(), 2u);
  EXPECT_EQ(spans[0].state, PocKind::kNormalActive);
  EXPECT_EQ(spans[0].start.ns, 5);
  EXPECT_EQ(spans[0].end.ns, 30);
  EXPECT_EQ(spans[1].state, PocKind::kHalt);
}

// Two nodes send a CAS. The one that became active out of the consistency check leads, by its own CAS.
TEST(StartupCycles, TheLeadingNodeIsTheOneThatWasActiveOutOfTheConsistencyCheck) {
  StartupData data;
  data.symbols = {symbol(90, 1, recording::records::Symbol::kCas), symbol(290, 0, recording::records::Symbol::kCas),
                  symbol(340, 0, recording::records::Symbol::kWakeup),
                  symbol(390, 1, recording::records::Symbol::kCas)};
  EXPECT_EQ(leading_node(data)->node, NodeId{1}) << "the last one while nobody is active";
  data.changes = {change(350, 2, PocKind::kIntegrationConsistencyCheck, PocKind::kNormalActive),
                  change(380, 0, PocKind::kColdstartConsistencyCheck, PocKind::kNormalActive)};
  EXPECT_EQ(leading_node(data)->node, NodeId{0});
  EXPECT_EQ(leading_node(data)->cas.ns, 300);
  EXPECT_FALSE(leading_node(StartupData{}).has_value());
}

// Cycles of nominally 1000. The node's clock is slow, so its frames, 70 into the cycle, come 1010 apart.
// Cycle 2 has no frame.
TEST(StartupCycles, BeginWhereTheLeadingNodesFramesSay) {
  StartupData data;
  const LeadingNode leader{NodeId{0}, {500}};
  const auto frame = [&](std::int64_t c, std::int64_t at, int node = 0, std::uint16_t slot = 3) {
    data.frames.push_back({{at}, {at + 10}, static_cast<NodeId>(node), c, slot, 0, true, true});
  };
  frame(0, 570);
  frame(0, 620, 1);
  frame(1, 1'580);
  frame(3, 3'600);
  frame(3, 3'650, 0, 4);
  frame(4, 9'999);  // of another schedule
  const auto starts = cycles_of(data, leader, Duration{1000}, {4'600});
  EXPECT_EQ(starts,
            (std::map<std::int64_t, TrueTime>{{0, {500}}, {1, {1'510}}, {2, {2'510}}, {3, {3'530}}, {4, {4'530}}}));
}

}  // namespace
}  // namespace ttf::report::startup
