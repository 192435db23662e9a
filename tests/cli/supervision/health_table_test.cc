#include "cli/supervision/health_table.h"

#include <gtest/gtest.h>

namespace ttf::cli::supervision {
namespace {

using nlohmann::json;

TEST(HealthTable, ShowsWhatIsKnownAndADashForTheRest) {
  HealthTable table({"laser_pre", "fusion"});
  const json health = {{"missed_slots", 2},
                       {"late_wakeups", 17},
                       {"lateness_us", {{"p50", 31.25}, {"p99", 180}, {"max", 2041.7}}},
                       {"sync_precision_us", 1.5},
                       {"drops", 0},
                       {"state", "normal active"}};
  EXPECT_EQ(table.update(1, health), std::nullopt);
  table.set_process(0, "exit 3");
  table.set_process(1, "running");
  EXPECT_EQ(table.text(),
            "                                    missed             late   p50   p99  longest  sync\n"
            "node       state          restarts   slots  drops  wake-ups  [us]  [us]     [us]  [us]\n"
            "---------  -------------  --------  ------  -----  --------  ----  ----  -------  ----\n"
            "laser_pre  exit 3                0       -      -         -     -     -        -     -\n"
            "fusion     normal active         0       2      0        17    31   180     2042   1.5\n");
}

TEST(HealthTable, SumsUpInALine) {
  HealthTable table({"laser", "camera", "fusion", "feature"});
  EXPECT_EQ(table.summary(), "0 of 4 nodes up (laser: starting, camera: starting, fusion: starting, and 1 more)");
  for (std::size_t node = 0; node < 4; ++node) table.set_process(node, "running");
  EXPECT_EQ(table.summary(), "4 of 4 nodes up");
  for (const char* const state : {"normal active", "integration listen"})
    for (const std::size_t node : {2u, 3u})
      EXPECT_EQ(table.update(node, {{"state", state},
                                    {"late_wakeups", 2},
                                    {"missed_slots", 3},
                                    {"drops", 4},
                                    {"lateness_us", {{"p99", 20.4 * static_cast<double>(node)}, {"max", 900}}}}),
                std::nullopt);
  EXPECT_EQ(table.update(2, {{"state", "normal active"}}), std::nullopt);
  table.begin_process(0);
  table.begin_process(0);
  table.set_process(0, "running");
  EXPECT_EQ(table.summary(),
            "3 of 4 nodes up (feature: integration listen); wake-ups late by 61 us (p99), 900 us (longest); "
            "4 late wake-ups, 6 slots missed, 8 drops; 1 restart");
  EXPECT_EQ(table.json()[0]["restarts"], 1);
}

TEST(HealthTable, AProcessThatFailedIsInNoState) {
  HealthTable table({"fusion"});
  EXPECT_EQ(table.update(0, {{"state", "normal active"}, {"drops", 3}}), std::nullopt);
  table.end_process(0, "exit 0", true);
  EXPECT_NE(table.text().find("exit 0, normal active"), std::string::npos);
  table.end_process(0, "signal 9 (Killed)", false);
  EXPECT_EQ(table.text().find("normal active"), std::string::npos);
  EXPECT_NE(table.text().find("signal 9 (Killed)"), std::string::npos);
  EXPECT_TRUE(table.json()[0]["state"].is_null());
  EXPECT_EQ(table.json()[0]["drops"], 3);
}

TEST(HealthTable, NamesTheStateOfACanInTrouble) {
  HealthTable table({"laser"});
  table.set_process(0, "running");
  const auto says = [&](const char* words) {
    return table.text().find(std::string("\nlaser  ") + words + "  ") != std::string::npos;
  };
  EXPECT_EQ(table.update(0, {{"can_errors", 0}, {"can_state", "error active"}}), std::nullopt);
  EXPECT_TRUE(says("running")) << table.text();
  EXPECT_EQ(table.update(0, {{"can_errors", 3}, {"can_state", "bus off"}}), std::nullopt);
  EXPECT_TRUE(says("running, CAN bus off")) << table.text();
  EXPECT_EQ(table.update(0, {{"state", "normal active"}}), std::nullopt);
  EXPECT_TRUE(says("normal active, CAN bus off")) << table.text();
  EXPECT_EQ(table.json()[0]["said"]["can_errors"], 3);
}

TEST(HealthTable, KeepsWhatAMessageDoesNotSay) {
  HealthTable table({"fusion"});
  EXPECT_EQ(table.update(0, {{"drops", 4}, {"lateness_us", {{"p50", 1.0}}}}), std::nullopt);
  EXPECT_EQ(table.update(0, {{"missed_slots", 1}, {"lateness_us", {{"max", 9.0}}}}), std::nullopt);
  EXPECT_EQ(table.of(0).drops, 4u);
  EXPECT_EQ(table.of(0).missed_slots, 1u);
  EXPECT_EQ(table.of(0).lateness_p50_us, 1.0);
  EXPECT_EQ(table.of(0).lateness_max_us, 9.0);
  table.begin_process(0);
  EXPECT_EQ(table.of(0).drops, std::nullopt);
}

TEST(HealthTable, RefusesAWholeMessageForOneMistake) {
  HealthTable table({"fusion"});
  for (const auto& [message, complaint] : std::vector<std::pair<json, std::string>>{
           {json::array(), "health: must be an object"},
           {{{"drops", 1}, {"missed_slots", -1}}, "health.missed_slots: must be a whole number from 0"},
           {{{"drops", 1.5}}, "health.drops: must be a whole number from 0"},
           {{{"drops", 1}, {"state", 3}}, "health.state: must be text"},
           {{{"drops", 1}, {"sync_precision_us", "1"}}, "health.sync_precision_us: must be a number from 0"},
           {{{"drops", 1}, {"sync_precision_us", -0.5}}, "health.sync_precision_us: must be a number from 0"},
           {{{"drops", 1}, {"lateness_us", 3}}, "health.lateness_us: must be an object"},
           {{{"drops", 1}, {"lateness_us", {{"p99", nullptr}}}}, "health.lateness_us.p99: must be a number from 0"}})
    EXPECT_EQ(table.update(0, message), complaint);
  EXPECT_EQ(table.of(0).drops, std::nullopt);
}

TEST(HealthTable, HasAJsonForm) {
  HealthTable table({"laser_pre", "fusion"});
  EXPECT_EQ(table.update(1, {{"drops", 4}, {"lateness_us", {{"p50", 1.5}}}, {"novelty", "x"}}), std::nullopt);
  const auto json_form = table.json();
  ASSERT_EQ(json_form.size(), 2u);
  EXPECT_EQ(json_form[0]["node"], "laser_pre");
  EXPECT_TRUE(json_form[0]["drops"].is_null());
  EXPECT_TRUE(json_form[0]["lateness_us"]["p50"].is_null());
  EXPECT_EQ(json_form[1]["drops"], 4);
  EXPECT_EQ(json_form[1]["lateness_us"]["p50"], 1.5);
  EXPECT_TRUE(json_form[1]["lateness_us"]["max"].is_null());
  EXPECT_EQ(json_form[1]["said"]["novelty"], "x");
}

TEST(HealthTable, LetsNobodyMoveTheCursor) {
  HealthTable table({"a\nb"});
  EXPECT_EQ(table.update(0, {{"state", "\x1b[2J"}}), std::nullopt);
  EXPECT_NE(table.text().find("a\\x0ab"), std::string::npos);
  EXPECT_NE(table.text().find("starting, \\x1b[2J"), std::string::npos);
}

}  // namespace
}  // namespace ttf::cli::supervision
