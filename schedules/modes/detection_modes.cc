#include "schedules/modes/detection_modes.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "core/check.h"
#include "core/decimal.h"
#include "schedules/analysis/chain/rest.h"
#include "schedules/analysis/clock_bounds.h"
#include "schedules/analysis/slot_groups.h"
#include "schedules/model/round.h"
#include "schedules/sequence/history.h"

namespace ttf::schedules::modes {
namespace {

using analysis::ClockBounds;
using analysis::chain::RestOfChain;

std::string ms(Duration time) { return scaled_text(time.ns, 1'000'000) + " ms"; }

Finding finding(const std::string& key, const std::string& value, const std::string& expected) {
  return {"command line", 0, key, value, expected};
}

// Returns the instants within a round at which a detection may begin: those of the grid.
std::vector<GlobalTime> beginnings(const model::Cluster& cluster, const Grid& grid) {
  const std::int64_t cycles = grid.step.ns / cluster.cycle().ns;
  std::vector<GlobalTime> instants;
  // If the step does not divide the round, a detection may begin in any cycle.
  const std::int64_t every = model::kCycles % cycles == 0 ? cycles : 1;
  for (std::int64_t c = model::kFromCycle; c < model::kFromCycle + model::kCycles; c += every)
    instants.push_back(model::time_of(cluster.flexray, c, grid.offset));
  return instants;
}

// Returns the longest time that a detection takes in global time.
Duration by_any_clock(const model::Cluster& cluster, Duration worst_case) {
  const ClockBounds clocks = analysis::clock_bounds(cluster);
  return worst_case + Duration{clocks.drift_ns(worst_case.ns) + model::kGranularity_ns + clocks.apart_ns};
}

// The shortest time between the lists of two detections, one directly behind the other, in any modes.
Duration shortest_between_lists(const model::Cluster& cluster, const std::vector<Mode>& modes) {
  std::optional<Duration> shortest;
  const ClockBounds clocks = analysis::clock_bounds(cluster);
  for (const Mode& mode : modes)
    for (const PlacedDetection& one : mode.detections)
      for (const Mode& next_mode : modes)
        for (const PlacedDetection& next : next_mode.detections) {
          const std::int64_t apart = (one.occupied - one.worst_case + next.best_case).ns;
          shortest = std::min(shortest.value_or(Duration{apart}), Duration{apart - clocks.drift_ns(apart)});
        }
  return std::max(Duration{}, shortest.value_or(Duration{}));
}

// Whether a list is in its slots before the next one is written.
bool leaves_in_time(const model::Cluster& cluster, PduId pdu, const std::vector<Mode>& modes, const Grid& grid) {
  const Duration next = shortest_between_lists(cluster, modes);
  const std::vector<analysis::SlotGroup> groups = analysis::slot_groups(cluster, pdu);
  // A list that may wait for later cycles may be torn.
  if (!std::ranges::all_of(groups, &analysis::SlotGroup::bounded)) return false;
  const std::int64_t apart = analysis::clock_bounds(cluster).apart_ns;
  for (const GlobalTime begins : beginnings(cluster, grid))
    for (const Mode& mode : modes)
      for (const PlacedDetection& one : mode.detections) {
        const GlobalTime written = begins + one.worst_case;
        const GlobalTime latest = begins + by_any_clock(cluster, one.worst_case);
        const bool taken = std::ranges::any_of(groups, [&](const analysis::SlotGroup& group) {
          const model::CycleInstant turn{group.base_cycle, group.repetition, group.taken_from};
          const std::int64_t cycle = next_occurrence(cluster.flexray, turn, latest).cycle;
          return time_of(cluster.flexray, cycle, group.taken_by) + Duration{apart} < written + next;
        });
        if (!taken) return false;
      }
  return true;
}

CameraBound bound_of(const model::Cluster& cluster, const RestOfChain& rest, const Mode& mode, const Grid& grid,
                     int sensor) {
  CameraBound bound;
  bound.sensor = sensor;
  bool first = true;
  for (const PlacedDetection& one : mode.detections) {
    if (one.detection.sensor != sensor) continue;
    for (const GlobalTime begins : beginnings(cluster, grid)) {
      const Duration least = rest.earliest(begins, one.best_case), most = rest.latest(begins, one.worst_case);
      bound.least = first ? least : std::min(bound.least, least);
      bound.most = std::max(bound.most, most);
      first = false;
    }
  }
  return bound;
}

// The longest time from the beginning of a picture until an event that it just misses has had its first command.
Duration longest(const model::Cluster& cluster, const RestOfChain& rest, const Grid& grid, const PlacedDetection& next,
                 Duration interval) {
  Duration most{};
  for (const GlobalTime begins : beginnings(cluster, grid)) most = std::max(most, rest.latest(begins, next.worst_case));
  return interval + most + Duration{analysis::clock_bounds(cluster).apart_ns};
}

// The pictures of a camera in a mode: all of them, or the whole ones.
std::vector<PlacedDetection> pictures(const Mode& mode, int sensor, bool whole) {
  std::vector<PlacedDetection> found;
  for (const PlacedDetection& one : mode.detections)
    if (one.detection.sensor == sensor && !(whole && one.detection.secondary)) found.push_back(one);
  return found;
}

Duration reaction_in(const model::Cluster& cluster, const RestOfChain& rest, const Mode& mode, const Grid& grid,
                     const std::vector<PlacedDetection>& seen) {
  Duration most{};
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const bool last = i + 1 == seen.size();
    const PlacedDetection& next = seen[last ? 0 : i + 1];
    const Duration interval = next.begins - seen[i].begins + (last ? mode.frame : Duration{});
    most = std::max(most, longest(cluster, rest, grid, next, interval));
  }
  return most;
}

int cameras(const Mode& mode) {
  int most = -1;
  for (const PlacedDetection& one : mode.detections) most = std::max(most, one.detection.sensor);
  return most + 1;
}

RestOfChain rest_of(const model::Cluster& cluster, const Detector& detector, std::size_t chain) {
  std::vector<RestOfChain> rests = analysis::chain::rests_behind(cluster, detector.node, *detector.task);
  TTF_CHECK(chain < rests.size(), "chain {} of {}", chain, rests.size());
  return rests[chain];
}

}  // namespace

Mode placed(const model::Cluster& cluster, const sequence::Sequence& sequence, const sequence::DetectionTimes& times,
            const Grid& grid) {
  TTF_CHECK(grid.step > Duration{} && grid.step.ns % cluster.cycle().ns == 0, "a step of {} ns", grid.step.ns);
  Mode mode;
  mode.sequence = sequence;
  for (const sequence::Detection& detection : sequence) {
    const Duration worst_case = times.of(detection), occupied = sequence::occupied(worst_case, grid.step);
    const Duration best_case = std::min(worst_case, grid.best_case.value_or(worst_case));
    mode.detections.push_back(
        {detection, mode.frame.ns / cluster.cycle().ns, mode.frame, worst_case, best_case, occupied});
    mode.frame += occupied;
  }
  mode.cycles = mode.frame.ns / cluster.cycle().ns;
  return mode;
}

std::vector<Finding> unsound(const model::Cluster& cluster, const Detector& detector, const std::vector<Mode>& modes,
                             const Grid& grid) {
  std::vector<Finding> findings;
  const std::string name = fmt::format("{}.{}", cluster.node(detector.node).name, detector.task->name);
  if (cluster.node(detector.node).tasks.size() != 1)
    findings.push_back(
        finding("--task", name, "must be its node's only task: detections follow each other without a gap"));
  if (detector.task->writes.size() != 1)
    findings.push_back(finding("--task", name, "must write one list, that of the detections' results"));
  if (grid.offset.value >= cluster.flexray.gMacroPerCycle)
    findings.push_back(finding("--offset", fmt::format("{}", grid.offset.value),
                               fmt::format("must be 0..{} macroticks", cluster.flexray.gMacroPerCycle - 1)));
  if (!findings.empty()) return findings;
  for (const bool secondary : {false, true})
    for (const Mode& mode : modes) {
      const auto late = std::ranges::find_if(mode.detections, [&](const PlacedDetection& one) {
        return one.detection.secondary == secondary && by_any_clock(cluster, one.worst_case) > one.occupied;
      });
      if (late == mode.detections.end()) continue;
      const Duration spare = by_any_clock(cluster, late->worst_case) - late->worst_case;
      findings.push_back(
          finding(secondary ? "--secondary" : "--primary", ms(late->worst_case),
                  fmt::format("must end {} before its steps of {} do: clocks differ", ms(spare), ms(late->occupied))));
      break;
    }
  const model::PortBinding& out = detector.task->writes.front();
  if (out.medium.is_flexray()) {
    if (!leaves_in_time(cluster, out.pdu, modes, grid))
      findings.push_back(finding(
          "--task", name,
          fmt::format("must have slots of {} between the lists of any two detections", cluster.pdu(out.pdu).name)));
    return findings;
  }
  for (const model::CanMessage& message : cluster.can(out.medium).messages)
    if (const Duration between = shortest_between_lists(cluster, modes);
        message.pdu == out.pdu && between < message.shortest_period)
      findings.push_back(finding("--task", name,
                                 fmt::format("must write its list every {} at most, the shortest period of {} on {}; "
                                             "those of two detections may be {} apart",
                                             ms(message.shortest_period), cluster.pdu(out.pdu).name,
                                             cluster.can(out.medium).name, ms(between))));
  return findings;
}

std::vector<CameraBound> bounds(const model::Cluster& cluster, const Detector& detector, const Mode& mode,
                                const Grid& grid, std::size_t chain) {
  const RestOfChain rest = rest_of(cluster, detector, chain);
  std::vector<CameraBound> all;
  for (int sensor = 0; sensor < cameras(mode); ++sensor) {
    CameraBound bound = bound_of(cluster, rest, mode, grid, sensor);
    bound.reaction_in_region = reaction_in(cluster, rest, mode, grid, pictures(mode, sensor, false));
    bound.reaction = reaction_in(cluster, rest, mode, grid, pictures(mode, sensor, true));
    all.push_back(bound);
  }
  return all;
}

std::vector<CameraBound> bounds_of_change(const model::Cluster& cluster, const Detector& detector, const Mode& before,
                                          const Mode& after, const Grid& grid, std::size_t chain) {
  const RestOfChain rest = rest_of(cluster, detector, chain);
  std::vector<CameraBound> all;
  for (int sensor = 0; sensor < cameras(after); ++sensor) {
    CameraBound bound = bound_of(cluster, rest, after, grid, sensor);
    const auto across = [&](bool whole) {
      const std::vector<PlacedDetection> old = pictures(before, sensor, whole), now = pictures(after, sensor, whole);
      TTF_CHECK(!old.empty() && !now.empty(), "camera {} has no picture", sensor);
      return longest(cluster, rest, grid, now.front(), before.frame - old.back().begins + now.front().begins);
    };
    bound.reaction_in_region = across(false);
    bound.reaction = across(true);
    all.push_back(bound);
  }
  return all;
}

}  // namespace ttf::schedules::modes
