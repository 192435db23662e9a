#include "report/drive/series.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "report/drive/tables.h"

namespace ttf::report::drive {
namespace {

recording::records::Stamp stamp(std::int64_t us, int node = 0) {
  return {TrueTime{us * 1000}, LocalTime{us * 1000}, GlobalTime{us * 1000}, NodeId(static_cast<std::uint8_t>(node))};
}

recording::records::TruthState truth(std::int64_t us, int object, double x, double y, int node = 0) {
  recording::records::TruthState state;
  state.at = TrueTime{us * 1000};
  state.object = ObjectId(static_cast<std::uint16_t>(object));
  state.x = x;
  state.y = y;
  state.node = NodeId(static_cast<std::uint8_t>(node));
  return state;
}

void use(DriveSeriesSink& sink, std::int64_t us, std::vector<std::pair<double, double>> positions,
         std::uint32_t image = 0, bool stale = false) {
  std::vector<recording::records::FeatureObject> objects;
  for (const auto& [x, y] : positions) {
    recording::records::FeatureObject& object = objects.emplace_back();
    object.image.x = x;
    object.image.y = y;
  }
  recording::records::FeatureUsed used;
  used.stamp = stamp(us);
  used.image_sequence = image;
  used.objects = objects;
  used.stale = stale;
  sink.on(used);
}

TEST(DriveSeries, AnErrorIsTheRootMeanSquareOverPairsClosestFirst) {
  DriveSeriesSink sink;
  use(sink, 1000, {{10.3, 0.4}, {20.0, 1.0}, {80.0, 0.0}});
  sink.on(truth(1000, 0, 20.0, 0.0));
  sink.on(truth(1000, 1, 10.0, 0.0));
  sink.on(truth(1000, 0, 20.0, 0.0, 7));  // the same, as another node recorded it
  use(sink, 2000, {{30.0, 0.0}});
  sink.on(truth(2000, 0, 30.0, 0.25));
  const DriveSeries series = sink.finish();
  ASSERT_EQ(series.position_error.size(), 2u);
  EXPECT_NEAR(series.position_error[0].value, std::sqrt((0.25 + 1.0) / 2), 1e-12);
  EXPECT_EQ(series.position_error[0].t_s, 0.001);
  EXPECT_EQ(series.position_error[1].value, 0.25);
  EXPECT_EQ(series.matched, 3u);
  EXPECT_EQ(series.spurious, 1u);
  EXPECT_EQ(series.missed, 0u);
}

TEST(DriveSeries, ObjectsTooFarOffOrStaleAreNotCompared) {
  DriveSeriesSink sink(4.0);
  use(sink, 1000, {{10.0, 4.5}});
  sink.on(truth(1000, 0, 10.0, 0.0));
  use(sink, 2000, {{10.0, 0.0}}, 0, true);
  sink.on(truth(2000, 0, 10.0, 0.0));
  const DriveSeries series = sink.finish();
  EXPECT_TRUE(series.position_error.empty());
  EXPECT_EQ(series.missed, 1u);
}

TEST(DriveSeries, AgesAreOfWhatIsInTheImageThatIsUsed) {
  DriveSeriesSink sink;
  const auto fused = [&](int sensor, std::uint32_t sequence, std::int64_t measured_us, std::int64_t at_us) {
    sink.on(recording::records::ListFused{stamp(at_us),
                                          1,
                                          {SensorId(static_cast<std::uint8_t>(sensor)), sequence},
                                          GlobalTime{measured_us * 1000},
                                          recording::records::Disposition::kFused});
  };
  fused(0, 4, 10'000, 40'000);
  fused(1, 9, 25'000, 41'000);
  sink.on(recording::records::ListFused{
      stamp(42'000), 1, {SensorId{1}, 10}, GlobalTime{30'000'000}, recording::records::Disposition::kHeld});
  const std::vector<MeasurementId> newest{{SensorId{0}, 4}, {SensorId{1}, 9}};
  recording::records::ImageWritten image;
  image.stamp = stamp(43'000);
  image.sequence = 7;
  image.newest = newest;
  sink.on(image);
  use(sink, 60'000, {}, 7);
  use(sink, 61'000, {}, 8);  // an image that nobody wrote
  const DriveSeries series = sink.finish();
  EXPECT_EQ(series.age_fused.at(SensorId{0}), std::vector<double>{30.0});
  EXPECT_EQ(series.age_used.at(SensorId{0}), std::vector<double>{50.0});
  EXPECT_EQ(series.age_used.at(SensorId{1}), std::vector<double>{35.0});
  ASSERT_EQ(series.newest_age.size(), 1u);
  EXPECT_EQ(series.newest_age[0].value, 35.0);
  EXPECT_EQ(series.oldest_age[0].value, 50.0);
}

TEST(DriveSeries, AFaultIsReportedByItsFirstAct) {
  DriveSeriesSink sink;
  sink.on(recording::records::FaultActivity{TrueTime{1'000'000}, 3, recording::records::FaultAct::kBegins, NodeId{2},
                                            "omission", "it begins"});
  sink.on(recording::records::FaultActivity{TrueTime{2'000'000}, 3, recording::records::FaultAct::kActs, NodeId{2},
                                            "omission", "the first"});
  sink.on(recording::records::FaultActivity{TrueTime{3'000'000}, 3, recording::records::FaultAct::kActs, NodeId{2},
                                            "omission", "the second"});
  const evaluation::faults::InjectedFault fault = sink.finish().faults.at(3);
  EXPECT_EQ(fault.begins, TrueTime{1'000'000});
  EXPECT_EQ(fault.acts, 2u);
  EXPECT_EQ(fault.text, "the first");
  EXPECT_EQ(fault.first_act, TrueTime{2'000'000});
  EXPECT_FALSE(fault.ends.has_value());
}

TEST(DriveSeries, AFaultWithoutActsOrItsBeginSaysNeither) {
  DriveSeriesSink sink;
  sink.on(recording::records::FaultActivity{TrueTime{1'000'000}, 3, recording::records::FaultAct::kEnds, NodeId{2},
                                            "omission", "it ends"});
  const evaluation::faults::InjectedFault fault = sink.finish().faults.at(3);
  EXPECT_EQ(fault.text, "");
  EXPECT_FALSE(fault.begins.has_value());
  EXPECT_EQ(fault.ends, TrueTime{1'000'000});
}

TEST(DriveSeries, AThinnedSeriesKeepsItsExtremes) {
  std::vector<TimedValue> all;
  for (int i = 0; i < 10'000; ++i) all.push_back({i * 0.001, i == 4321 ? -9.0 : std::sin(i)});
  const auto some = thinned(all, 300);
  EXPECT_LE(some.size(), 300u);
  EXPECT_EQ(std::ranges::count(some, -9.0, &TimedValue::value), 1);
  EXPECT_TRUE(std::ranges::is_sorted(some, {}, &TimedValue::t_s));
  EXPECT_EQ(thinned(all, 10'000).size(), all.size());
}

Drive drive_of(std::uint64_t seed, const std::string& strategy, double error) {
  Drive drive{"out", "bend", strategy, {}, strategy, seed, {}, nullptr};
  drive.summary["rmse_truth"]["position_m"] = error;
  return drive;
}

TEST(DrivesAnswer, OfOneDriveNothingIsCertain) {
  const Drive a = drive_of(1, "buff", 0.2), b = drive_of(1, "tt", 0.1);
  const DrivesAnswer answer = answer_of({{&a, {}}, {&b, {}}});
  EXPECT_EQ(answer.answer.find("In this one drive buff is off by 0.200 m in position, tt by 0.100 m ("), 0u)
      << answer.answer;
  ASSERT_EQ(answer.more.size(), 1u);
  EXPECT_EQ(answer.more[0].find("One drive is one draw"), 0u);
}

// Paired: common disturbances cancel.
TEST(DrivesAnswer, OfSeveralSeedsDifferencesArePaired) {
  std::vector<Drive> drives;
  for (int seed = 1; seed <= 4; ++seed) {
    drives.push_back(drive_of(static_cast<std::uint64_t>(seed), "buff", 0.1 * seed + 0.01 + 0.001 * (seed % 2)));
    drives.push_back(drive_of(static_cast<std::uint64_t>(seed), "tt", 0.1 * seed));
  }
  drives.push_back(drive_of(5, "tt", 7.0));  // its partner is missing
  std::vector<ReportedDrive> reported;
  for (const Drive& drive : drives) reported.push_back({&drive, {}});
  const DrivesAnswer answer = answer_of(reported);
  EXPECT_EQ(answer.answer.find("Over 4 runs of bend, tt has the smallest position error, for certain: 0.25 ± 0.21 m"),
            0u)
      << answer.answer;
  EXPECT_NE(answer.answer.find("; buff +0.01050 ± 0.00092 m."), std::string::npos) << answer.answer;
  const auto tables = repeated_tables(reported);
  ASSERT_EQ(tables.size(), 1u);
  EXPECT_EQ(tables[0].rows[0].back(), "-0.01050 ± 0.00092 less");
  EXPECT_EQ(tables[0].rows.size(), 1u) << "rows without any value";
}

// TT is 18.8 % worse in one drive, and better in the next one.
TEST(DrivesAnswer, NoWinnerIsNamedThatTheDrivesCannotDecide) {
  std::vector<Drive> drives;
  const double more[] = {0.0188, -0.01, 0.004, -0.009};
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    drives.push_back(drive_of(seed, "buff", 0.1));
    drives.push_back(drive_of(seed, "tt", 0.1 + more[seed - 1]));
  }
  std::vector<ReportedDrive> reported;
  for (const Drive& drive : drives) reported.push_back({&drive, {}});
  EXPECT_EQ(
      answer_of(reported).answer.find("4 runs of bend cannot tell which strategy has the smallest position error: "
                                      "buff 0.100 ± 0 m (95 %); tt +0.001 ± 0.021 m."),
      0u)
      << answer_of(reported).answer;
}

TEST(DrivesAnswer, AStrategyWithoutAFigureWinsNothing) {
  std::vector<Drive> drives;
  for (const std::uint64_t seed : {1u, 2u}) {
    drives.push_back({"out", "bend", "adva", {}, "adva", seed, {}, nullptr});
    drives.back().summary["deadlines_missed"] = -3;  // no count
    drives.push_back(drive_of(seed, "buff", 0.2 + 0.01 * static_cast<double>(seed)));
    drives.push_back(drive_of(seed, "tt", 0.1));
  }
  std::vector<ReportedDrive> reported;
  for (const Drive& drive : drives) reported.push_back({&drive, {}});
  const DrivesAnswer answer = answer_of(reported);
  EXPECT_NE(answer.answer.find(", tt has the smallest position error"), std::string::npos) << answer.answer;
  EXPECT_NE(answer.answer.find("; adva has no value; buff +0.1"), std::string::npos) << answer.answer;
  EXPECT_TRUE(answer.more.empty());
  EXPECT_EQ(answer_of({reported[0], reported[3]}).answer,
            "Over 2 runs of bend: No position was compared with the truth.");
}

}  // namespace
}  // namespace ttf::report::drive
