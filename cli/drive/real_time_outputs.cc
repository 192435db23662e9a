#include "cli/drive/real_time_outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "evaluation/lateness/lateness_account.h"
#include "report/drawing/tables.h"

namespace ttf::cli::drive {
namespace {

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

}  // namespace

std::string real_time_text(const StrategyResult& result) {
  if (!result.real_time) return "";
  std::string text = "lateness [us], in real time\n";
  text += distributions(result, {{"wake-ups", &NodeLateness::wake_ups}, {"floor", &NodeLateness::floor}});
  text += distributions(result, {{"frames left", &NodeLateness::departures}, {"frames came", &NodeLateness::arrivals}});
  text += distributions(result, {{"in transit", &NodeLateness::transits}});
  return text + problems(result) + "\n" + media(result) + sums(result);
}

}  // namespace ttf::cli::drive
