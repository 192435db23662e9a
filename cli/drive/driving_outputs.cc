#include "cli/drive/driving_outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/sweep/driving.h"
#include "report/drawing/tables.h"

namespace ttf::cli::drive {
namespace {

using evaluation::driving::DrivingFindings;
using evaluation::driving::WarningFindings;
using recording::records::kEmergencyBraking;
using recording::records::kForwardCollision;
using report::drawing::cell;

std::string finite_cell(double value, int digits) { return std::isfinite(value) ? cell(value, digits) : "-"; }

std::string warnings_cell(const WarningFindings& w) {
  return fmt::format("{} / {} / {} / {}", w.right, w.wrong, w.missed, w.late);
}
std::string lateness_of_warnings(const WarningFindings& w) {
  if (w.late == 0) return "-";
  return fmt::format("{} / {}", cell(in_ms(w.lateness_sum) / static_cast<double>(w.late), 0), cell(in_ms(w.latest), 0));
}

std::string degrees_cell(double rad) { return cell(rad * 180.0 / std::numbers::pi, 2); }
WarningFindings beside(const DrivingFindings& f) {
  return evaluation::driving::together(f.warnings[recording::records::kBlindSpotLeft],
                                       f.warnings[recording::records::kBlindSpotRight]);
}

std::string spread_cell(const evaluation::driving::Spread& spread) {
  return fmt::format("{} / {}", finite_cell(1e3 * spread.mean(), 0), finite_cell(1e3 * spread.deviation(), 0));
}

struct DrivingRow {
  const char* name;
  std::string (*value)(const DrivingFindings&);
  // Only some drives have the row.
  bool (*has)(const DrivingFindings&) = [](const DrivingFindings&) { return true; };
};
bool keeps_lane(const DrivingFindings& f) { return f.lane.has_value(); }
bool warns_ahead(const DrivingFindings& f) { return f.warns_ahead; }
bool watches(const DrivingFindings& f) { return f.watches_blind_spot; }
bool has_detections(const DrivingFindings& f) { return f.detections.has_value(); }
const DrivingRow kDrivingRows[] = {
    {"smallest gap [m]", [](const DrivingFindings& f) { return finite_cell(f.smallest_gap_m, 2); }},
    {"smallest time to collision [s]", [](const DrivingFindings& f) { return finite_cell(f.smallest_ttc_s, 2); }},
    {"collision at [s], with [m/s]",
     [](const DrivingFindings& f) {
       if (!f.collision) return std::string("none");
       return fmt::format("{} {}", cell(1e-9 * static_cast<double>(f.collision->at.ns), 2),
                          cell(f.collision->closing_mps, 1));
     }},
    {"stopping distance [m]",
     [](const DrivingFindings& f) {
       return f.stopping_distance_m ? cell(*f.stopping_distance_m, 2) : std::string("-");
     }},
    {"reaction time [s]",
     [](const DrivingFindings& f) { return f.reaction ? cell(f.reaction->seconds(), 2) : std::string("-"); },
     [](const DrivingFindings& f) { return f.reaction.has_value(); }},
    {"detections of whole pictures / of regions",
     [](const DrivingFindings& f) {
       return f.detections ? fmt::format("{} / {}", f.detections->primary, f.detections->secondary) : std::string("-");
     },
     has_detections},
    {"  frame, mean / deviation [ms]",
     [](const DrivingFindings& f) { return f.detections ? spread_cell(f.detections->frames) : std::string("-"); },
     has_detections},
    {"  interval of the camera looked at most, mean / deviation [ms]",
     [](const DrivingFindings& f) { return f.detections ? spread_cell(f.detections->intervals) : std::string("-"); },
     has_detections},
    {"error of the gap, RMS [m]", [](const DrivingFindings& f) { return finite_cell(f.gap_error_rms_m, 2); }},
    {"below R157's distance [% of time]",
     [](const DrivingFindings& f) { return finite_cell(100 * f.below_minimum, 1); }},
    {"largest deceleration [m/s^2]", [](const DrivingFindings& f) { return cell(f.largest_deceleration, 2); }},
    {"jerk, RMS / largest [m/s^3]",
     [](const DrivingFindings& f) { return fmt::format("{} / {}", cell(f.jerk_rms, 2), cell(f.largest_jerk, 1)); }},
    {"collision warnings right / wrong / missed / late",
     [](const DrivingFindings& f) { return warnings_cell(f.warnings[kForwardCollision]); }, warns_ahead},
    {"  late by, mean / most [ms]",
     [](const DrivingFindings& f) { return lateness_of_warnings(f.warnings[kForwardCollision]); }, warns_ahead},
    {"emergency brakings right / wrong / missed / late",
     [](const DrivingFindings& f) { return warnings_cell(f.warnings[kEmergencyBraking]); }, warns_ahead},
    {"  late by, mean / most [ms]",
     [](const DrivingFindings& f) { return lateness_of_warnings(f.warnings[kEmergencyBraking]); }, warns_ahead},
    {"offset from the lane's middle, RMS / largest [m]",
     [](const DrivingFindings& f) {
       return fmt::format("{} / {}", cell(f.lane->offset_rms_m, 3), cell(f.lane->largest_offset_m, 3));
     },
     keeps_lane},
    {"heading from the lane's, RMS / largest [deg]",
     [](const DrivingFindings& f) {
       return fmt::format("{} / {}", degrees_cell(f.lane->heading_rms_rad), degrees_cell(f.lane->largest_heading_rad));
     },
     keeps_lane},
    {"beyond a mark [% of time]", [](const DrivingFindings& f) { return cell(100 * f.lane->outside, 1); }, keeps_lane},
    {"lane departure warnings right / wrong / missed / late",
     [](const DrivingFindings& f) { return warnings_cell(f.warnings[recording::records::kLaneDeparture]); },
     keeps_lane},
    {"  late by, mean / most [ms]",
     [](const DrivingFindings& f) { return lateness_of_warnings(f.warnings[recording::records::kLaneDeparture]); },
     keeps_lane},
    {"blind spot warnings right / wrong / missed / late",
     [](const DrivingFindings& f) { return warnings_cell(beside(f)); }, watches},
    {"  late by, mean / most [ms]", [](const DrivingFindings& f) { return lateness_of_warnings(beside(f)); }, watches},
    {"readings of commands: applied / none / refused",
     [](const DrivingFindings& f) { return fmt::format("{} / {} / {}", f.applied, f.none_new, f.invalid + f.late); }},
};

nlohmann::ordered_json warnings_json(const WarningFindings& w) {
  nlohmann::ordered_json json{{"hazards", w.hazards}, {"given", w.given},   {"right", w.right},
                              {"wrong", w.wrong},     {"missed", w.missed}, {"late", w.late}};
  json["late_mean_ms"] = nullptr;
  json["late_most_ms"] = nullptr;
  if (w.late > 0) {
    json["late_mean_ms"] = in_ms(w.lateness_sum) / static_cast<double>(w.late);
    json["late_most_ms"] = in_ms(w.latest);
  }
  return json;
}

}  // namespace

report::plots::DrivingOptions driving_options(const sim::drives::Scenario& scenario,
                                              const schedules::model::Cluster& cluster, const std::string& title) {
  report::plots::DrivingOptions options{title, sim::drives::evaluation_start(scenario),
                                        sim::drives::drive_end(scenario), scenario.world.ego->front,
                                        scenario.world.ego->width};
  if (const auto lane = experiments::sweep::lane_kept(scenario, cluster))
    options.lane = [lane = evaluation::driving::TrueLane(*lane)](const recording::records::EgoTruth& ego) {
      const evaluation::driving::InLane place = lane.place_of(ego);
      return report::plots::PlaceInLane{place.offset, place.heading};
    };
  return options;
}

std::vector<std::vector<std::string>> driving_rows(const std::vector<const StrategyResult*>& results) {
  std::vector<std::vector<std::string>> rows;
  if (std::ranges::none_of(results, [](const StrategyResult* one) { return one->driving.has_value(); })) return rows;
  for (const DrivingRow& row : kDrivingRows) {
    const auto has = [&](const StrategyResult* one) { return one->driving && row.has(*one->driving); };
    if (std::ranges::none_of(results, has)) continue;
    rows.push_back({row.name});
    for (const StrategyResult* one : results) rows.back().push_back(has(one) ? row.value(*one->driving) : "-");
  }
  return rows;
}

nlohmann::ordered_json driving_json(const DrivingFindings& f) {
  nlohmann::ordered_json json{{"smallest_gap_m", f.smallest_gap_m},
                              {"smallest_time_to_collision_s", f.smallest_ttc_s},
                              {"collision", nullptr},
                              {"stopping_distance_m", nullptr},
                              {"reaction_s", nullptr},
                              {"detections", nullptr},
                              {"gap_error_rms_m", f.gap_error_rms_m},
                              {"below_r157_distance", f.below_minimum},
                              {"largest_deceleration_mps2", f.largest_deceleration},
                              {"jerk_rms_mps3", f.jerk_rms},
                              {"largest_jerk_mps3", f.largest_jerk},
                              {"commands_issued", f.issued},
                              {"readings",
                               {{"applied", f.applied},
                                {"none_new", f.none_new},
                                {"invalid", f.invalid},
                                {"late", f.late},
                                {"nothing_asked", f.nothing_asked},
                                {"weaker", f.weaker}}}};
  if (f.collision)
    json["collision"] = {{"at_s", 1e-9 * static_cast<double>(f.collision->at.ns)},
                         {"closing_mps", f.collision->closing_mps}};
  if (f.stopping_distance_m) json["stopping_distance_m"] = *f.stopping_distance_m;
  if (f.lane) {
    json["lane"] = {{"offset_rms_m", f.lane->offset_rms_m},
                    {"largest_offset_m", f.lane->largest_offset_m},
                    {"heading_rms_rad", f.lane->heading_rms_rad},
                    {"largest_heading_rad", f.lane->largest_heading_rad},
                    {"beyond_a_mark", f.lane->outside}};
    json["lane_departure_warnings"] = warnings_json(f.warnings[recording::records::kLaneDeparture]);
  }
  if (f.warns_ahead) {
    json["collision_warnings"] = warnings_json(f.warnings[kForwardCollision]);
    json["emergency_brakings"] = warnings_json(f.warnings[kEmergencyBraking]);
  }
  if (f.watches_blind_spot) json["blind_spot_warnings"] = warnings_json(beside(f));
  if (f.reaction) json["reaction_s"] = f.reaction->seconds();
  if (f.detections)
    json["detections"] = {{"primary", f.detections->primary},
                          {"secondary", f.detections->secondary},
                          {"frame_s", f.detections->frames.mean()},
                          {"frame_sigma_s", f.detections->frames.deviation()},
                          {"interval_s", f.detections->intervals.mean()},
                          {"interval_sigma_s", f.detections->intervals.deviation()}};
  return json;
}

}  // namespace ttf::cli::drive
