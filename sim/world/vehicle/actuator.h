// The actuator between a command and the wheels (driven.h).
#pragma once

#include <optional>

#include "core/strict_yaml.h"
#include "core/time.h"

namespace ttf::sim::world::vehicle {

enum class WithoutCommand { kHold, kDecay, kBrake };

struct ActuatorConfig {
  // From the actuator's reading of a command until something happens. It is longer than the actuator's task, so that an
  // actuation has reached all others before it begins.
  Duration dead_time = Duration::milliseconds(50);
  Duration lag = Duration::milliseconds(200);  // the acceleration follows with it
  std::optional<Duration> steering_lag{};      // the front wheels follow with it; absent: `lag`
  double gain = 1.0;                           // a share of the acceleration
  double largest_acceleration = 3.0;           // [m/s^2], that a command may ask for
  double largest_deceleration = 9.0;           // [m/s^2], positive
  double largest_steering = 0.6;               // [rad], to either side
  // A command is refused if its instant is further away than this when it is read.
  Duration oldest = Duration::milliseconds(100);
  int dead_time_line = 0, oldest_line = 0;  // in the file
  // The reaction begins when no actuation has begun for this time. It counts from the drive's start, too.
  Duration after = Duration::milliseconds(200);
  WithoutCommand without = WithoutCommand::kBrake;
  Duration decay = Duration::milliseconds(500);  // the time constant of kDecay
  double deceleration = 4.0;                     // [m/s^2], of kBrake, positive
  // The schedule's: the time between two readings of commands. The vehicle has room for twice as many actuations.
  Duration between = Duration::milliseconds(2);
};
// Reads all but `between`.
ActuatorConfig load_actuator(YamlMap& yaml);

}  // namespace ttf::sim::world::vehicle
