// The measures of a drive, by name: a number each, or not a number if the drive has none. docs/reference/measures.md explains
// them; a test holds the two together.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "evaluation/accuracy/drive_measures.h"
#include "evaluation/driving/driving_account.h"
#include "recording/records/records.h"
#include "sim/drives/drive.h"

namespace ttf::experiments::sweep {

// A drive's findings. `driving` is null unless commands drive the vehicle.
struct MeasuredDrive {
  const evaluation::accuracy::DriveSummary& summary;
  const sim::drives::DriveOutcome& outcome;
  const evaluation::driving::DrivingFindings* driving = nullptr;
};

struct Measure {
  std::string_view name, unit, meaning;
  double (*of)(const MeasuredDrive& drive);
  bool is_event = false;  // 0 or 1 in a drive: its mean is a share of drives (experiments/results/share.h)
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
// Measures of a vehicle that commands drive; without a value in a drive it is not a number.
inline constexpr double kNone = evaluation::driving::DrivingFindings::kNone;
template <class Of> double driven(const MeasuredDrive& drive, const Of& of) {
  const double value = drive.driving == nullptr ? kNone : of(*drive.driving);
  return value == kNone ? evaluation::accuracy::kNotMeasured : value;
}
template <class Of> double detected(const MeasuredDrive& drive, const Of& of) {
  return driven(drive, [&](const auto& f) { return f.detections ? of(*f.detections) : kNone; });
}
inline double warnings(const MeasuredDrive& drive, std::size_t service,
                       std::uint64_t evaluation::driving::WarningFindings::*count) {
  return driven(drive, [&](const auto& f) { return static_cast<double>(f.warnings[service].*count); });
}

inline evaluation::driving::WarningFindings beside(const evaluation::driving::DrivingFindings& f) {
  return evaluation::driving::together(f.warnings[recording::records::kBlindSpotLeft],
                                       f.warnings[recording::records::kBlindSpotRight]);
}
// Measures of services that only some drives have.
template <class Of> double in_lane(const MeasuredDrive& drive, const Of& of) {
  return driven(drive, [&](const auto& f) { return f.lane ? of(*f.lane) : kNone; });
}
template <class Of> double departure(const MeasuredDrive& drive, const Of& of) {
  return driven(drive,
                [&](const auto& f) { return f.lane ? of(f.warnings[recording::records::kLaneDeparture]) : kNone; });
}
template <class Of> double blind_spot(const MeasuredDrive& drive, const Of& of) {
  return driven(drive, [&](const auto& f) { return f.watches_blind_spot ? of(beside(f)) : kNone; });
}
inline double lateness_ms(const evaluation::driving::WarningFindings& w) {
  return w.late == 0 ? kNone : static_cast<double>(w.lateness_sum.ns) / static_cast<double>(w.late) * 1e-6;
}

}  // namespace measure

// clang-format off
inline constexpr std::array<Measure, 88> kMeasures{{
  {"position_rmse_truth", "m", "root mean square of the position error against the truth, when the image is used",
   [](const MeasuredDrive& d) { return d.summary.position_rmse_truth; }},
  {"position_mse_truth", "m^2", "mean square of the position error against the truth, unbiased when averaged over drives",
   [](const MeasuredDrive& d) { return d.summary.position_rmse_truth * d.summary.position_rmse_truth; }},
  {"velocity_rmse_truth", "m/s", "root mean square of the velocity error against the truth",
   [](const MeasuredDrive& d) { return d.summary.velocity_rmse_truth; }},
  {"position_rmse_reference", "m", "root mean square of the position error against the DGPS",
   [](const MeasuredDrive& d) { return d.summary.position_rmse_reference; }},
  {"position_mse_reference", "m^2", "mean square of the position error against the DGPS",
   [](const MeasuredDrive& d) {
     return d.summary.position_rmse_reference * d.summary.position_rmse_reference;
   }},
  {"velocity_rmse_reference", "m/s", "root mean square of the velocity error against the DGPS",
   [](const MeasuredDrive& d) { return d.summary.velocity_rmse_reference; }},
  {"nees", "", "normalised estimation error squared of (x, y, vx, vy): 4 if the filter judges its own error rightly",
   [](const MeasuredDrive& d) { return d.summary.nees; }},
  {"missed", "", "share of true objects without an image's object",
   [](const MeasuredDrive& d) { return measure::share(d.summary.missed, d.summary.missed + d.summary.matched); }},
  {"spurious", "", "share of an image's objects without a true object",
   [](const MeasuredDrive& d) { return measure::share(d.summary.spurious, d.summary.spurious + d.summary.matched); }},
  {"age_fused", "ms", "mean age of a measurement when it is fused",
   [](const MeasuredDrive& d) { return measure::milliseconds(d.summary.age_fused); }},
  {"age_used_newest", "ms", "median age of the newest measurement in an image when the image is used",
   [](const MeasuredDrive& d) { return measure::milliseconds(d.summary.age_used_newest, 500); }},
  {"age_used_newest_p99", "ms", "99th percentile of the age of the newest measurement in an image when the image is used",
   [](const MeasuredDrive& d) { return measure::milliseconds(d.summary.age_used_newest, 990); }},
  {"age_used_oldest", "ms", "median age of the oldest of the sensors' newest measurements",
   [](const MeasuredDrive& d) { return measure::milliseconds(d.summary.age_used_oldest, 500); }},
  {"lists_fused", "", "observation lists that were fused in the whole drive",
   [](const MeasuredDrive& d) { return static_cast<double>(d.summary.fused + d.summary.fused_late); }},
  {"out_of_sequence", "", "share of lists that came after a newer one",
   [](const MeasuredDrive& d) { return measure::share(d.summary.out_of_sequence, d.summary.received); }},
  {"precision", "us", "largest difference of the clocks",
   [](const MeasuredDrive& d) { return static_cast<double>(d.outcome.precision.ns) * 1e-3; }},
  {"flexray_load", "", "share of the time in which the busier FlexRay channel is taken",
   [](const MeasuredDrive& d) { return d.outcome.flexray_load; }},
  {"position_mse_reference_corrected", "m^2",
   "mean square of the position error against the DGPS, minus the expected part of the DGPS' own error",
   [](const MeasuredDrive& d) { return d.summary.position_mse_reference_corrected; }},
  {"position_mse_expected", "m^2",
   "expected position_mse_truth by covariances alone: one object, straight ahead, no bias",
   [](const MeasuredDrive& d) { return d.summary.position_mse_expected; }},
  {"face_mse_expected", "m^2",
   "expected face_mse_truth by covariances alone: one object, straight ahead, no bias",
   [](const MeasuredDrive& d) { return d.summary.face_mse_expected; }},
  {"face_rmse", "m", "root mean square of the distance between the middle of the true visible face and that of the image",
   [](const MeasuredDrive& d) { return d.summary.box.face_m; }},
  {"face_mse_truth", "m^2",
   "mean square of the distance between the middles of the visible face, unbiased when averaged over drives",
   [](const MeasuredDrive& d) { return d.summary.box.face_m * d.summary.box.face_m; }},
  {"gap_rmse", "m", "root mean square of the error of the gap: the range to the object along the line of sight",
   [](const MeasuredDrive& d) { return d.summary.box.gap_m; }},
  {"heading_rmse", "rad", "root mean square of the error of the heading",
   [](const MeasuredDrive& d) { return d.summary.box.heading_rad; }},
  {"speed_rmse", "m/s", "root mean square of the error of the speed",
   [](const MeasuredDrive& d) { return d.summary.box.speed_mps; }},
  {"acceleration_rmse", "m/s^2", "root mean square of the error of the acceleration along the heading",
   [](const MeasuredDrive& d) { return d.summary.box.acceleration_mps2; }},
  {"length_rmse", "m", "root mean square of the error of the length",
   [](const MeasuredDrive& d) { return d.summary.box.length_m; }},
  {"width_rmse", "m", "root mean square of the error of the width",
   [](const MeasuredDrive& d) { return d.summary.box.width_m; }},
  {"gospa", "m", "GOSPA of image and truth, as the p-th root of the mean p-th power over the uses of images",
   [](const MeasuredDrive& d) { return d.summary.tracking.gospa.distance_m; }},
  {"gospa_localisation", "m^p", "part of GOSPA to the power p from the errors of pairs",
   [](const MeasuredDrive& d) { return d.summary.tracking.gospa.localisation; }},
  {"gospa_missed", "m^p", "part of GOSPA to the power p from missed objects",
   [](const MeasuredDrive& d) { return d.summary.tracking.gospa.missed; }},
  {"gospa_false", "m^p", "part of GOSPA to the power p from false objects of the image",
   [](const MeasuredDrive& d) { return d.summary.tracking.gospa.false_estimates; }},
  {"ospa", "m", "OSPA of image and truth, as the p-th root of the mean p-th power over the uses of images",
   [](const MeasuredDrive& d) { return d.summary.tracking.ospa.distance_m; }},
  {"ospa_localisation", "m^p", "part of OSPA to the power p from errors up to the cut-off",
   [](const MeasuredDrive& d) { return d.summary.tracking.ospa.localisation; }},
  {"ospa_cardinality", "m^p", "part of OSPA to the power p from a wrong number of objects",
   [](const MeasuredDrive& d) { return d.summary.tracking.ospa.cardinality; }},
  {"mota", "", "CLEAR-MOT accuracy: 1 minus misses, false objects and switches per true object",
   [](const MeasuredDrive& d) { return d.summary.tracking.mot.mota(); }},
  {"motp", "m", "CLEAR-MOT precision: mean distance of the matches",
   [](const MeasuredDrive& d) { return d.summary.tracking.mot.motp_m(); }},
  {"switches", "", "matches of an object with another track than before, in the whole drive",
   [](const MeasuredDrive& d) { return measure::number(d.summary.tracking.mot.switches, d.summary.tracking); }},
  {"fraction_tracked", "", "share of its life for which an object is tracked, mean over the objects",
   [](const MeasuredDrive& d) { return d.summary.tracking.lives.mean_fraction_tracked; }},
  {"mostly_tracked", "", "share of objects that are tracked for 80 % of their life or more",
   [](const MeasuredDrive& d) { return measure::share(d.summary.tracking.lives.mostly_tracked, d.summary.tracking.lives.objects); }},
  {"mostly_lost", "", "share of objects that are tracked for less than 20 % of their life",
   [](const MeasuredDrive& d) { return measure::share(d.summary.tracking.lives.mostly_lost, d.summary.tracking.lives.objects); }},
  {"fragmentations", "", "times that an object was tracked again after a loss, in the whole drive",
   [](const MeasuredDrive& d) { return measure::number(d.summary.tracking.lives.fragmentations, d.summary.tracking); }},
  {"confirmed_after", "ms", "mean time from the first judged instant of an object to its first match",
   [](const MeasuredDrive& d) { return 1e3 * d.summary.tracking.lives.mean_confirmed_after_s; }},
  {"nees_position", "", "normalised estimation error squared of the position over its 2 degrees of freedom: 1 if rightly judged",
   [](const MeasuredDrive& d) { return d.summary.own.position; }},
  {"nees_velocity", "", "the same of the velocity",
   [](const MeasuredDrive& d) { return d.summary.own.velocity; }},
  {"nees_heading", "", "normalised estimation error squared of the heading: 1 if rightly judged",
   [](const MeasuredDrive& d) { return d.summary.own.heading; }},
  {"nees_speed", "", "the same of the speed",
   [](const MeasuredDrive& d) { return d.summary.own.speed; }},
  {"nees_acceleration", "", "the same of the acceleration along the heading, of models that have one",
   [](const MeasuredDrive& d) { return d.summary.own.acceleration; }},
  {"nees_length", "", "the same of the length",
   [](const MeasuredDrive& d) { return d.summary.own.length; }},
  {"nees_width", "", "the same of the width",
   [](const MeasuredDrive& d) { return d.summary.own.width; }},
  {"nis", "", "normalised innovation squared of confirmed tracks, over its degrees of freedom: 1 if the filter judges its predictions rightly",
   [](const MeasuredDrive& d) { return d.summary.own.innovations; }},
  {"stopping_distance", "m",
   "way from the instant at which the object ahead brakes until the vehicle stands; absent in a drive in which it does not",
   [](const MeasuredDrive& d) { return measure::driven(d, [](const auto& f) { return f.stopping_distance_m.value_or(measure::kNone); }); }},
  {"smallest_gap", "m", "smallest true gap to the object ahead; 0 in a collision",
   [](const MeasuredDrive& d) { return measure::driven(d, [](const auto& f) { return f.smallest_gap_m; }); }},
  {"smallest_ttc", "s", "smallest true time to collision, for constant speeds",
   [](const MeasuredDrive& d) { return measure::driven(d, [](const auto& f) { return f.smallest_ttc_s; }); }},
  {"gap_error_rms", "m", "root mean square of the true gap's error against standstill and time gap of adaptive cruise control",
   [](const MeasuredDrive& d) { return measure::driven(d, [](const auto& f) { return f.gap_error_rms_m; }); }},
  {"largest_deceleration", "m/s^2", "largest deceleration of the vehicle",
   [](const MeasuredDrive& d) { return measure::driven(d, [](const auto& f) { return f.largest_deceleration; }); }},
  {"jerk_rms", "m/s^3", "root mean square of the vehicle's jerk over 40 ms or more, while it moves",
   [](const MeasuredDrive& d) { return measure::driven(d, [](const auto& f) { return f.jerk_rms; }); }},
  {"largest_jerk", "m/s^3", "largest jerk of the vehicle over 40 ms or more, while it moves",
   [](const MeasuredDrive& d) { return measure::driven(d, [](const auto& f) { return f.largest_jerk; }); }},
  {"below_r157", "", "share of the time behind an object in which the true gap is below UN R157's minimum following distance",
   [](const MeasuredDrive& d) { return measure::driven(d, [](const auto& f) { return f.below_minimum; }); }},
  {"collision", "", "share of drives with a collision",
   [](const MeasuredDrive& d) { return measure::driven(d, [](const auto& f) { return f.collision ? 1.0 : 0.0; }); }, true},
  {"collision_speed", "m/s", "closing speed at the first collision; absent in a drive without one",
   [](const MeasuredDrive& d) { return measure::driven(d, [](const auto& f) { return f.collision ? f.collision->closing_mps : measure::kNone; }); }},
  {"warnings_wrong", "", "forward collision warnings without a true hazard, in a drive",
   [](const MeasuredDrive& d) { return measure::warnings(d, recording::records::kForwardCollision, &evaluation::driving::WarningFindings::wrong); }},
  {"warnings_missed", "", "hazards without a forward collision warning, in a drive",
   [](const MeasuredDrive& d) { return measure::warnings(d, recording::records::kForwardCollision, &evaluation::driving::WarningFindings::missed); }},
  {"warnings_late", "", "hazards whose forward collision warning began after them, in a drive",
   [](const MeasuredDrive& d) { return measure::warnings(d, recording::records::kForwardCollision, &evaluation::driving::WarningFindings::late); }},
  {"brakings_wrong", "", "emergency brakings without a true hazard, in a drive",
   [](const MeasuredDrive& d) { return measure::warnings(d, recording::records::kEmergencyBraking, &evaluation::driving::WarningFindings::wrong); }},
  {"brakings_missed", "", "hazards without emergency braking, in a drive",
   [](const MeasuredDrive& d) { return measure::warnings(d, recording::records::kEmergencyBraking, &evaluation::driving::WarningFindings::missed); }},
  {"brakings_late", "", "hazards whose emergency braking began after them, in a drive",
   [](const MeasuredDrive& d) { return measure::warnings(d, recording::records::kEmergencyBraking, &evaluation::driving::WarningFindings::late); }},
  {"reaction_time", "s",
   "time from the instant at which the object ahead truly falls below `judgement.reaction_speed` until an image says so",
   [](const MeasuredDrive& d) { return measure::driven(d, [](const auto& f) { return f.reaction ? f.reaction->seconds() : measure::kNone; }); }},
  {"detection_frame", "s", "mean length of the frames of a detector that several cameras share",
   [](const MeasuredDrive& d) { return measure::detected(d, [](const auto& f) { return f.frames.mean(); }); }},
  {"detection_interval", "s", "mean time between two detections of the camera that such a detector looks at most",
   [](const MeasuredDrive& d) { return measure::detected(d, [](const auto& f) { return f.intervals.mean(); }); }},
  {"detection_interval_sigma", "s", "standard deviation of these times in a drive",
   [](const MeasuredDrive& d) { return measure::detected(d, [](const auto& f) { return f.intervals.deviation(); }); }},
  {"lane_offset_rms", "m", "root mean square of the true offset from the middle of the lane that a service keeps",
   [](const MeasuredDrive& d) { return measure::in_lane(d, [](const auto& l) { return l.offset_rms_m; }); }},
  {"lane_offset_largest", "m", "largest true offset from the lane's middle",
   [](const MeasuredDrive& d) { return measure::in_lane(d, [](const auto& l) { return l.largest_offset_m; }); }},
  {"lane_heading_rms", "rad", "root mean square of the true heading from the lane's direction",
   [](const MeasuredDrive& d) { return measure::in_lane(d, [](const auto& l) { return l.heading_rms_rad; }); }},
  {"lane_heading_largest", "rad", "largest true heading from the lane's direction",
   [](const MeasuredDrive& d) { return measure::in_lane(d, [](const auto& l) { return l.largest_heading_rad; }); }},
  {"beyond_mark", "", "share of the time in which a side of the vehicle is beyond its mark",
   [](const MeasuredDrive& d) { return measure::in_lane(d, [](const auto& l) { return l.outside; }); }},
  {"departures", "", "times of 100 ms or longer in which a side is beyond its mark, in a drive",
   [](const MeasuredDrive& d) { return measure::departure(d, [](const auto& w) { return static_cast<double>(w.hazards); }); }},
  {"departure_warnings_right", "", "lane departure warnings within 300 ms of a departure, in a drive",
   [](const MeasuredDrive& d) { return measure::departure(d, [](const auto& w) { return static_cast<double>(w.right); }); }},
  {"departure_warnings_wrong", "", "all other lane departure warnings, in a drive",
   [](const MeasuredDrive& d) { return measure::departure(d, [](const auto& w) { return static_cast<double>(w.wrong); }); }},
  {"departure_warnings_missed", "", "departures without a warning, in a drive",
   [](const MeasuredDrive& d) { return measure::departure(d, [](const auto& w) { return static_cast<double>(w.missed); }); }},
  {"departure_warnings_late", "", "departures whose warning began after them, in a drive",
   [](const MeasuredDrive& d) { return measure::departure(d, [](const auto& w) { return static_cast<double>(w.late); }); }},
  {"departure_lateness", "ms", "mean delay of the late lane departure warnings; absent in a drive without one",
   [](const MeasuredDrive& d) { return measure::departure(d, &measure::lateness_ms); }},
  {"blind_spot_hazards", "", "times of 100 ms or longer in which an object is in the blind spot of a side, in a drive",
   [](const MeasuredDrive& d) { return measure::blind_spot(d, [](const auto& w) { return static_cast<double>(w.hazards); }); }},
  {"blind_spot_warnings_right", "", "blind spot warnings within 300 ms of a hazard of their side, in a drive",
   [](const MeasuredDrive& d) { return measure::blind_spot(d, [](const auto& w) { return static_cast<double>(w.right); }); }},
  {"blind_spot_warnings_wrong", "", "all other blind spot warnings, in a drive",
   [](const MeasuredDrive& d) { return measure::blind_spot(d, [](const auto& w) { return static_cast<double>(w.wrong); }); }},
  {"blind_spot_warnings_missed", "", "hazards without a blind spot warning, in a drive",
   [](const MeasuredDrive& d) { return measure::blind_spot(d, [](const auto& w) { return static_cast<double>(w.missed); }); }},
  {"blind_spot_warnings_late", "", "hazards whose blind spot warning began after them, in a drive",
   [](const MeasuredDrive& d) { return measure::blind_spot(d, [](const auto& w) { return static_cast<double>(w.late); }); }},
  {"blind_spot_lateness", "ms", "mean delay of the late blind spot warnings; absent in a drive without one",
   [](const MeasuredDrive& d) { return measure::blind_spot(d, &measure::lateness_ms); }},
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
