#include "schedules/modes/detection_modes.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/check.h"
#include "schedules/analysis/chain/rest.h"
#include "schedules/analysis/clock_bounds.h"
#include "schedules/model/ports.h"
#include "schedules/model/round.h"
#include "schedules/sequence/history.h"

namespace ttf::schedules::modes {
namespace {

using analysis::ClockBounds;
using analysis::chain::RestOfChain;

// The rest of a chain, and how old a picture is when its detection begins.
struct Following {
  RestOfChain rest;
  RestOfChain::PictureAge picture;
};
Following following(const model::Cluster& cluster, const Detector& detector, std::size_t chain) {
  std::vector<RestOfChain> rests = analysis::chain::rests_behind(cluster, detector.node, *detector.task);
  TTF_CHECK(chain < rests.size(), "chain {} of {}", chain, rests.size());
  Following found{std::move(rests[chain]), {}};
  if (is_by_time(detector.task->activation)) found.picture = found.rest.picture_at_start();
  return found;
}

CameraBound bound_of(const model::Cluster& cluster, const Following& behind, const Mode& mode, const Grid& grid,
                     int sensor) {
  CameraBound bound;
  bound.sensor = sensor;
  bool first = true;
  for (const PlacedDetection& one : mode.detections) {
    if (one.detection.sensor != sensor) continue;
    for (const GlobalTime begins : beginnings(cluster, grid)) {
      const Duration least = behind.picture.best + behind.rest.earliest(begins, one.best_case),
                     most = behind.picture.worst + behind.rest.latest(begins, one.worst_case);
      bound.least = first ? least : std::min(bound.least, least);
      bound.most = std::max(bound.most, most);
      first = false;
    }
  }
  return bound;
}

// The longest time from a picture until an event that it just misses has had its first command. The detection of the next
// picture begins an interval behind that of the first.
Duration longest(const model::Cluster& cluster, const Following& behind, const Grid& grid, const PlacedDetection& next,
                 Duration interval) {
  Duration most{};
  for (const GlobalTime begins : beginnings(cluster, grid))
    most = std::max(most, behind.rest.latest(begins, next.worst_case));
  return behind.picture.worst + interval + most + Duration{analysis::clock_bounds(cluster).apart_ns};
}

// The pictures of a camera in a mode: all of them, or the whole ones.
std::vector<PlacedDetection> pictures(const Mode& mode, int sensor, bool whole) {
  std::vector<PlacedDetection> found;
  for (const PlacedDetection& one : mode.detections)
    if (one.detection.sensor == sensor && !(whole && one.detection.secondary)) found.push_back(one);
  return found;
}

Duration reaction_in(const model::Cluster& cluster, const Following& behind, const Mode& mode, const Grid& grid,
                     const std::vector<PlacedDetection>& seen) {
  Duration most{};
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const bool last = i + 1 == seen.size();
    const PlacedDetection& next = seen[last ? 0 : i + 1];
    const Duration interval = next.begins - seen[i].begins + (last ? mode.frame : Duration{});
    most = std::max(most, longest(cluster, behind, grid, next, interval));
  }
  return most;
}

int cameras(const Mode& mode) {
  int most = -1;
  for (const PlacedDetection& one : mode.detections) most = std::max(most, one.detection.sensor);
  return most + 1;
}

// The cameras whose pictures the chain leads from.
std::vector<int> cameras_of(const model::Cluster& cluster, const Detector& detector, const Mode& mode,
                            const RestOfChain& rest) {
  const std::vector<const model::PortBinding*> ports = camera_ports(*detector.task);
  std::vector<int> found;
  for (int sensor = 0; sensor < cameras(mode); ++sensor) {
    const auto place = static_cast<std::size_t>(sensor);
    if (ports.size() < 2 || (place < ports.size() && cluster.pdu(ports[place]->pdu).sensor == rest.sensor()))
      found.push_back(sensor);
  }
  return found;
}

}  // namespace

std::vector<GlobalTime> beginnings(const model::Cluster& cluster, const Grid& grid) {
  const std::int64_t cycles = grid.step.ns / cluster.cycle().ns;
  std::vector<GlobalTime> instants;
  // If the step does not divide the round, a detection may begin in all cycles that some multiple of it reaches.
  const std::int64_t every = std::gcd<std::int64_t>(cycles_per_round(cluster.flexray), cycles);
  const std::int64_t from = first_analysed(cluster.flexray);
  for (std::int64_t c = from; c < from + cycles_per_round(cluster.flexray); c += every)
    instants.push_back(model::time_of(cluster.flexray, c + grid.base_cycle % every, grid.offset));
  return instants;
}

Duration by_any_clock(const model::Cluster& cluster, Duration worst_case) {
  const ClockBounds clocks = analysis::clock_bounds(cluster);
  return worst_case + Duration{clocks.drift_ns(worst_case.ns) + model::kGranularity_ns + clocks.apart_ns};
}

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

std::vector<CameraBound> bounds(const model::Cluster& cluster, const Detector& detector, const Mode& mode,
                                const Grid& grid, std::size_t chain) {
  const Following behind = following(cluster, detector, chain);
  std::vector<CameraBound> all;
  for (const int sensor : cameras_of(cluster, detector, mode, behind.rest)) {
    CameraBound bound = bound_of(cluster, behind, mode, grid, sensor);
    bound.reaction_in_region = reaction_in(cluster, behind, mode, grid, pictures(mode, sensor, false));
    bound.reaction = reaction_in(cluster, behind, mode, grid, pictures(mode, sensor, true));
    all.push_back(bound);
  }
  return all;
}

std::vector<CameraBound> bounds_of_change(const model::Cluster& cluster, const Detector& detector, const Mode& before,
                                          const Mode& after, const Grid& grid, std::size_t chain) {
  const Following behind = following(cluster, detector, chain);
  std::vector<CameraBound> all;
  for (const int sensor : cameras_of(cluster, detector, after, behind.rest)) {
    CameraBound bound = bound_of(cluster, behind, after, grid, sensor);
    const auto across = [&](bool whole) {
      const std::vector<PlacedDetection> old = pictures(before, sensor, whole), now = pictures(after, sensor, whole);
      TTF_CHECK(!old.empty() && !now.empty(), "camera {} has no picture", sensor);
      return longest(cluster, behind, grid, now.front(), before.frame - old.back().begins + now.front().begins);
    };
    bound.reaction_in_region = across(false);
    bound.reaction = across(true);
    all.push_back(bound);
  }
  return all;
}

}  // namespace ttf::schedules::modes
