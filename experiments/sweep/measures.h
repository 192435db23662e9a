// The measures of a drive, by name: a number each, or not a number if the drive has none.
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

}  // namespace measure

// clang-format off
inline constexpr std::array<Measure, 19> kMeasures{{
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
}};
// clang-format on

constexpr const Measure* find_measure(std::string_view name) {
  for (const Measure& measure : kMeasures)
    if (measure.name == name) return &measure;
  return nullptr;
}

}  // namespace ttf::experiments::sweep
