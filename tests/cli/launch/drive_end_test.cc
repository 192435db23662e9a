// The sentence about the nodes in operation at the end of a drive.
#include "cli/launch/drive_end.h"

#include <gtest/gtest.h>

#include "cli/drive/summary.h"

namespace ttf::cli::launch {
namespace {

constexpr supervision::Ending kWell{false, 0}, kKilled{true, 9};
const std::string kActive = "normal active", kLost = "integration listen";

TEST(DriveEnd, SaysNothingWhereAllAreInOperation) {
  const DriveEnd end = drive_end({{"laser", false, kWell, ""}, {"fusion", true, kWell, kActive}});
  EXPECT_EQ(end.sentence(), "");
  EXPECT_FALSE(end.nobody);
  EXPECT_TRUE(end.absent.empty());
}

TEST(DriveEnd, NamesWhoWasNot) {
  const DriveEnd one =
      drive_end({{"laser", false, kWell, ""}, {"fusion", true, kWell, kActive}, {"feature", true, kWell, kLost}});
  EXPECT_EQ(one.sentence(), "feature was not in operation at the end: integration listen");
  EXPECT_FALSE(one.nobody);
  const DriveEnd two =
      drive_end({{"gateway", true, kWell, kLost}, {"fusion", true, kWell, kActive}, {"feature", true, kWell, kLost}});
  EXPECT_EQ(two.sentence(), "gateway, feature were not in operation at the end: integration listen");
  EXPECT_EQ(to_json(drive::LaunchFindings{two.absent, {}, {}}).dump(),
            R"({"not_in_operation_at_end":[{"node":"gateway","state":"integration listen"},)"
            R"({"node":"feature","state":"integration listen"}]})");
}

TEST(DriveEnd, SaysWhatEachWas) {
  const DriveEnd end = drive_end({{"laser", false, kKilled, ""},
                                  {"a", true, kWell, "normal passive"},
                                  {"b", true, kWell, kActive},
                                  {"c", true, kKilled, kActive},  // its last words were of better days
                                  {"d", true, std::nullopt, ""},
                                  {"e", true, kWell, ""}});
  EXPECT_EQ(end.sentence(),
            "laser, a, c, d, e were not in operation at the end: signal 9 (Killed) (laser, c); normal passive (a); "
            "never started (d); no state reported (e)");
}

// A real node has no process, and is in operation while it is received.
TEST(DriveEnd, JudgesRealNodesByTheirFrames) {
  const DriveEnd end = drive_end({{"fusion", true, kWell, kActive, false},
                                  {"heard", true, std::nullopt, "", true},
                                  {"absent", true, std::nullopt, "waiting", true}});
  EXPECT_EQ(end.sentence(), "absent was not in operation at the end: waiting");
  EXPECT_FALSE(end.nobody);
  EXPECT_TRUE(drive_end({{"fusion", true, kWell, kLost, false}, {"heard", true, std::nullopt, "", true}}).nobody);
}

// Sensors' devices alone are no cluster.
TEST(DriveEnd, NobodyIsNobodyOnFlexRay) {
  const DriveEnd same =
      drive_end({{"laser", false, kWell, ""}, {"fusion", true, kWell, kLost}, {"feature", true, kWell, kLost}});
  EXPECT_TRUE(same.nobody);
  EXPECT_EQ(same.sentence(), "no node was in operation at the end: integration listen");
  const DriveEnd different = drive_end({{"fusion", true, kWell, kLost}, {"feature", true, kKilled, kActive}});
  EXPECT_TRUE(different.nobody);
  EXPECT_EQ(different.sentence(),
            "no node was in operation at the end: integration listen (fusion); signal 9 (Killed) (feature)");
}

TEST(DriveEnd, InVirtualTimeTheRecordsSayTheStates) {
  schedules::model::Cluster cluster;
  cluster.nodes.resize(3);
  cluster.nodes[1].flexray.emplace();
  cluster.nodes[2].flexray.emplace();
  evaluation::cluster::NodeStartup off, active;
  off.node = NodeId{0};
  off.state = "off";
  active.node = NodeId{2};
  active.state = kLost;
  using Names = std::vector<std::string>;
  EXPECT_EQ(states_at_end(cluster, false, {off, active}), (Names{"", kActive, kLost}));
  EXPECT_EQ(states_at_end(cluster, true, {off, active}), (Names{"", "not powered on", kLost}));
}

TEST(DriveEnd, IsOfTheLastProcessOfEachNode) {
  EndWatch watch(2);
  int reported = 0;
  supervision::Hooks hooks;
  hooks.on_gone = [&](std::size_t, const supervision::Ending&, bool) { ++reported; };
  const supervision::Hooks around = watch.around(hooks);
  EXPECT_FALSE(watch.begun());
  EXPECT_EQ(around.on_all_ready(), nlohmann::json::object());
  EXPECT_TRUE(watch.begun());
  around.on_gone(1, kKilled, true);
  around.on_gone(1, kWell, false);
  EXPECT_EQ(reported, 2);
  schedules::model::Cluster cluster;
  cluster.nodes.resize(2);
  const std::vector<NodeAtEnd> nodes = watch.nodes(cluster, {"", kActive});
  EXPECT_FALSE(nodes[0].ending);
  ASSERT_TRUE(nodes[1].ending);
  EXPECT_TRUE(nodes[1].ending->success());
  EXPECT_EQ(nodes[1].state, kActive);
}

}  // namespace
}  // namespace ttf::cli::launch
