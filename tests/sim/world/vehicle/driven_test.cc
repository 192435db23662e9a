// A vehicle that commands drive: the actuator between them and the wheels, and its own reaction without them.
#include "sim/world/vehicle/driven.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "sim/world/road/road.h"
#include "tests/sim/world/drives.h"
#include "tests/support/allocation_counter.h"

namespace ttf::sim::world::vehicle {
namespace {

constexpr Duration kLong = Duration::milliseconds(10'000);

EgoConfig at_speed(double speed) {
  EgoConfig config;
  config.speed = speed;
  config.actuator.emplace();
  config.actuator->lag = Duration::milliseconds(500);
  config.actuator->without = WithoutCommand::kHold;
  return config;
}

TEST(Driven, KeepsItsSpeedUntilTheFirstCommandIfItHolds) {
  Driven driven(at_speed(20.0), nullptr, kLong);
  EXPECT_NEAR(driven.at(at_ms(5000)).x, 100.0, 1e-6);
  EXPECT_NEAR(driven.at(at_ms(5000)).vx, 20.0, 1e-9);
  EXPECT_EQ(driven.at(at_ms(5000)).acceleration, 0.0);
}

// a = u (1 - exp(-t / T)), so that v = v0 + u (t - T (1 - exp(-t / T))).
TEST(Driven, FollowsACommandWithItsLag) {
  EgoConfig config = at_speed(20.0);
  config.actuator->gain = 0.5;
  Driven driven(config, nullptr, kLong);
  driven.actuate({at_ms(1003), -4.0, 0.0});
  const double lag = 0.5, asked = -2.0;
  for (const std::int64_t after : {1, 100, 777, 2500}) {
    const double t = 1e-3 * static_cast<double>(after), left = 1.0 - std::exp(-t / lag);
    const RearAxleMotion motion = driven.at(at_ms(1003 + after));
    EXPECT_NEAR(motion.vx, 20.0 + asked * (t - lag * left), 1e-9) << after;
    EXPECT_NEAR(motion.acceleration, asked * left, 1e-9) << after;
  }
}

TEST(Driven, TheFrontWheelsMayHaveALagOfTheirOwn) {
  constexpr Duration kNone, kSome = Duration::milliseconds(500);
  const auto yaw_rate = [](Duration lag, std::optional<Duration> steering_lag) {
    EgoConfig config = at_speed(20.0);
    config.actuator->lag = lag;
    config.actuator->steering_lag = steering_lag;
    Driven driven(config, nullptr, kLong);
    driven.actuate({at_ms(1000), 0.0, 0.01});
    return driven.at(at_ms(1300)).yaw_rate;
  };
  EXPECT_EQ(yaw_rate(kSome, kNone), yaw_rate(kNone, std::nullopt));
  EXPECT_EQ(yaw_rate(kNone, kSome), yaw_rate(kSome, std::nullopt)) << "absent, it is that of the acceleration";
  // The wheels are at 1 - exp(-0.6) = 0.45 of the command, and the vehicle turns behind them.
  EXPECT_LT(yaw_rate(kNone, kSome), 0.45 * yaw_rate(kNone, kNone));
}

TEST(Driven, ReactsWithoutAFirstCommandToo) {
  EgoConfig config = at_speed(20.0);
  config.actuator->lag = {};
  config.actuator->without = WithoutCommand::kBrake;
  Driven driven(config, nullptr, kLong);
  EXPECT_NEAR(driven.at(at_ms(200)).vx, 20.0, 1e-9);
  EXPECT_NEAR(driven.at(at_ms(1200)).vx, 16.0, 1e-9);
  driven.actuate({at_ms(1300), 0.0, 0.0});
  EXPECT_NEAR(driven.at(at_ms(1400)).vx, 20.0 - 1.1 * 4.0, 1e-9);
}

TEST(Driven, ItsWayDependsOnTheCommandsAlone) {
  const auto driven_with = [](std::int64_t looks_every) {
    Driven driven(at_speed(15.0), nullptr, kLong);
    std::vector<RearAxleMotion> seen;
    for (std::int64_t at = 0; at < 9000; ++at) {
      if (at % 37 == 5) driven.actuate({at_ms(at + 20), std::sin(0.01 * static_cast<double>(at)), 0.02});
      if (looks_every > 0 && at % looks_every == 0) (void)driven.at(at_ms(at));
    }
    for (const std::int64_t at : {8999, 4321, 17, 6000}) seen.push_back(driven.at(at_ms(at)));
    return seen;
  };
  const std::vector<RearAxleMotion> never = driven_with(0), often = driven_with(1), sometimes = driven_with(143);
  for (std::size_t i = 0; i < never.size(); ++i) {
    for (const auto member : {&RearAxleMotion::x, &RearAxleMotion::y, &RearAxleMotion::heading, &RearAxleMotion::vx,
                              &RearAxleMotion::yaw_rate, &RearAxleMotion::acceleration}) {
      EXPECT_EQ(never[i].*member, often[i].*member) << i;
      EXPECT_EQ(never[i].*member, sometimes[i].*member) << i;
    }
  }
}

TEST(Driven, WithoutCommandsItHoldsDecaysOrBrakes) {
  const auto speed_after = [](WithoutCommand reaction) {
    EgoConfig config = at_speed(20.0);
    config.actuator->lag = {};
    config.actuator->without = reaction;
    config.actuator->after = Duration::milliseconds(200);
    config.actuator->decay = Duration::milliseconds(500);
    config.actuator->deceleration = 5.0;
    Driven driven(config, nullptr, kLong);
    driven.actuate({at_ms(100), 2.0, 0.0});
    EXPECT_NEAR(driven.at(at_ms(300)).vx, 20.4, 1e-9);
    return driven.at(at_ms(1300)).vx;
  };
  EXPECT_NEAR(speed_after(WithoutCommand::kHold), 22.4, 1e-9);
  EXPECT_NEAR(speed_after(WithoutCommand::kDecay), 20.4 + 2.0 * 0.5 * (1.0 - std::exp(-2.0)), 3e-3);
  EXPECT_NEAR(speed_after(WithoutCommand::kBrake), 15.4, 1e-9);
}

TEST(Driven, ACommandEndsTheReaction) {
  EgoConfig config = at_speed(20.0);
  config.actuator->lag = {};
  config.actuator->without = WithoutCommand::kBrake;
  Driven driven(config, nullptr, kLong);
  driven.actuate({at_ms(100), 0.0, 0.0});
  driven.actuate({at_ms(1100), 0.0, 0.0});
  EXPECT_NEAR(driven.at(at_ms(1200)).vx, 20.0 - 0.8 * 4.0, 1e-9);
}

TEST(Driven, StandsAfterBrakingAndStartsAgain) {
  EgoConfig config = at_speed(4.0);
  Driven driven(config, nullptr, kLong);
  driven.actuate({at_ms(100), -30.0, 0.0});
  EXPECT_EQ(driven.at(at_ms(4000)).vx, 0.0);
  EXPECT_EQ(driven.at(at_ms(4000)).acceleration, 0.0);
  const double stood = driven.at(at_ms(4000)).x;
  driven.actuate({at_ms(5000), 1.0, 0.0});
  EXPECT_NEAR(driven.at(at_ms(4999)).x, stood, 1e-9);
  EXPECT_GT(driven.at(at_ms(9000)).vx, 0.5);
}

TEST(Driven, TakesNoMoreThanItsLimits) {
  EgoConfig config = at_speed(20.0);
  config.actuator->lag = {};
  config.actuator->largest_deceleration = 3.0;
  config.actuator->largest_steering = 0.05;
  Driven driven(config, nullptr, kLong);
  driven.actuate({at_ms(1000), -8.0, 0.5});
  EXPECT_NEAR(driven.at(at_ms(2000)).vx, 17.0, 0.2);
  Driven gentle(config, nullptr, kLong);
  gentle.actuate({at_ms(1000), -3.0, 0.05});
  EXPECT_EQ(driven.at(at_ms(2000)).yaw_rate, gentle.at(at_ms(2000)).yaw_rate);
}

TEST(Driven, AllocatesNothingOnItsWay) {
  Driven driven(at_speed(20.0), nullptr, kLong);
  const std::int64_t before = support::allocations();
  for (std::int64_t at = 0; at < 10'000; ++at) {
    driven.actuate({at_ms(at + 1), 0.1, 0.0});
    (void)driven.at(at_ms(at));
  }
  EXPECT_EQ(support::allocations(), before);
}

// A drive of an hour would need 86 MB for an actuation each millisecond. The schedule has one each 40 ms.
TEST(Driven, HasRoomForTwiceAsManyActuationsAsReadings) {
  EgoConfig config = at_speed(20.0);
  config.actuator->between = Duration::milliseconds(40);
  Driven driven(config, nullptr, kLong);
  const std::int64_t before = support::allocations();
  int taken = 0;
  for (std::int64_t k = 1; k <= 502; ++k) taken += driven.insert({at_ms(k), 0.1, 0.0}) == Inserted::kNew ? 1 : 0;
  EXPECT_EQ(driven.insert({at_ms(503), 0.1, 0.0}), Inserted::kRefused);
  EXPECT_EQ(support::allocations(), before);
  EXPECT_EQ(taken, 502);
}

// Looks at 1200 ms, then an actuation of 1000 ms comes, then an earlier one, then both again.
TEST(Driven, AnActuationMayBecomeKnownLateOrTwice) {
  Driven late(at_speed(20.0), nullptr, kLong), in_time(at_speed(20.0), nullptr, kLong);
  for (const Actuation& one : {Actuation{at_ms(903), 1.0, 0.01}, Actuation{at_ms(1000), -3.0, 0.0}})
    in_time.actuate(one);
  EXPECT_NE(late.at(at_ms(1200)).x, in_time.at(at_ms(1200)).x);
  EXPECT_EQ(late.insert({at_ms(1000), -3.0, 0.0}), Inserted::kLate);
  EXPECT_EQ(late.insert({at_ms(903), 1.0, 0.01}), Inserted::kLate);
  EXPECT_EQ(late.insert({at_ms(903), 7.0, 0.0}), Inserted::kKnown);
  EXPECT_EQ(late.insert({at_ms(1300), 2.0, 0.0}), Inserted::kNew);
  EXPECT_EQ(late.insert({at_ms(0), 2.0, 0.0}), Inserted::kRefused);
  in_time.actuate({at_ms(1300), 2.0, 0.0});
  for (std::int64_t at = 1; at < 3000; at += 97) {
    EXPECT_EQ(late.at(at_ms(at)).x, in_time.at(at_ms(at)).x) << at;
    EXPECT_EQ(late.at(at_ms(at)).yaw_rate, in_time.at(at_ms(at)).yaw_rate) << at;
  }
}

TEST(Driven, AProfileBesideAnActuatorIsRefused) {
  try {
    world_from("ego: {actuator: {}, profile: [{duration: 1 s}]}\nobjects: []");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("must be absent beside `actuator`"), std::string::npos) << error.what();
  }
  try {
    world_from("ego: {actuator: {gain: .nan}}\nobjects: []");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("ego.actuator.gain"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace ttf::sim::world::vehicle
