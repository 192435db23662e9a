#include "cli/supervision/health_table.h"

#include <gtest/gtest.h>

namespace ttf::cli::supervision {
namespace {

using nlohmann::json;

TEST(HealthTable, ShowsWhatIsKnownAndADashForTheRest) {
  HealthTable table({"laser_pre", "fusion"});
  EXPECT_FALSE(table.anything_said());
  const json health = {{"missed_slots", 2},
                       {"late_wakeups", 17},
                       {"lateness_us", {{"p50", 31.25}, {"p99", 180}, {"max", 2041.7}}},
                       {"sync_precision_us", 1.5},
                       {"drops", 0},
                       {"state", "normal active"}};
  EXPECT_EQ(table.update(1, health), std::nullopt);
  table.set_process(0, "exit 3");
  table.set_process(1, "running");
  EXPECT_TRUE(table.anything_said());
  EXPECT_EQ(
      table.text(),
      "node       missed slots  late wake-ups  late p50 [us]  p99 [us]  max [us]  sync precision [us]  drops  state\n"
      "---------  ------------  -------------  -------------  --------  --------  -------------------  -----  "
      "----------------------\n"
      "laser_pre             -              -              -         -         -                    -      -  exit 3\n"
      "fusion                2             17           31.2     180.0    2041.7                  1.5      0  running, "
      "normal active\n");
}

TEST(HealthTable, NamesTheStateOfACanInTrouble) {
  HealthTable table({"laser"});
  table.set_process(0, "running");
  const auto says = [&](const char* words) { return table.text().ends_with(std::string("-  ") + words + "\n"); };
  EXPECT_EQ(table.update(0, {{"can_errors", 0}, {"can_state", "error active"}}), std::nullopt);
  EXPECT_TRUE(says("running")) << table.text();
  EXPECT_EQ(table.update(0, {{"can_errors", 3}, {"can_state", "bus off"}}), std::nullopt);
  EXPECT_TRUE(says("running, CAN bus off")) << table.text();
  EXPECT_EQ(table.update(0, {{"state", "normal active"}}), std::nullopt);
  EXPECT_TRUE(says("running, normal active, CAN bus off")) << table.text();
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
  table.forget(0);
  EXPECT_EQ(table.of(0).drops, std::nullopt);
  EXPECT_FALSE(table.anything_said());
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
  EXPECT_FALSE(table.anything_said());
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
