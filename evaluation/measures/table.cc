#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <vector>

#include "core/check.h"
#include "evaluation/measures/figures.h"
#include "evaluation/measures/measure.h"

namespace ttf::evaluation::measures {
namespace {

using F = const DriveFigures&;
using driving::WarningFindings;
using recording::records::WarningKind;

constexpr Scale kPercent{100.0, "%"}, kPercentOfTime{100.0, "% of time"}, kMilliseconds{1e3, "ms"},
    kDegrees{180.0 / std::numbers::pi, "deg"};
constexpr ShownIn kTable = ShownIn::kTable, kPage = ShownIn::kPage;

constexpr std::string_view kBetter = "can look better", kSame = "the same", kWorse = "worse",
                           kSameOrWorse = "the same or worse", kBrakesLater = "worse, if the vehicle brakes later",
                           kWholeHazard = "worse, if the image misses it for the whole hazard";

constexpr Shown show(std::string_view label, int decimals = 0) { return {label, decimals}; }

double mean_ms(Duration sum, std::uint64_t count) {
  return count == 0 ? Getter::kNone : static_cast<double>(sum.ns) / static_cast<double>(count) * 1e-6;
}
double mean_ms(const accuracy::AgeStatistics& age) { return mean_ms(age.sum, age.count); }
double worst_ms(const accuracy::AgeStatistics& age) { return age.count == 0 ? Getter::kNone : in_ms(age.worst); }
double quantile_ms(const recording::records::BinnedDurations& durations, int permille) {
  return durations.longest() == Duration{} ? Getter::kNone : in_ms(durations.quantile(permille));
}
double share(std::uint64_t part, std::uint64_t of) {
  return of == 0 ? Getter::kNone : static_cast<double>(part) / static_cast<double>(of);
}
// A count of a drive that was not judged is none.
std::optional<std::uint64_t> judged(F f, std::uint64_t count) {
  return f.summary.tracking.instants == 0 ? std::nullopt : std::optional(count);
}
// Lists that were made and never fused: too late for the strategy, or lost between tasks.
std::uint64_t lost_lists(F f) {
  const nodes::host::ExecutiveCounts& counts = f.outcome.counts;
  return f.summary.dropped + counts.torn_lists + counts.overwritten_lists + counts.discarded_lists;
}
// A single clock, or clocks that never ran together, have no precision instead of a perfect one.
double precision_us(F f) { return f.outcome.precision == Duration{} ? Getter::kNone : in_us(f.outcome.precision); }

const WarningFindings& ahead(F f) { return f.driving->warnings[index_of(WarningKind::kForwardCollision)]; }
const WarningFindings& braking(F f) { return f.driving->warnings[index_of(WarningKind::kEmergencyBraking)]; }
const WarningFindings& departure(F f) { return f.driving->warnings[index_of(WarningKind::kLaneDeparture)]; }
WarningFindings beside(F f) {  // both sides together
  return driving::together(f.driving->warnings[index_of(WarningKind::kBlindSpotLeft)],
                           f.driving->warnings[index_of(WarningKind::kBlindSpotRight)]);
}
double late_ms(const WarningFindings& warnings) { return mean_ms(warnings.lateness_sum, warnings.late); }
double latest_ms(const WarningFindings& warnings) {
  return warnings.late == 0 ? Getter::kNone : in_ms(warnings.latest);
}

// clang-format off
constexpr Measure kErrors[] = {
  {"position_rmse_truth", "/rmse_truth/position_m", "m", [](F f) { return f.summary.position_rmse_truth; },
   "root mean square of the position error against the truth, when the image is used", kBetter,
   show("position RMSE against truth", 3).repeated()},
  {"position_mse_truth", "", "m^2", [](F f) { return f.summary.position_rmse_truth * f.summary.position_rmse_truth; },
   "mean square of the position error against the truth, unbiased when averaged over drives", kBetter},
  {"velocity_rmse_truth", "/rmse_truth/velocity_mps", "m/s", [](F f) { return f.summary.velocity_rmse_truth; },
   "root mean square of the velocity error against the truth", kBetter,
   show("velocity RMSE against truth", 3).repeated()},
  {"", "/rmse_truth/x", "m", [](F f) { return f.summary.rmse_truth[0]; },
   "root mean square of the error of the position along x against the truth", "",
   show("  x", 2).only(kTable).begins("  x, y, vx, vy")},
  {"", "/rmse_truth/y", "m", [](F f) { return f.summary.rmse_truth[1]; },
   "root mean square of the error of the position along y against the truth", "",
   show("  y", 2).only(kTable).joins(" ")},
  {"", "/rmse_truth/vx", "m/s", [](F f) { return f.summary.rmse_truth[2]; },
   "root mean square of the error of the velocity along x against the truth", "",
   show("  vx", 2).only(kTable).joins(" ")},
  {"", "/rmse_truth/vy", "m/s", [](F f) { return f.summary.rmse_truth[3]; },
   "root mean square of the error of the velocity along y against the truth", "",
   show("  vy", 2).only(kTable).joins(" ")},
  {"face_rmse", "/rmse_box/face_m", "m", [](F f) { return f.summary.box.face_m; },
   "root mean square of the distance between the middle of the true visible face and that of the image", kBetter,
   show("  visible face", 3).repeated().begins("  visible face, gap to it [m]")},
  {"face_mse_truth", "", "m^2", [](F f) { return f.summary.box.face_m * f.summary.box.face_m; },
   "mean square of the distance between the middles of the visible face, unbiased when averaged over drives", kBetter},
  {"gap_rmse", "/rmse_box/gap_m", "m", [](F f) { return f.summary.box.gap_m; },
   "root mean square of the error of the gap: the range to the object along the line of sight", kBetter,
   show("  gap to it", 3).joins(" ")},
  {"heading_rmse", "/rmse_box/heading_rad", "rad", [](F f) { return f.summary.box.heading_rad; },
   "root mean square of the error of the heading", kBetter,
   show("  heading", 3).begins("  heading [rad], speed [m/s]")},
  {"speed_rmse", "/rmse_box/speed_mps", "m/s", [](F f) { return f.summary.box.speed_mps; },
   "root mean square of the error of the speed", kBetter, show("  speed", 3).joins(" ")},
  {"acceleration_rmse", "/rmse_box/acceleration_mps2", "m/s^2", [](F f) { return f.summary.box.acceleration_mps2; },
   "root mean square of the error of the acceleration along the heading", kBetter, show("  acceleration", 3)},
  {"length_rmse", "/rmse_box/length_m", "m", [](F f) { return f.summary.box.length_m; },
   "root mean square of the error of the length", kBetter, show("  length", 3).begins("  length, width [m]")},
  {"width_rmse", "/rmse_box/width_m", "m", [](F f) { return f.summary.box.width_m; },
   "root mean square of the error of the width", kBetter, show("  width", 3).joins(" ")},
  {"position_mse_expected", "", "m^2", [](F f) { return f.summary.position_mse_expected; },
   "expected position_mse_truth by covariances alone: one object, straight ahead, no bias", kSame},
  {"face_mse_expected", "", "m^2", [](F f) { return f.summary.face_mse_expected; },
   "expected face_mse_truth by covariances alone: one object, straight ahead, no bias", kSame},
  {"position_rmse_reference", "/rmse_reference/position_m", "m", [](F f) { return f.summary.position_rmse_reference; },
   "root mean square of the position error against the DGPS", kBetter,
   show("position RMSE against DGPS", 3).repeated()},
  {"position_mse_reference", "", "m^2",
   [](F f) { return f.summary.position_rmse_reference * f.summary.position_rmse_reference; },
   "mean square of the position error against the DGPS", kBetter},
  {"position_mse_reference_corrected", "", "m^2", [](F f) { return f.summary.position_mse_reference_corrected; },
   "mean square of the position error against the DGPS, minus the expected part of the DGPS' own error", kBetter},
  {"velocity_rmse_reference", "/rmse_reference/velocity_mps", "m/s",
   [](F f) { return f.summary.velocity_rmse_reference; }, "root mean square of the velocity error against the DGPS",
   kBetter, show("velocity RMSE against DGPS", 3).repeated()},
  {"", "/rmse_reference/compared", "", [](F f) { return f.summary.reference_compared; },
   "objects that were compared with the DGPS", ""},
  {"nees", "/nees/mean", "", [](F f) { return f.summary.nees; },
   "normalised estimation error squared of (x, y, vx, vy): 4 if the filter judges its own error rightly", kBetter,
   show("NEES (4 degrees of freedom)", 2).repeated()},
  {"", "/nees/samples", "", [](F f) { return f.summary.nees_samples; },
   "errors in the mean of the normalised estimation error squared", ""},
  {"", "/nees/degrees_of_freedom", "", [](F) { return 4; },
   "of the normalised estimation error squared: x, y, vx, vy", ""},
  {"", "/nees/band_95/0", "", [](F f) { return f.summary.nees_low; },
   "lower end of the band that holds the mean with 95 %, if the filter judges its own error rightly", "",
   show("  95 % band from", 2).begins("  95 % band")},
  {"", "/nees/band_95/1", "", [](F f) { return f.summary.nees_high; }, "its upper end", "",
   show("  to", 2).joins("..")},
  {"nees_position", "/nees/per_degree/position", "", [](F f) { return f.summary.own.position; },
   "normalised estimation error squared of the position over its 2 degrees of freedom: 1 if rightly judged", kBetter,
   show("  of the position, over its degrees", 2).only(kPage)},
  {"nees_velocity", "/nees/per_degree/velocity", "", [](F f) { return f.summary.own.velocity; },
   "the same of the velocity", kBetter, show("  of the velocity", 2).only(kPage)},
  {"nees_heading", "/nees/per_degree/heading", "", [](F f) { return f.summary.own.heading; },
   "normalised estimation error squared of the heading: 1 if rightly judged", kBetter,
   show("  of the heading", 2).begins("  of heading, speed, acceleration")},
  {"nees_speed", "/nees/per_degree/speed", "", [](F f) { return f.summary.own.speed; }, "the same of the speed",
   kBetter, show("  of the speed", 2).joins(" ")},
  {"nees_acceleration", "/nees/per_degree/acceleration", "", [](F f) { return f.summary.own.acceleration; },
   "the same of the acceleration along the heading, of models that have one", kBetter,
   show("  of the acceleration", 2).joins(" ")},
  {"nees_length", "/nees/per_degree/length", "", [](F f) { return f.summary.own.length; }, "the same of the length",
   kBetter, show("  of the length", 2).begins("  of length, width")},
  {"nees_width", "/nees/per_degree/width", "", [](F f) { return f.summary.own.width; }, "the same of the width",
   kBetter, show("  of the width", 2).joins(" ")},
  {"nis", "/nis/per_degree", "", [](F f) { return f.summary.own.innovations; },
   "normalised innovation squared of confirmed tracks, over its degrees of freedom: 1 if the filter judges its predictions rightly",
   kBetter, show("NIS per degree of freedom", 2).repeated()},
  {"", "/nis/degrees_of_freedom", "", [](F f) { return f.summary.own.innovation_degrees; },
   "of all innovations together", ""},
};

constexpr Measure kLists[] = {
  {"", "/age_when_fused/count", "", [](F f) { return f.summary.age_fused.count; }, "measurements or lists of this age",
   ""},
  {"age_fused", "/age_when_fused/mean_ms", "ms", [](F f) { return mean_ms(f.summary.age_fused); },
   "mean age of a measurement when it is fused", kSame, show("age when fused, mean", 1).repeated()},
  {"", "/age_when_fused/worst_ms", "ms", [](F f) { return worst_ms(f.summary.age_fused); },
   "largest age of a measurement when it is fused", "", show("age when fused, worst", 1)},
  {"", "/age_when_used/count", "", [](F f) { return f.summary.age_used.count; }, "measurements or lists of this age",
   ""},
  {"", "/age_when_used/mean_ms", "ms", [](F f) { return mean_ms(f.summary.age_used); },
   "mean age of each sensor's newest measurement when an image is used", "", show("age when used, mean", 1).repeated()},
  {"", "/age_when_used/worst_ms", "ms", [](F f) { return worst_ms(f.summary.age_used); },
   "largest age of each sensor's newest measurement when an image is used", "", show("age when used, worst", 1)},
  {"age_used_newest", "", "ms", [](F f) { return quantile_ms(f.summary.age_used_newest, 500); },
   "median age of the newest measurement in an image when the image is used", kSame},
  {"age_used_newest_p99", "", "ms", [](F f) { return quantile_ms(f.summary.age_used_newest, 990); },
   "99th percentile of the age of the newest measurement in an image when the image is used", kSame},
  {"age_used_oldest", "", "ms", [](F f) { return quantile_ms(f.summary.age_used_oldest, 500); },
   "median age of the oldest of the sensors' newest measurements", kSame},
  {"", "/observations/received", "", [](F f) { return f.summary.received; },
   "observation lists that reached the fusion node", "", show("observation lists received")},
  {"", "/observations/out_of_sequence", "", [](F f) { return f.summary.out_of_sequence; },
   "lists that came after a newer one", "", show("  arrived out of sequence")},
  {"out_of_sequence", "", "", [](F f) { return share(f.summary.out_of_sequence, f.summary.received); },
   "share of lists that came after a newer one", kSame},
  {"lists_fused", "", "", [](F f) { return f.summary.fused + f.summary.fused_late; },
   "observation lists that were fused in the whole drive", kSame},
  {"", "/observations/fused", "", [](F f) { return f.summary.fused; }, "lists that were fused in order", ""},
  {"", "/observations/late", "", [](F f) { return f.summary.fused_late; }, "lists that were fused after a newer one",
   "", show("  fused late (retrodicted)")},
  {"", "/observations/held", "", [](F f) { return f.summary.held; },
   "waits: one for each list at each fusion instant that left it for later", "", show("  times held back")},
  {"", "/held_back_for/count", "", [](F f) { return f.summary.held_for.count; }, "lists that were held back", ""},
  {"", "/held_back_for/mean_ms", "ms", [](F f) { return mean_ms(f.summary.held_for); },
   "mean time from a list's first wait until its fusion", "",
   show("  held back for, mean", 1).begins("  held back for, mean / worst [ms]")},
  {"", "/held_back_for/worst_ms", "ms", [](F f) { return worst_ms(f.summary.held_for); },
   "largest time from a list's first wait until its fusion", "", show("  held back for, worst", 1).joins(" / ")},
  {"", "/observations/lost", "", [](F f) { return lost_lists(f); },
   "lists that were sent and never fused: the next four together", "",
   show("  dropped").means("lost observation list")},
  {"", "/observations/dropped", "", [](F f) { return f.summary.dropped; }, "lists that were too old for the history",
   "", show("    too old to be fused").rare()},
  {"", "/observations/torn", "", [](F f) { return f.outcome.counts.torn_lists; },
   "lists that were displaced before they were complete", "", show("    torn on the way").rare()},
  {"", "/observations/overwritten", "", [](F f) { return f.outcome.counts.overwritten_lists; },
   "lists that were overwritten before a task read them", "", show("    overwritten before being read").rare()},
  {"", "/observations/discarded", "", [](F f) { return f.outcome.counts.discarded_lists; },
   "lists without a known time of measurement", "", show("    discarded: no time measured").rare()},
  {"", "/observations/duplicates", "", [](F f) { return f.summary.duplicates; }, "lists that came twice", ""},
  {"", "/odometry/samples", "", [](F f) { return f.summary.odometry_samples; },
   "samples of odometry that the fusion node took in", "", {}, When::kOdometry},
  {"", "/odometry/stops", "", [](F f) { return f.summary.odometry_stops; }, "times that no newer sample came", "",
   show("times that odometry stopped").rare(), When::kOdometry},
  {"", "/uses", "", [](F f) { return f.summary.uses; }, "times that the feature service used an image or refused it",
   "", show("uses of an image")},
  {"", "/uses_refused_as_stale", "", [](F f) { return f.summary.stale_uses; }, "of these, images that were too old", "",
   show("  refused for its age").rare()},
  {"", "/uses_with_warning", "", [](F f) { return f.summary.warnings; }, "uses with a warning about an object", "",
   show("  with a warning")},
  {"", "/objects/compared", "", [](F f) { return f.summary.matched; },
   "pairs of an image's object and a true object, over all uses", "",
   show("objects compared").begins("objects compared / missed / spurious")},
  {"", "/objects/missed", "", [](F f) { return judged(f, f.summary.missed); }, "true objects without an image's object", "",
   show("  missed").joins(" / ").means("missed object")},
  {"", "/objects/spurious", "", [](F f) { return judged(f, f.summary.spurious); }, "an image's objects without a true object", "",
   show("  spurious").joins(" / ")},
  {"", "/objects/out_of_view", "", [](F f) { return judged(f, f.summary.out_of_view); },
   "true objects that are not judged: they are in no sensor's field, or hidden", "",
   show("  out of view, not judged").rare()},
  {"", "/objects/shown_out_of_view", "", [](F f) { return judged(f, f.summary.shown_out_of_view); },
   "an image's objects on these, not judged either", ""},
  {"missed", "", "", [](F f) { return share(f.summary.missed, f.summary.missed + f.summary.matched); },
   "share of true objects in view without an image's object", kWorse},
  {"out_of_view", "", "",
   [](F f) {
     return share(f.summary.out_of_view, f.summary.out_of_view + f.summary.missed + f.summary.matched);
   },
   "share of true objects in no sensor's field, or hidden: they are not judged", kSame},
  {"spurious", "", "", [](F f) { return share(f.summary.spurious, f.summary.spurious + f.summary.matched); },
   "share of an image's objects without a true object", "can look worse"},
};

constexpr Measure kTracking[] = {
  {"gospa", "/gospa/distance_m", "m", [](F f) { return f.summary.tracking.gospa.distance_m; },
   "GOSPA of image and truth, as the p-th root of the mean p-th power over the uses of images",
   "worse, by c^p / 2 for each, unless its estimate would be off by more than c / 2^(1/p)",
   show("GOSPA", 3).repeated()},
  {"gospa_localisation", "/gospa/localisation", "m^p", [](F f) { return f.summary.tracking.gospa.localisation; },
   "part of GOSPA to the power p from the errors of pairs", kBetter,
   show("  its part from pairs", 3).begins("  located, missed, false")},
  {"gospa_missed", "/gospa/missed", "m^p", [](F f) { return f.summary.tracking.gospa.missed; },
   "part of GOSPA to the power p from missed objects", kWorse, show("  from missed objects", 3).joins(" ")},
  {"gospa_false", "/gospa/false", "m^p", [](F f) { return f.summary.tracking.gospa.false_estimates; },
   "part of GOSPA to the power p from false objects of the image", kSame, show("  from false ones", 3).joins(" ")},
  {"", "/gospa/cut_off_m", "m", [](F f) { return f.summary.tracking.cut_off.distance_m; }, "the cut-off c", "",
   show("  its cut-off, c", 1).only(kPage)},
  {"", "/gospa/order", "", [](F f) { return f.summary.tracking.cut_off.order; }, "the order p", "",
   show("  its order, p", 1).only(kPage)},
  {"", "/gospa/alpha", "", [](F) { return 2; }, "alpha: a missed or false object costs c^p / alpha", ""},
  {"", "/gospa/instants", "", [](F f) { return f.summary.tracking.instants; }, "judged instants", ""},
  {"ospa", "/ospa/distance_m", "m", [](F f) { return f.summary.tracking.ospa.distance_m; },
   "OSPA of image and truth, as the p-th root of the mean p-th power over the uses of images",
   "worse, unless a false object makes up for it", show("OSPA, with the same", 3).only(kPage)},
  {"ospa_localisation", "/ospa/localisation", "m^p", [](F f) { return f.summary.tracking.ospa.localisation; },
   "part of OSPA to the power p from errors up to the cut-off", kBetter},
  {"ospa_cardinality", "/ospa/cardinality", "m^p", [](F f) { return f.summary.tracking.ospa.cardinality; },
   "part of OSPA to the power p from a wrong number of objects", "worse, unless a false object makes up for it"},
  {"", "/ospa/cut_off_m", "m", [](F f) { return f.summary.tracking.cut_off.distance_m; }, "the cut-off c", ""},
  {"", "/ospa/order", "", [](F f) { return f.summary.tracking.cut_off.order; }, "the order p", ""},
  {"mota", "/clear_mot/mota", "", [](F f) { return f.summary.tracking.mot.mota(); },
   "CLEAR-MOT accuracy: 1 minus misses, false objects and switches per true object", kWorse,
   show("MOTA", 1).in(kPercent).repeated().begins("MOTA [%] / switches of track")},
  {"switches", "/clear_mot/switches", "", [](F f) { return judged(f, f.summary.tracking.mot.switches); },
   "matches of an object with another track than before, in the whole drive", kBetter,
   show("switches of track").joins(" / ")},
  {"motp", "/clear_mot/motp_m", "m", [](F f) { return f.summary.tracking.mot.motp_m(); },
   "CLEAR-MOT precision: mean distance of the matches", kBetter, show("MOTP", 3)},
  {"", "/clear_mot/objects", "", [](F f) { return f.summary.tracking.mot.objects; },
   "true objects, summed over the instants", ""},
  {"", "/clear_mot/matches", "", [](F f) { return f.summary.tracking.mot.matches; },
   "matches of an object with a track", ""},
  {"", "/clear_mot/misses", "", [](F f) { return f.summary.tracking.mot.misses; }, "objects without a track", ""},
  {"", "/clear_mot/false_positives", "", [](F f) { return f.summary.tracking.mot.false_positives; },
   "tracks without an object", ""},
  {"", "/clear_mot/gate_m", "m", [](F f) { return f.summary.tracking.gate_m; }, "largest distance of a match", ""},
  {"", "/track_life/objects", "", [](F f) { return f.summary.tracking.lives.objects; },
   "different true objects in the drive", ""},
  {"", "/track_life/confirmed", "", [](F f) { return f.summary.tracking.lives.confirmed; },
   "objects that were matched at least once", ""},
  {"", "/track_life/mostly_tracked", "", [](F f) { return f.summary.tracking.lives.mostly_tracked; },
   "objects that are tracked for 80 % of their life or more", "", show("objects mostly tracked").only(kPage)},
  {"", "/track_life/partly_tracked", "", [](F f) { return f.summary.tracking.lives.partly_tracked; },
   "objects between mostly tracked and mostly lost", "", show("  partly tracked").only(kPage)},
  {"", "/track_life/mostly_lost", "", [](F f) { return f.summary.tracking.lives.mostly_lost; },
   "objects that are tracked for less than 20 % of their life", "", show("  mostly lost").only(kPage)},
  {"mostly_tracked", "", "",
   [](F f) { return share(f.summary.tracking.lives.mostly_tracked, f.summary.tracking.lives.objects); },
   "share of objects that are tracked for 80 % of their life or more", "worse or the same"},
  {"mostly_lost", "", "",
   [](F f) { return share(f.summary.tracking.lives.mostly_lost, f.summary.tracking.lives.objects); },
   "share of objects that are tracked for less than 20 % of their life", "worse or the same"},
  {"fraction_tracked", "/track_life/mean_fraction_tracked", "",
   [](F f) { return f.summary.tracking.lives.mean_fraction_tracked; },
   "share of its life for which an object is tracked, mean over the objects", kWorse,
   show("life tracked, mean", 1).in(kPercent).only(kPage)},
  {"fragmentations", "/track_life/fragmentations", "",
   [](F f) { return judged(f, f.summary.tracking.lives.fragmentations); },
   "times that an object was tracked again after a loss, in the whole drive",
   "worse, if the object is tracked before and after", show("tracks broken and resumed").only(kPage)},
  {"", "/track_life/lost", "", [](F f) { return judged(f, f.summary.tracking.lives.lost); },
   "objects that lost their track: tracked again after a loss, or by another track", "",
   show("objects that lost their track").rare()},
  {"track_lost", "", "",
   [](F f) { return f.summary.tracking.instants == 0 ? Getter::kNone : f.summary.tracking.lives.lost > 0 ? 1.0 : 0.0; },
   "share of drives in which an object lost its track: tracked again after a loss, or by another track",
   "worse, if the object is tracked before and after", {}, When::kAlways, true},
  {"confirmed_after", "", "ms", [](F f) { return 1e3 * f.summary.tracking.lives.mean_confirmed_after_s; },
   "mean time from the first judged instant of an object to its first match",
   "worse, if it is missed at first; an object never tracked has no part"},
  {"", "/track_life/mean_confirmed_after_s", "s", [](F f) { return f.summary.tracking.lives.mean_confirmed_after_s; },
   "mean time from the first judged instant of an object to its first match", ""},
};

constexpr Measure kCluster[] = {
  {"precision", "/precision_us", "us", [](F f) { return precision_us(f); }, "largest difference of the clocks", kSame,
   show("precision of the time base", 3)},
  {"", "/slot_problems", "", [](F f) { return f.outcome.counts.slot_problems; },
   "slots whose frame a receiver found missing or wrong", "", show("slot problems").means("slot problem")},
  {"", "/deadlines_missed", "", [](F f) { return f.outcome.counts.deadlines_missed; },
   "executions that ended after their deadline", "", show("deadlines missed").means("missed deadline")},
  {"", "/overruns", "", [](F f) { return f.outcome.counts.overruns; }, "activations of a task that still waited", ""},
  {"", "/saturated_signals", "", [](F f) { return f.outcome.counts.saturated_signals; },
   "values beyond the range of their signal", ""},
  {"", "/refused_fragments", "", [](F f) { return f.outcome.counts.refused_fragments; },
   "fragments of lists that were stale or malformed, on any bus", "", show("fragments refused").rare()},
  {"", "/refused_can_frames", "", [](F f) { return f.outcome.counts.refused_can_frames; },
   "CAN frames that the schedule has not", "", show("CAN frames refused").rare()},
  {"", "/unlisted_fates", "", [](F f) { return f.outcome.counts.unlisted_fates; }, "lists whose fate has no record", "",
   show("lists without a record of their fate").rare()},
  {"", "/frames_sent", "", [](F f) { return f.outcome.frames_sent; }, "frames that were sent on FlexRay", ""},
  {"flexray_load", "/flexray_load", "", [](F f) { return f.outcome.flexray_load; },
   "share of the time in which the busier FlexRay channel is taken", kSame,
   show("FlexRay load per channel", 1).in(kPercent)},
};

constexpr Measure kDriving[] = {
  {"smallest_gap", "/driving/smallest_gap_m", "m", [](F f) { return f.driving->smallest_gap_m; },
   "smallest true gap to the object ahead; 0 in a collision", kBrakesLater, show("smallest gap", 2), When::kDriven},
  {"smallest_ttc", "/driving/smallest_time_to_collision_s", "s", [](F f) { return f.driving->smallest_ttc_s; },
   "smallest true time to collision, for constant speeds", kBrakesLater, show("smallest time to collision", 2),
   When::kDriven},
  {"collision", "", "", [](F f) { return f.driving->collision.has_value() ? 1.0 : 0.0; },
   "share of drives with a collision", kSameOrWorse, {}, When::kDriven, true},
  {"", "/driving/collision/at_s", "s", [](F f) { return 1e-9 * static_cast<double>(f.driving->collision->at.ns); },
   "time of the first collision", "", show("collision at", 2).begins("collision at [s], with [m/s]").or_else("none"),
   When::kCollision},
  {"collision_speed", "/driving/collision/closing_mps", "m/s", [](F f) { return f.driving->collision->closing_mps; },
   "closing speed at the first collision; absent in a drive without one", kBrakesLater, show("  with", 1).joins(" "),
   When::kCollision},
  {"stopping_distance", "/driving/stopping_distance_m", "m", [](F f) { return f.driving->stopping_distance_m; },
   "way from the instant at which the object ahead brakes until the vehicle stands; absent in a drive in which it does not",
   kBrakesLater, show("stopping distance", 2), When::kDriven},
  {"reaction_time", "/driving/reaction_s", "s", [](F f) { return f.driving->reaction->seconds(); },
   "time from the instant at which the object ahead truly falls below `judgement.reaction_speed` until an image says so",
   kWorse, show("reaction time", 2), When::kReaction},
  {"", "/driving/detections/primary", "", [](F f) { return f.driving->detections->primary; },
   "detections in whole pictures", "",
   show("detections of whole pictures").begins("detections of whole pictures / of regions"), When::kDetections},
  {"", "/driving/detections/secondary", "", [](F f) { return f.driving->detections->secondary; },
   "detections in regions of pictures", "", show("  of regions").joins(" / "), When::kDetections},
  {"detection_frame", "/driving/detections/frame_s", "s", [](F f) { return f.driving->detections->frames.mean(); },
   "mean length of the frames of a detector that several cameras share", kSame,
   show("  frame, mean").in(kMilliseconds).begins("  frame, mean / deviation [ms]"), When::kDetections},
  {"", "/driving/detections/frame_sigma_s", "s", [](F f) { return f.driving->detections->frames.deviation(); },
   "standard deviation of these lengths in a drive", "", show("  frame, deviation").in(kMilliseconds).joins(" / "),
   When::kDetections},
  {"detection_interval", "/driving/detections/interval_s", "s",
   [](F f) { return f.driving->detections->intervals.mean(); },
   "mean time between two detections of the camera that such a detector looks at most", kSame,
   show("  interval of the camera looked at most, mean").in(kMilliseconds).begins("  interval of the camera looked at most, mean / deviation [ms]"),
   When::kDetections},
  {"detection_interval_sigma", "/driving/detections/interval_sigma_s", "s",
   [](F f) { return f.driving->detections->intervals.deviation(); }, "standard deviation of these times in a drive",
   kSame, show("  its deviation").in(kMilliseconds).joins(" / "), When::kDetections},
  {"gap_error_rms", "/driving/gap_error_rms_m", "m", [](F f) { return f.driving->gap_error_rms_m; },
   "root mean square of the true gap's error against standstill and time gap of adaptive cruise control",
   "worse, if the gap drifts meanwhile", show("error of the gap, RMS", 2), When::kDriven},
  {"below_r157", "/driving/below_r157_distance", "", [](F f) { return f.driving->below_minimum; },
   "share of the time behind an object in which the true gap is below UN R157's minimum following distance",
   kBrakesLater, show("below R157's distance", 1).in(kPercentOfTime), When::kDriven},
  {"largest_deceleration", "/driving/largest_deceleration_mps2", "m/s^2",
   [](F f) { return f.driving->largest_deceleration; }, "largest deceleration of the vehicle", kSameOrWorse,
   show("largest deceleration", 2), When::kDriven},
  {"jerk_rms", "/driving/jerk_rms_mps3", "m/s^3", [](F f) { return f.driving->jerk_rms; },
   "root mean square of the vehicle's jerk over 40 ms or more, while it moves", kSameOrWorse,
   show("jerk, RMS", 2).begins("jerk, RMS / largest [m/s^3]"), When::kDriven},
  {"largest_jerk", "/driving/largest_jerk_mps3", "m/s^3", [](F f) { return f.driving->largest_jerk; },
   "largest jerk of the vehicle over 40 ms or more, while it moves", kSameOrWorse,
   show("jerk, largest", 1).joins(" / "), When::kDriven},
  {"", "/driving/collision_warnings/hazards", "", [](F f) { return ahead(f).hazards; },
   "true hazards: the true time to collision is below the service's time for 100 ms or longer", "", {},
   When::kWarnsAhead},
  {"", "/driving/collision_warnings/given", "", [](F f) { return ahead(f).given; },
   "forward collision warnings that were given", "", {}, When::kWarnsAhead},
  {"", "/driving/collision_warnings/right", "", [](F f) { return ahead(f).right; },
   "forward collision warnings within 300 ms of a hazard", "",
   show("collision warnings right").begins("collision warnings right / wrong / missed / late"), When::kWarnsAhead},
  {"warnings_wrong", "/driving/collision_warnings/wrong", "", [](F f) { return ahead(f).wrong; },
   "forward collision warnings without a true hazard, in a drive", kSame, show("  wrong").joins(" / "),
   When::kWarnsAhead},
  {"warnings_missed", "/driving/collision_warnings/missed", "", [](F f) { return ahead(f).missed; },
   "hazards without a forward collision warning, in a drive", kWholeHazard, show("  missed").joins(" / "),
   When::kWarnsAhead},
  {"warnings_late", "/driving/collision_warnings/late", "", [](F f) { return ahead(f).late; },
   "hazards whose forward collision warning began after them, in a drive", kSameOrWorse, show("  late").joins(" / "),
   When::kWarnsAhead},
  {"", "/driving/collision_warnings/late_mean_ms", "ms", [](F f) { return late_ms(ahead(f)); },
   "mean delay of the late ones", "", show("  late by, mean").begins("  late by, mean / most [ms]"), When::kWarnsAhead},
  {"", "/driving/collision_warnings/late_most_ms", "ms", [](F f) { return latest_ms(ahead(f)); },
   "largest delay of the late ones", "", show("  late by, most").joins(" / "), When::kWarnsAhead},
  {"", "/driving/emergency_brakings/hazards", "", [](F f) { return braking(f).hazards; },
   "true hazards: the true time to collision is below the service's time for 100 ms or longer", "", {},
   When::kWarnsAhead},
  {"", "/driving/emergency_brakings/given", "", [](F f) { return braking(f).given; },
   "emergency brakings that were given", "", {}, When::kWarnsAhead},
  {"", "/driving/emergency_brakings/right", "", [](F f) { return braking(f).right; },
   "emergency brakings within 300 ms of a hazard", "",
   show("emergency brakings right").begins("emergency brakings right / wrong / missed / late"), When::kWarnsAhead},
  {"brakings_wrong", "/driving/emergency_brakings/wrong", "", [](F f) { return braking(f).wrong; },
   "emergency brakings without a true hazard, in a drive", kSame, show("  wrong").joins(" / "), When::kWarnsAhead},
  {"brakings_missed", "/driving/emergency_brakings/missed", "", [](F f) { return braking(f).missed; },
   "hazards without emergency braking, in a drive", kWholeHazard, show("  missed").joins(" / "), When::kWarnsAhead},
  {"brakings_late", "/driving/emergency_brakings/late", "", [](F f) { return braking(f).late; },
   "hazards whose emergency braking began after them, in a drive", kSameOrWorse, show("  late").joins(" / "),
   When::kWarnsAhead},
  {"", "/driving/emergency_brakings/late_mean_ms", "ms", [](F f) { return late_ms(braking(f)); },
   "mean delay of the late ones", "", show("  late by, mean").begins("  late by, mean / most [ms]"), When::kWarnsAhead},
  {"", "/driving/emergency_brakings/late_most_ms", "ms", [](F f) { return latest_ms(braking(f)); },
   "largest delay of the late ones", "", show("  late by, most").joins(" / "), When::kWarnsAhead},
  {"lane_offset_rms", "/driving/lane/offset_rms_m", "m", [](F f) { return f.driving->lane->offset_rms_m; },
   "root mean square of the true offset from the middle of the lane that a service keeps", kSame,
   show("offset from the lane's middle, RMS", 3).begins("offset from the lane's middle, RMS / largest [m]"),
   When::kLane},
  {"lane_offset_largest", "/driving/lane/largest_offset_m", "m", [](F f) { return f.driving->lane->largest_offset_m; },
   "largest true offset from the lane's middle", kSame, show("  largest", 3).joins(" / "), When::kLane},
  {"lane_heading_rms", "/driving/lane/heading_rms_rad", "rad", [](F f) { return f.driving->lane->heading_rms_rad; },
   "root mean square of the true heading from the lane's direction", kSame,
   show("heading from the lane's, RMS", 2).in(kDegrees).begins("heading from the lane's, RMS / largest [deg]"),
   When::kLane},
  {"lane_heading_largest", "/driving/lane/largest_heading_rad", "rad",
   [](F f) { return f.driving->lane->largest_heading_rad; }, "largest true heading from the lane's direction", kSame,
   show("  largest", 2).in(kDegrees).joins(" / "), When::kLane},
  {"beyond_mark", "/driving/lane/beyond_a_mark", "", [](F f) { return f.driving->lane->outside; },
   "share of the time in which a side of the vehicle is beyond its mark", kSame,
   show("beyond a mark", 1).in(kPercentOfTime), When::kLane},
  {"departures", "/driving/lane_departure_warnings/hazards", "", [](F f) { return departure(f).hazards; },
   "times of 100 ms or longer in which a side is beyond its mark, in a drive", kSame, {}, When::kLane},
  {"", "/driving/lane_departure_warnings/given", "", [](F f) { return departure(f).given; }, " that were given", "", {},
   When::kLane},
  {"departure_warnings_right", "/driving/lane_departure_warnings/right", "", [](F f) { return departure(f).right; },
   "lane departure warnings within 300 ms of a departure, in a drive", kSame,
   show("lane departure warnings right").begins("lane departure warnings right / wrong / missed / late"), When::kLane},
  {"departure_warnings_wrong", "/driving/lane_departure_warnings/wrong", "", [](F f) { return departure(f).wrong; },
   "all other lane departure warnings, in a drive", kSame, show("  wrong").joins(" / "), When::kLane},
  {"departure_warnings_missed", "/driving/lane_departure_warnings/missed", "", [](F f) { return departure(f).missed; },
   "departures without a warning, in a drive", kSame, show("  missed").joins(" / "), When::kLane},
  {"departure_warnings_late", "/driving/lane_departure_warnings/late", "", [](F f) { return departure(f).late; },
   "departures whose warning began after them, in a drive", kSame, show("  late").joins(" / "), When::kLane},
  {"departure_lateness", "/driving/lane_departure_warnings/late_mean_ms", "ms",
   [](F f) { return late_ms(departure(f)); },
   "mean delay of the late lane departure warnings; absent in a drive without one", kSame,
   show("  late by, mean").begins("  late by, mean / most [ms]"), When::kLane},
  {"", "/driving/lane_departure_warnings/late_most_ms", "ms", [](F f) { return latest_ms(departure(f)); },
   "largest delay of the late ones", "", show("  late by, most").joins(" / "), When::kLane},
  {"blind_spot_hazards", "/driving/blind_spot_warnings/hazards", "", [](F f) { return beside(f).hazards; },
   "times of 100 ms or longer in which an object is in the blind spot of a side, in a drive", kSame, {},
   When::kBlindSpot},
  {"", "/driving/blind_spot_warnings/given", "", [](F f) { return beside(f).given; },
   "blind spot warnings that were given", "", {}, When::kBlindSpot},
  {"blind_spot_warnings_right", "/driving/blind_spot_warnings/right", "", [](F f) { return beside(f).right; },
   "blind spot warnings within 300 ms of a hazard of their side, in a drive", kWorse,
   show("blind spot warnings right").begins("blind spot warnings right / wrong / missed / late"), When::kBlindSpot},
  {"blind_spot_warnings_wrong", "/driving/blind_spot_warnings/wrong", "", [](F f) { return beside(f).wrong; },
   "all other blind spot warnings, in a drive", kSame, show("  wrong").joins(" / "), When::kBlindSpot},
  {"blind_spot_warnings_missed", "/driving/blind_spot_warnings/missed", "", [](F f) { return beside(f).missed; },
   "hazards without a blind spot warning, in a drive", kWholeHazard, show("  missed").joins(" / "), When::kBlindSpot},
  {"blind_spot_warnings_late", "/driving/blind_spot_warnings/late", "", [](F f) { return beside(f).late; },
   "hazards whose blind spot warning began after them, in a drive", kSameOrWorse, show("  late").joins(" / "),
   When::kBlindSpot},
  {"blind_spot_lateness", "/driving/blind_spot_warnings/late_mean_ms", "ms", [](F f) { return late_ms(beside(f)); },
   "mean delay of the late blind spot warnings; absent in a drive without one", kSameOrWorse,
   show("  late by, mean").begins("  late by, mean / most [ms]"), When::kBlindSpot},
  {"", "/driving/blind_spot_warnings/late_most_ms", "ms", [](F f) { return latest_ms(beside(f)); },
   "largest delay of the late ones", "", show("  late by, most").joins(" / "), When::kBlindSpot},
  {"", "/driving/commands_issued", "", [](F f) { return f.driving->issued; }, "commands that services issued", "", {},
   When::kDriven},
  {"", "/driving/readings/applied", "", [](F f) { return f.driving->applied; },
   "readings of the actuator with a command that it applied", "",
   show("readings of commands: applied").begins("readings of commands: applied / none / refused"), When::kDriven},
  {"", "/driving/readings/none_new", "", [](F f) { return f.driving->none_new; }, "readings without a new command", "",
   show("  none").joins(" / "), When::kDriven},
  {"", "/driving/readings/invalid", "", [](F f) { return f.driving->invalid; }, "readings of a malformed command", "",
   {}, When::kDriven},
  {"", "/driving/readings/late", "", [](F f) { return f.driving->late; }, "readings of a command that was too old", "",
   {}, When::kDriven},
  {"", "", "", [](F f) { return f.driving->invalid + f.driving->late; },
   "readings of a command that was malformed or too old", "", show("  refused").only(kTable).joins(" / "),
   When::kDriven},
  {"", "/driving/readings/nothing_asked", "", [](F f) { return f.driving->nothing_asked; },
   "commands that ask for nothing", "", {}, When::kDriven},
  {"", "/driving/readings/weaker", "", [](F f) { return f.driving->weaker; }, "commands that are weaker than another's",
   "", {}, When::kDriven},
};
// clang-format on

}  // namespace

std::span<const Measure> measures(Subject subject) {
  switch (subject) {
    case Subject::kErrors: return kErrors;
    case Subject::kLists: return kLists;
    case Subject::kTracking: return kTracking;
    case Subject::kCluster: return kCluster;
    case Subject::kDriving: return kDriving;
  }
  return {};
}

std::span<const Measure> measures() {
  static const std::vector<Measure> all = [] {
    std::vector<Measure> rows;
    for (const Subject subject : kSubjects) rows.insert(rows.end(), measures(subject).begin(), measures(subject).end());
    return rows;
  }();
  return all;
}

const Measure* find_measure(std::string_view name) {
  const auto found = std::ranges::find(measures(), name, &Measure::name);
  return name.empty() || found == measures().end() ? nullptr : &*found;
}

const Measure& measure_at(std::string_view path) {
  const auto found = std::ranges::find(measures(), path, &Measure::path);
  TTF_CHECK(!path.empty() && found != measures().end(), "no measure has the path {}", path);
  return *found;
}

bool is_ratio_scale(const Measure& measure) {
  return !measure.unit.empty() && measure.name != "position_mse_reference_corrected";
}

std::string label_of(const Measure& measure) {
  const Shown& shown = measure.shown;
  const std::string_view unit = shown.scale.unit.empty() ? measure.unit : shown.scale.unit;
  return unit.empty() ? std::string(shown.label) : fmt::format("{} [{}]", shown.label, unit);
}

}  // namespace ttf::evaluation::measures
