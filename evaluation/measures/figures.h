// A drive's findings, from which the measures are taken, and their values.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "evaluation/accuracy/drive_measures.h"
#include "evaluation/driving/driving_account.h"
#include "evaluation/measures/measure.h"
#include "sim/drives/drive.h"

namespace ttf::evaluation::measures {

struct DriveFigures {
  const accuracy::DriveSummary& summary;
  const sim::drives::DriveOutcome& outcome;
  const driving::DrivingFindings* driving = nullptr;  // null unless commands drive the vehicle
};

bool applies(When when, const DriveFigures& figures);
// Returns the value, or not a number if the drive has none.
double value_of(const Measure& measure, const DriveFigures& figures);

// Writes the values with a path into a strategy's part of summary.json. One that is not finite becomes null.
void add_to(nlohmann::ordered_json& json, std::span<const Measure> rows, const DriveFigures& figures);

}  // namespace ttf::evaluation::measures
