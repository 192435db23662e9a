#include "evaluation/measures/figures.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

namespace ttf::evaluation::measures {
namespace {

// A part of the summary that is null instead of absent, if a drive in which commands drive the vehicle has it not.
std::string_view null_part(When when) {
  switch (when) {
    case When::kCollision: return "/driving/collision";
    case When::kReaction: return "/driving/reaction_s";
    case When::kDetections: return "/driving/detections";
    case When::kAlways:
    case When::kOdometry:
    case When::kDriven:
    case When::kLane:
    case When::kWarnsAhead:
    case When::kBlindSpot: return "";
  }
  return "";
}

}  // namespace

bool applies(When when, const DriveFigures& figures) {
  if (when == When::kAlways) return true;
  if (when == When::kOdometry) return figures.summary.odometry_samples + figures.summary.odometry_stops > 0;
  if (figures.driving == nullptr) return false;
  switch (when) {
    case When::kCollision: return figures.driving->collision.has_value();
    case When::kReaction: return figures.driving->reaction.has_value();
    case When::kDetections: return figures.driving->detections.has_value();
    case When::kLane: return figures.driving->lane.has_value();
    case When::kWarnsAhead: return figures.driving->warns_ahead;
    case When::kBlindSpot: return figures.driving->watches_blind_spot;
    case When::kAlways:
    case When::kOdometry:
    case When::kDriven: return true;
  }
  return false;
}

double value_of(const Measure& measure, const DriveFigures& figures) {
  const double value = applies(measure.when, figures) ? measure.of(figures) : Getter::kNone;
  return std::isfinite(value) ? value : Getter::kNone;
}

void add_to(nlohmann::ordered_json& json, std::span<const Measure> rows, const DriveFigures& figures) {
  using Pointer = nlohmann::ordered_json::json_pointer;
  for (const Measure& row : rows) {
    if (row.path.empty()) continue;
    if (!applies(row.when, figures)) {
      const std::string_view part = null_part(row.when);
      if (!part.empty() && figures.driving != nullptr) json[Pointer(std::string(part))] = nullptr;
      continue;
    }
    nlohmann::ordered_json& place = json[Pointer(std::string(row.path))];
    if (const double value = value_of(row, figures); !std::isfinite(value))
      place = nullptr;
    else if (row.of.is_count())
      place = static_cast<std::uint64_t>(value);
    else
      place = value;
  }
}

}  // namespace ttf::evaluation::measures
