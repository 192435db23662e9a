#include "cli/track/track_outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "core/counted.h"
#include "evaluation/measures/figures.h"
#include "report/drawing/tables.h"

namespace ttf::cli::track {
namespace {

constexpr std::array<const char*, 3> kQuartiles{"lower quartile", "median", "upper quartile"};

recording::replay::SensorAccount sum_of(const std::vector<recording::replay::SensorAccount>& accounts) {
  recording::replay::SensorAccount sum;
  for (const recording::replay::SensorAccount& one : accounts) {
    sum.lists += one.lists;
    sum.observations += one.observations;
    sum.in_order += one.in_order;
    sum.late += one.late;
    sum.too_old += one.too_old;
    sum.duplicates += one.duplicates;
    sum.held += one.held;
    sum.longest_hold = std::max(sum.longest_hold, one.longest_hold);
    sum.longest_delay = std::max(sum.longest_delay, one.longest_delay);
  }
  return sum;
}

void add_row(report::drawing::Table& table, const std::string& name, const recording::replay::SensorAccount& account) {
  std::vector<std::string> row{name};
  for (const std::uint64_t count : {account.lists, account.observations, account.in_order, account.late,
                                    account.too_old, account.duplicates, account.held})
    row.push_back(std::to_string(count));
  row.push_back(report::drawing::cell(in_ms(account.longest_hold), 1));
  row.push_back(report::drawing::cell(in_ms(account.longest_delay), 1));
  table.add(std::move(row));
}

nlohmann::ordered_json account_json(const recording::replay::SensorAccount& account) {
  return {{"lists", account.lists},
          {"observations", account.observations},
          {"fused_in_order", account.in_order},
          {"fused_late", account.late},
          {"dropped_too_old", account.too_old},
          {"duplicates", account.duplicates},
          {"held_back", account.held},
          {"longest_hold_ms", in_ms(account.longest_hold)},
          {"longest_delay_ms", in_ms(account.longest_delay)}};
}

std::string accuracy_text(const TrackAccuracy& accuracy) {
  const evaluation::accuracy::TrackingMeasures& all = accuracy.tracking;
  report::drawing::Table table({"against the truth", ""});
  table.add({"position RMSE [m]", report::drawing::cell(accuracy.position_rmse_m, 3)});
  table.add({"velocity RMSE [m/s]", report::drawing::cell(accuracy.velocity_rmse_mps, 3)});
  table.add({"objects compared / missed / spurious",
             fmt::format("{} / {} / {}", accuracy.compared, accuracy.missed, accuracy.spurious)});
  table.add({fmt::format("GOSPA [m], c = {:g} m, p = {:g}", all.cut_off.distance_m, all.cut_off.order),
             report::drawing::cell(all.gospa.distance_m, 3)});
  table.add({"MOTA [%]", report::drawing::cell(100 * all.mot.mota(), 1)});
  table.add({"switches of track", std::to_string(all.mot.switches)});
  return table.text();
}

nlohmann::ordered_json accuracy_json(const TrackAccuracy& accuracy) {
  nlohmann::ordered_json json{{"position_rmse_m", accuracy.position_rmse_m},
                              {"velocity_rmse_mps", accuracy.velocity_rmse_mps},
                              {"compared", accuracy.compared},
                              {"missed", accuracy.missed},
                              {"spurious", accuracy.spurious}};
  evaluation::accuracy::DriveSummary summary;
  summary.tracking = accuracy.tracking;
  const sim::drives::DriveOutcome outcome;
  add_to(json, evaluation::measures::measures(evaluation::measures::Subject::kTracking), {summary, outcome});
  return json;
}

std::string scans_text(const ScanAccount& scans, const LivesSummary& lives) {
  report::drawing::Table table({"scans", std::to_string(scans.scans)});
  table.add({"returns", std::to_string(scans.returns)});
  table.add({"boxes", std::to_string(scans.fates.objects)});
  for (const sensors::laser::NamedFate& fate : sensors::laser::kOtherFates)
    table.add({fmt::format("segments: {}", fate.words), std::to_string(scans.fates.*fate.count)});
  if (scans.left_out > 0) table.add({"boxes beyond max_observations", std::to_string(scans.left_out)});
  table.add({"overlapping pairs of tracks", std::to_string(lives.overlapping_pairs)});
  table.add({"overlaps, summed over scans", std::to_string(lives.overlaps)});
  for (std::size_t q = 0; q < 3; ++q)
    table.add({fmt::format("lifetime [s]: {}", kQuartiles[q]), report::drawing::cell(lives.lifetimes_s[q], 2)});
  return table.text();
}

nlohmann::ordered_json scans_json(const ScanAccount& scans, const LivesSummary& lives) {
  nlohmann::ordered_json json{{"scans", scans.scans}, {"returns", scans.returns}, {"boxes", scans.fates.objects}};
  for (const sensors::laser::NamedFate& fate : sensors::laser::kOtherFates)
    json["segments"][std::string(fate.name)] = scans.fates.*fate.count;
  json["boxes_beyond_max_observations"] = scans.left_out;
  json["overlapping_pairs"] = lives.overlapping_pairs;
  json["overlaps"] = lives.overlaps;
  json["lifetime_s"] = {{"lower_quartile", lives.lifetimes_s[0]},
                        {"median", lives.lifetimes_s[1]},
                        {"upper_quartile", lives.lifetimes_s[2]}};
  return json;
}

}  // namespace

std::string track_table(const TrackResult& result) {
  report::drawing::Table table({"sensor", "lists", "observations", "in order", "late", "too old", "duplicates",
                                "held back", "longest\nhold [ms]", "longest\ndelay [ms]"});
  for (std::size_t s = 0; s < result.sensors.size(); ++s) add_row(table, result.sensors[s], result.account.sensors[s]);
  add_row(table, "all", sum_of(result.account.sensors));
  std::string text = table.text();
  if (result.damaged > 0) text += fmt::format("{} left out\n", counted(result.damaged, "damaged row"));
  if (result.accuracy) text += accuracy_text(*result.accuracy);
  if (result.scans && result.lives) text += scans_text(*result.scans, *result.lives);
  return text + fmt::format("{} by {}, {} written\n", counted(result.account.tracks, "track"), result.strategy,
                            counted(result.account.rows, "row"));
}

nlohmann::ordered_json to_json(const TrackResult& result) {
  nlohmann::ordered_json json{{"strategy", result.strategy}, {"damaged_rows", result.damaged}};
  json["all"] = account_json(sum_of(result.account.sensors));
  json["sensors"] = nlohmann::ordered_json::array();
  for (std::size_t s = 0; s < result.sensors.size(); ++s) {
    nlohmann::ordered_json sensor{{"name", result.sensors[s]}};
    sensor.update(account_json(result.account.sensors[s]));
    json["sensors"].push_back(sensor);
  }
  json["tracks"] = result.account.tracks;
  json["rows"] = result.account.rows;
  if (result.accuracy) json["truth"] = accuracy_json(*result.accuracy);
  if (result.scans && result.lives) json["scans"] = scans_json(*result.scans, *result.lives);
  json["did_its_work"] = result.verdict.did_its_work();
  json["reasons"] = result.verdict.reasons;
  return json;
}

}  // namespace ttf::cli::track
