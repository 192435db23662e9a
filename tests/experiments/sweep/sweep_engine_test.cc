#include "experiments/sweep/engine.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/file_bytes.h"
#include "experiments/sweep/answers/answer_text.h"
#include "tests/experiments/sweep/small_sweep.h"
#include "tests/experiments/sweep/store_folder.h"
#include "tests/support/full_disk.h"
#include "tests/support/patterns.h"

namespace ttf::experiments::sweep {
namespace {

class SweepEngine : public StoreFolder {
 protected:
  // The store's contents as text after all drives.
  std::string driven(const SweepDrives& drives, const std::string& name, unsigned workers) const {
    results::Store fresh = store(drives, name);
    run_sweep(drives, fresh, {}, workers, [](const SweepProgress&) {});
    return answers::runs_csv(drives.sweep(), fresh);
  }
};

TEST_F(SweepEngine, TheSameForAnyNumberOfWorkers) {
  const SweepFile sweep = small_sweep(5);
  const SweepDrives drives(sweep);
  const std::string one = driven(drives, "1", 1);
  EXPECT_EQ(std::count(one.begin(), one.end(), '\n'), 1 + 2 * 2 * 5);
  EXPECT_EQ(driven(drives, "2", 2), one);
  EXPECT_EQ(driven(drives, "8", 8), one);
}

// Workers meet in all that trackers share.
TEST_F(SweepEngine, TheSameWithEveryTrackerForAnyNumberOfWorkers) {
  std::string scenario = read_file(TTF_SOURCE_DIR "/scenarios/dynamics.yaml");  // an axis varies written keys only
  scenario += "  motion: constant_velocity\n  filter: extended\n  systematic: ignore\n  association: nearest\n";
  std::ofstream(path("trackers.yaml")) << support::replaced(scenario, "\\.\\./", TTF_SOURCE_DIR "/");
  std::string text = support::replaced(sweep_text(1), "\\.\\./.*yaml", path("trackers.yaml"));
  text.insert(text.find("measures:"),
              "  tracker:\n"
              "    settings:\n"
              "      turning: {tracker.motion: ctrv, tracker.filter: unscented}\n"
              "      interacting: {tracker.motion: interacting}\n"
              "      considering: {tracker.systematic: consider}\n"
              "      joint: {tracker.association: jpda}\n");
  const SweepFile sweep = parse_sweep(text, TTF_SOURCE_DIR "/experiments/small.yaml");
  const SweepDrives drives(sweep);
  const std::string one = driven(drives, "1", 1);
  EXPECT_EQ(support::matches(one, ",done,").size(), 2U * 4 * 2);
  EXPECT_EQ(driven(drives, "4", 4), one);
}

// Clocks are compared only where their precision is asked for; nothing else changes.
TEST_F(SweepEngine, PrecisionIsThereWhereItIsAskedFor) {
  SweepFile sweep = small_sweep(1);
  const results::Row without = SweepDrives(sweep).run({0, 0, 0});
  sweep.measures.push_back("precision");
  const results::Row with = SweepDrives(sweep).run({0, 0, 0});
  ASSERT_EQ(with.values.size(), 4u);
  EXPECT_EQ((std::vector{with.values[0], with.values[1], with.values[3]}), without.values) << "the last is track_lost";
  EXPECT_GT(with.values[2], 0.01);
  EXPECT_LT(with.values[2], 10.0);
}

// A remote worker that takes some keys at a time, and returns them one turn later.
class OneElsewhere final : public Elsewhere {
 public:
  explicit OneElsewhere(const SweepDrives& drives) : driver_(drives) {}
  std::size_t turn(const Grab& grab, const Deposit& deposit) override {
    driven += done_.size();
    deposit(std::exchange(done_, {}));
    driver_.drive(grab(), [this](results::Row row) { done_.push_back(std::move(row)); });
    return done_.size();
  }
  std::size_t driven = 0;

 private:
  Driver driver_;
  std::vector<results::Row> done_;
};

// Only drives whose vehicle commands drive have measures of the loop.
TEST_F(SweepEngine, AClosedLoopHasItsMeasures) {
  SweepFile open = small_sweep(1);
  open.measures = {"collision", "gap_error_rms", "stopping_distance"};
  results::Row undriven = SweepDrives(open).run({0, 0, 0});
  EXPECT_EQ(undriven.values.back(), 0.0) << "its tracks are judged";
  undriven.values.pop_back();
  for (const double value : undriven.values) EXPECT_TRUE(std::isnan(value));
  const SweepFile closed = parse_sweep(
      "kind: sweep\nname: loop\nquestion: Does it stop?\nscenario: ../scenarios/acc_braking_lead.yaml\nseed: 1\n"
      "replications: 1\nparadigms:\n  tt: {strategy: tt, set: {duration: 8 s}}\n"
      "axes:\n  noise: {keys: [world.acceleration_noise], values: [0, 1]}\n"
      "measures: [stopping_distance, smallest_gap, gap_error_rms, largest_deceleration, collision, collision_speed]\n",
      TTF_SOURCE_DIR "/experiments/loop.yaml");
  const results::Row row = SweepDrives(closed).run({0, 0, 0});
  ASSERT_EQ(row.status, results::kDone);
  EXPECT_TRUE(std::isnan(row.values[0])) << "it still drives";
  EXPECT_GT(row.values[1], 10.0);
  EXPECT_LT(row.values[1], 40.0);
  EXPECT_GT(row.values[2], 0.1);
  EXPECT_GT(row.values[3], 1.0);
  EXPECT_EQ(row.values[4], 0.0);
  EXPECT_TRUE(std::isnan(row.values[5]));
}

// A drive along a lane has its place there. One without the services has none of their measures.
TEST_F(SweepEngine, ServicesThatKeepALaneAndWatchABlindSpotHaveTheirs) {
  const auto values = [](const char* scenario) {
    const SweepFile sweep = parse_sweep(
        fmt::format(
            "kind: sweep\nname: lane\nquestion: Does it stay?\nscenario: ../scenarios/{}.yaml\nseed: 1\n"
            "replications: 1\nparadigms:\n  tt: {{strategy: tt, set: {{duration: 4500 ms}}}}\n"
            "axes:\n  noise: {{keys: [world.acceleration_noise], values: [0, 1]}}\n"
            "measures: [lane_offset_rms, lane_offset_largest, beyond_mark, departures, departure_warnings_wrong, "
            "departure_lateness, blind_spot_hazards, blind_spot_warnings_right, blind_spot_warnings_missed]\n",
            scenario),
        TTF_SOURCE_DIR "/experiments/lane.yaml");
    const results::Row row = SweepDrives(sweep).run({0, 0, 0});
    EXPECT_EQ(row.status, results::kDone);
    return row.values;
  };
  // A car overtakes from 3 s on.
  std::vector<double> with = values("blind_spot"), without = values("acc_braking_lead");
  without.pop_back();  // track_lost
  for (const double value : without) EXPECT_TRUE(std::isnan(value));
  EXPECT_GT(with[0], 0.0);
  EXPECT_GE(with[1], with[0]);
  EXPECT_LT(with[1], 0.85) << "no side reaches its mark";
  for (const std::size_t none : {2, 3, 4}) EXPECT_EQ(with[none], 0.0) << none;
  EXPECT_TRUE(std::isnan(with[5])) << "no warning is late";
  EXPECT_EQ(with[6], 1.0);
  EXPECT_EQ(with[7] + with[8], 1.0) << "it is warned of, or missed";
}

TEST_F(SweepEngine, TheSameWhereOthersDriveToo) {
  const SweepFile sweep = small_sweep(20);
  const SweepDrives drives(sweep);
  const std::string alone = driven(drives, "alone", 2);
  results::Store shared = store(drives, "shared");
  OneElsewhere other(drives);
  run_sweep(
      drives, shared, {}, 1, [](const SweepProgress&) {}, &other);
  EXPECT_EQ(answers::runs_csv(sweep, shared), alone);
  EXPECT_GT(other.driven, 0u);
  EXPECT_LT(other.driven, 80u);
}

TEST_F(SweepEngine, ShardsPutTogetherAreTheWhole) {
  const SweepFile sweep = small_sweep(5);
  const SweepDrives drives(sweep);
  const std::string whole = driven(drives, "whole", 2);
  results::Store first = store(drives, "first"), second = store(drives, "second"), both = store(drives, "both");
  run_sweep(drives, first, {0, 2}, 2, [](const SweepProgress&) {});
  run_sweep(drives, second, {1, 2}, 2, [](const SweepProgress&) {});
  EXPECT_EQ(first.count(), 12u);
  EXPECT_EQ(second.count(), 8u);
  for (results::Store* part : {&second, &first}) part->for_each([&](const results::Row& row) { both.add({row}); });
  EXPECT_EQ(answers::runs_csv(sweep, both), whole);
}

TEST_F(SweepEngine, OnlyWhatIsMissingIsDriven) {
  const SweepFile sweep = small_sweep(4);
  const SweepDrives drives(sweep);
  const std::string whole = driven(drives, "whole", 2);
  results::Store some = store(drives, "some");
  some.add({drives.run({1, 2, 0}), drives.run({0, 0, 1})});
  SweepProgress last;
  run_sweep(drives, some, {}, 2, [&](const SweepProgress& now) { last = now; });
  EXPECT_EQ(last.driven, 14u);
  EXPECT_EQ(last.done, 16u);
  EXPECT_EQ(last.all, 16u);
  EXPECT_EQ(answers::runs_csv(sweep, some), whole);
}

// A replication's draws are the same for all paradigms and points, and are stored beside the measures.
TEST_F(SweepEngine, DrawnAxesAreDrawnOnceAReplication) {
  std::string text = sweep_text(3);
  text.insert(text.find("measures:"), "  q: {keys: [tracker.process_noise], uniform: [0.1, 5]}\n");
  const SweepFile with_draws = parse_sweep(text, TTF_SOURCE_DIR "/experiments/small.yaml");
  const SweepDrives drives(with_draws);
  EXPECT_THAT(drives.columns(), testing::ElementsAre("q", "position_rmse_truth", "age_fused", "track_lost"));
  const results::Row one = drives.run({0, 1, 0}), other = drives.run({1, 1, 1}), next = drives.run({0, 2, 0});
  EXPECT_EQ(one.values[0], other.values[0]);
  EXPECT_NE(one.values[0], next.values[0]);
  EXPECT_GE(one.values[0], 0.1);
  EXPECT_LT(one.values[0], 5.0);
  EXPECT_EQ(drives.prepare({0, 1, 0}).scenario.tracker.process_noise, one.values[0]);
}

// A point that is certain enough after a batch gets no more.
TEST_F(SweepEngine, StopsWhereItIsSureEnough) {
  const SweepFile enough = small_sweep(9, "stop: {half_width: 1e6, batch: 3}\n");
  const SweepDrives some(enough);
  results::Store first = store(some, "enough");
  run_sweep(some, first, {}, 2, [](const SweepProgress&) {});
  EXPECT_EQ(first.count(), 2u * 2u * 3u);
  const SweepFile never = small_sweep(5, "stop: {half_width: 0, batch: 3}\n");
  const SweepDrives all(never);
  results::Store second = store(all, "never");
  run_sweep(all, second, {}, 2, [](const SweepProgress&) {});
  EXPECT_EQ(second.count(), 2u * 2u * 5u);
}

// The disk is full after the first batch of two. With room again, the sweep goes on where it was.
TEST_F(SweepEngine, AFullDiskEndsItAndLosesNothing) {
  const SweepFile sweep = small_sweep(6, "stop: {half_width: 0, batch: 3}\n");
  const SweepDrives drives(sweep);
  const std::string whole = driven(drives, "whole", 2);
  results::Store some = store(drives, "some");
  std::optional<support::FullDisk> full;
  std::uint64_t written = 0;
  const auto fill = [&](const SweepProgress& now) {
    written = now.driven;
    if (written >= 12 && !full) full.emplace(512);
  };
  std::string words;
  try {
    run_sweep(drives, some, {}, 2, fill);
  } catch (const std::runtime_error& error) {
    words = error.what();
  }
  full.reset();
  EXPECT_THAT(words, testing::AnyOf(testing::HasSubstr("some: database or disk is full"),
                                    testing::HasSubstr("some: disk I/O error")));
  EXPECT_EQ(written, 12u);
  EXPECT_EQ(some.count(), 12u);
  SweepProgress last;
  run_sweep(drives, some, {}, 2, [&](const SweepProgress& now) { last = now; });
  EXPECT_EQ(last.driven, 12u);
  EXPECT_EQ(answers::runs_csv(sweep, some), whole);
}

}  // namespace
}  // namespace ttf::experiments::sweep
