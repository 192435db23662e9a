// A node in start-up reports its controller's changes with their reasons.
#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "tests/nodes/host/one_node.h"

namespace ttf::nodes::host {
namespace {

// Records outlive the call here, so their words are copied.
struct Reported final : recording::records::Sink {
  struct Change {
    std::int64_t at;  // us of true time since power-on
    int from, to;
    std::string from_name, to_name, why, consequence;
    bool operator==(const Change&) const = default;
    friend void PrintTo(const Change& c, std::ostream* out) {
      *out << c.at << ": " << c.from_name << " -> " << c.to_name << ", " << c.why << "; " << c.consequence << '\n';
    }
  };
  struct Symbol {
    std::int64_t start, end;
    int channel;
    recording::records::Symbol kind;
    bool operator==(const Symbol&) const = default;
  };
  std::vector<Change> changes;
  std::vector<Symbol> symbols;
  std::vector<std::int64_t> powered;  // us
  int of_the_cluster = 0;             // records with their own global time

  using recording::records::Sink::on;
  void on(const recording::records::StateChanged& r) override {
    changes.push_back({r.stamp.true_time.ns / 1000, static_cast<int>(r.from), static_cast<int>(r.to),
                       std::string(r.from_name), std::string(r.to_name), std::string(r.why),
                       std::string(r.consequence)});
    of_the_cluster += r.stamp.global.ns != r.stamp.local.ns ? 1 : 0;
  }
  void on(const recording::records::PowerChanged& r) override {
    EXPECT_TRUE(r.on);
    powered.push_back(r.stamp.true_time.ns / 1000);
  }
  void on(const recording::records::SymbolSent& r) override {
    symbols.push_back({r.stamp.true_time.ns / 1000, r.end.true_time.ns / 1000, r.channel, r.kind});
    of_the_cluster += r.end.global.ns != r.end.local.ns ? 1 : 0;
  }
};

struct ColdNode {
  schedules::model::Cluster cluster = bus::small_cluster(4);  // node 0 is a coldstart node
  bus::NoPort port;
  NoLines lines;
  Reported reported;
  std::unique_ptr<Executive> executive;

  explicit ColdNode(std::optional<bus::controller::InitialClock> clock = std::nullopt,
                    ColdStart cold = ColdStart::kStarts, Duration boots = {}) {
    cluster.flexray.gColdStartAttempts = 2;
    cluster.nodes[0].flexray->pdListenTimeout = 2 * (bus::kMicroPerCycle + 121);
    const ExecutiveConfig config{&cluster, NodeId{0}, timebase::Oscillator(25'000, 0, 0), clock, 1, 0, {}, cold, boots};
    executive = std::make_unique<Executive>(config, std::vector<std::shared_ptr<Step>>{}, &port,
                                            std::vector<bus::ports::CanPort*>{}, lines, reported);
  }
  void run_to(std::int64_t us) {
    const Microticks end{40 * us};
    for (Microticks next = executive->next_event(); next <= end; next = executive->next_event())
      executive->advance(next);
  }
};

// Two attempts allowed give two CAS: after the listen timeout of 2 * 40 121 microticks, and after the silent
// cycle. Cycle 0 begins a macrotick after the end of the CAS, which lasts 39 bits of 0.1 us. The node gives
// up at the end of cycle 4.
TEST(ExecutiveStartup, EveryChangeOfStateIsReportedWithItsReason) {
  ColdNode node;
  node.run_to(60'000);
  constexpr const char* kTimeout =
      "the channels were idle for the listen timeout: it sends a collision avoidance symbol to start the cluster";
  constexpr const char* kLeads = "no other node tried to start the cluster in four cycles: it leads";
  constexpr const char* kNobody = "no other node's startup frame came in the first cycle of the check";
  constexpr const char* kResolution = "coldstart collision resolution";
  constexpr const char* kCheck = "coldstart consistency check";
  EXPECT_EQ(node.reported.changes,
            (std::vector<Reported::Change>{
                {0, 0x00, 0x0F, "default config", "config", "the host commanded CONFIG", ""},
                {0, 0x0F, 0x01, "config", "ready", "the host completed the configuration", ""},
                {0, 0x01, 0x21, "ready", "coldstart listen", "the host commanded RUN",
                 "it may start the cluster if no other node does"},
                {2'006, 0x21, 0x22, "coldstart listen", kResolution, kTimeout, ""},
                {6'010, 0x22, 0x23, kResolution, kCheck, kLeads, ""},
                {7'010, 0x23, 0x24, kCheck, "coldstart gap", kNobody, ""},
                {8'010, 0x24, 0x22, "coldstart gap", kResolution,
                 "the silent cycle is over: it sends a collision avoidance symbol once more", ""},
                {12'015, 0x22, 0x23, kResolution, kCheck, kLeads, ""},
                {13'015, 0x23, 0x27, kCheck, "integration listen", kNobody,
                 "its coldstart attempts are exhausted: it can only join others"},
            }));
}

TEST(ExecutiveStartup, SymbolsAreReportedOnEachChannelTheyLeaveOn) {
  ColdNode node;
  node.run_to(60'000);
  EXPECT_EQ(node.reported.symbols,
            (std::vector<Reported::Symbol>{{2'006, 2'009, 0, recording::records::Symbol::kCas},
                                           {2'006, 2'009, 1, recording::records::Symbol::kCas},
                                           {8'010, 8'014, 0, recording::records::Symbol::kCas},
                                           {8'010, 8'014, 1, recording::records::Symbol::kCas}}));
}

// It has no global time then and reports its local time instead.
TEST(ExecutiveStartup, EventsBeforeNormalOperationHaveLocalTimeForGlobalTime) {
  ColdNode node;
  node.run_to(60'000);
  EXPECT_EQ(node.reported.of_the_cluster, 0);
}

bus::ports::Reception received_until(std::int64_t us, bus::ports::Signal signal) {
  return {schedules::model::Channel::kA, signal, {40 * (us - 50)}, {40 * us}, {}};
}

// Two patterns of 60 bits and 180 idle ones, 48 us, after the listen timeout of 2006 us. Then start-up, which
// listens anew.
TEST(ExecutiveStartup, AWakingNodeSendsThePatternOnOneChannelAndStartsUpAfterwards) {
  ColdNode node(std::nullopt, ColdStart::kWakes);
  node.run_to(4'500);
  ASSERT_EQ(node.reported.symbols.size(), 3u);
  EXPECT_EQ(node.reported.symbols[0], (Reported::Symbol{2'006, 2'054, 0, recording::records::Symbol::kWakeup}));
  EXPECT_EQ(node.reported.symbols[1].start, 2'054 + 2'006);
  EXPECT_EQ(node.reported.symbols[1].kind, recording::records::Symbol::kCas);
  std::vector<std::string> states;
  for (const Reported::Change& change : node.reported.changes) states.push_back(change.to_name);
  EXPECT_EQ(states, (std::vector<std::string>{"config", "ready", "wakeup listen", "wakeup send", "ready",
                                              "coldstart listen", "coldstart collision resolution"}));
}

// Somebody else's pattern ends a wake-up as well as its own.
TEST(ExecutiveStartup, AWakingNodeStartsUpAtOnceWhenAnotherWasFaster) {
  ColdNode node(std::nullopt, ColdStart::kWakes);
  node.run_to(1'000);
  node.executive->receive(received_until(1'000, bus::ports::Signal::kWakeup));
  ASSERT_EQ(node.reported.changes.size(), 5u);
  EXPECT_EQ(node.reported.changes[3].why, "another node sent a wake-up pattern first");
  EXPECT_EQ(node.reported.changes[4].to_name, "coldstart listen");
  EXPECT_EQ(node.reported.changes[4].at, 1'000);
}

TEST(ExecutiveStartup, ASleepingNodeReceivesNothingButAWakeupPattern) {
  ColdNode node(std::nullopt, ColdStart::kSleeps, Duration::milliseconds(3));
  node.executive->receive(received_until(100, bus::ports::Signal::kCas));
  node.executive->receive(received_until(300, bus::ports::Signal::kUndecodable));
  node.run_to(20'000);
  EXPECT_TRUE(node.reported.changes.empty());
  EXPECT_EQ(node.executive->clock(), nullptr);

  node.executive->receive(received_until(20'000, bus::ports::Signal::kWakeup));
  node.executive->receive(received_until(21'000, bus::ports::Signal::kWakeup));
  node.run_to(22'999);
  EXPECT_TRUE(node.reported.powered.empty());
  node.run_to(24'000);
  EXPECT_EQ(node.reported.powered, std::vector<std::int64_t>{23'000}) << "3 ms after the first pattern";
  ASSERT_EQ(node.reported.changes.size(), 3u);
  EXPECT_EQ(node.reported.changes[2].to_name, "coldstart listen");
  EXPECT_EQ(node.reported.changes[2].at, 23'000);
}

TEST(ExecutiveStartup, ANodeThatBeginsIntegratedHasNothingToReport) {
  ColdNode node(bus::controller::InitialClock{{1000}, 0});
  node.run_to(60'000);
  EXPECT_TRUE(node.reported.changes.empty());
  EXPECT_TRUE(node.reported.symbols.empty());
}

}  // namespace
}  // namespace ttf::nodes::host
