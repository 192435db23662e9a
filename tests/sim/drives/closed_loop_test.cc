// Drives whose commands drive the vehicle: the same every time, without allocations, and distinguished from others.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/file_bytes.h"
#include "evaluation/driving/driving_account.h"
#include "schedules/check/checker.h"
#include "sim/drives/step_catalog.h"
#include "tests/schedules/cluster_file.h"
#include "tests/sim/drives/drive_fixture.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/refusals.h"

namespace ttf::sim::drives {
namespace {

using fusion::strategies::StrategyKind;
using testing::HasSubstr;

constexpr const char* kBraking = "scenarios/acc_braking_lead.yaml";

Drive braking(StrategyKind kind, const std::string& more = {}) {
  const std::string file = shipped(kBraking);
  Drive drive(kBraking, kind);
  drive.scenario = parse_scenario(read_file(file) + more, file);
  return drive;
}

evaluation::driving::DrivingFindings found_in(const Drive& drive) {
  evaluation::driving::DrivingAccount account({}, evaluation_start(drive.scenario));
  drive.run(account);
  return account.finish();
}

struct WayOfTheVehicle : recording::records::Sink {
  std::vector<double> values;
  std::int64_t allocations_at_start = -1, allocations = 0;
  using recording::records::Sink::on;
  void on(const recording::records::EgoTruth& ego) override {
    if (values.size() + 4 > values.capacity()) return;
    values.insert(values.end(), {static_cast<double>(ego.at.ns), ego.x, ego.vx, ego.acceleration});
  }
  void on(const recording::records::TaskRun&) override {
    allocations = support::allocations();
    if (allocations_at_start < 0) allocations_at_start = allocations;
  }
  WayOfTheVehicle() { values.reserve(1'000'000); }
};

TEST(ClosedLoop, RepeatsItselfAndAllocatesNothing) {
  Drive drive = braking(StrategyKind::kAdva);
  drive.scenario.duration = Duration::milliseconds(2'000);
  WayOfTheVehicle once, again, otherwise;
  drive.run(once);
  drive.run(again);
  drive.run(otherwise, 2);
  ASSERT_GT(once.values.size(), 400u);
  EXPECT_EQ(once.values, again.values);
  EXPECT_NE(once.values, otherwise.values) << "another seed measures otherwise, so the vehicle drives otherwise";
  EXPECT_EQ(once.allocations, once.allocations_at_start);
}

// A planner and low-level control instead of services, and regions of interest on their way back to the detector.
TEST(ClosedLoop, OfAPlannerRepeatsItselfAndAllocatesNothing) {
  struct Way final : WayOfTheVehicle {
    int plans = 0, regions = 0, secondary = 0;
    using Sink::on;
    void on(const recording::records::PlanMade& plan) override {
      ++plans;
      if (plan.camera != kNoSensor) ++regions;
    }
    void on(const recording::records::DetectionMade& made) override { secondary += made.secondary ? 1 : 0; }
  };
  Drive drive("scenarios/adaptive_detection.yaml", StrategyKind::kAdva);
  drive.scenario.duration = Duration::milliseconds(2'000);
  Way once, again;
  drive.run(once);
  drive.run(again);
  ASSERT_GT(once.values.size(), 400u);
  EXPECT_EQ(once.values, again.values);
  EXPECT_EQ(once.allocations, once.allocations_at_start);
  EXPECT_GT(once.plans, 190);
  EXPECT_GT(once.regions, 100);
  EXPECT_GT(once.secondary, 10);
  EXPECT_NEAR(once.values[once.values.size() - 2], 29.5, 1.0) << "the planner asks for 30 m/s during start-up";
}

TEST(ClosedLoop, StopsBehindTheOneAheadInTheWholeDrive) {
  for (const StrategyKind kind : {StrategyKind::kBuff, StrategyKind::kAdva, StrategyKind::kTt}) {
    const evaluation::driving::DrivingFindings found = found_in(braking(kind));
    EXPECT_FALSE(found.collision) << name_of(kind);
    EXPECT_TRUE(found.stopping_distance_m) << name_of(kind);
    EXPECT_GT(found.smallest_gap_m, 0.3) << name_of(kind);
    EXPECT_GT(found.applied, 400u);
    EXPECT_EQ(found.late, 0u);
  }
}

// The services' node has no supply for two seconds: no command comes, and the vehicle does what its file says.
TEST(ClosedLoop, WithoutCommandsTheVehicleDoesWhatItsFileSays) {
  const std::string dead = "faults:\n  - {kind: crash, node: feature, from: 2 s, duration: 3 s}\n";
  using sim::world::vehicle::WithoutCommand;
  const auto speed_at_the_end = [&](WithoutCommand reaction) {
    Drive drive = braking(StrategyKind::kTt, dead);
    drive.scenario.duration = Duration::milliseconds(3'500);
    drive.scenario.world.ego->actuator->without = reaction;
    WayOfTheVehicle way;
    drive.run(way);
    return way.values[way.values.size() - 2];
  };
  const double held = speed_at_the_end(WithoutCommand::kHold), decayed = speed_at_the_end(WithoutCommand::kDecay),
               braked = speed_at_the_end(WithoutCommand::kBrake);
  EXPECT_NEAR(held, 22.0, 2.0);
  EXPECT_NEAR(decayed, 22.0, 2.0);
  EXPECT_NE(held, decayed);
  EXPECT_NEAR(braked, 22.0 - 4.0 * 1.05, 1.0);
}

// Through the first bend, from its clothoid on.
TEST(ClosedLoop, KeepsItsLaneInABend) {
  Drive drive("scenarios/lane_keeping.yaml", StrategyKind::kTt);
  Scenario& scenario = drive.scenario;
  scenario.duration = Duration::milliseconds(5'000);
  scenario.world.duration = scenario.duration;
  scenario.world.ego->on->station += 80.0;
  scenario.world.objects.resize(1);
  scenario.world.objects.front().on->start.station += 80.0;
  evaluation::driving::DrivingAccount account(
      {.lane = evaluation::driving::LaneConfig{*scenario.world.road, scenario.world.ego->on->lane}},
      evaluation_start(scenario));
  const DriveOutcome outcome = drive.run(account);
  EXPECT_EQ(outcome.counts.overwritten_lists, 0u) << "lane keeping wants the newest odometry, not each";
  const evaluation::driving::DrivingFindings found = account.finish();
  EXPECT_LT(found.lane->largest_offset_m, 0.4);
  EXPECT_EQ(found.lane->outside, 0.0);
  EXPECT_GT(found.applied, 150u) << "readings of both axes, each 40 ms";
}

std::string refusal(const Drive& drive) {
  return support::refusal_of([&] {
    check_loop(drive.scenario, drive.cluster);
    check_tasks(drive.scenario, drive.cluster);
  });
}

TEST(ClosedLoop, HasOneActuatorAndAVehicle) {
  const Drive sound = braking(StrategyKind::kTt);
  EXPECT_EQ(refusal(sound), "");
  Drive drive = sound;
  drive.scenario.world.ego->actuator.reset();
  EXPECT_THAT(refusal(drive), HasSubstr("needs a vehicle that it drives"));
  drive = sound;
  const NodeId actuator = *drive.cluster.find_node("actuator");
  auto& tasks = drive.cluster.nodes[index_of(actuator)].tasks;
  tasks.push_back(tasks.front());
  EXPECT_THAT(refusal(drive), HasSubstr("must be absent: actuator has an actuator, and a vehicle has one"));
  tasks.pop_back();
  EXPECT_EQ(between_readings(drive.cluster), Duration::milliseconds(40));
  tasks.front().activation.at.repetition = 0;
  EXPECT_THAT(refusal(drive), HasSubstr("nodes.actuator.tasks.act.activation: must be by time"));
  tasks.front().activation.at.repetition = 8;
  tasks.front().activation.kind = schedules::model::ActivationKind::kMessage;
  EXPECT_THAT(refusal(drive), HasSubstr("nodes.actuator.tasks.act.activation: must be by time"));
  tasks.clear();
  EXPECT_THAT(refusal(drive), HasSubstr("needs a cluster whose commands drive the vehicle"));
  drive = sound;
  drive.scenario.world.ego->actuator->dead_time = Duration::microseconds(200);
  EXPECT_THAT(refusal(drive), HasSubstr("world.ego.actuator.dead_time = 0.2 ms: must be at least"));
  drive = sound;
  drive.scenario.world.ego->actuator->oldest = Duration::milliseconds(280);
  EXPECT_THAT(refusal(drive), HasSubstr("world.ego.actuator.oldest = 280 ms: must be from 1 ms to below 280 ms"));
  drive = sound;
  drive.scenario.sensors.of<sensors::laser::Kind>().usual.model.device.time.fixed = 0.01;
  EXPECT_THAT(refusal(drive), HasSubstr("the stamps of laser err"));
  drive = sound;
  drive.scenario.sensors.of<sensors::odometry::Kind>().usual.model.device.time.sigma = 0.01;
  EXPECT_THAT(refusal(drive), HasSubstr("the stamps of odometry err"));
  EXPECT_EQ(actuator_node(sound.cluster), actuator);
}

// The first sentence about the shipped cluster after a change, as the program's checks come.
std::string refusal_after(const std::string& change, const std::string& to) {
  std::string text = schedules::shipped_text("closed_loop_synchronised");
  const std::size_t at = text.find(change);
  if (at == std::string::npos) throw std::runtime_error(change);
  text.replace(at, change.size(), to);
  return support::refusal_of([&] {
    const schedules::model::Cluster cluster = schedules::file::parse_cluster(std::move(text), "loop.yaml");
    if (auto findings = schedules::check::check(cluster); !findings.empty()) throw InputError(std::move(findings));
    check_steps(cluster);
  });
}

TEST(ClosedLoop, AServiceThatIsNotFedOrReadIsRefused) {
  const std::string both = "reads: {image: image on flexray, odometry: odometry_list on flexray}\n        writes: ";
  EXPECT_THAT(refusal_after(both, "reads: {odometry: odometry_list on flexray}\n        writes: "),
              HasSubstr("nodes.feature.tasks.cruise.reads: must bind the port image"));
  EXPECT_THAT(refusal_after(", emergency: emergency_command on flexray", ""),
              HasSubstr("nodes.feature.tasks.brake.writes.command = emergency_command on flexray: is written, but no "
                        "task reads it"));
  EXPECT_THAT(refusal_after("        writes: {command: cruise_command on flexray}\n", ""),
              HasSubstr("nodes.actuator.tasks.act.reads.command = cruise_command on flexray: is read, but no task "
                        "writes it"));
}

TEST(ClosedLoop, GainsAreNumbers) {
  for (const char* const gain : {".nan", ".inf", "strong"}) {
    const std::string file = shipped(kBraking);
    std::string text = read_file(file);
    text.replace(text.find("time_gap: 1.8"), 13, std::string("gap_gain: ") + gain);
    try {
      (void)parse_scenario(std::move(text), file);
      ADD_FAILURE() << gain;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("adaptive_cruise_control.gap_gain = " + std::string(gain) +
                                          ": must be a number 0..10 1/s^2"));
    }
  }
}

TEST(ClosedLoop, LaneKeepingNeedsALane) {
  Drive drive("scenarios/lane_keeping.yaml", StrategyKind::kTt);
  EXPECT_EQ(refusal(drive), "");
  drive.scenario.world.road.reset();
  EXPECT_THAT(refusal(drive), HasSubstr("nodes.feature.tasks.keep_lane.step = lane_keeping: needs a lane"));
}

TEST(ClosedLoop, ObjectsThatFollowAreReportedNotToSeeTheVehicle) {
  Drive drive = braking(StrategyKind::kTt);
  EXPECT_EQ(following_warning(drive.scenario), "");
  drive.scenario.world.objects.front().on->follow.emplace();
  EXPECT_THAT(following_warning(drive.scenario), HasSubstr("world.ego.actuator: drives a vehicle that objects which "
                                                           "follow do not see, such as leader"));
}

TEST(ClosedLoop, ASectionWithoutItsStepIsReported) {
  const Drive drive = braking(StrategyKind::kTt, "\nlane_keeping: {}\nvehicle_control: {}\n");
  const std::string reported = unused_sections(drive.scenario, {&drive.cluster, 1});
  EXPECT_THAT(reported, HasSubstr("lane_keeping: has no effect: no task of the cluster has this step\n"));
  EXPECT_THAT(reported, HasSubstr("vehicle_control: has no effect"));
  EXPECT_EQ(reported.find("emergency_braking"), std::string::npos);
  EXPECT_EQ(unused_sections(braking(StrategyKind::kTt).scenario, {&drive.cluster, 1}), "");
  // The gap is judged by that of adaptive cruise control, whichever service keeps it.
  const std::string file = shipped("scenarios/adaptive_detection.yaml");
  const Drive planned("scenarios/adaptive_detection.yaml", StrategyKind::kTt);
  EXPECT_THAT(
      unused_sections(parse_scenario(read_file(file) + "\nadaptive_cruise_control: {}\n", file), {&planned.cluster, 1}),
      HasSubstr("adaptive_cruise_control: has no effect but on the judged error of the gap: no task"));
}

}  // namespace
}  // namespace ttf::sim::drives
