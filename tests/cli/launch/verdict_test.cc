#include "cli/launch/verdict.h"

#include <gtest/gtest.h>

#include "schedules/file/loader.h"

namespace ttf::cli::launch {
namespace {

using fusion::strategies::StrategyKind;

struct Verdicts : testing::Test {
  schedules::model::Cluster cluster =
      schedules::file::load_cluster(TTF_SOURCE_DIR "/schedules/paper_synchronised.yaml");
  evaluation::lateness::RealTimeFindings real_time;
  DriveFacts facts{&cluster, &real_time, {}, 0, ""};
};

// The bounds of `schedule check`, and the 500 us of the arrival window.
TEST_F(Verdicts, TheScheduleAndTheStrategyPromiseAges) {
  constexpr std::int64_t kReal = 1'000'000;
  const auto tt = promised_ages(cluster, StrategyKind::kTt, kReal);
  const auto buff = promised_ages(cluster, StrategyKind::kBuff, kReal);
  ASSERT_EQ(tt.size(), 2u);
  EXPECT_NEAR(in_ms(tt.at(SensorId{0})), 100.9, 0.01);
  EXPECT_NEAR(in_ms(tt.at(SensorId{1})), 42.64, 0.01);
  EXPECT_NEAR(in_ms(buff.at(SensorId{0})), 140.52, 0.01);
  // Ten times slower, the window weighs a tenth.
  EXPECT_NEAR(in_ms(promised_ages(cluster, StrategyKind::kTt, 10 * kReal).at(SensorId{0})), 100.45, 0.01);
}

TEST_F(Verdicts, WhereNothingWasCountedNothingMatters) {
  facts.service.uses = 37;
  const Verdict verdict = verdict_of(facts);
  EXPECT_FALSE(verdict.matters);
  EXPECT_EQ(verdict.sentence,
            "nothing was late or lost, and each of 37 used images was as fresh as the schedule promises");
}

TEST_F(Verdicts, ProblemsThatDoNotReachTheServiceDoNotMatter) {
  facts.service.uses = 37;
  facts.restarts = 1;
  real_time.timing[NodeId{0}].late_wake_ups = 30;
  real_time.timing[NodeId{1}] = {9, 13, 2, 0, 5, {3, 1}, {}};
  const Verdict verdict = verdict_of(facts);
  EXPECT_FALSE(verdict.matters);
  EXPECT_EQ(
      verdict.sentence,
      "39 late wake-ups, 13 missed slots, 2 late frames, 1 lost frame, 1 restart: this does not matter, each of 37 "
      "used images was as fresh as the schedule promises");
}

TEST_F(Verdicts, RealNodesAreCountedAsOthersAre) {
  facts.service.uses = 37;
  facts.restarts = 1;
  facts.external = "camera_pre: 3 late, 1 malformed";
  EXPECT_EQ(
      verdict_of(facts).sentence,
      "1 restart; camera_pre: 3 late, 1 malformed: this does not matter, each of 37 used images was as fresh as the "
      "schedule promises");
}

TEST_F(Verdicts, ProblemsThatReachTheServiceMatter) {
  facts.service = {1462,
                   3,
                   {{SensorId{0}, {12, Duration::milliseconds(140), Duration::milliseconds(101)}}},
                   Duration::milliseconds(320)};
  facts.absent = "gateway was not in operation at the end: integration listen";
  real_time.timing[NodeId{0}].slots_missed = 1;
  const Verdict verdict = verdict_of(facts);
  EXPECT_TRUE(verdict.matters);
  EXPECT_EQ(
      verdict.sentence,
      "this matters: 3 of 1462 used images were refused: too old; the newest measurement of laser was up to 140.0 ms "
      "old in 12 of 1462 used images, and the schedule promises 101.0 ms; no image was used for 320.0 ms; gateway was "
      "not in operation at the end: integration listen (1 missed slot)");
}

TEST_F(Verdicts, ASensorThatNeverCameMatters) {
  facts.service.uses = 50;
  facts.service.older[SensorId{1}] = {46, Duration::milliseconds(1010), Duration::milliseconds(100), 46};
  EXPECT_EQ(verdict_of(facts).sentence,
            "this matters: 46 of 50 used images had no measurement of camera for up to 1010.0 ms, and the schedule "
            "promises one within 100.0 ms");
}

TEST_F(Verdicts, ADriveWithoutAnyUseMatters) {
  EXPECT_EQ(verdict_of(facts).sentence, "this matters: no image was used");
}

}  // namespace
}  // namespace ttf::cli::launch
