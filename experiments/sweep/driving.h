// The judgement of a drive in which commands drive the vehicle, by its scenario.
#pragma once

#include "drives/scenario.h"
#include "evaluation/driving/driving_account.h"

namespace ttf::experiments::sweep {

// Returns the account's settings for a scenario whose vehicle commands drive.
evaluation::driving::DrivingConfig driving_config(const drives::Scenario& scenario);
// Returns whether commands drive the scenario's vehicle.
inline bool is_driven(const drives::Scenario& scenario) { return scenario.world.ego && scenario.world.ego->actuator; }

}  // namespace ttf::experiments::sweep
