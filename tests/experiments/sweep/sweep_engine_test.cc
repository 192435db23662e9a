#include "experiments/sweep/engine.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "experiments/sweep/answer.h"
#include "experiments/sweep/text.h"
#include "tests/experiments/sweep/small_sweep.h"
#include "tests/support/full_disk.h"

namespace ttf::experiments::sweep {
namespace {

class SweepEngine : public testing::Test {
 protected:
  SweepEngine() : folder_((std::filesystem::temp_directory_path() / "ttfusion_sweep_XXXXXX").string()) {
    if (mkdtemp(folder_.data()) == nullptr) throw std::runtime_error("no folder");
  }
  ~SweepEngine() override { std::filesystem::remove_all(folder_); }

  results::Store store(const SweepDrives& drives, const std::string& name) const {
    return results::Store::create(folder_ + "/" + name, {"small", drives.identity(), "1", "", drives.columns()});
  }
  // The store's contents as text after all drives.
  std::string driven(const SweepDrives& drives, const std::string& name, unsigned workers) const {
    results::Store fresh = store(drives, name);
    run_sweep(drives, fresh, {}, workers, [](const SweepProgress&) {});
    return runs_csv(drives.sweep(), fresh);
  }
  std::string folder_;
};

TEST_F(SweepEngine, TheSameForAnyNumberOfWorkers) {
  const SweepFile sweep = small_sweep(5);
  const SweepDrives drives(sweep);
  const std::string one = driven(drives, "1", 1);
  EXPECT_EQ(std::count(one.begin(), one.end(), '\n'), 1 + 2 * 2 * 5);
  EXPECT_EQ(driven(drives, "2", 2), one);
  EXPECT_EQ(driven(drives, "8", 8), one);
}

// Clocks are compared only where their precision is asked for; nothing else changes.
TEST_F(SweepEngine, PrecisionIsThereWhereItIsAskedFor) {
  SweepFile sweep = small_sweep(1);
  const results::Row without = SweepDrives(sweep).run({0, 0, 0});
  sweep.measures.push_back("precision");
  const results::Row with = SweepDrives(sweep).run({0, 0, 0});
  ASSERT_EQ(with.values.size(), 3u);
  EXPECT_EQ(std::vector(with.values.begin(), with.values.begin() + 2), without.values);
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

TEST_F(SweepEngine, TheSameWhereOthersDriveToo) {
  const SweepFile sweep = small_sweep(40);
  const SweepDrives drives(sweep);
  const std::string alone = driven(drives, "alone", 2);
  results::Store shared = store(drives, "shared");
  OneElsewhere other(drives);
  run_sweep(
      drives, shared, {}, 1, [](const SweepProgress&) {}, &other);
  EXPECT_EQ(runs_csv(sweep, shared), alone);
  EXPECT_GT(other.driven, 0u);
  EXPECT_LT(other.driven, 160u);
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
  EXPECT_EQ(runs_csv(sweep, both), whole);
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
  EXPECT_EQ(runs_csv(sweep, some), whole);
}

// A replication's draws are the same for all paradigms and points, and are stored beside the measures.
TEST_F(SweepEngine, DrawnAxesAreDrawnOnceAReplication) {
  std::string text = sweep_text(3);
  text.insert(text.find("measures:"), "  q: {keys: [tracker.process_noise], uniform: [0.1, 5]}\n");
  const SweepFile with_draws = parse_sweep(text, TTF_SOURCE_DIR "/experiments/small.yaml");
  const SweepDrives drives(with_draws);
  EXPECT_THAT(drives.columns(), testing::ElementsAre("q", "position_rmse_truth", "age_fused"));
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
  EXPECT_EQ(runs_csv(sweep, some), whole);
}

// ---- evaluation of made-up rows

results::Row made_up(std::uint32_t point, std::uint32_t replication, std::uint32_t paradigm, double rmse) {
  return {{point, replication, paradigm}, results::kDone, {rmse, 10.0}};
}

std::string unmet(const ExpectationAnswer& answer) {
  std::string text;
  for (const Unmet& one : answer.unmet) text += one.point + ": " + one.why + "\n";
  return text;
}

TEST_F(SweepEngine, DifferencesArePaired) {
  const SweepFile sweep =
      small_sweep(4,
                  "expect: [{measure: position_rmse_truth, less: tt, than: adva, where: {noise: 40}}, "
                  "{measure: position_rmse_truth, less: tt, than: adva}]\n");
  const SweepDrives drives(sweep);
  results::Store made = store(drives, "made");
  // Both vary by far more than they differ by.
  const double common[] = {1.0, 5.0, 2.0, 9.0};
  for (std::uint32_t r = 0; r < 4; ++r)
    made.add({made_up(0, r, 0, common[r]), made_up(0, r, 1, common[r] + 0.3 + 0.01 * r), made_up(1, r, 0, common[r]),
              made_up(1, r, 1, common[r] - 0.1 - 0.01 * r)});
  const SweepAnswer answer = answer_of(sweep, made);
  ASSERT_EQ(answer.points.size(), 2u);
  const results::Interval& before = answer.points[0].differences[1][0];
  EXPECT_NEAR(before.mean, 0.315, 1e-12);
  EXPECT_NEAR(before.half_width, 3.1824 * std::sqrt(0.0005 / 3.0) / 2.0, 1e-6);  // Student's t of 3 degrees
  EXPECT_GT(answer.points[0].means[1][0].half_width, 1.0);
  EXPECT_EQ(answer.points[0].differences[0][0].count, 0u) << "of the baseline from itself";
  ASSERT_EQ(answer.crossings.size(), 1u);
  EXPECT_NEAR(answer.crossings[0].at, 1.0 + 39.0 * 0.315 / (0.315 + 0.115), 1e-9);
  EXPECT_TRUE(answer.crossings[0].certain);
  ASSERT_EQ(answer.expectations.size(), 2u);
  EXPECT_TRUE(answer.expectations[0].holds());
  EXPECT_EQ(answer.expectations[1].outcome, Outcome::kFails);
  EXPECT_EQ(unmet(answer.expectations[1]), "noise 1: it is more, by +0.315 +- 0.021 m\n");
  EXPECT_FALSE(answer.holds());
  const std::string text = answer_text(sweep, answer);
  EXPECT_THAT(text, testing::HasSubstr(
                        "position_rmse_truth of tt is less than that of adva at 1 point, more at 1, undecided at 0."));
  EXPECT_THAT(text, testing::HasSubstr("They cross at noise 29.57."));
  EXPECT_THAT(text, testing::HasSubstr("+0.315 +- 0.021 more*"));
  EXPECT_THAT(text,
              testing::HasSubstr("2 of 2 comparisons, marked *, stay certain together by Holm's method at 5 %; each "
                                 "interval stands for itself."));
}

// Differences of mean m and variance 1 in three drives, t = sqrt(3) m: p = 1 - t / sqrt(2 + t^2) = 0.04.
TEST_F(SweepEngine, WhatIsCertainAloneNeedNotBeCertainAmongOthers) {
  const SweepFile sweep = small_sweep(3);
  const SweepDrives drives(sweep);
  results::Store made = store(drives, "made");
  for (std::uint32_t r = 0; r < 3; ++r) {
    const double off = 2.7995 + static_cast<double>(r) - 1.0;
    made.add({made_up(0, r, 0, 9.0), made_up(0, r, 1, 9.0 + off), made_up(1, r, 0, 9.0), made_up(1, r, 1, 9.0 - off)});
  }
  const SweepAnswer answer = answer_of(sweep, made);
  EXPECT_TRUE(answer.points[0].differences[1][0].above(0.0));
  EXPECT_TRUE(answer.points[1].differences[1][0].below(0.0));
  EXPECT_EQ(answer.comparisons, 2u);
  EXPECT_EQ(answer.certain, 0u);
  ASSERT_EQ(answer.crossings.size(), 1u);
  EXPECT_FALSE(answer.crossings[0].certain);
  const std::string text = answer_text(sweep, answer);
  EXPECT_THAT(text, testing::HasSubstr("0 of 2 comparisons, marked *, stay certain together"));
  EXPECT_THAT(text, testing::Not(testing::HasSubstr("They cross")));
}

// A sweep of the error and the one against the DGPS, which agree if `margin` says so.
SweepFile agreement(const std::string& margin) {
  std::string text = sweep_text(
      3, "expect: [{measure: position_rmse_truth, agrees: position_rmse_reference, of: adva" + margin + "}]\n");
  text.replace(text.find("age_fused"), 9, "position_rmse_reference");
  return parse_sweep(text, TTF_SOURCE_DIR "/experiments/small.yaml");
}

// At the first point the difference is 0 +- 0.248 (Student's t of 2 degrees: 4.3027), at the second 2 +- 0.248.
TEST_F(SweepEngine, MeasuresAgreeWithinAMargin) {
  const auto judged = [&](const std::string& margin) {
    const SweepFile sweep = agreement(margin);
    const SweepDrives drives(sweep);
    results::Store made = store(drives, "made" + margin);
    for (std::uint32_t r = 0; r < 3; ++r) {
      const double off = 0.1 * (static_cast<double>(r) - 1.0);  // not on the average
      made.add({{{0, r, 0}, results::kDone, {5.0 + r + off, 5.0 + r}},
                {{1, r, 0}, results::kDone, {7.0 + r + off, 5.0 + r}}});
    }
    return answer_of(sweep, made).expectations.at(0);
  };
  const ExpectationAnswer outside = judged(", margin: 0.25 m");
  EXPECT_EQ(outside.text, "position_rmse_truth of adva agrees with position_rmse_reference, margin 0.25 m");
  EXPECT_EQ(outside.outcome, Outcome::kFails);
  EXPECT_EQ(unmet(outside), "noise 40: differs by +2.00 +- 0.25, beyond the margin of 0.25 m\n");
  EXPECT_TRUE(judged(", margin: 2.3 m").holds());
  EXPECT_EQ(unmet(judged(", margin: 2.1 m")),
            "noise 40: cannot tell: the interval +2.00 +- 0.25 is on both sides of the margin of 2.1 m; more "
            "replications\n");
  EXPECT_THAT(
      unmet(judged(", margin: 0.1 m")),
      testing::StartsWith("noise 1: cannot tell: the interval +0.00 +- 0.25 is wider than the margin of 0.1 m"));
  EXPECT_EQ(judged(", margin: 3 %").outcome, Outcome::kFails);
  EXPECT_TRUE(judged(", margin: 60 %").holds());
  EXPECT_EQ(judged("").text, judged(", margin: 10 %").text);
}

// One measure is a third of the other. A few drives that spread widely do not make them equal.
TEST_F(SweepEngine, FewDrivesDoNotAgree) {
  const SweepFile sweep = agreement("");
  const SweepDrives drives(sweep);
  results::Store few = store(drives, "few");
  const double spread[] = {-0.010, 0.012, -0.002};
  EXPECT_EQ(answer_of(sweep, few).expectations[0].outcome, Outcome::kCannotTell) << "without any drive";
  for (std::uint32_t r = 0; r < 3; ++r) {
    for (const std::uint32_t point : {0u, 1u}) few.add({{{point, r, 0}, results::kDone, {0.0124 + spread[r], 0.0351}}});
    const SweepAnswer answer = answer_of(sweep, few);
    EXPECT_EQ(answer.expectations[0].outcome, Outcome::kCannotTell) << r;
    EXPECT_THAT(unmet(answer.expectations[0]), testing::HasSubstr("more replications")) << r;
    EXPECT_THAT(answer_text(sweep, answer), testing::HasSubstr("margin 10 %: cannot tell\n  noise 1: cannot tell:"));
    EXPECT_FALSE(answer.holds());
  }
}

// At an exact tie, the sides differ by the points behind it.
TEST_F(SweepEngine, ACrossingMayBeAtAPoint) {
  std::string text = sweep_text(3);
  text.replace(text.find("[1, 40]"), 7, "[1, 20, 40]");
  const SweepFile sweep = parse_sweep(text, TTF_SOURCE_DIR "/experiments/small.yaml");
  const SweepDrives drives(sweep);
  const auto crossings = [&](const std::string& name, std::array<double, 3> differences) {
    results::Store made = store(drives, name);
    for (std::uint32_t point = 0; point < 3; ++point)
      for (std::uint32_t r = 0; r < 3; ++r)
        made.add({made_up(point, r, 0, 1.0), made_up(point, r, 1, 1.0 + differences[point] * (1.0 + 0.01 * r))});
    return answer_of(sweep, made).crossings;
  };
  const std::vector<Crossing> through = crossings("through", {-1.0, 0.0, 1.0});
  ASSERT_EQ(through.size(), 1u);
  EXPECT_EQ(through[0].at, 20.0);
  EXPECT_EQ(through[0].before, 0u);
  EXPECT_EQ(through[0].after, 2u);
  EXPECT_TRUE(through[0].certain);
  EXPECT_TRUE(crossings("touched", {1.0, 0.0, 1.0}).empty());
  EXPECT_TRUE(crossings("left", {0.0, 0.0, 1.0}).empty());
  EXPECT_TRUE(crossings("met", {1.0, 0.0, 0.0}).empty());
}

// A failed drive is a row, and only removes its pair from the differences.
TEST_F(SweepEngine, AFailedRunIsARow) {
  const SweepFile sweep = small_sweep(3);
  const SweepDrives drives(sweep);
  results::Store failing = store(drives, "failing");
  failing.add({made_up(0, 0, 0, 1.0),
               made_up(0, 1, 0, 2.0),
               made_up(0, 2, 0, 3.0),
               made_up(0, 0, 1, 2.0),
               {{0, 1, 1}, "out of luck", {std::nan(""), std::nan("")}},
               made_up(0, 2, 1, 4.0)});
  const SweepAnswer answer = answer_of(sweep, failing);
  EXPECT_EQ(answer.failed, 1u);
  EXPECT_EQ(answer.points[0].differences[1][0].count, 2u);
  EXPECT_EQ(answer.points[0].means[0][0].count, 3u);
  EXPECT_THAT(runs_csv(sweep, failing), testing::HasSubstr("0,1,1,tt,out of luck,,\n"));
}

}  // namespace
}  // namespace ttf::experiments::sweep
