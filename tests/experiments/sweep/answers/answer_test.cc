// The answers of a sweep from rows that are made up here.
#include "experiments/sweep/answers/answer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "experiments/sweep/answers/answer_text.h"
#include "experiments/sweep/answers/figures.h"
#include "tests/experiments/sweep/small_sweep.h"
#include "tests/experiments/sweep/store_folder.h"

namespace ttf::experiments::sweep::answers {
namespace {

using SweepAnswers = StoreFolder;

results::Row made_up(std::uint32_t point, std::uint32_t replication, std::uint32_t paradigm, double rmse) {
  return {{point, replication, paradigm}, results::kDone, {rmse, 10.0, 0.0}};
}

std::string unmet(const ExpectationAnswer& answer) {
  std::string text;
  for (const Unmet& one : answer.unmet) text += one.point + ": " + one.why + "\n";
  return text;
}

// A drive that does not stop has no distance; a collision is a share of drives.
TEST_F(SweepAnswers, AbsentValuesAreCountedAndEventsAreShares) {
  std::string text = sweep_text(4);
  text.replace(text.find("position_rmse_truth, age_fused"), 30, "stopping_distance, collision");
  const SweepFile sweep = parse_sweep(text, TTF_SOURCE_DIR "/experiments/small.yaml");
  const SweepDrives drives(sweep);
  results::Store made = store(drives, "made");
  const auto row = [](std::uint32_t point, std::uint32_t r, std::uint32_t paradigm, double distance, double collision) {
    return results::Row{{point, r, paradigm}, results::kDone, {distance, collision, 0.0}};
  };
  for (std::uint32_t r = 0; r < 4; ++r)
    made.add({row(0, r, 0, 70.0 + r, 0.0), row(0, r, 1, r == 0 ? std::nan("") : 71.0 + r, r == 0 ? 1.0 : 0.0)});
  const SweepAnswer answer = answer_of(sweep, made);
  EXPECT_EQ(answer.points[0].means[1][0].count, 3u);
  EXPECT_EQ(answer.points[0].differences[1][0].count, 3u);
  EXPECT_NEAR(answer.points[0].differences[1][0].mean, 1.0, 1e-12);
  EXPECT_NEAR(answer.points[0].means[1][1].mean, 0.25, 1e-12);
  EXPECT_NEAR(answer.points[0].means[1][1].low(), 0.0456, 1e-4);
  EXPECT_NEAR(answer.points[0].means[1][1].high(), 0.6994, 1e-4);
  EXPECT_GT(answer.points[0].differences[1][1].half_width, 0.1);
  EXPECT_THAT(answer_text(sweep, answer), testing::HasSubstr(" of 3"));
  EXPECT_EQ(interval_text(answer.points[0].means[1][1], false), "0.25 (0.05 to 0.70)");
}

// One drive of tt lost a track, with seven times the error. The answer without that replication has only its others, of both.
TEST_F(SweepAnswers, LostTracksAreCountedAndLeftOutForAllParadigms) {
  std::string text = sweep_text(5);
  text.replace(text.find("age_fused"), 9, "track_lost");
  const SweepFile sweep = parse_sweep(text, TTF_SOURCE_DIR "/experiments/small.yaml");
  const SweepDrives drives(sweep);
  results::Store made = store(drives, "made");
  const auto row = [](std::uint32_t point, std::uint32_t r, std::uint32_t paradigm, double rmse, bool lost) {
    return results::Row{{point, r, paradigm}, results::kDone, {rmse, lost ? 1.0 : 0.0}};
  };
  for (std::uint32_t r = 0; r < 5; ++r) {
    const bool lost = r == 2;
    made.add({row(0, r, 0, 1.0, false), row(0, r, 1, lost ? 7.0 : 0.9 - 0.01 * r, lost), row(1, r, 0, 2.0, false),
              row(1, r, 1, 1.8 - 0.01 * r, false)});
  }
  const SweepAnswer answer = answer_of(sweep, made);
  EXPECT_NEAR(answer.points[0].differences[1][0].mean, (6.0 - 0.4 - 0.08) / 5.0, 1e-12);
  ASSERT_TRUE(answer.lost);
  EXPECT_EQ(answer.lost->drives, (std::vector<std::uint64_t>{10, 10}));
  EXPECT_EQ(answer.lost->lost, (std::vector<std::uint64_t>{0, 1}));
  EXPECT_EQ(answer.lost->left_out, 1u);
  ASSERT_EQ(answer.lost->points.size(), 2u);
  const PointAnswer &first = answer.lost->points[0], &second = answer.lost->points[1];
  EXPECT_EQ(first.means[0][0].count, 4u);
  EXPECT_EQ(first.means[1][0].count, 4u);
  EXPECT_NEAR(first.differences[1][0].mean, -0.1 - 0.08 / 4.0, 1e-12);
  EXPECT_EQ(second.means[1][0].count, 5u);
  EXPECT_NEAR(second.differences[1][0].mean, answer.points[1].differences[1][0].mean, 1e-12);
  const std::string sentences = answer_sentences(sweep, answer);
  EXPECT_THAT(sentences, testing::HasSubstr("undecided at 1."));
  EXPECT_THAT(sentences,
              testing::HasSubstr("An object lost its track in 0 of 10 drives of adva, 1 of 10 drives of tt.\n"
                                 "Without 1 replication that lost a track, left out for all paradigms:\n"
                                 "position_rmse_truth of tt is less than that of adva at 2 points"));
}

// The event is stored with every drive. A drive without tracks is not among those that may lose one.
TEST_F(SweepAnswers, LostTracksAreCountedWithoutBeingAskedFor) {
  const SweepFile sweep = small_sweep(3);
  results::Store made = store(SweepDrives(sweep), "made");
  for (std::uint32_t r = 0; r < 3; ++r)
    for (const std::uint32_t point : {0u, 1u}) {
      results::Row one = made_up(point, r, 0, 1.0), other = made_up(point, r, 1, r == 1 ? 7.0 : 0.9 - 0.01 * r);
      other.values.back() = r == 1 ? 1.0 : 0.0;
      if (r == 2) one.values.back() = std::nan("");
      made.add({one, other});
    }
  const SweepAnswer answer = answer_of(sweep, made);
  ASSERT_TRUE(answer.lost);
  EXPECT_EQ(answer.lost->drives, (std::vector<std::uint64_t>{4, 6}));
  EXPECT_EQ(answer.lost->lost, (std::vector<std::uint64_t>{0, 2}));
  EXPECT_EQ(answer.points[0].means[0].size(), 2u) << "no measure of the file";
  EXPECT_THAT(answer_text(sweep, answer),
              testing::HasSubstr("An object lost its track in 0 of 4 drives of adva, 2 of 6 drives of tt.\n"
                                 "Without 2 replications that lost a track, left out for all paradigms:\n"));
}

TEST_F(SweepAnswers, WithoutALostTrackThereIsNoSecondAnswer) {
  const SweepFile without = small_sweep(2);
  results::Store none = store(SweepDrives(without), "without");
  none.add({made_up(0, 0, 0, 1.0), made_up(0, 0, 1, 1.0)});
  EXPECT_FALSE(answer_of(without, none).lost) << "none is lost, and the file does not ask";
  std::string text = sweep_text(2);
  text.replace(text.find("age_fused"), 9, "track_lost");
  const SweepFile sweep = parse_sweep(text, TTF_SOURCE_DIR "/experiments/small.yaml");
  results::Store made = store(SweepDrives(sweep), "made");
  for (std::uint32_t r = 0; r < 2; ++r)
    for (const std::uint32_t point : {0u, 1u})
      made.add({results::Row{{point, r, 0}, results::kDone, {1.0, 0.0}},
                results::Row{{point, r, 1}, results::kDone, {0.9 + 0.01 * r, 0.0}}});
  const SweepAnswer answer = answer_of(sweep, made);
  ASSERT_TRUE(answer.lost);
  EXPECT_TRUE(answer.lost->points.empty());
  EXPECT_THAT(answer_text(sweep, answer),
              testing::HasSubstr("An object lost its track in 0 of 4 drives of adva, 0 of 4 drives of tt.\n"));
  EXPECT_THAT(answer_text(sweep, answer), testing::Not(testing::HasSubstr("Without")));
}

TEST_F(SweepAnswers, DifferencesArePaired) {
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
                        "position_rmse_truth of tt is less than that of adva at 1 point (-2.7 %), more at 1 (+7.4 %), "
                        "undecided at 0."));
  EXPECT_THAT(text, testing::HasSubstr("They cross at noise 29.57."));
  EXPECT_THAT(text, testing::HasSubstr("+0.315 +- 0.021 more*"));
  EXPECT_THAT(text, testing::HasSubstr(
                        "2 of 2 comparisons, marked *, stay certain together by Holm's method at 5 %; each "
                        "interval stands for itself.\n"
                        "Of all pairs of paradigms, 2 of 2 comparisons stay certain together likewise: adva less "
                        "than tt at noise 1; tt less than adva at noise 40."));
}

// Differences of mean m and variance 1 in three drives, t = sqrt(3) m: p = 1 - t / sqrt(2 + t^2) = 0.04.
TEST_F(SweepAnswers, ADifferenceCertainAloneNeedNotBeCertainAmongOthers) {
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
TEST_F(SweepAnswers, MeasuresAgreeWithinAMargin) {
  const auto judged = [&](const std::string& margin) {
    const SweepFile sweep = agreement(margin);
    const SweepDrives drives(sweep);
    results::Store made = store(drives, "made" + margin);
    for (std::uint32_t r = 0; r < 3; ++r) {
      const double off = 0.1 * (static_cast<double>(r) - 1.0);  // not on the average
      made.add({{{0, r, 0}, results::kDone, {5.0 + r + off, 5.0 + r, 0.0}},
                {{1, r, 0}, results::kDone, {7.0 + r + off, 5.0 + r, 0.0}}});
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
  EXPECT_THAT(unmet(judged(", margin: 0.1 m")),
              testing::StartsWith("noise 1: cannot tell: the interval 0.00 +- 0.25 is wider than the margin of 0.1 m"));
  EXPECT_EQ(judged(", margin: 3 %").outcome, Outcome::kFails);
  EXPECT_TRUE(judged(", margin: 60 %").holds());
  EXPECT_EQ(judged("").text, judged(", margin: 10 %").text);
}

// One measure is a third of the other. A few drives that spread widely do not make them equal.
TEST_F(SweepAnswers, FewDrivesDoNotAgree) {
  const SweepFile sweep = agreement("");
  const SweepDrives drives(sweep);
  results::Store few = store(drives, "few");
  const double spread[] = {-0.010, 0.012, -0.002};
  EXPECT_EQ(answer_of(sweep, few).expectations[0].outcome, Outcome::kUndecided) << "without any drive";
  for (std::uint32_t r = 0; r < 3; ++r) {
    for (const std::uint32_t point : {0u, 1u})
      few.add({{{point, r, 0}, results::kDone, {0.0124 + spread[r], 0.0351, 0.0}}});
    const SweepAnswer answer = answer_of(sweep, few);
    EXPECT_EQ(answer.expectations[0].outcome, Outcome::kUndecided) << r;
    EXPECT_THAT(unmet(answer.expectations[0]), testing::HasSubstr("more replications")) << r;
    EXPECT_THAT(answer_text(sweep, answer), testing::HasSubstr("margin 10 %: cannot tell\n  noise 1: cannot tell:"));
    EXPECT_FALSE(answer.holds());
  }
}

// Both paradigms at noise 40 with themselves at noise 1. One is less by 0.115 in every drive, the other varies.
TEST_F(SweepAnswers, ValuesOfAnAxisAreCompared) {
  const SweepFile sweep = small_sweep(4, "compare: {axis: noise, baseline: 1}\n");
  const SweepDrives drives(sweep);
  results::Store made = store(drives, "made");
  const double common[] = {1.0, 5.0, 2.0, 9.0};
  for (std::uint32_t r = 0; r < 4; ++r) {
    const double off = r % 2 == 0 ? 1.0 : -1.0;
    made.add({made_up(0, r, 0, common[r]), made_up(0, r, 1, common[r]), made_up(1, r, 0, common[r] - 0.1 - 0.01 * r),
              made_up(1, r, 1, common[r] + off)});
  }
  const SweepAnswer answer = answer_of(sweep, made);
  EXPECT_EQ(answer.comparisons, 2u);
  EXPECT_EQ(answer.certain, 1u);
  EXPECT_TRUE(answer.crossings.empty());
  for (const std::size_t p : {0u, 1u}) EXPECT_EQ(answer.points[0].differences[p][0].count, 0u);
  const results::Interval& less = answer.points[1].differences[0][0];
  EXPECT_NEAR(less.mean, -0.115, 1e-12);
  EXPECT_NEAR(less.half_width, 3.1824 * std::sqrt(0.0005 / 3.0) / 2.0, 1e-6);
  EXPECT_TRUE(answer.points[1].stays[0]);
  const std::string text = answer_text(sweep, answer);
  EXPECT_THAT(text,
              testing::StartsWith("Is it so?\n\nposition_rmse_truth of adva with noise 40 is less than with 1, by "
                                  "0.115 +- 0.021 m.\n"));
  EXPECT_THAT(text,
              testing::HasSubstr("\nThere is no difference of position_rmse_truth of tt between noise 40 and 1 that "
                                 "these drives can tell: 0.0 +- 1.8 m.\n"));
  EXPECT_THAT(text, testing::HasSubstr("adva, minus 1"));
  EXPECT_THAT(text, testing::HasSubstr("-0.115 +- 0.021 less*"));
  EXPECT_THAT(summary_csv(sweep, answer), testing::HasSubstr("\n1,40,adva,position_rmse_truth,4,4.135"));
}

// From noise 1 to 40 adva falls to a half, in every drive, and tt to a quarter.
TEST_F(SweepAnswers, InteractionsAnswerFirst) {
  const std::string asked = "interactions: [{axis: noise, lowers: tt, more_than: adva}]\n";
  const auto reported = [&](const std::string& name, const std::string& more, double adva, double tt, double spread) {
    const SweepFile sweep = small_sweep(4, more);
    const SweepDrives drives(sweep);
    results::Store made = store(drives, name);
    const double common[] = {4.0, 5.0, 6.0, 5.0};
    for (std::uint32_t r = 0; r < 4; ++r) {
      const double off = 1.0 + (r % 2 == 0 ? spread : -spread);
      made.add({made_up(0, r, 0, common[r]), made_up(0, r, 1, common[r]), made_up(1, r, 0, common[r] * adva * off),
                made_up(1, r, 1, common[r] * tt)});
    }
    const SweepAnswer answer = answer_of(sweep, made);
    const std::string text = answer_text(sweep, answer);
    EXPECT_THAT(text, testing::HasSubstr("stay certain together by Holm's method at 5 %, as a family of their own."));
    EXPECT_EQ(text.find("The jackknife's interval of an interaction needs some twenty replications, and here has 4.") !=
                  std::string::npos,
              more.find("by: difference") == std::string::npos);
    const std::size_t begin = text.find("\n\n") + 2;
    return text.substr(begin, text.find('\n', begin) - begin);
  };
  const std::string change = "noise from 1 to 40 changes position_rmse_truth of ";
  EXPECT_EQ(reported("yes", asked, 0.5, 0.25, 0.0),
            "Yes: " + change +
                "tt by -75.0 % (-75.0 to -75.0), and that of adva by -50.0 % (-50.0 to -50.0). Beside that of "
                "adva, tt's becomes less by 50.0 % (50.0 to 50.0).");
  EXPECT_THAT(reported("no", asked, 0.5, 0.9, 0.01), testing::StartsWith("No: " + change + "tt by -10.0 %"));
  EXPECT_THAT(reported("both", asked, 2.0, 1.5, 0.01), testing::StartsWith("No, it only raises tt less: "));
  EXPECT_THAT(reported("none", asked, 0.5, 0.5, 0.5),
              AllOf(testing::StartsWith("There is no difference that these drives can tell: " + change),
                    testing::HasSubstr(" tt against adva: ")));
  // In metres the changes are half and a quarter of 5 +- 1.3.
  EXPECT_EQ(reported("metres",
                     "interactions: [{axis: noise, from: 1, to: 40, lowers: tt, more_than: adva, by: difference}]\n",
                     0.5, 0.75, 0.0),
            "No: " + change +
                "tt by -1.25 +- 0.32 m, and that of adva by -2.50 +- 0.65 m. Beside that of adva, tt's becomes "
                "more by 1.25 +- 0.32 m.");
}

// On a dry and on a wet road. adva changes by a factor, in every drive. tt changes by `dry` and `wet`, more or less.
class InteractionsOnTwoRoads : public SweepAnswers {
 protected:
  std::string reported(const std::string& interaction, double adva, double dry, double wet) {
    std::string file = sweep_text(4, "interactions: [" + interaction + "]\n");
    file.insert(file.find("measures:"), "  road: {settings: {dry: {}, wet: {world.own_speed: 12}}}\n");
    const SweepFile sweep = parse_sweep(file, TTF_SOURCE_DIR "/experiments/small.yaml");
    const SweepDrives drives(sweep);
    results::Store made = store(drives, std::to_string(++stores_));
    for (std::uint32_t r = 0; r < 4; ++r) {
      const double common = 5.0 + 0.5 * r, off = r % 2 == 0 ? 1.1 : 0.9;
      for (const std::uint32_t road : {0u, 1u})
        made.add({made_up(road, r, 0, common), made_up(road, r, 1, common), made_up(2 + road, r, 0, adva * common),
                  made_up(2 + road, r, 1, (road == 0 ? dry : wet) * common * off)});
    }
    const std::string lines = answer_sentences(sweep, answer_of(sweep, made));
    return lines.substr(0, lines.find('\n'));
  }
  int stores_ = 0;
};

TEST_F(InteractionsOnTwoRoads, AnInteractionMayDependOnOtherAxes) {
  const auto of = [&](double dry, double wet) {
    return reported("{axis: noise, lowers: tt, more_than: adva}", 0.5, dry, wet);
  };
  EXPECT_THAT(of(0.1, 0.2),
              AllOf(testing::StartsWith("Yes, at all 2 points: noise from 1 to 40 changes position_rmse_truth of "
                                        "tt (estimates from -90 to -80 %) and of adva (-50 %). "),
                    testing::EndsWith(" tt's factor is estimated 60 to 80 % below adva's.")));
  EXPECT_THAT(of(0.9, 0.8), AllOf(testing::StartsWith("No, at all 2 points: "), testing::EndsWith(" above adva's.")));
  EXPECT_THAT(of(0.5, 0.5),
              testing::StartsWith("There is no difference that these drives can tell, at any of 2 points: "));
  EXPECT_THAT(of(0.1, 0.5),
              AllOf(testing::StartsWith("In part: noise from 1 to 40 lowers position_rmse_truth of tt (-90 %)"),
                    testing::HasSubstr(" more than that of adva (-50 %) at road dry; at road wet there is no "
                                       "difference that these drives can tell. At road dry tt's factor is 80 % below "
                                       "adva's.")));
  EXPECT_THAT(of(0.9, 0.5), AllOf(testing::StartsWith("No: noise from 1 to 40 lowers "),
                                  testing::HasSubstr(" less than that of adva (-50 %) at road dry; at road wet ")));
  EXPECT_THAT(
      of(0.1, 0.9),
      AllOf(testing::StartsWith("It depends: noise from 1 to 40 lowers position_rmse_truth of tt (-90 %) more "),
            testing::HasSubstr(" more than that of adva (-50 %) at road dry, and lowers position_rmse_truth "
                               "of tt (-10 %) less than that of adva (-50 %) at road wet.")));
}

// The error of adva doubles, that of tt rises on both roads or on one.
TEST_F(InteractionsOnTwoRoads, AnErrorThatRisesIsNotCalledLowered) {
  const auto of = [&](double dry, double wet) {
    return reported("{axis: noise, lowers: tt, more_than: adva}", 2.0, dry, wet);
  };
  EXPECT_THAT(of(1.5, 2.0),
              AllOf(testing::StartsWith("No: noise from 1 to 40 raises position_rmse_truth of tt (+49 %) less than "
                                        "that of adva (+100 %) at road dry; at road wet there is no difference"),
                    testing::EndsWith("At road dry tt's factor is 25 % below adva's.")));
  EXPECT_THAT(of(1.2, 1.3), testing::StartsWith("No, it only raises tt less, at all 2 points: "));
  EXPECT_THAT(of(0.5, 1.3),
              testing::StartsWith("It depends: noise from 1 to 40 lowers position_rmse_truth of tt (-50 %) more than "
                                  "that of adva (+100 %) at road dry, and raises position_rmse_truth of tt (+29 %) "
                                  "less than that of adva (+100 %) at road wet."));
}

TEST_F(InteractionsOnTwoRoads, DifferencesHaveTheirUnit) {
  EXPECT_THAT(reported("{axis: noise, lowers: tt, more_than: adva, by: difference}", 0.5, 0.1, 0.2),
              testing::EndsWith(" of tt (estimates from -5.2 to -4.6 m) and of adva (-2.9 m). tt's change is estimated "
                                "1.7 to 2.3 m below adva's."));
}

TEST(Figures, AnIntervalThatExcludesZeroShowsIt) {
  EXPECT_EQ(percent_text({20, 1.0064, 1.0001, 1.0127}), "+0.64 % (+0.01 to +1.27)");
  EXPECT_EQ(percent_text({20, 0.99999, 0.98, 1.02}), "0 % (-2 to +2)");
  EXPECT_EQ(range_text(-0.74, -0.04, true, "%"), "-0.74 to -0.04 %");
  EXPECT_EQ(range_text(-0.5, -0.5, true, "ms"), "-0.50 ms");
}

// A replication counts only if all four of its drives were done.
TEST_F(SweepAnswers, InteractionsNeedAllFourDrives) {
  const SweepFile sweep = small_sweep(7, "interactions: [{axis: noise, lowers: tt, more_than: adva}]\n");
  const SweepDrives drives(sweep);
  results::Store made = store(drives, "made");
  for (std::uint32_t r = 0; r < 7; ++r)
    for (std::uint32_t drive = 0; drive < 4; ++drive) {
      if (drive == r) continue;  // each of the first four replications lacks one
      results::Row row = made_up(drive / 2, r, drive % 2, 1.0 + r);
      if (r == 4 && drive == 0) row = {row.key, "out of luck", {std::nan(""), std::nan(""), std::nan("")}};
      made.add({row});
    }
  const SweepAnswer answer = answer_of(sweep, made);
  ASSERT_EQ(answer.interactions.size(), 1u);
  ASSERT_EQ(answer.interactions[0].points.size(), 1u);
  EXPECT_EQ(answer.interactions[0].points[0].interaction.count, 2u);
}

// Ten paradigms beside each other go on below, each time with the axis.
TEST_F(SweepAnswers, TablesFitAPage) {
  std::string text = sweep_text(3);
  const std::size_t at = text.find("  tt: ");
  for (int p = 0; p < 8; ++p)
    text.insert(
        at, "  paradigm_" + std::to_string(p) + ": {strategy: adva, set: {duration: 700 ms, evaluate_from: 400 ms}}\n");
  const SweepFile sweep = parse_sweep(text, TTF_SOURCE_DIR "/experiments/small.yaml");
  const SweepDrives drives(sweep);
  results::Store made = store(drives, "made");
  for (std::uint32_t point = 0; point < 2; ++point)
    for (std::uint32_t r = 0; r < 3; ++r)
      for (std::uint32_t p = 0; p < 10; ++p) made.add({made_up(point, r, p, 1.0 + p + 0.1 * r * p)});
  const SweepAnswer answer = answer_of(sweep, made);
  const std::string all = answer_text(sweep, answer), tables = all.substr(all.find("\nposition_rmse_truth [m]"));
  std::size_t heads = 0, begin = 0;
  for (std::size_t end = tables.find('\n'); end != std::string::npos; begin = end + 1, end = tables.find('\n', begin)) {
    const std::string line = tables.substr(begin, end - begin);
    if (line.find("comparisons, marked") != std::string::npos) break;
    EXPECT_LE(line.size(), 100u) << line;
    heads += line.starts_with("noise  ");
  }
  EXPECT_GT(heads, 3u);
}

// At an exact tie, the sides differ by the points behind it.
TEST_F(SweepAnswers, ACrossingMayBeAtAPoint) {
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
TEST_F(SweepAnswers, AFailedRunIsARow) {
  const SweepFile sweep = small_sweep(3);
  const SweepDrives drives(sweep);
  results::Store failing = store(drives, "failing");
  failing.add({made_up(0, 0, 0, 1.0),
               made_up(0, 1, 0, 2.0),
               made_up(0, 2, 0, 3.0),
               made_up(0, 0, 1, 2.0),
               {{0, 1, 1}, "out of luck", {std::nan(""), std::nan(""), std::nan("")}},
               made_up(0, 2, 1, 4.0)});
  const SweepAnswer answer = answer_of(sweep, failing);
  EXPECT_EQ(answer.failed, 1u);
  EXPECT_EQ(answer.points[0].differences[1][0].count, 2u);
  EXPECT_EQ(answer.points[0].means[0][0].count, 3u);
  EXPECT_THAT(runs_csv(sweep, failing), testing::HasSubstr("0,1,1,tt,out of luck,,,\n"));
}

}  // namespace
}  // namespace ttf::experiments::sweep::answers
