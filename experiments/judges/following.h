// The gap error of a vehicle that follows another one, under a schedule's instants.
//
// The loop is that of docs/schedules/expected_error.md. Adaptive cruise control has the default gains of nodes/control/time_gap.h.
// The drive train has a lag. White noise drives the speed of the lead, which forgets. The loop is linear: it has no
// limits, no tracker, and no noise of sensors. A sensor's measurement samples the gap and the speeds. The command of a
// use rests on the newest sample that has reached it. It acts from there on.
#pragma once

#include <vector>

#include "core/time.h"

namespace ttf::experiments::judges {

struct FollowingVehicle {
  double time_gap_s = 1.8;
  double lag_s = 0.2;      // the drive train's
  double memory_s = 10.0;  // the lead's speed forgets
  double density = 1.0;    // spectral density of the lead's noise [m^2/s^3]
};

// A command acts from `at` on, within the round or behind it. It rests on the sample of `sampled`, at or before `at`.
struct Command {
  Duration at{}, sampled{};
};

struct CommandRound {
  Duration length{};
  std::vector<Duration> samples;  // within the round, rising
  std::vector<Command> commands;  // at least one; `sampled` is one of the samples, or one whole rounds away
};

// Returns the expected squared error of the gap [m^2]; infinite if the loop is not stable. It is the same to the last
// digit wherever the round begins.
double gap_error(const FollowingVehicle& vehicle, const CommandRound& round);

}  // namespace ttf::experiments::judges
