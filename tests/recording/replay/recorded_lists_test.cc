// Rows become lists in the order of arrival. Simulated delays depend only on sensor and number.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "fusion/strategies/strategy.h"
#include "recording/replay/recorded_lists.h"
#include "recording/replay/sensor_timing.h"
#include "tests/recording/replay/replay_rows.h"

namespace ttf::recording::replay {
namespace {

using testing::ElementsAre;

constexpr GlobalTime ms(std::int64_t count) { return GlobalTime{count * 1'000'000}; }

std::vector<std::string> sentences_of(const Findings& findings) {
  std::vector<std::string> sentences;
  for (const Finding& finding : findings.list()) sentences.push_back(finding.sentence());
  return sentences;
}

TEST(RecordedLists, RowsOfOneSensorTimeAndArrivalAreAList) {
  ReplayConfig config;
  const RecordedLists arrivals = recorded_lists_of_rows(
      {position_row("b", 0, 90, 1, 0), position_row("a", 0, 20, 2, 0), position_row("b", 0, 90, 3, 0),
       position_row("a", 50, 70, 4, 0), position_row("b", 100, 80, 5, 0), position_row("a", 50, 95, 6, 0)},
      config);
  EXPECT_THAT(arrivals.sensors, ElementsAre("a", "b")) << "by name, whoever comes first";
  ASSERT_EQ(arrivals.lists.size(), 5u);
  const auto& l = arrivals.lists;
  EXPECT_EQ(l[0].id, (MeasurementId{SensorId{0}, 0}));
  EXPECT_EQ(l[1].id, (MeasurementId{SensorId{0}, 1}));
  EXPECT_EQ(l[2].id, (MeasurementId{SensorId{1}, 1})) << "numbered by time, not by arrival";
  EXPECT_EQ(l[3].id, (MeasurementId{SensorId{1}, 0}));
  EXPECT_EQ(l[3].observations.size(), 2u);
  EXPECT_EQ(l[3].observations[1].z(0), 3.0);
  EXPECT_EQ(l[4].id, l[1].id) << "the list of 50 ms, heard again";
  EXPECT_EQ(l[4].copy, 1u);
  EXPECT_EQ(l[1].copy, 0u);
  EXPECT_EQ(l[1].measured, ms(50));
  EXPECT_EQ(l[1].arrival, ms(70));
}

TEST(RecordedLists, NoiseIsTheRowsOwnOrTheSensors) {
  ReplayConfig config;
  config.sensors = {{"s", {}}};
  config.sensors[0].second.noise = {0.4, 0.6, 0.02, 0.7, 0.1, 0.3, 0.2};
  std::vector<recording::rows::ObservationRow> rows{position_row("s", 0, 0, 1, 2), position_row("s", 0, 0, 3, 4),
                                                    position_row("s", 0, 0, 5, 0.5)};
  rows[0].covariance = {{0.25, 0.1, 0.09, 0, 0, 0}};
  rows[0].heading = 1.0;
  rows[0].length = 4.0;
  rows[0].sigma_length = 0.05;
  rows[1].kind = recording::rows::ObservationRow::Kind::kRangeBearingRate;
  rows[2].kind = recording::rows::ObservationRow::Kind::kRangeBearing;
  const RecordedLists arrivals = recorded_lists_of_rows(rows, config);
  ASSERT_EQ(arrivals.lists.size(), 1u);
  const auto& o = arrivals.lists[0].observations;
  EXPECT_EQ(o[0].r(0, 1), 0.1);
  EXPECT_EQ(o[0].r(1, 0), 0.1);
  EXPECT_EQ(o[0].r(1, 1), 0.09);
  EXPECT_TRUE(o[0].has_heading && o[0].has_length && !o[0].has_width && !o[0].has_span);
  EXPECT_EQ(o[0].sigma_heading, 0.1);
  EXPECT_EQ(o[0].sigma_length, 0.05);
  EXPECT_EQ(o[1].kind, fusion::sensors::ObservationKind::kRangeBearingRate);
  EXPECT_EQ(o[1].r.diagonal(), Eigen::Vector3d(0.6 * 0.6, 0.02 * 0.02, 0.7 * 0.7));
  EXPECT_EQ(o[2].kind, fusion::sensors::ObservationKind::kPosition) << "without a rate: converted";
  EXPECT_NEAR(o[2].z.head<2>().norm(), 5.0, 0.01);
}

TEST(RecordedLists, ARowThatNoFilterCanTakeIsAFinding) {
  ReplayConfig config;
  config.file = "c.yaml";
  config.sensors = {{"a", {}}, {"b", {}}};
  std::vector<recording::rows::ObservationRow> rows{position_row("a", 0, 0, 1, 0), position_row("c", 0, 0, 2, 0),
                                                    position_row("b", 0, 0, 3, 0)};
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].line = static_cast<int>(i) + 2;
  rows[2].covariance = {{0.04, 0.2, 0.04, 0, 0, 0}};
  for (std::size_t i = 0; i < config.tracker.max_observations; ++i) rows.push_back(position_row("a", 0, 0, 1, 0));
  rows.back().line = 99;
  Findings findings;
  const RecordedLists arrivals = recorded_lists_of(rows, config, "o.csv", findings);
  EXPECT_THAT(sentences_of(findings),
              ElementsAre("o.csv:3: sensor = c: must be a sensor of c.yaml: a or b",
                          "o.csv:4: covariance: must be positive definite beyond rounding errors",
                          "o.csv:99: sensor = a: must have at most 64 observations at one time "
                          "(max_observations of the tracker)"));
  ASSERT_EQ(arrivals.lists.size(), 1u);
  EXPECT_EQ(arrivals.lists[0].observations.size(), 64u);
}

TEST(RecordedLists, ClassesAreNumberedByTheirNames) {
  ReplayConfig config;
  std::vector<recording::rows::ObservationRow> rows;
  for (int i = 0; i < 17; ++i) {
    rows.push_back(position_row("a", i, i, 0, 0));
    rows.back().class_name = std::string(1, static_cast<char>('z' - i));
    rows.back().line = i + 2;
  }
  try {
    recorded_lists_of_rows(rows, config);
    FAIL() << "17 classes";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "o.csv:18: class = j: must be one of at most 16 classes");
  }
  rows.pop_back();
  rows.back().class_name.clear();
  const RecordedLists arrivals = recorded_lists_of_rows(rows, config);
  EXPECT_EQ(arrivals.classes.front(), "l");
  EXPECT_EQ(arrivals.lists[0].observations[0].class_id, fusion::sensors::ClassId{14}) << "z";
  EXPECT_EQ(arrivals.lists[0].observations[0].score, 1.0);
  EXPECT_EQ(arrivals.lists[15].observations[0].class_id, fusion::sensors::kNoClass);
}

std::map<MeasurementId, GlobalTime> arrival_of(const RecordedLists& arrivals) {
  std::map<MeasurementId, GlobalTime> result;
  for (const RecordedList& list : arrivals.lists) result[list.id] = list.arrival;
  return result;
}

TEST(SimulatedArrivals, DelaysAreWithinTheirBoundsAndOfTheSeed) {
  ReplayConfig config;
  const RecordedLists recorded = recorded_lists_of_rows(two_cars(10), config);
  SimulatedArrivals simulated;
  simulated.delays = {std::nullopt, SimulatedArrivals::Delay{Duration::milliseconds(20), Duration::milliseconds(170)}};
  simulated.seed = 3;
  RecordedLists once = recorded, twice = recorded, other = recorded;
  simulate(once, simulated);
  simulate(twice, simulated);
  simulated.seed = 4;
  simulate(other, simulated);
  EXPECT_EQ(arrival_of(once), arrival_of(twice));
  EXPECT_NE(arrival_of(once), arrival_of(other));
  Duration least = Duration::milliseconds(1000), most;
  for (const RecordedList& list : once.lists) {
    const Duration delay = list.arrival - list.measured;
    if (list.id.sensor == SensorId{0}) {
      EXPECT_EQ(delay.ns, 0) << "a sensor without a delay keeps the recorded one";
      continue;
    }
    least = std::min(least, delay);
    most = std::max(most, delay);
  }
  EXPECT_GE(least, Duration::milliseconds(20));
  EXPECT_LT(least, Duration::milliseconds(30));
  EXPECT_LE(most, Duration::milliseconds(170));
  EXPECT_GT(most, Duration::milliseconds(160));
  EXPECT_TRUE(std::is_sorted(once.lists.begin(), once.lists.end(),
                             [](const RecordedList& a, const RecordedList& b) { return a.arrival < b.arrival; }));

  // Without the camera, the radar's delays stay the same.
  std::vector<recording::rows::ObservationRow> rows = two_cars(10);
  std::erase_if(rows, [](const recording::rows::ObservationRow& row) { return row.sensor == "camera"; });
  RecordedLists alone = recorded_lists_of_rows(rows, config);
  simulated.seed = 3;
  simulate(alone, simulated);
  const auto with_camera = arrival_of(once);
  for (const auto& [id, arrival] : arrival_of(alone)) EXPECT_EQ(with_camera.at(id), arrival);
}

TEST(SimulatedArrivals, AShuffleKeepsEachBlockTogether) {
  ReplayConfig config;
  const RecordedLists recorded = recorded_lists_of_rows(two_cars(2), config);
  SimulatedArrivals simulated;
  simulated.shuffle = 8;
  RecordedLists shuffled = recorded;
  simulate(shuffled, simulated);
  ASSERT_EQ(shuffled.lists.size(), recorded.lists.size());
  int moved = 0;
  for (std::size_t from = 0; from < recorded.lists.size(); from += 8) {
    const std::size_t to = std::min(from + 8, recorded.lists.size());
    std::vector<MeasurementId> before, after;
    for (std::size_t i = from; i < to; ++i) {
      before.push_back(recorded.lists[i].id);
      after.push_back(shuffled.lists[i].id);
      moved += before.back() != after.back();
      EXPECT_EQ(shuffled.lists[i].arrival, recorded.lists[to - 1].arrival);
      EXPECT_GE(shuffled.lists[i].arrival, shuffled.lists[i].measured);
    }
    EXPECT_THAT(after, testing::UnorderedElementsAreArray(before));
  }
  EXPECT_GT(moved, 40);
}

TEST(SensorTiming, WorstDelaysAreTheConfigurationsOrTheLongestSeen) {
  ReplayConfig config;
  const RecordedLists arrivals = recorded_lists_of_rows(
      {position_row("a", 0, 20, 0, 0), position_row("a", 50, 110, 0, 0), position_row("b", 0, 5, 0, 0)}, config);
  EXPECT_THAT(longest_delays(arrivals), ElementsAre(Duration::milliseconds(60), Duration::milliseconds(5)));
  config.sensors[1].second.worst_delay = Duration::milliseconds(300);
  const auto timings = sensor_timings(arrivals, config, fusion::strategies::StrategyKind::kBuff);
  ASSERT_EQ(timings.size(), 2u);
  EXPECT_EQ(timings[0].settling.settled(ms(1000)), ms(940));
  EXPECT_EQ(timings[1].settling.settled(ms(1000)), ms(700));
  EXPECT_FALSE(timings[0].scheduled);
}

TEST(SensorTiming, APeriodIsTheOneAllInstantsLieOn) {
  EXPECT_EQ(regular_period({ms(7), ms(107), ms(207), ms(507), ms(607)}), Duration::milliseconds(100))
      << "two are missing";
  EXPECT_EQ(regular_period({ms(0), ms(98), ms(203), ms(300)}), Duration::milliseconds(100)) << "a little off";
  EXPECT_EQ(regular_period({ms(0), ms(100), ms(130), ms(300), ms(400)}), std::nullopt) << "more than a quarter off";
  EXPECT_EQ(regular_period({ms(0), ms(100)}), std::nullopt);
}

TEST(SensorTiming, TtNeedsASchedule) {
  ReplayConfig config;
  config.file = "c.yaml";
  const RecordedLists arrivals = recorded_lists_of_rows(two_cars(2), config);
  const auto seen = sensor_timings(arrivals, config, fusion::strategies::StrategyKind::kTt);
  EXPECT_TRUE(seen[0].scheduled && seen[1].scheduled);
  EXPECT_EQ(seen[0].period, Duration::milliseconds(50));
  EXPECT_EQ(seen[1].period, Duration::milliseconds(70));
  config.sensors[0].second.period = Duration::milliseconds(25);
  config.sensors[0].second.first = ms(-75);
  const auto given = sensor_timings(arrivals, config, fusion::strategies::StrategyKind::kTt);
  EXPECT_EQ(given[0].period, Duration::milliseconds(25));
  EXPECT_EQ(given[0].first, ms(-75));
  ReplayConfig bare;
  bare.file = "c.yaml";
  const RecordedLists once = recorded_lists_of_rows({position_row("a", 0, 0, 0, 0)}, bare);
  try {
    sensor_timings(once, bare, fusion::strategies::StrategyKind::kTt);
    FAIL() << "nothing is known of any schedule";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "c.yaml: strategy = tt: needs the period of at least one sensor: no period is given, and no sensor "
                 "measures at regular instants");
  }
}

}  // namespace
}  // namespace ttf::recording::replay
