// The outputs of a run in real time: words, JSON, and the page, from records made by hand.
#include "cli/drive/real_time_outputs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <unistd.h>

#include "cli/drive/summary.h"
#include "recording/log/writer.h"
#include "schedules/file/loader.h"
#include "tests/support/patterns.h"

namespace ttf::cli::drive {
namespace {

namespace fs = std::filesystem;

recording::records::BinnedDurations late_by(std::initializer_list<std::pair<std::int64_t, int>> us_and_times) {
  recording::records::BinnedDurations late;
  for (const auto& [us, times] : us_and_times)
    for (int i = 0; i < times; ++i) late.add(Duration::microseconds(us));
  return late;
}

// Stretched ten times. Node 0 has 1000 wake-ups. Node 2 reported none, but had problems.
StrategyResult a_drive() {
  StrategyResult result;
  result.strategy = fusion::strategies::StrategyKind::kTt;
  result.cluster = schedules::file::load_cluster(TTF_SOURCE_DIR "/schedules/paper_synchronised.yaml");
  result.summary.age_used_newest = late_by({{20'000, 98}, {30'000, 2}});
  result.summary.age_used_oldest = late_by({{25'000, 100}});
  evaluation::lateness::RealTimeFindings found;
  found.time_scale_ppm = 10'000'000;
  recording::exports::NodeLateness& late = found.lateness[NodeId{0}];
  late.wake_ups = late_by({{10, 500}, {20, 490}, {50, 9}, {3000, 1}});
  late.floor = late_by({{7, 1000}});
  late.arrivals = late_by({{40, 10}});
  late.transits = late_by({{60, 20}});
  found.timing[NodeId{0}] = {3, 1, 0, 0, 0, {}, Duration{12'345}};
  found.timing[NodeId{2}] = {0, 0, 4, 5, 6, {2, 1}, std::nullopt};
  found.medium[NodeId{0}] = {{}, 101, 102, 103, 104, 105, 106, 107};
  found.precision.push_back({"ash", late_by({{2, 50}, {3, 1}})});
  result.real_time = found;
  return result;
}

std::string name_of_node(const StrategyResult& result, int node) {
  return result.cluster.nodes[static_cast<std::size_t>(node)].name;
}

nlohmann::ordered_json json_of(const StrategyResult& result) {
  return to_json(sim::drives::Scenario{}, 1, {result})["strategies"][0];
}

// Matches lines; runs of blanks count as one.
bool has_line(const std::string& text, const std::string& pattern) {
  const std::string blanks = support::replaced(pattern, " ", " +");
  return support::found(text, "(^|\n)" + blanks + " *(\n|$)");
}

TEST(RealTimeOutputs, TablesHaveTheHistogramsAndTheCounts) {
  const StrategyResult result = a_drive();
  const std::string text = real_time_text(result);
  const std::string first = name_of_node(result, 0), third = name_of_node(result, 2);
  EXPECT_TRUE(has_line(text, "node wake-ups p50 p99 p99.9 longest floor p50 p99 p99.9 longest")) << text;
  EXPECT_TRUE(has_line(text, first + " 1000 11 21 51 3000 1000 7 7 7 7")) << text;
  EXPECT_TRUE(has_line(text, first + " 0 - - - - 10 40 40 40 40")) << text;
  EXPECT_TRUE(has_line(text, first + " 20 60 60 60 60")) << text;
  EXPECT_TRUE(has_line(text, " late slots frames withheld by sender lost on largest")) << text;
  EXPECT_TRUE(has_line(text, "node wake-ups missed late early the sender away the way correction \\[us\\]")) << text;
  EXPECT_TRUE(has_line(text, first + " 3 1 0 0 0 0 0 12.3")) << text;
  EXPECT_TRUE(has_line(text, third + " 0 0 4 5 2 1 3 -")) << text;
  EXPECT_TRUE(has_line(text, "medium of sent received no room to send lost dropped foreign malformed")) << text;
  EXPECT_TRUE(has_line(text, first + " 101 102 103 104 107 105 106")) << text;
  // Drive time, which is ten times as long in real time; for a bin, its end.
  EXPECT_TRUE(has_line(text, "clocks apart \\[us\\] 51 30.0 30.0 30.0")) << text;
  EXPECT_TRUE(has_line(text, "sensor to feature, newest measurement \\[ms\\] 100 204.8 300.0 300.0")) << text;
  EXPECT_TRUE(has_line(text, "sensor to feature, oldest measurement \\[ms\\] 100 250.0 250.0 250.0")) << text;
}

TEST(RealTimeOutputs, JsonHasTheSame) {
  const StrategyResult result = a_drive();
  const nlohmann::ordered_json json = json_of(result)["real_time"];
  EXPECT_EQ(json["time_scale"], 10.0);
  ASSERT_EQ(json["nodes"].size(), 2u);
  const auto& first = json["nodes"][0];
  EXPECT_EQ(first["node"], name_of_node(result, 0));
  EXPECT_EQ(
      first["lateness_us"]["wake_ups"],
      (nlohmann::ordered_json{{"count", 1000}, {"p50", 11.0}, {"p99", 21.0}, {"p999", 51.0}, {"longest", 3000.0}}));
  EXPECT_EQ(first["lateness_us"]["floor"]["p99"], 7.0);
  EXPECT_EQ(first["lateness_us"]["departures"]["count"], 0);
  EXPECT_TRUE(first["lateness_us"]["departures"]["longest"].is_null());
  EXPECT_EQ(first["lateness_us"]["transits"]["count"], 20);
  EXPECT_EQ(first["medium"], (nlohmann::ordered_json{{"sent", 101},
                                                     {"received", 102},
                                                     {"not_sent", 103},
                                                     {"lost", 104},
                                                     {"foreign", 105},
                                                     {"malformed", 106},
                                                     {"dropped", 107}}));
  EXPECT_EQ(first["late_wake_ups"], 3);
  EXPECT_EQ(first["slots_missed"], 1);
  EXPECT_DOUBLE_EQ(first["largest_offset_correction_us"].get<double>(), 12.345);
  const auto& third = json["nodes"][1];
  EXPECT_EQ(third["late_frames"], 4);
  EXPECT_EQ(third["early_frames"], 5);
  EXPECT_EQ(third["frames_lost"], 6);
  EXPECT_EQ(third["withheld_by_the_sender"], 2);
  EXPECT_EQ(third["sender_away"], 1);
  EXPECT_EQ(third["lost_on_the_way"], 3);
  EXPECT_TRUE(third["medium"].is_null());
  EXPECT_TRUE(third["largest_offset_correction_us"].is_null());
  ASSERT_EQ(json["precision_us"].size(), 1u);
  EXPECT_EQ(json["precision_us"][0]["host"], "ash");
  EXPECT_EQ(json["precision_us"][0]["longest"], 30.0);
  EXPECT_EQ(json["sensor_to_feature_ms"]["newest"]["p99"], 300.0);
  EXPECT_EQ(json["sensor_to_feature_ms"]["oldest"]["count"], 100);
}

TEST(RealTimeOutputs, InVirtualTimeThereIsNothingToReport) {
  StrategyResult result = a_drive();
  result.real_time.reset();
  EXPECT_EQ(real_time_text(result), "");
  EXPECT_FALSE(json_of(result).contains("real_time"));
}

TEST(RealTimeOutputs, ThePageShowsTableAndPicture) {
  const fs::path folder = fs::temp_directory_path() / ("ttf_test_real_time." + std::to_string(::getpid()));
  fs::create_directories(folder);
  const auto page_of = [&](StrategyResult result) {
    result.log_path = (folder / "tt.mcap").string();
    recording::log::LogWriter(result.log_path, {}).close();
    write_pictures(sim::drives::Scenario{}, {result}, folder.string());
    std::ifstream file(folder / "index.html");
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  StrategyResult without = a_drive();
  without.real_time.reset();
  EXPECT_EQ(page_of(without).find("lateness"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder / "tt_lateness.svg"));
  const std::string page = page_of(a_drive());
  EXPECT_NE(page.find("<img src=\"tt_lateness.svg\""), std::string::npos);
  EXPECT_NE(page.find("lateness [us], in real time\nnode"), std::string::npos);
  for (const char* file : {"tt_lateness.svg", "tt_lateness.png", "tt_lateness.pdf"})
    EXPECT_TRUE(fs::exists(folder / file));
  const std::vector<std::string> known = picture_files("tt");
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    EXPECT_TRUE(name == "tt.mcap" || std::count(known.begin(), known.end(), name) == 1) << name;
  }
  fs::remove_all(folder);
}

}  // namespace
}  // namespace ttf::cli::drive
