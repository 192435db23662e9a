// The measures of a drive, by name: a number each, or not a number if the drive has none. docs/measures.md explains
// them; a test holds the two together.
#pragma once

#include <array>
#include <string_view>

#include "drives/drive.h"
#include "evaluation/accuracy/drive_measures.h"

namespace ttf::experiments::sweep {

struct Measure {
  std::string_view name, unit, meaning;
  double (*of)(const evaluation::accuracy::DriveSummary& summary, const drives::DriveOutcome& outcome);
};

namespace measure {

inline double milliseconds(const evaluation::accuracy::AgeStatistics& age) {
  return age.count == 0 ? evaluation::accuracy::kNotMeasured
                        : static_cast<double>(age.sum.ns) / static_cast<double>(age.count) * 1e-6;
}
inline double milliseconds(const recording::records::BinnedDurations& durations, std::uint64_t permille) {
  return durations.longest() == Duration{} ? evaluation::accuracy::kNotMeasured
                                           : static_cast<double>(durations.quantile(permille).ns) * 1e-6;
}
inline double share(std::uint64_t part, std::uint64_t of) {
  return of == 0 ? evaluation::accuracy::kNotMeasured : static_cast<double>(part) / static_cast<double>(of);
}
inline double number(std::uint64_t count, const evaluation::accuracy::TrackingMeasures& tracking) {
  return tracking.instants == 0 ? evaluation::accuracy::kNotMeasured : static_cast<double>(count);
}

}  // namespace measure

// clang-format off
inline constexpr std::array<Measure, 51> kMeasures{{
  {"position_rmse_truth", "m", "root mean square of the position error against the truth, when the image is used",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return s.position_rmse_truth; }},
  {"position_mse_truth", "m^2", "mean square of the position error against the truth, unbiased when averaged over drives",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return s.position_rmse_truth * s.position_rmse_truth; }},
  {"velocity_rmse_truth", "m/s", "root mean square of the velocity error against the truth",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return s.velocity_rmse_truth; }},
  {"position_rmse_reference", "m", "root mean square of the position error against the DGPS",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return s.position_rmse_reference; }},
  {"position_mse_reference", "m^2", "mean square of the position error against the DGPS",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) {
     return s.position_rmse_reference * s.position_rmse_reference;
   }},
  {"velocity_rmse_reference", "m/s", "root mean square of the velocity error against the DGPS",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return s.velocity_rmse_reference; }},
  {"nees", "", "normalised estimation error squared of (x, y, vx, vy): 4 if the filter judges its own error rightly",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return s.nees; }},
  {"missed", "", "share of true objects without an image's object",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return measure::share(s.missed, s.missed + s.matched); }},
  {"spurious", "", "share of an image's objects without a true object",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return measure::share(s.spurious, s.spurious + s.matched); }},
  {"age_fused", "ms", "mean age of a measurement when it is fused",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return measure::milliseconds(s.age_fused); }},
  {"age_used_newest", "ms", "median age of the newest measurement in an image when the image is used",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return measure::milliseconds(s.age_used_newest, 500); }},
  {"age_used_newest_p99", "ms", "99th percentile of the age of the newest measurement in an image when the image is used",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return measure::milliseconds(s.age_used_newest, 990); }},
  {"age_used_oldest", "ms", "median age of the oldest of the sensors' newest measurements",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return measure::milliseconds(s.age_used_oldest, 500); }},
  {"lists_fused", "", "observation lists that were fused in the whole drive",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return static_cast<double>(s.fused + s.fused_late); }},
  {"out_of_sequence", "", "share of lists that came after a newer one",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return measure::share(s.out_of_sequence, s.received); }},
  {"precision", "us", "largest difference of the clocks",
   [](const evaluation::accuracy::DriveSummary&, const drives::DriveOutcome& o) { return static_cast<double>(o.precision.ns) * 1e-3; }},
  {"flexray_load", "", "share of the time in which the busier FlexRay channel is taken",
   [](const evaluation::accuracy::DriveSummary&, const drives::DriveOutcome& o) { return o.flexray_load; }},
  {"position_mse_reference_corrected", "m^2",
   "mean square of the position error against the DGPS, minus the expected part of the DGPS' own error",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return s.position_mse_reference_corrected; }},
  {"position_mse_expected", "m^2",
   "expected position_mse_truth by covariances alone: one object, straight ahead, no bias",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return s.position_mse_expected; }},
  {"face_mse_expected", "m^2",
   "expected face_mse_truth by covariances alone: one object, straight ahead, no bias",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return s.face_mse_expected; }},
  {"face_rmse", "m", "root mean square of the distance between the middle of the true visible face and that of the image",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return s.box.face_m; }},
  {"face_mse_truth", "m^2",
   "mean square of the distance between the middles of the visible face, unbiased when averaged over drives",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return s.box.face_m * s.box.face_m; }},
  {"gap_rmse", "m", "root mean square of the error of the gap: the range to the object along the line of sight",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return s.box.gap_m; }},
  {"heading_rmse", "rad", "root mean square of the error of the heading",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return s.box.heading_rad; }},
  {"speed_rmse", "m/s", "root mean square of the error of the speed",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return s.box.speed_mps; }},
  {"acceleration_rmse", "m/s^2", "root mean square of the error of the acceleration along the heading",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return s.box.acceleration_mps2; }},
  {"length_rmse", "m", "root mean square of the error of the length",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return s.box.length_m; }},
  {"width_rmse", "m", "root mean square of the error of the width",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return s.box.width_m; }},
  {"gospa", "m", "GOSPA of image and truth, as the p-th root of the mean p-th power over the uses of images",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return s.tracking.gospa.distance_m; }},
  {"gospa_localisation", "m^p", "part of GOSPA to the power p from the errors of pairs",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return s.tracking.gospa.localisation; }},
  {"gospa_missed", "m^p", "part of GOSPA to the power p from missed objects",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return s.tracking.gospa.missed; }},
  {"gospa_false", "m^p", "part of GOSPA to the power p from false objects of the image",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return s.tracking.gospa.false_estimates; }},
  {"ospa", "m", "OSPA of image and truth, as the p-th root of the mean p-th power over the uses of images",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return s.tracking.ospa.distance_m; }},
  {"ospa_localisation", "m^p", "part of OSPA to the power p from errors up to the cut-off",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return s.tracking.ospa.localisation; }},
  {"ospa_cardinality", "m^p", "part of OSPA to the power p from a wrong number of objects",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return s.tracking.ospa.cardinality; }},
  {"mota", "", "CLEAR-MOT accuracy: 1 minus misses, false objects and switches per true object",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return s.tracking.mot.mota(); }},
  {"motp", "m", "CLEAR-MOT precision: mean distance of the matches",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return s.tracking.mot.motp_m(); }},
  {"switches", "", "matches of an object with another track than before, in the whole drive",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return measure::number(s.tracking.mot.switches, s.tracking); }},
  {"fraction_tracked", "", "share of its life for which an object is tracked, mean over the objects",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return s.tracking.lives.mean_fraction_tracked; }},
  {"mostly_tracked", "", "share of objects that are tracked for 80 % of their life or more",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return measure::share(s.tracking.lives.mostly_tracked, s.tracking.lives.objects); }},
  {"mostly_lost", "", "share of objects that are tracked for less than 20 % of their life",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return measure::share(s.tracking.lives.mostly_lost, s.tracking.lives.objects); }},
  {"fragmentations", "", "times that an object was tracked again after a loss, in the whole drive",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return measure::number(s.tracking.lives.fragmentations, s.tracking); }},
  {"confirmed_after", "ms", "mean time from the first judged instant of an object to its first match",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return 1e3 * s.tracking.lives.mean_confirmed_after_s; }},
  {"nees_position", "", "normalised estimation error squared of the position over its 2 degrees of freedom: 1 if rightly judged",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return s.own.position; }},
  {"nees_velocity", "", "the same of the velocity",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return s.own.velocity; }},
  {"nees_heading", "", "normalised estimation error squared of the heading: 1 if rightly judged",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return s.own.heading; }},
  {"nees_speed", "", "the same of the speed",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return s.own.speed; }},
  {"nees_acceleration", "", "the same of the acceleration along the heading, of models that have one",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return s.own.acceleration; }},
  {"nees_length", "", "the same of the length",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return s.own.length; }},
  {"nees_width", "", "the same of the width",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return s.own.width; }},
  {"nis", "", "normalised innovation squared of confirmed tracks, over its degrees of freedom: 1 if the filter judges its predictions rightly",
   [](const evaluation::accuracy::DriveSummary& s, const drives::DriveOutcome&) { return s.own.innovations; }},
}};
// clang-format on

constexpr const Measure* find_measure(std::string_view name) {
  for (const Measure& measure : kMeasures)
    if (measure.name == name) return &measure;
  return nullptr;
}

// Returns whether a change is best told as a share of the value before. So it is for errors, distances and ages, which have
// a unit and cannot be negative. It is not for shares, counts and normalised squares, nor for an error minus an expected one.
constexpr bool is_ratio_scale(const Measure& measure) {
  return !measure.unit.empty() && measure.name != "position_mse_reference_corrected";
}

}  // namespace ttf::experiments::sweep
