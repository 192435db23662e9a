// The replay: every list has one fate, and lists are released when allowed. Strategies with the same final
// information give the same result, to the last bit.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "recording/replay/replay.h"
#include "recording/replay/sensor_timing.h"
#include "tests/recording/replay/replay_rows.h"

namespace ttf::recording::replay {
namespace {

using fusion::strategies::StrategyKind;

struct Outcome {
  ReplayAccount account;
  std::vector<std::string> lines;  // the tracks as written
  std::vector<GlobalTime> known;   // the instants of fusions that took something in
  std::vector<recording::rows::TrackRow> last;
};

Outcome outcome_of(const RecordedLists& arrivals, const ReplayConfig& config, StrategyKind strategy,
                   bool predict = false) {
  Outcome outcome;
  const ReplaySetup setup{strategy, config.tracker, sensor_timings(arrivals, config, strategy), predict};
  outcome.account = replay(arrivals, setup, [&](GlobalTime known, std::span<const fusion::tracks::TrackView> tracks) {
    outcome.known.push_back(known);
    outcome.last.clear();
    for (const fusion::tracks::TrackView& track : tracks) {
      outcome.last.push_back(track_row_of(track, known, arrivals.classes));
      outcome.lines.push_back(recording::rows::track_line(outcome.last.back()));
    }
  });
  return outcome;
}

// Compares every number of the last tracks, but not their names: those follow the order of confirmation.
void expect_same_end(const Outcome& a, const Outcome& b) {
  ASSERT_EQ(a.last.size(), b.last.size());
  for (std::size_t i = 0; i < a.last.size(); ++i) {
    recording::rows::TrackRow one = a.last[i], other = b.last[i];
    one.known_ns = other.known_ns = 0;
    one.track = other.track = 0;
    EXPECT_EQ(recording::rows::track_line(one), recording::rows::track_line(other));
    EXPECT_EQ(one.x, other.x);
    EXPECT_EQ(one.vy, other.vy);
    EXPECT_EQ(one.covariance, other.covariance);
  }
}

std::uint64_t fates(const SensorAccount& account) {
  return account.in_order + account.late + account.too_old + account.duplicates;
}

TEST(TrackReplay, FollowsBothCars) {
  ReplayConfig config;
  const RecordedLists arrivals = recorded_lists_of_rows(two_cars(10), config);
  const Outcome outcome = outcome_of(arrivals, config, StrategyKind::kAdva);
  EXPECT_EQ(outcome.account.tracks, 2u);
  EXPECT_EQ(outcome.account.rows, outcome.lines.size());
  ASSERT_EQ(outcome.last.size(), 2u);
  // The last camera list is from 9.95 s.
  EXPECT_NEAR(outcome.last[0].x, 10.0 + 8.0 * 9.95, 0.5);
  EXPECT_NEAR(outcome.last[1].x, 40.0 + 8.0 * 9.95, 0.5);
  EXPECT_NEAR(outcome.last[0].vx, 8.0, 1.0);
  EXPECT_EQ(outcome.last[0].time_ns, 9'950'000'000);
  EXPECT_FALSE(outcome.last[0].coasting);
  ASSERT_EQ(outcome.account.sensors.size(), 2u);
  for (const SensorAccount& sensor : outcome.account.sensors) EXPECT_EQ(sensor.in_order, sensor.lists);
  EXPECT_EQ(outcome.account.sensors[0].lists, 200u);
  EXPECT_EQ(outcome.account.sensors[0].observations, 400u);
}

// Rows number their classes by the alphabet: a van is 1, the tracker's truck. Without a class of this name, reports are of none
// of its classes.
TEST(TrackReplay, ReportsAreOfTheClassOfTheirName) {
  for (const auto& [name, length] : {std::pair{"van", 5.5}, {"truck", 12.0}, {"car", 4.4}, {"bus", 4.4}}) {
    ReplayConfig config;
    for (const fusion::config::ClassPrior& prior : fusion::config::kClassPriors)
      config.tracker.classes.push_back(prior);
    std::vector<recording::rows::ObservationRow> rows;
    for (std::int64_t ms = 0; ms < 1000; ms += 50) {
      rows.push_back(position_row("camera", ms, ms, 20.0, 0.0));
      rows.back().width = 2.0;
      rows.back().sigma_width = 0.5;
      rows.back().class_name = name;
    }
    rows.push_back(position_row("camera", 0, 0, 90.0, 0.0));
    rows.back().class_name = "aeroplane";
    const RecordedLists arrivals = recorded_lists_of_rows(rows, config);
    ASSERT_EQ(arrivals.classes, (std::vector<std::string>{"aeroplane", name}));
    double seen = 0.0;
    const ReplaySetup setup{StrategyKind::kAdva, config.tracker, sensor_timings(arrivals, config, StrategyKind::kAdva)};
    replay(arrivals, setup, [&](GlobalTime, std::span<const fusion::tracks::TrackView> tracks) {
      ASSERT_LE(tracks.size(), 1u);
      if (!tracks.empty()) seen = tracks.front().length;
    });
    EXPECT_NEAR(seen, length, 1e-6) << name;
  }
}

TEST(TrackReplay, AdvaEndsTheSameForEveryOrderOfArrival) {
  ReplayConfig config;
  const RecordedLists in_order = recorded_lists_of_rows(two_cars(6), config);
  const Outcome expected = outcome_of(in_order, config, StrategyKind::kAdva);
  for (const std::uint64_t seed : {1u, 2u, 3u})
    for (const std::size_t shuffle : {std::size_t{1}, std::size_t{7}, std::size_t{30}}) {
      RecordedLists arrivals = in_order;
      SimulatedArrivals simulated;
      if (shuffle == 1) simulated.delays.assign(2, SimulatedArrivals::Delay{Duration{}, Duration::milliseconds(400)});
      simulated.shuffle = shuffle;
      simulated.seed = seed;
      simulate(arrivals, simulated);
      const Outcome outcome = outcome_of(arrivals, config, StrategyKind::kAdva);
      EXPECT_GT(outcome.account.sensors[0].late, 20u);
      EXPECT_EQ(outcome.account.sensors[0].too_old + outcome.account.sensors[1].too_old, 0u);
      expect_same_end(expected, outcome);
    }
}

// A backward radar at the back with a known error: the same tracks as with a correct one at the origin.
TEST(TrackReplay, FollowsBothCarsFromAnotherPlace) {
  ReplayConfig plain;
  const Outcome expected = outcome_of(recorded_lists_of_rows(two_cars(10), plain), plain, StrategyKind::kAdva);
  std::vector<recording::rows::ObservationRow> rows = two_cars(10);
  for (recording::rows::ObservationRow& row : rows) {
    if (row.sensor == "radar") {
      row.z[0] += 0.4;
      row.z[1] += std::numbers::pi + 0.02;
    } else {
      const double x = row.z[0] - 1.5, y = row.z[1] - 0.5;
      row.z = {y, -x, 0.0};
    }
  }
  ReplayConfig placed = parse_replay_config(
      "sensors:\n"
      "  camera: {mounting: {x: 1.5, y: 0.5, heading: 1.5707963267948966}}\n"
      "  radar: {mounting: {heading: 3.141592653589793}, bias: {range: 0.4, bearing: 0.02}}\n",
      "c.yaml", {});
  const Outcome outcome = outcome_of(recorded_lists_of_rows(rows, placed), placed, StrategyKind::kAdva);
  ASSERT_EQ(outcome.last.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(outcome.last[i].x, expected.last[i].x, 1e-6);
    EXPECT_NEAR(outcome.last[i].y, expected.last[i].y, 1e-6);
    EXPECT_NEAR(outcome.last[i].vx, expected.last[i].vx, 1e-6);
    for (std::size_t k = 0; k < outcome.last[i].covariance.size(); ++k)
      EXPECT_NEAR(outcome.last[i].covariance[k], expected.last[i].covariance[k], 1e-6);
  }
}

// Two sensors disagree within their biases: the tracks' considered covariances contain the biases.
TEST(TrackReplay, ConsideredBiasesAreInTheTracks) {
  const char* kSensors = "sensors: {camera: {bias_sigma: {x: 0.5, y: 0.5}}, radar: {bias_sigma: {bearing: 0.02}}}\n";
  std::vector<ReplayConfig> configs{
      parse_replay_config(kSensors, "c.yaml", {}),
      parse_replay_config(std::string(kSensors) + "tracker: {systematic: consider}\n", "c.yaml", {})};
  std::vector<Outcome> outcomes;
  for (ReplayConfig& config : configs)
    outcomes.push_back(outcome_of(recorded_lists_of_rows(two_cars(10), config), config, StrategyKind::kAdva));
  ASSERT_EQ(outcomes[1].last.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    // In y: both sensors may be biased in it, for any number of observations.
    EXPECT_GT(outcomes[1].last[i].covariance[4], 2.0 * outcomes[0].last[i].covariance[4]);
    EXPECT_GT(outcomes[1].last[i].covariance[4], 0.1);
  }
}

TEST(TrackReplay, EveryListHasItsFateInEachWayThatBuffWaits) {
  for (const fusion::config::BuffWaiting waits :
       {fusion::config::BuffWaiting::kSchedule, fusion::config::BuffWaiting::kMeasured,
        fusion::config::BuffWaiting::kFixedLag}) {
    ReplayConfig config;
    RecordedLists arrivals = recorded_lists_of_rows(two_cars(4), config);
    config.tracker.buff_waits = waits;
    config.tracker.fixed_lag = Duration::milliseconds(25);
    SimulatedArrivals simulated;
    simulated.delays.assign(2, SimulatedArrivals::Delay{Duration{}, Duration::milliseconds(45)});
    simulate(arrivals, simulated);
    const Outcome outcome = outcome_of(arrivals, config, StrategyKind::kBuff);
    expect_same_end(outcome_of(arrivals, config, StrategyKind::kAdva), outcome);
    for (const SensorAccount& sensor : outcome.account.sensors) EXPECT_EQ(fates(sensor), sensor.lists);
    const std::uint64_t late = outcome.account.sensors[0].late + outcome.account.sensors[1].late;
    if (waits == fusion::config::BuffWaiting::kSchedule) {
      EXPECT_EQ(late, 0u);
    }
    if (waits == fusion::config::BuffWaiting::kFixedLag) {
      EXPECT_GT(late, 0u);
      EXPECT_LE(outcome.account.sensors[0].longest_hold, Duration::milliseconds(25));
      EXPECT_GT(outcome.account.sensors[0].longest_hold, Duration::milliseconds(15)) << "some list came nearly at once";
    }
  }
}
// A measurement just before the first instant of its sensor's schedule is that instant's.
TEST(TrackReplay, TtWaitsForTheScheduleFromItsFirstInstantOn) {
  ReplayConfig config;
  const RecordedLists arrivals =
      recorded_lists_of_rows({position_row("a", 999, 1000, 1, 0), position_row("b", 999, 1000, 1, 0)}, config);
  for (auto& [name, setup] : config.sensors) {
    setup.period = Duration::milliseconds(100);
    setup.first = GlobalTime{1'000'000'000};
    setup.worst_delay = Duration::milliseconds(50);
  }
  RecordedLists alone = arrivals;
  alone.lists.resize(1);
  const Outcome outcome = outcome_of(alone, config, StrategyKind::kTt);
  EXPECT_EQ(outcome.account.sensors[0].in_order, 1u);
  EXPECT_EQ(outcome.account.sensors[0].longest_hold, Duration::milliseconds(50));
}
// The camera calls the near car a van twice as often as a car. For the other one, both names are equally
// frequent, and the first one counts.
TEST(TrackReplay, ClassAndThirdAxisGoWithTheTrackForEveryOrderOfArrival) {
  ReplayConfig config;
  std::vector<recording::rows::ObservationRow> rows = two_cars(2);
  int seen = 0;
  for (recording::rows::ObservationRow& row : rows) {
    if (row.sensor != "camera") continue;
    const bool near = seen % 2 == 0;
    row.class_name = near ? (seen % 6 == 0 ? "car" : "van") : (seen % 4 == 1 ? "van" : "car");
    row.score = near ? 0.25 : 0.5;
    row.elevation = 0.001 * static_cast<double>(row.time_ns / 1'000'000);
    if (near) row.height = 2.0;
    ++seen;
  }
  rows.back().class_name = "zebra";  // in the radar's last list, with which the tracks end
  rows.back().score = 0.0;
  const RecordedLists in_order = recorded_lists_of_rows(rows, config);
  EXPECT_THAT(in_order.classes, testing::ElementsAre("car", "van", "zebra"));
  const Outcome expected = outcome_of(in_order, config, StrategyKind::kAdva);
  ASSERT_EQ(expected.last.size(), 2u);
  const std::size_t near = expected.last[0].x < expected.last[1].x ? 0 : 1;
  EXPECT_EQ(expected.last[near].class_name, "van");
  EXPECT_NEAR(expected.last[near].class_share, 26.0 / 40.0, 1e-12)
      << "every third of 40 lists says car, the first one, too";
  EXPECT_EQ(expected.last[near].height, 2.0);
  EXPECT_EQ(expected.last[near].z, 1.95) << "of the newest that had it";
  EXPECT_EQ(expected.last[1 - near].class_name, "car");
  EXPECT_EQ(expected.last[1 - near].class_share, 0.5);
  EXPECT_FALSE(expected.last[1 - near].height);
  RecordedLists shuffled = in_order;
  SimulatedArrivals simulated;
  simulated.shuffle = 25;
  simulate(shuffled, simulated);
  expect_same_end(expected, outcome_of(shuffled, config, StrategyKind::kAdva));
}

TEST(TrackReplay, AllStrategiesEndTheSameAndLoseNothing) {
  ReplayConfig config;
  RecordedLists arrivals = recorded_lists_of_rows(two_cars(6), config);
  SimulatedArrivals simulated;
  simulated.delays = {SimulatedArrivals::Delay{Duration{}, Duration::milliseconds(30)},
                      SimulatedArrivals::Delay{Duration::milliseconds(40), Duration::milliseconds(100)}};
  simulate(arrivals, simulated);
  const Outcome adva = outcome_of(arrivals, config, StrategyKind::kAdva);
  EXPECT_GT(adva.account.sensors[1].late, 40u);
  EXPECT_EQ(adva.account.sensors[0].held, 0u);
  for (const StrategyKind strategy : {StrategyKind::kBuff, StrategyKind::kTt}) {
    const Outcome outcome = outcome_of(arrivals, config, strategy);
    expect_same_end(adva, outcome);
    for (const SensorAccount& sensor : outcome.account.sensors) {
      EXPECT_EQ(sensor.late, 0u) << "the worst delays are as they were seen, so nothing is fused too early";
      EXPECT_EQ(fates(sensor), sensor.lists);
    }
    EXPECT_GT(outcome.account.sensors[0].held, 60u);
    EXPECT_GT(outcome.account.sensors[0].longest_hold.ns, 0);
    EXPECT_LE(outcome.account.sensors[0].longest_hold, Duration::milliseconds(100));
  }
}

// A list of the camera at 0 ms waits for the radar, whose worst delay is 80 ms; no other list ever comes.
//   camera  0 ------------------------ arrives 10
//   BUFF                                            let go at 80
TEST(TrackReplay, AHeldListIsLetGoWhenTheWorstDelayIsOver) {
  ReplayConfig config;
  config.tracker.confirm_hits = config.tracker.confirm_window = 1;
  config.sensors = {{"camera", {}}, {"radar", {}}};
  config.sensors[1].second.worst_delay = Duration::milliseconds(80);
  const RecordedLists arrivals = recorded_lists_of_rows({position_row("camera", 0, 10, 5, 0)}, config);
  const Outcome buff = outcome_of(arrivals, config, StrategyKind::kBuff);
  EXPECT_THAT(buff.known, testing::ElementsAre(GlobalTime{80'000'000}));
  EXPECT_EQ(buff.account.sensors[0].held, 1u);
  EXPECT_EQ(buff.account.sensors[0].longest_hold, Duration::milliseconds(70));
  EXPECT_EQ(buff.account.sensors[0].longest_delay, Duration::milliseconds(10));
  EXPECT_EQ(buff.last[0].time_ns, 0);
  EXPECT_EQ(outcome_of(arrivals, config, StrategyKind::kBuff, true).last[0].time_ns, 80'000'000)
      << "predicted to the instant of the fusion";

  // TT: the radar's last instant before is at -30 ms, so its list is there by 50 ms.
  config.sensors[1].second.period = Duration::milliseconds(100);
  config.sensors[1].second.first = GlobalTime{-30'000'000};
  EXPECT_THAT(outcome_of(arrivals, config, StrategyKind::kTt).known, testing::ElementsAre(GlobalTime{50'000'000}));
}

TEST(TrackReplay, DuplicatesAndWhatIsTooOldAreCounted) {
  ReplayConfig config;
  config.tracker.history_scans = 4;
  std::vector<recording::rows::ObservationRow> rows;
  for (std::int64_t ms = 0; ms < 1000; ms += 50) {
    rows.push_back(position_row("a", ms, ms, 10.0, 0.0));
    if (ms == 500) rows.push_back(position_row("a", ms, ms + 20, 10.0, 0.0));  // received twice
  }
  rows.push_back(position_row("b", 100, 900, 10.0, 0.0));  // older than the history
  const RecordedLists arrivals = recorded_lists_of_rows(rows, config);
  for (const StrategyKind strategy : {StrategyKind::kAdva, StrategyKind::kBuff}) {
    const ReplayAccount account = outcome_of(arrivals, config, strategy).account;
    EXPECT_EQ(account.sensors[0].duplicates, 1u);
    EXPECT_EQ(account.sensors[0].lists, 21u);
    EXPECT_EQ(fates(account.sensors[0]), 21u);
    EXPECT_EQ(fates(account.sensors[1]), 1u);
    if (strategy == StrategyKind::kAdva) {
      EXPECT_EQ(account.sensors[1].too_old, 1u);
    }
  }
}

TEST(TrackReplay, NumbersFarFromZeroStayFinite) {
  ReplayConfig config;
  std::vector<recording::rows::ObservationRow> rows;
  for (std::int64_t ms = 0; ms < 500; ms += 50) {
    rows.push_back(position_row("a", 3'999'999'000'000 + ms, 3'999'999'000'000 + ms, 1e7, -1e7));
    rows.back().covariance = {{1e-8, 0.0, 1e8, 0.0, 0.0, 0.0}};
    rows.push_back(rows.back());
    rows.back().sensor = "b";
    rows.back().kind = recording::rows::ObservationRow::Kind::kRangeBearingRate;
    rows.back().z = {1e7, -100.0, 1e4};
    rows.back().covariance = {{1e8, 0.0, 1e-8, 0.0, 0.0, 1e-8}};
  }
  const RecordedLists arrivals = recorded_lists_of_rows(rows, config);
  const Outcome outcome = outcome_of(arrivals, config, StrategyKind::kAdva);
  for (const std::string& line : outcome.lines) {
    EXPECT_EQ(line.find("nan"), std::string::npos) << line;
    EXPECT_EQ(line.find("inf"), std::string::npos) << line;
  }
}

}  // namespace
}  // namespace ttf::recording::replay
