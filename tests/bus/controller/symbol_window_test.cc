// The symbol window: media access test symbols, their instants, and the status of received signals.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/bus/alone.h"
#include "tests/bus/startup_cluster.h"

namespace ttf::bus::controller {
namespace {

using schedules::model::Channels;

// The window is macroticks 840..859, its action point 847; a symbol lasts 9 + 30 bits, 156 microticks.
constexpr int kWindow = 840, kWindowEnd = 860, kPoint = 847, kSymbol = 156;
schedules::model::Cluster windowed(schedules::model::Cluster cluster) {
  cluster.flexray.gdSymbolWindow = kWindowEnd - kWindow;
  cluster.flexray.gdNIT -= kWindowEnd - kWindow;
  return cluster;
}

struct Single : Alone {
  explicit Single(schedules::model::Cluster made = windowed(small_cluster(4))) : Alone(0, std::move(made)) {}

  std::vector<NoPort::Sent> symbols() const {
    std::vector<NoPort::Sent> found;
    for (const auto& sent : port.sent)
      if (sent.signal == ports::Signal::kCas) found.push_back(sent);
    return found;
  }
  // `from`: microticks into cycle 0's window (negative: before it).
  void receive(ports::Signal signal, std::int64_t from, std::int64_t length = kSymbol, Channel channel = Channel::kA) {
    const Microticks start = at(0, kWindow) + Microticks{from};
    controller.advance(start + Microticks{length - 1});
    controller.receive({channel, signal, start, start + Microticks{length}, {}});
  }
  SymbolWindowSeen seen(Channel channel = Channel::kA) {
    run_to(0, 990);
    return controller.symbol_window_status(channel);
  }
};

TEST(MediaTestSymbol, LeavesAtTheActionPointOnBothChannels) {
  Single node;
  EXPECT_TRUE(node.controller.send_media_test_symbol());
  node.run_to(3);
  const auto symbols = node.symbols();
  ASSERT_EQ(symbols.size(), 2u);
  for (const auto& symbol : symbols) {
    EXPECT_EQ(symbol.start, Alone::at(0, kPoint));
    EXPECT_EQ(symbol.end - symbol.start, Microticks{kSymbol});
  }
  EXPECT_EQ(symbols[0].channel, Channel::kA);
  EXPECT_EQ(symbols[1].channel, Channel::kB);
}

TEST(MediaTestSymbol, OnTheChannelsAskedForAndAttached) {
  Single asked;
  EXPECT_TRUE(asked.controller.send_media_test_symbol(Channels::kB));
  asked.run_to(1);
  ASSERT_EQ(asked.symbols().size(), 1u);
  EXPECT_EQ(asked.symbols()[0].channel, Channel::kB);

  schedules::model::Cluster cluster = windowed(small_cluster(4));
  cluster.nodes[0].flexray->pChannels = Channels::kA;
  Single attached(cluster);
  EXPECT_TRUE(attached.controller.send_media_test_symbol());
  attached.run_to(1);
  ASSERT_EQ(attached.symbols().size(), 1u);
  EXPECT_EQ(attached.symbols()[0].channel, Channel::kA);
}

// Behind the minislots, if any: 24 of 5 MT from 844 on.
TEST(MediaTestSymbol, TheWindowFollowsTheDynamicSegment) {
  schedules::model::Cluster cluster = small_cluster(4);
  cluster.flexray.gNumberOfMinislots = 24;
  cluster.flexray.gdSymbolWindow = 20;
  cluster.flexray.gdNIT = 1000 - 844 - 120 - 20;
  cluster.flexray.gOffsetCorrectionStart = 990;
  Single node(cluster);
  EXPECT_TRUE(node.controller.send_media_test_symbol());
  node.run_to(2);
  ASSERT_EQ(node.symbols().size(), 2u);
  EXPECT_EQ(node.symbols()[0].start, Alone::at(0, 844 + 120 + 7));
}

TEST(MediaTestSymbol, OneAtATimeAndInTheNextWindow) {
  Single node;
  node.controller.advance(Alone::at(0, kPoint) - Microticks{1});
  EXPECT_TRUE(node.controller.send_media_test_symbol(Channels::kA));   // just in time for cycle 0
  EXPECT_FALSE(node.controller.send_media_test_symbol(Channels::kA));  // pending
  node.run_to(0, kPoint);
  EXPECT_TRUE(node.controller.send_media_test_symbol(Channels::kA));  // too late for it
  node.run_to(4);
  ASSERT_EQ(node.symbols().size(), 2u);
  EXPECT_EQ(node.symbols()[0].start, Alone::at(0, kPoint));
  EXPECT_EQ(node.symbols()[1].start, Alone::at(1, kPoint));
}

TEST(MediaTestSymbol, IsRefusedWithoutWindowAndInKeySlotOnlyMode) {
  Single without(small_cluster(4));
  EXPECT_FALSE(without.controller.send_media_test_symbol());

  schedules::model::Cluster cluster = windowed(small_cluster(4));
  cluster.nodes[0].flexray->pKeySlotOnlyEnabled = true;
  Single node(cluster);
  EXPECT_FALSE(node.controller.send_media_test_symbol());
  node.controller.command(poc::PocEventKind::kAllSlots, Alone::at(0, 10));
  EXPECT_FALSE(node.controller.send_media_test_symbol());  // from the next cycle on
  node.run_to(1);
  EXPECT_TRUE(node.controller.send_media_test_symbol());
  node.run_to(2);
  EXPECT_EQ(node.symbols().size(), 2u);
}

// A node without received sync frames and without its own is passive from cycle 2 on.
TEST(MediaTestSymbol, ASymbolAskedForInTimeIsDroppedInNormalPassive) {
  schedules::model::Cluster cluster = windowed(small_cluster(4));
  cluster.nodes[0].flexray->pKeySlotUsedForSync = cluster.nodes[0].flexray->pKeySlotUsedForStartup = false;
  cluster.flexray.gMaxWithoutClockCorrectionPassive = 1;
  cluster.nodes[0].flexray->pAllowHaltDueToClock = false;
  Single node(cluster);
  node.run_to(1, kWindowEnd);
  EXPECT_TRUE(node.controller.send_media_test_symbol());
  node.run_to(2);
  ASSERT_EQ(node.controller.state().kind, poc::PocKind::kNormalPassive);
  EXPECT_FALSE(node.controller.send_media_test_symbol());
  node.run_to(5);
  EXPECT_TRUE(node.symbols().empty());
}

TEST(MediaTestSymbol, ARequestDoesNotOutliveTheSchedule) {
  Single node;
  EXPECT_TRUE(node.controller.send_media_test_symbol());
  node.controller.command(poc::PocEventKind::kFreeze, Alone::at(0, 20));
  node.controller.start_integrated({Alone::at(1, 0), 0});
  node.run_to(4);
  EXPECT_TRUE(node.symbols().empty());
}

TEST(SymbolWindow, AMediaTestSymbolIsValidWhereItIsReceived) {
  Rig rig(windowed(small_cluster(3)), {300'000, -300'000, 0}, Duration{500});
  rig.run_cycles(20);
  EXPECT_TRUE(rig.controller(0).send_media_test_symbol(Channels::kB));
  rig.run_cycles(21);
  const SymbolWindowSeen valid{.valid_mts = true};
  for (const std::size_t node : {1u, 2u}) {
    EXPECT_EQ(rig.controller(node).symbol_window_status(Channel::kB), valid);
    EXPECT_EQ(rig.controller(node).symbol_window_status(Channel::kA), SymbolWindowSeen{});
    EXPECT_TRUE(rig.reports(node).problems.empty());
  }
  EXPECT_EQ(rig.controller(0).symbol_window_status(Channel::kB), SymbolWindowSeen{});
  rig.run_cycles(22);
  EXPECT_EQ(rig.controller(1).symbol_window_status(Channel::kB), SymbolWindowSeen{});
}

// The two senders receive each other while they send; the third receives one symbol.
TEST(SymbolWindow, TwoSendersConflict) {
  Rig rig(windowed(small_cluster(3)), {0, 0, 0}, Duration{500});
  rig.run_cycles(4);
  EXPECT_TRUE(rig.controller(0).send_media_test_symbol());
  EXPECT_TRUE(rig.controller(1).send_media_test_symbol());
  rig.run_cycles(5);
  const SymbolWindowSeen conflict{.syntax_error = true, .transmission_conflict = true};
  EXPECT_EQ(rig.controller(0).symbol_window_status(Channel::kA), conflict);
  EXPECT_EQ(rig.controller(1).symbol_window_status(Channel::kB), conflict);
  EXPECT_EQ(rig.controller(2).symbol_window_status(Channel::kA), SymbolWindowSeen{.valid_mts = true});
}

TEST(SymbolWindow, AnythingButASymbolIsASyntaxError) {
  const SymbolWindowSeen error{.syntax_error = true};
  for (const ports::Signal signal : {ports::Signal::kUndecodable, ports::Signal::kWakeup, ports::Signal::kFrame}) {
    Single node;
    node.receive(signal, 300);
    EXPECT_EQ(node.seen(), error) << static_cast<int>(signal);
    EXPECT_EQ(node.seen(Channel::kB), SymbolWindowSeen{});
  }
  Single twice;
  twice.receive(ports::Signal::kCas, 100);
  twice.receive(ports::Signal::kCas, 400);
  EXPECT_EQ(twice.seen(), (SymbolWindowSeen{.valid_mts = true, .syntax_error = true}));
  Single spoilt;
  spoilt.receive(ports::Signal::kUndecodable, 100, 20);
  spoilt.receive(ports::Signal::kCas, 400);
  EXPECT_EQ(spoilt.seen(), error);
}

// gdCASRxLowMax is 91 bits of four microticks.
TEST(SymbolWindow, ALowPhaseThatIsTooLongIsNoSymbol) {
  Single longest, longer;
  longest.receive(ports::Signal::kCas, 100, 91 * 4);
  longer.receive(ports::Signal::kCas, 100, 91 * 4 + 1);
  EXPECT_EQ(longest.seen(), SymbolWindowSeen{.valid_mts = true});
  EXPECT_EQ(longer.seen(), SymbolWindowSeen{.syntax_error = true});
}

TEST(SymbolWindow, BothEndsAreBoundaries) {
  constexpr std::int64_t kLength = (kWindowEnd - kWindow) * 40;
  const SymbolWindowSeen valid{.valid_mts = true}, violation{.boundary_violation = true};
  const auto reports = [](std::int64_t from, ports::Signal signal = ports::Signal::kCas) {
    Single node;
    node.receive(signal, from);
    return node.seen();
  };
  EXPECT_EQ(reports(0), valid);
  EXPECT_EQ(reports(-1), violation);
  EXPECT_EQ(reports(-kSymbol), SymbolWindowSeen{});  // all before it
  EXPECT_EQ(reports(kLength - kSymbol), valid);
  EXPECT_EQ(reports(kLength - kSymbol + 1), violation);
  EXPECT_EQ(reports(kLength), SymbolWindowSeen{});  // all behind it
  EXPECT_EQ(reports(kLength - 1, ports::Signal::kUndecodable),
            (SymbolWindowSeen{.syntax_error = true, .boundary_violation = true}));
}

TEST(SymbolWindow, StandsFromTheEndOfOneWindowToTheEndOfTheNext) {
  Single node;
  node.receive(ports::Signal::kCas, 280);
  node.controller.advance(Alone::at(0, kWindowEnd) - Microticks{1});
  EXPECT_EQ(node.controller.symbol_window_status(Channel::kA), SymbolWindowSeen{});
  node.run_to(0, kWindowEnd);
  EXPECT_TRUE(node.controller.symbol_window_status(Channel::kA).valid_mts);
  node.controller.advance(Alone::at(1, kWindowEnd) - Microticks{1});
  EXPECT_TRUE(node.controller.symbol_window_status(Channel::kA).valid_mts);
  node.run_to(1, kWindowEnd);
  EXPECT_EQ(node.controller.symbol_window_status(Channel::kA), SymbolWindowSeen{});
}

// Three nodes run and test the medium in every cycle. A fourth integrates. It reports no symbols until it is
// normal active, and the symbols do not delay that.
TEST(SymbolWindow, SaysNothingDuringStartup) {
  Rig rig(windowed(startup_cluster(3, 1)), {0, 0, 0, 0}, {}, {at_ms(1.0), at_ms(1.2), at_ms(1.4), at_ms(40.0)});
  bool silent = true;
  int received_by_others = 0;
  for (int cycle = 25; cycle < 80; ++cycle) {
    if (rig.controller(0).state().kind == poc::PocKind::kNormalActive) rig.controller(0).send_media_test_symbol();
    rig.run_until(at_ms(cycle));
    if (rig.controller(3).state().kind != poc::PocKind::kNormalActive)
      silent &= rig.controller(3).symbol_window_status(Channel::kA) == SymbolWindowSeen{};
    received_by_others += rig.controller(1).symbol_window_status(Channel::kA).valid_mts;
  }
  EXPECT_TRUE(silent);
  EXPECT_GT(received_by_others, 50);
  EXPECT_EQ(rig.controller(3).state().kind, poc::PocKind::kNormalActive);
  EXPECT_TRUE(rig.controller(3).symbol_window_status(Channel::kA).valid_mts);
  for (const auto& problem : rig.reports(1).problems) EXPECT_EQ(problem.slot, 4);  // the fourth's, before its start
}

}  // namespace
}  // namespace ttf::bus::controller
