#include "cli/drive/real_time_outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "evaluation/lateness/lateness_account.h"
#include "report/drawing/tables.h"

namespace ttf::cli::drive {
namespace {

using evaluation::lateness::NodeTiming;
using evaluation::lateness::RealTimeFindings;
using recording::exports::NodeLateness;
using recording::records::BinnedDurations;

// The quantiles in the tables, per thousand: median, 99 %, 99.9 %; the longest value is beside them.
constexpr int kQuantiles[] = {500, 990, 999};

void add_cells(std::vector<std::string>& cells, const BinnedDurations& late) {
  cells.push_back(fmt::format("{}", late.count()));
  for (const int thousandths : kQuantiles)
    cells.push_back(late.empty() ? "-" : report::drawing::cell(in_us(late.quantile(thousandths)), 0));
  cells.push_back(late.empty() ? "-" : report::drawing::cell(in_us(late.longest()), 0));
}

struct Distribution {
  std::string name;
  BinnedDurations NodeLateness::*of;
};

// Returns the nodes' distributions side by side, or "" if all are empty.
std::string distributions(const StrategyResult& result, const std::vector<Distribution>& all) {
  std::vector<std::string> head{"node"};
  for (const Distribution& one : all) head.insert(head.end(), {one.name, "p50", "p99", "p99.9", "longest"});
  report::drawing::Table table(head);
  for (std::size_t column = 1; column < head.size(); column += head.size() / all.size()) table.begin_group(column);
  for (const auto& [node, late] : result.real_time->lateness) {
    if (std::all_of(all.begin(), all.end(), [&l = late](const Distribution& one) { return (l.*one.of).empty(); }))
      continue;
    std::vector<std::string> cells{result.cluster.node(node).name};
    for (const Distribution& one : all) add_cells(cells, late.*one.of);
    table.add(std::move(cells));
  }
  return table.rows() == 0 ? "" : table.text() + "\n";
}

std::string problems(const StrategyResult& result) {
  report::drawing::Table table({"node", "late\nwake-ups", "slots\nmissed", "frames\nlate", "\nearly",
                                "withheld by\nthe sender", "sender\naway", "lost on\nthe way",
                                "largest\ncorrection [us]"});
  for (const auto& [node, timing] : result.real_time->timing)
    table.add(
        {result.cluster.node(node).name, fmt::format("{}", timing.late_wake_ups),
         fmt::format("{}", timing.slots_missed), fmt::format("{}", timing.late_frames),
         fmt::format("{}", timing.early_frames), fmt::format("{}", timing.missing.withheld),
         fmt::format("{}", timing.missing.away), fmt::format("{}", timing.lost_on_the_way()),
         timing.largest_offset_correction ? report::drawing::cell(in_us(*timing.largest_offset_correction), 1) : "-"});
  return table.text() +
         "Slots missed: frames that this node withheld. Frames: those of other nodes, as this node heard them. Slot "
         "problems, in the\ntable above: slots, by node and channel, whose frame had not come when the static segment "
         "ended (docs/media/real_time.md).\n";
}

// Returns "" if the nodes recorded no counts of a medium.
std::string media(const StrategyResult& result) {
  report::drawing::Table table(
      {"medium of", "sent", "received", "no room to send", "lost", "dropped", "foreign", "malformed"});
  for (const auto& [node, counts] : result.real_time->medium) {
    std::vector<std::string> cells{result.cluster.node(node).name};
    for (const std::uint64_t count :
         {counts.sent, counts.received, counts.not_sent, counts.lost, counts.dropped, counts.foreign, counts.malformed})
      cells.push_back(fmt::format("{}", count));
    table.add(std::move(cells));
  }
  return table.rows() == 0 ? "" : table.text() + "\n";
}

// Converts a duration of the drive's time to real time.
double scaled_us(const StrategyResult& result, Duration d) {
  return in_us(evaluation::lateness::in_real_time(d, result.real_time->time_scale_ppm));
}

std::string sums(const StrategyResult& result) {
  report::drawing::Table table({"in real time", "samples", "p50", "p99", "longest"});
  const auto add = [&](const std::string& name, const BinnedDurations& all, double unit_us, int decimals) {
    const auto cell = [&](Duration d) {
      return all.empty() ? "-" : report::drawing::cell(scaled_us(result, d) / unit_us, decimals);
    };
    table.add(
        {name, fmt::format("{}", all.count()), cell(all.quantile(500)), cell(all.quantile(990)), cell(all.longest())});
  };
  const bool one_host = result.real_time->precision.size() == 1;
  for (const evaluation::lateness::HostPrecision& host : result.real_time->precision)
    add(one_host ? "clocks apart [us]" : fmt::format("clocks on {} apart [us]", host.host), host.apart, 1.0, 1);
  add("sensor to feature, newest measurement [ms]", result.summary.age_used_newest, 1e3, 1);
  add("sensor to feature, oldest measurement [ms]", result.summary.age_used_oldest, 1e3, 1);
  if (result.driving) add("jitter of the readings of commands [us]", result.driving->reading_jitter, 1.0, 0);
  return table.text();
}

nlohmann::ordered_json late_json(const BinnedDurations& late) {
  if (late.empty()) return {{"count", 0}, {"p50", nullptr}, {"p99", nullptr}, {"p999", nullptr}, {"longest", nullptr}};
  return {{"count", late.count()},
          {"p50", in_us(late.quantile(500))},
          {"p99", in_us(late.quantile(990))},
          {"p999", in_us(late.quantile(999))},
          {"longest", in_us(late.longest())}};
}

nlohmann::ordered_json medium_json(const recording::records::MediumCounts& counts) {
  return {{"sent", counts.sent},      {"received", counts.received}, {"not_sent", counts.not_sent},
          {"lost", counts.lost},      {"foreign", counts.foreign},   {"malformed", counts.malformed},
          {"dropped", counts.dropped}};
}

nlohmann::ordered_json scaled_json(const StrategyResult& result, const BinnedDurations& all, double unit_us) {
  if (all.empty()) return {{"count", 0}, {"p50", nullptr}, {"p99", nullptr}, {"longest", nullptr}};
  const auto value = [&](Duration d) { return scaled_us(result, d) / unit_us; };
  return {{"count", all.count()},
          {"p50", value(all.quantile(500))},
          {"p99", value(all.quantile(990))},
          {"longest", value(all.longest())}};
}

}  // namespace

std::string real_time_text(const StrategyResult& result) {
  if (!result.real_time) return "";
  std::string text = "lateness [us], in real time\n";
  text += distributions(result, {{"wake-ups", &NodeLateness::wake_ups}, {"floor", &NodeLateness::floor}});
  text += distributions(result, {{"frames left", &NodeLateness::departures}, {"frames came", &NodeLateness::arrivals}});
  text += distributions(result, {{"in transit", &NodeLateness::transits}});
  return text + problems(result) + "\n" + media(result) + sums(result);
}

nlohmann::ordered_json real_time_json(const StrategyResult& result) {
  if (!result.real_time) return nullptr;
  const RealTimeFindings& found = *result.real_time;
  nlohmann::ordered_json json;
  json["time_scale"] = static_cast<double>(found.time_scale_ppm) * 1e-6;
  json["nodes"] = nlohmann::ordered_json::array();
  for (const auto& [node, timing] : found.timing) {
    const auto of_node = found.lateness.find(node);
    const NodeLateness late = of_node == found.lateness.end() ? NodeLateness{} : of_node->second;
    nlohmann::ordered_json one;
    one["node"] = result.cluster.node(node).name;
    one["lateness_us"] = {{"wake_ups", late_json(late.wake_ups)},
                          {"floor", late_json(late.floor)},
                          {"departures", late_json(late.departures)},
                          {"arrivals", late_json(late.arrivals)},
                          {"transits", late_json(late.transits)}};
    one["late_wake_ups"] = timing.late_wake_ups;
    one["slots_missed"] = timing.slots_missed;
    one["late_frames"] = timing.late_frames;
    one["early_frames"] = timing.early_frames;
    one["frames_lost"] = timing.frames_lost;
    one["withheld_by_the_sender"] = timing.missing.withheld;
    one["sender_away"] = timing.missing.away;
    one["lost_on_the_way"] = timing.lost_on_the_way();
    one["medium"] = nullptr;
    if (const auto told = found.medium.find(node); told != found.medium.end())
      one["medium"] = medium_json(told->second);
    one["largest_offset_correction_us"] = nullptr;
    if (timing.largest_offset_correction)
      one["largest_offset_correction_us"] = in_us(*timing.largest_offset_correction);
    json["nodes"].push_back(std::move(one));
  }
  json["precision_us"] = nlohmann::ordered_json::array();
  for (const evaluation::lateness::HostPrecision& host : found.precision) {
    nlohmann::ordered_json one{{"host", host.host}};
    one.update(scaled_json(result, host.apart, 1.0));
    json["precision_us"].push_back(std::move(one));
  }
  json["sensor_to_feature_ms"] = {{"newest", scaled_json(result, result.summary.age_used_newest, 1e3)},
                                  {"oldest", scaled_json(result, result.summary.age_used_oldest, 1e3)}};
  if (result.driving) json["reading_jitter_us"] = scaled_json(result, result.driving->reading_jitter, 1.0);
  return json;
}

}  // namespace ttf::cli::drive
