// Lane keeping, blind spot warning, emergency braking and an actuator with lateral commands, each with lists by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "nodes/driving/actuator.h"
#include "nodes/driving/adaptive_cruise_control.h"
#include "nodes/driving/blind_spot_warning.h"
#include "nodes/driving/emergency_braking.h"
#include "nodes/driving/steering/lane_keeping.h"
#include "tests/nodes/driving/service_by_hand.h"

namespace ttf::nodes::driving {
namespace {

using namespace recording::records;
using sim::world::vehicle::WithoutCommand;
using steering::LaneKeeping;
using steering::LaneKeepingConfig;

struct Lanes final : ServiceByHand {
  explicit Lanes(const LaneKeepingConfig& config = {})
      : ServiceByHand(task_there("feature", "lane_keeping")),
        step(surround(), task_there("feature", "lane_keeping"), config) {}

  // Two marks of a lane of 3.5 m around a line 10 m ahead; each side may be missing, or be of a low validity.
  void see(double offset, double heading = 0.0, double curvature = 0.0, double left = 1.0, double right = 1.0) {
    std::vector<Element> marks;
    const auto add = [&](double aside, double validity) {
      marks.push_back(
          {{"offset", offset + aside}, {"heading", heading}, {"curvature", curvature}, {"validity", validity}});
    };
    if (right > 0.0) add(-1.75, right);
    if (left > 0.0) add(1.75, left);
    receive("marks", marks);
    drive();
  }
  void drive() {
    receive("odometry", {{{"speed", 20.0}, {"yaw_rate", 0.0}}});
    run(step);
  }
  LaneKeeping step;
};

TEST(LaneKeeping, SteersTowardsTheMiddle) {
  Lanes lanes;
  lanes.see(0.0);
  ASSERT_TRUE(lanes.issued && lanes.issued->valid);
  EXPECT_EQ(lanes.issued->reason, CommandReason::kLane);
  EXPECT_NEAR(lanes.issued->steering, 0.0, 1e-3);
  for (const double side : {1.0, -1.0}) {
    Lanes aside;
    aside.see(side * 0.4);
    EXPECT_NEAR(aside.issued->steering, side * std::atan(0.6 * 0.4 / 21.0), 1e-3);
  }
  Lanes bend;
  bend.see(0.125, 0.025, 0.0025);  // an arc of 400 m, on its middle
  EXPECT_GT(bend.issued->steering, 2.58 / 400.0) << "tyres slip, and the wheels lag";
  EXPECT_LT(bend.issued->steering, 0.04);
}

TEST(LaneKeeping, OneMarkIsEnoughAndAFalseOneIsNone) {
  Lanes lanes;
  for (int list = 0; list < 5; ++list) lanes.see(0.2);
  const double both = lanes.issued->steering;
  for (int list = 0; list < 5; ++list) lanes.see(0.2, 0.0, 0.0, 1.0, 0.0);
  EXPECT_NEAR(lanes.issued->steering, both, 1e-3);
  Lanes deceived;
  deceived.see(0.2, 0.0, 0.0, 0.2, 0.2);
  EXPECT_FALSE(deceived.issued->valid);
}

TEST(LaneKeeping, GoesOnWithoutMarksForAWhile) {
  Lanes lanes;
  lanes.see(0.0);
  for (int execution = 1; execution <= 5; ++execution) {
    lanes.drive();
    EXPECT_TRUE(lanes.issued->valid) << execution;
  }
  lanes.drive();
  EXPECT_FALSE(lanes.issued->valid);
  lanes.see(0.0);
  EXPECT_TRUE(lanes.issued->valid);
}

TEST(LaneKeeping, WarnsOfALaneThatIsLeft) {
  Lanes lanes;
  lanes.see(0.8);
  EXPECT_TRUE(lanes.warnings.empty());
  for (int list = 0; list < 12; ++list) lanes.see(1.0);
  ASSERT_EQ(lanes.warnings.size(), 1u);
  EXPECT_EQ(lanes.warnings[0].service, WarningKind::kLaneDeparture);
  for (int list = 0; list < 12; ++list) lanes.see(0.8);
  ASSERT_EQ(lanes.warnings.size(), 2u);
  EXPECT_FALSE(lanes.warnings[1].on);
}

struct Sides final : ServiceByHand {
  Sides() : ServiceByHand(task_there("feature", "blind_spot_warning")) {}
  // A car of 4.4 m by 1.8 m.
  void see(double x, double y, double status = 1.0) {
    receive("image", {{{"id", 7}, {"x", x}, {"y", y}, {"length", 4.4}, {"width", 1.8}, {"status", status}}});
    run(step);
  }
  BlindSpotWarning step{surround(), task_there("feature", "blind_spot_warning"), {}};
};

TEST(BlindSpotWarning, WarnsOfACarInTheNextLaneAlone) {
  Sides sides;
  sides.see(-7.0, 3.5);  // its front is 0.7 m behind the zone
  sides.see(0.0, 7.0);   // two lanes further
  sides.see(0.0, 0.0);   // no place beside the vehicle
  sides.see(0.0, 3.5, 0.0);
  EXPECT_TRUE(sides.warnings.empty());
  sides.see(-6.0, 3.5);
  ASSERT_EQ(sides.warnings.size(), 1u);
  EXPECT_EQ(sides.warnings[0].service, WarningKind::kBlindSpotLeft);
  EXPECT_EQ(sides.warnings[0].track, TrackId{7});
  sides.see(3.7, 3.5);  // its rear is 0.1 m ahead of the eyes: within the margin
  EXPECT_EQ(sides.warnings.size(), 1u);
  sides.see(4.0, 3.5);
  ASSERT_EQ(sides.warnings.size(), 2u);
  EXPECT_FALSE(sides.warnings[1].on);
  sides.see(0.0, -3.5);
  ASSERT_EQ(sides.warnings.size(), 3u);
  EXPECT_EQ(sides.warnings[2].service, WarningKind::kBlindSpotRight);
}

TEST(BlindSpotWarning, KeepsItsWarningsWithoutAnImage) {
  Sides sides;
  sides.see(0.0, 3.5);
  for (int execution = 0; execution < 5; ++execution) sides.run(sides.step);
  EXPECT_EQ(sides.warnings.size(), 1u);
}

struct Wheels final : ServiceByHand {
  explicit Wheels(WithoutCommand without)
      : ServiceByHand(task_there("actuator", "actuator")),
        step(surround(), task_there("actuator", "actuator"), of(without)) {}
  static sim::world::vehicle::ActuatorConfig of(WithoutCommand without) {
    sim::world::vehicle::ActuatorConfig config;
    config.without = without;
    return config;
  }
  void command(const std::string& port, double acceleration, double steering) {
    receive(port, {{{"valid", 1.0}, {"acceleration", acceleration}, {"steering", steering}}});
  }
  Actuator step;
};

TEST(ActuatorWithLateral, EachAxisFollowsItsOwnCommands) {
  Wheels wheels(WithoutCommand::kHold);
  wheels.command("command", -1.0, 0.3);
  wheels.command("lateral", -5.0, 0.02);
  const auto both = wheels.run(wheels.step);
  ASSERT_TRUE(both);
  EXPECT_NEAR(both->acceleration, -1.0, 1e-9);
  EXPECT_NEAR(both->steering, 0.02, 1e-9);
  ASSERT_EQ(wheels.taken.size(), 2u);
  EXPECT_EQ(wheels.taken[1].verdict, CommandVerdict::kApplied);
  wheels.command("emergency", -8.0, 0.3);
  const auto brakes = wheels.run(wheels.step);
  ASSERT_TRUE(brakes);
  EXPECT_NEAR(brakes->acceleration, -8.0, 1e-9);
  EXPECT_NEAR(brakes->steering, 0.02, 1e-9) << "the wheels stay";
  ASSERT_EQ(wheels.taken.size(), 2u) << "the list of cruise control that is not there, and the one that came";
  EXPECT_EQ(wheels.taken[0].verdict, CommandVerdict::kNoneNew);
  EXPECT_NEAR(wheels.taken[1].steering, 0.02, 1e-9) << "a record has what was handed over";
  wheels.command("lateral", 0.0, 0.03);
  const auto steers = wheels.run(wheels.step);
  ASSERT_TRUE(steers);
  EXPECT_NEAR(steers->acceleration, -8.0, 1e-9) << "engine and brakes go on";
  EXPECT_NEAR(steers->steering, 0.03, 1e-9);
  EXPECT_FALSE(wheels.run(wheels.step));
}

TEST(ActuatorWithLateral, AnAxisWithoutCommandsDoesWhatTheFileSays) {
  const auto last = [](WithoutCommand without, const char* dies) {
    Wheels wheels(without);
    std::optional<host::Actuation> actuation;
    for (int execution = 0; execution < 11; ++execution) {
      for (const char* const port : {"command", "lateral"})
        if (execution == 0 || std::string_view(port) != dies) wheels.command(port, -1.0, 0.02);
      actuation = wheels.run(wheels.step);
    }
    return *actuation;  // 400 ms after the last command of the dead one, of which the first 200 ms are none
  };
  const double faded = std::exp(-0.4);
  EXPECT_NEAR(last(WithoutCommand::kHold, "lateral").steering, 0.02, 1e-9);
  EXPECT_NEAR(last(WithoutCommand::kDecay, "lateral").steering, 0.02 * faded, 1e-9);
  EXPECT_NEAR(last(WithoutCommand::kDecay, "lateral").acceleration, -1.0, 1e-9);
  EXPECT_NEAR(last(WithoutCommand::kBrake, "lateral").steering, 0.02, 1e-9);
  EXPECT_NEAR(last(WithoutCommand::kBrake, "lateral").acceleration, -4.0, 1e-9);
  EXPECT_NEAR(last(WithoutCommand::kHold, "command").acceleration, -1.0, 1e-9);
  EXPECT_NEAR(last(WithoutCommand::kDecay, "command").acceleration, -faded, 1e-9);
  EXPECT_NEAR(last(WithoutCommand::kBrake, "command").acceleration, -4.0, 1e-9);
  EXPECT_NEAR(last(WithoutCommand::kBrake, "command").steering, 0.02, 1e-9);
}

// Silence begins 200 ms after the first execution.
TEST(ActuatorWithLateral, AnAxisThatNeverHadACommandReactsToo) {
  const auto at = [](WithoutCommand without, const char* speaks, int executions) {
    Wheels wheels(without);
    std::optional<host::Actuation> actuation;
    for (int execution = 0; execution < executions; ++execution) {
      wheels.command(speaks, 0.5, 0.02);
      actuation = wheels.run(wheels.step);
    }
    return *actuation;
  };
  EXPECT_NEAR(at(WithoutCommand::kBrake, "lateral", 5).acceleration, 0.0, 1e-9);
  EXPECT_NEAR(at(WithoutCommand::kBrake, "lateral", 6).acceleration, -4.0, 1e-9);
  EXPECT_NEAR(at(WithoutCommand::kBrake, "lateral", 6).steering, 0.02, 1e-9);
  EXPECT_NEAR(at(WithoutCommand::kBrake, "command", 5).acceleration, 0.5, 1e-9);
  EXPECT_NEAR(at(WithoutCommand::kBrake, "command", 6).acceleration, -4.0, 1e-9);
  for (const WithoutCommand without : {WithoutCommand::kHold, WithoutCommand::kDecay}) {
    EXPECT_NEAR(at(without, "lateral", 11).acceleration, 0.0, 1e-9) << "there is nothing to hold";
    EXPECT_NEAR(at(without, "command", 11).acceleration, 0.5, 1e-9);
    EXPECT_NEAR(at(without, "command", 11).steering, 0.0, 1e-9);
  }
}

// So the records alone give the vehicle of the actuations.
TEST(ActuatorWithLateral, EachAppliedRecordHasWhatWasHandedOver) {
  for (const WithoutCommand without : {WithoutCommand::kHold, WithoutCommand::kDecay, WithoutCommand::kBrake}) {
    Wheels wheels(without);
    std::size_t compared = 0;
    for (int execution = 0; execution < 24; ++execution) {
      if (execution % 2 == 0) wheels.command("command", -0.1 * execution, 0.3);
      if (execution % 5 == 0) wheels.command("emergency", -8.0, 0.3);
      if (execution < 8 && execution % 3 != 1) wheels.command("lateral", -5.0, 0.001 * execution);
      const auto actuation = wheels.run(wheels.step);
      bool reported = false;
      for (const CommandTaken& taken : wheels.taken) {
        if (taken.verdict != CommandVerdict::kApplied) continue;
        ASSERT_TRUE(actuation) << execution;
        EXPECT_EQ(taken.from, actuation->from);
        EXPECT_EQ(taken.acceleration, actuation->acceleration) << execution;
        EXPECT_EQ(taken.steering, actuation->steering) << execution;
        reported = true;
      }
      EXPECT_EQ(reported, actuation.has_value()) << execution;
      compared += reported;
    }
    EXPECT_GT(compared, 12u);
  }
}

// A car on the own lane of a bend of 400 m, 2 m to the left of the x axis.
TEST(AdaptiveCruiseControl, ItsCorridorBendsIfItIsCurved) {
  for (const bool curved : {false, true}) {
    const schedules::model::Task& task = task_there("feature", "adaptive_cruise_control");
    CruiseConfig config;
    config.path.curved = curved;
    AdaptiveCruiseControl step(surround(), task, config);
    ServiceByHand service(task);
    service.receive("image",
                    {{{"id", 7}, {"x", 40}, {"y", 2}, {"heading", 0.1}, {"speed", 20}, {"length", 4}, {"status", 1}}});
    service.receive("odometry", {{{"speed", 20}, {"yaw_rate", 0.05}}});
    service.run(step);
    ASSERT_TRUE(service.issued && service.issued->valid);
    EXPECT_EQ(service.issued->track, curved ? TrackId{7} : kNoTrack);
    if (!curved) continue;
    EXPECT_NEAR(service.issued->gap, 40.0 - 2.0 - 3.4, 0.01);
    EXPECT_NEAR(service.issued->speed_ahead, 20.0, 0.01);
  }
}

// A car 0.4 m ahead, whose speed is an estimate with noise.
TEST(EmergencyBraking, BeginsNothingAtAStandstill) {
  const schedules::model::Task& task = task_there("feature", "emergency_braking");
  EmergencyBraking step(surround(), task, {});
  ServiceByHand service(task);
  const auto see = [&](double own_speed, double speed_ahead) {
    service.receive("image", {{{"id", 7},
                               {"x", 5.8},
                               {"y", 0},
                               {"heading", 0},
                               {"speed", speed_ahead},
                               {"length", 4},
                               {"width", 1.8},
                               {"status", 1}}});
    service.receive("odometry", {{{"speed", own_speed}, {"yaw_rate", 0}}});
    service.run(step);
    return service.issued && service.issued->valid;
  };
  EXPECT_FALSE(see(0.1, -0.8));
  EXPECT_TRUE(service.warnings.empty());
  EXPECT_TRUE(see(0.8, 0.0));
  EXPECT_TRUE(see(0.1, -0.8)) << "what has begun goes on";
  EXPECT_EQ(service.warnings.size(), 2u);
  EXPECT_FALSE(see(0.0, 0.0));
  EXPECT_FALSE(see(0.0, -0.8));
  EXPECT_EQ(service.warnings.size(), 4u);
}

}  // namespace
}  // namespace ttf::nodes::driving
