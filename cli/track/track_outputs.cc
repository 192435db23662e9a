#include "cli/track/track_outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/counted.h"
#include "report/drawing/tables.h"

namespace ttf::cli::track {
namespace {

replay::SensorAccount sum_of(const std::vector<replay::SensorAccount>& accounts) {
  replay::SensorAccount sum;
  for (const replay::SensorAccount& one : accounts) {
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

void add_row(report::drawing::Table& table, const std::string& name, const replay::SensorAccount& account) {
  std::vector<std::string> row{name};
  for (const std::uint64_t count : {account.lists, account.observations, account.in_order, account.late,
                                    account.too_old, account.duplicates, account.held})
    row.push_back(std::to_string(count));
  row.push_back(report::drawing::cell(in_ms(account.longest_hold), 1));
  row.push_back(report::drawing::cell(in_ms(account.longest_delay), 1));
  table.add(std::move(row));
}

nlohmann::ordered_json account_json(const replay::SensorAccount& account) {
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

}  // namespace

std::string track_table(const TrackResult& result) {
  report::drawing::Table table({"sensor", "lists", "observations", "in order", "late", "too old", "duplicates",
                                "held back", "longest hold [ms]", "longest delay [ms]"});
  for (std::size_t s = 0; s < result.sensors.size(); ++s) add_row(table, result.sensors[s], result.account.sensors[s]);
  add_row(table, "all", sum_of(result.account.sensors));
  std::string text = table.text();
  if (result.damaged > 0) text += fmt::format("{} left out\n", counted(result.damaged, "damaged row"));
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
  json["did_its_work"] = result.verdict.did_its_work();
  json["reasons"] = result.verdict.reasons;
  return json;
}

}  // namespace ttf::cli::track
