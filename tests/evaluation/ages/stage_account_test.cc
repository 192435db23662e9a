#include "evaluation/ages/stage_account.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>
#include <vector>

#include "evaluation/accuracy/image_uses.h"
#include "evaluation/accuracy/plane.h"
#include "recording/records/tee.h"
#include "schedules/analysis/ages.h"
#include "tests/sim/drives/drive_fixture.h"

namespace ttf::evaluation::ages {
namespace {

using fusion::strategies::StrategyKind;
using schedules::analysis::AgePath;
using schedules::analysis::Waypoint;

// The ages of measurements at the first use of an image with them, as the measures of a drive have them.
class FirstUses final : public accuracy::ImageUses {
 public:
  explicit FirstUses(TrueTime from) : ImageUses(accuracy::kGate_m), from_(from) {}

  std::map<SensorId, std::map<TrueTime, Duration>> ages;  // by the instant of measuring

 private:
  void fused(SensorId, Duration) override {}
  void judged(const accuracy::JudgedUse&) override {}
  bool used(const recording::records::FeatureUsed& use, std::span<const accuracy::PlaneEstimate>,
            std::span<const accuracy::SensorAge> all) override {
    for (const accuracy::SensorAge& one : all)
      if (const TrueTime measured = use.stamp.true_time - one.age; measured >= from_)
        ages[one.sensor].try_emplace(measured, one.age);
    return false;
  }
  TrueTime from_;
};

bool holds(StrategyKind strategy) { return strategy == StrategyKind::kBuff; }

std::vector<SensorStages> stages_of(const sim::drives::Drive& drive, const std::vector<AgePath>& paths,
                                    FirstUses* uses = nullptr) {
  StageAccount account(paths, holds(drive.strategy), sim::drives::evaluation_start(drive.scenario));
  std::vector<recording::records::Sink*> sinks{&account};
  if (uses != nullptr) sinks.push_back(uses);
  recording::records::Tee tee(sinks);
  drive.run(tee);
  return account.finish();
}

TEST(StageAccount, ShippedDrivesAreWithinTheBoundsOfTheirSchedules) {
  for (const char* scenario : {"scenarios/paper_scenario1.yaml", "scenarios/two_lasers.yaml"})
    for (const StrategyKind strategy : fusion::strategies::kAllStrategies) {
      const sim::drives::Drive drive(scenario, strategy);
      const auto paths = schedules::analysis::measurement_ages(drive.cluster);
      const std::vector<SensorStages> all = stages_of(drive, paths);
      ASSERT_EQ(all.size(), paths.size());
      for (const SensorStages& sensor : all) {
        SCOPED_TRACE(std::string(scenario) + ", " + std::string(name_of(strategy)) + ", " +
                     drive.cluster.sensor(sensor.sensor).name);
        EXPECT_GT(sensor.seen(), 15u);
        EXPECT_GE(sensor.measured, sensor.seen());
        EXPECT_TRUE(sensor.to_use);
        EXPECT_TRUE(sensor.within());
        std::set<std::string> names;
        for (const StageFinding& stage : sensor.stages) {
          EXPECT_TRUE(names.insert(stage.name).second) << stage.name << " is there twice";
          EXPECT_EQ(stage.beyond, 0u) << stage.name << ": " << in_ms(stage.age_best) << " "
                                      << in_ms(stage.age_worst.value_or(Duration{})) << ", had "
                                      << in_ms(stage.age.least) << " " << in_ms(stage.age.most);
          EXPECT_GE(stage.had.least, Duration{}) << stage.name;
        }
      }
    }
}

TEST(StageAccount, StagesAddUpToTheAgeOfTheMeasures) {
  for (const StrategyKind strategy : fusion::strategies::kAllStrategies) {
    const sim::drives::Drive drive("scenarios/paper_scenario1.yaml", strategy);
    FirstUses uses(sim::drives::evaluation_start(drive.scenario));
    for (const SensorStages& sensor : stages_of(drive, schedules::analysis::measurement_ages(drive.cluster), &uses)) {
      SCOPED_TRACE(std::string(name_of(strategy)) + ", " + drive.cluster.sensor(sensor.sensor).name);
      Duration sum{};
      for (const StageFinding& stage : sensor.stages) {
        sum += stage.had.sum;
        EXPECT_EQ(stage.had.count, sensor.seen());
        EXPECT_EQ(sum, stage.age.sum) << stage.name;
      }
      // Those ages are on the clock that stamped the measurement.
      Duration elsewhere{};
      for (const auto& [measured, age] : uses.ages[sensor.sensor]) elsewhere += age;
      const auto count = static_cast<std::int64_t>(uses.ages[sensor.sensor].size());
      ASSERT_EQ(static_cast<std::int64_t>(sensor.seen()), count);
      EXPECT_NEAR(in_us(Duration{(sum - elsewhere).ns / count}), 0.0, 10.0);
    }
  }
}

TEST(StageAccount, HoldingForOrderIsAStageOfItsOwn) {
  const auto held = [](StrategyKind strategy) {
    const sim::drives::Drive drive("scenarios/paper_scenario1.yaml", strategy);
    Duration most{};
    for (const SensorStages& sensor : stages_of(drive, schedules::analysis::measurement_ages(drive.cluster)))
      for (const StageFinding& stage : sensor.stages)
        if (stage.name == "held for order") most = std::max(most, stage.had.most);
    return most;
  };
  EXPECT_GT(held(StrategyKind::kBuff), Duration::milliseconds(10));
  EXPECT_EQ(held(StrategyKind::kAdva), Duration{});
}

TEST(StageAccount, AnAgeBeyondItsBoundIsCounted) {
  const sim::drives::Drive drive("scenarios/paper_scenario1.yaml", StrategyKind::kTt);
  std::vector<AgePath> paths = schedules::analysis::measurement_ages(drive.cluster);
  paths[0].waypoints.back().worst = paths[0].waypoints.back().best;
  paths[1].waypoints.front().best = Duration::milliseconds(900);
  const std::vector<SensorStages> all = stages_of(drive, paths);
  EXPECT_GT(all[0].stages.back().beyond, 0u);
  EXPECT_FALSE(all[0].within());
  EXPECT_EQ(all[1].stages.front().beyond, all[1].seen());
}

// The way of one measurement through a path of two tasks, without a use.
class ShortWay : public ::testing::Test {
 protected:
  static recording::records::Stamp stamp(std::int64_t ms, NodeId node) { return {{ms * 1'000'000}, {}, {}, node}; }
  static std::vector<AgePath> path() {
    AgePath path;
    path.to_fusion = {{"a executes", {}, Duration::milliseconds(2)}, {"b is sent", {}, Duration::milliseconds(3)}};
    path.waypoints = {{Waypoint::Kind::kWritten, NodeId{1}, PduId{4}, 1, {}, Duration::milliseconds(2), {}},
                      {Waypoint::Kind::kFused, NodeId{2}, kNoPdu, 2, {}, Duration::milliseconds(5), {}}};
    return {path};
  }
  void measure(std::uint32_t sequence, std::int64_t ms) {
    account.on(recording::records::Measured{stamp(ms, NodeId{1}), {SensorId{0}, sequence}, {}});
  }
  void write(std::uint32_t sequence, std::int64_t ms) {
    account.on(recording::records::ListHop{stamp(ms, NodeId{1}), recording::records::Hop::kWritten, PduId{4},
                                           SensorId{0}, sequence});
  }
  void fuse(std::uint32_t sequence, std::int64_t ms) {
    recording::records::ListFused fused;
    fused.stamp = stamp(ms, NodeId{2});
    fused.id = {SensorId{0}, sequence};
    account.on(fused);
  }
  StageAccount account{path(), false, TrueTime{100'000'000}};
};

TEST_F(ShortWay, EndsAtTheFusionWithoutAUse) {
  measure(1, 101), write(1, 102), fuse(1, 104);
  measure(2, 111), write(2, 113), fuse(2, 117);  // 6 ms are too many
  const SensorStages all = account.finish().at(0);
  ASSERT_EQ(all.stages.size(), 2u);
  EXPECT_EQ(all.stages[0].name, "a executes");
  EXPECT_EQ(all.stages[0].had.least, Duration::milliseconds(1));
  EXPECT_EQ(all.stages[0].had.most, Duration::milliseconds(2));
  EXPECT_EQ(all.stages[1].had.mean(), Duration::milliseconds(3));
  EXPECT_EQ(all.stages[1].beyond, 1u);
  EXPECT_FALSE(all.to_use);
}

TEST_F(ShortWay, OnlyWholeWaysOfTheJudgedPartCount) {
  measure(1, 99), write(1, 100), fuse(1, 101);      // too early
  measure(2, 111), fuse(2, 114);                    // its list is not seen
  measure(3, 121), write(3, 122);                   // lost
  fuse(7, 123);                                     // never measured
  measure(2, 2111), write(2, 2112), fuse(2, 2113);  // the sensor counts anew
  const SensorStages all = account.finish().at(0);
  EXPECT_EQ(all.measured, 3u);
  EXPECT_EQ(all.seen(), 1u);
}

// Sums of such times would overflow.
TEST_F(ShortWay, ImpossibleWaysOfADamagedLogDoNotCount) {
  constexpr std::int64_t kFarMs = 1'000'000'000'000;
  for (std::uint32_t i = 0; i < 6; ++i) measure(i, 100 + i), write(i, kFarMs), fuse(i, 110 + i);
  measure(6, 120), write(6, 122), fuse(6, 124);
  const SensorStages all = account.finish().at(0);
  EXPECT_EQ(all.seen(), 1u);
  EXPECT_EQ(all.stages[0].had.most, Duration::milliseconds(2));
}

// A path through an image to its use.
class ThroughImages : public ShortWay {
 protected:
  static std::vector<AgePath> path_to_use() {
    std::vector<AgePath> paths = path();
    paths[0].reaches_use = true;
    paths[0].to_use = paths[0].to_fusion;
    paths[0].to_use.push_back({"c executes", {}, Duration::milliseconds(9)});
    paths[0].waypoints.push_back({Waypoint::Kind::kUsed, NodeId{3}, kNoPdu, 3, {}, Duration::milliseconds(9), {}});
    return paths;
  }
  void show(std::uint32_t image, std::uint32_t sequence, std::int64_t ms) {
    recording::records::ImageWritten written;
    written.stamp = stamp(ms, NodeId{2});
    written.sequence = image;
    const MeasurementId newest{SensorId{0}, sequence};
    written.newest = {&newest, 1};
    through.on(written);
  }
  void use(std::uint32_t image, std::int64_t ms) {
    recording::records::FeatureUsed used;
    used.stamp = stamp(ms, NodeId{3});
    used.image_sequence = image;
    through.on(used);
  }
  StageAccount through{path_to_use(), false, TrueTime{}};
};

// A fusion node that starts anew numbers its images from 0 again: the earliest written are forgotten, not the lowest numbers.
TEST_F(ThroughImages, AnImageOfANodeThatStartedAnewIsRemembered) {
  for (std::uint32_t i = 0; i < 70; ++i) show(1000 + i, 0, 1 + i);
  for (std::uint32_t i = 0; i < 3; ++i) {
    through.on(recording::records::Measured{stamp(100 + i, NodeId{1}), {SensorId{0}, i}, {}});
    through.on(recording::records::ListHop{stamp(101 + i, NodeId{1}), recording::records::Hop::kWritten, PduId{4},
                                           SensorId{0}, i});
    recording::records::ListFused fused;
    fused.stamp = stamp(102 + i, NodeId{2});
    fused.id = {SensorId{0}, i};
    through.on(fused);
    show(i, i, 103 + i);
  }
  for (std::uint32_t i = 0; i < 3; ++i) use(i, 107 + i);
  EXPECT_EQ(through.finish().at(0).seen(), 3u);
}

}  // namespace
}  // namespace ttf::evaluation::ages
