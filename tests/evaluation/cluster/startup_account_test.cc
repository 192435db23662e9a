#include "evaluation/cluster/startup_account.h"

#include <gtest/gtest.h>

namespace ttf::evaluation::cluster {
namespace {

constexpr std::int64_t kMs = 1'000'000;

recording::records::Stamp at(std::int64_t true_ns, int node, std::int64_t global_ns) {
  return {{true_ns}, {true_ns}, {global_ns}, static_cast<NodeId>(node)};
}

// Cycles of 5 ms. Node 1 is active from cycle 7 on, by a clock 3 us behind its grid. It stops, and comes back
// in cycle 21 of its new count.
TEST(StartupAccount, HasTheFirstEntryIntoNormalActiveAndThePresentState) {
  StartupAccount account(Duration{5 * kMs});
  account.on(recording::records::PowerChanged{at(3 * kMs, 1, 3 * kMs), true});
  account.on(recording::records::StateChanged{at(3 * kMs, 1, 3 * kMs), recording::records::PocKind::kReady,
                                              recording::records::PocKind::kColdstartListen, "ready",
                                              "coldstart listen", "RUN", "it may lead"});
  account.on(recording::records::StateChanged{
      at(52 * kMs, 1, 35 * kMs - 3'000), recording::records::PocKind::kColdstartJoin,
      recording::records::PocKind::kNormalActive, "coldstart join", "normal active", "joined", ""});
  account.on(recording::records::PowerChanged{at(90 * kMs, 1, 73 * kMs), false});
  ASSERT_EQ(account.nodes().size(), 1u);
  EXPECT_EQ(account.nodes()[0].state, "off");
  account.on(recording::records::PowerChanged{at(95 * kMs, 1, 95 * kMs), true});
  account.on(recording::records::StateChanged{at(190 * kMs, 1, 105 * kMs), recording::records::PocKind::kColdstartJoin,
                                              recording::records::PocKind::kNormalActive, "coldstart join",
                                              "normal active", "again", "so be it"});
  const NodeStartup node = account.nodes()[0];
  EXPECT_EQ(node.powered, TrueTime{3 * kMs});
  ASSERT_TRUE(node.active.has_value());
  EXPECT_EQ(node.active->at, TrueTime{52 * kMs});
  EXPECT_EQ(node.active->cycle, 7);
  EXPECT_EQ(node.active->from, "coldstart join");
  EXPECT_EQ(node.active->why, "joined");
  EXPECT_EQ(node.state, "normal active");
  EXPECT_EQ(node.why, "again; so be it");
}

TEST(StartupAccount, ANodeThatNeverBecameActiveStatesWhatItWaitsFor) {
  StartupAccount account(Duration{5 * kMs});
  account.on(recording::records::StateChanged{at(3 * kMs, 2, 3 * kMs), recording::records::PocKind::kReady,
                                              recording::records::PocKind::kIntegrationListen, "ready",
                                              "integration listen", "the host commanded RUN",
                                              "it is not a coldstart node and waits for a running schedule"});
  const NodeStartup node = account.nodes()[0];
  EXPECT_FALSE(node.active.has_value());
  EXPECT_FALSE(node.powered.has_value());
  EXPECT_EQ(node.state, "integration listen");
  EXPECT_EQ(node.why, "the host commanded RUN; it is not a coldstart node and waits for a running schedule");
  EXPECT_TRUE(StartupAccount(Duration{}).nodes().empty());
}

}  // namespace
}  // namespace ttf::evaluation::cluster
