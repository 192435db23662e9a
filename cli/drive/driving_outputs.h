// A closed loop's findings for people and as JSON: gap, braking, jerk and warnings. Other drives have none.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/drive/run_outputs.h"
#include "report/plots/driving_picture.h"

namespace ttf::cli::drive {

// Returns rows of the comparison table, with a cell for each result; none, if no vehicle was driven.
std::vector<std::vector<std::string>> driving_rows(const std::vector<const StrategyResult*>& results);
// Returns the picture's settings for such a scenario.
report::plots::DrivingOptions driving_options(const sim::drives::Scenario& scenario,
                                              const schedules::model::Cluster& cluster, const std::string& title);
nlohmann::ordered_json driving_json(const evaluation::driving::DrivingFindings& found);

}  // namespace ttf::cli::drive
