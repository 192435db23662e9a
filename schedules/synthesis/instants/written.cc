#include "schedules/synthesis/instants/written.h"

#include <algorithm>
#include <utility>

#include "core/check.h"
#include "schedules/analysis/age_stages.h"
#include "schedules/left_out/earliest.h"
#include "schedules/synthesis/plan/ways.h"

namespace ttf::schedules::synthesis::instants {

using plan::fuses;
using plan::Hop;
using plan::Plan;
using plan::PlannedChain;
using plan::PlannedList;
using plan::task_at;
using plan::TaskId;
using plan::way_to;

model::Cluster with_instants(const Plan& plan, const Timed& timed, const Reading& reading, const Solution& solution) {
  model::Cluster cluster = timed.cluster;
  cluster.parameter_lines = plan.unchanging->parameter_lines;
  for (std::size_t p = 0; p < cluster.pdus.size(); ++p) {
    cluster.pdus[p].header = plan.unchanging->pdus[p].header;
    cluster.pdus[p].element = plan.unchanging->pdus[p].element;
  }
  const model::GlobalParameters& g = cluster.flexray;
  const auto set = [&](model::CycleInstant& at, std::size_t activity) {
    at.base_cycle = static_cast<int>(solution.offsets[activity] / g.gMacroPerCycle);
    at.offset = Macroticks{solution.offsets[activity] % g.gMacroPerCycle};
  };
  for (std::size_t s = 0; s < cluster.sensors.size(); ++s)
    if (reading.sensors[s]) set(cluster.sensors[s].at, *reading.sensors[s]);
  for (std::size_t n = 0; n < cluster.nodes.size(); ++n)
    for (std::size_t t = 0; t < cluster.nodes[n].tasks.size(); ++t)
      if (reading.tasks[n][t]) set(cluster.nodes[n].tasks[t].activation.at, *reading.tasks[n][t]);
  for (std::size_t l = 0; l < timed.lists.size(); ++l) {
    const PlannedList& list = timed.lists[l];
    model::CycleInstant at;
    set(at, reading.lists[l]);
    PlannedList placed = list;
    placed.base_cycle = at.base_cycle;
    placed.slot = static_cast<int>(at.offset.value / g.gdStaticSlot) + 1;
    placed.entry.reset();  // copies of a list have no entry of their own
    left_out::add_frames(cluster, placed);
  }
  left_out::set_deadlines(cluster, plan.tasks);
  return cluster;
}

std::vector<Ticks> offsets_of(const Read& read, const model::Cluster& cluster) {
  const model::GlobalParameters& g = cluster.flexray;
  std::vector<Ticks> offsets;
  for (const Activity& activity : read.reading.problem.activities) offsets.push_back(activity.fixed.value_or(0));
  const auto at = [&](const model::CycleInstant& instant) {
    return instant.base_cycle * Ticks{g.gMacroPerCycle} + instant.offset.value;
  };
  for (std::size_t s = 0; s < cluster.sensors.size(); ++s)
    if (read.reading.sensors[s]) offsets[*read.reading.sensors[s]] = at(cluster.sensors[s].at);
  for (std::size_t n = 0; n < cluster.nodes.size(); ++n)
    for (std::size_t t = 0; t < cluster.nodes[n].tasks.size(); ++t)
      if (read.reading.tasks[n][t]) offsets[*read.reading.tasks[n][t]] = at(cluster.nodes[n].tasks[t].activation.at);
  for (std::size_t l = 0; l < read.timed.lists.size(); ++l) {
    if (read.reading.problem.activities[read.reading.lists[l]].fixed) continue;
    const auto frame = std::find_if(cluster.frames.begin(), cluster.frames.end(), [&](const model::FrameSlot& one) {
      return one.pdu == read.timed.lists[l].pdu && one.fragment == 0;
    });
    TTF_CHECK(frame != cluster.frames.end(), "a planned list without a slot");
    offsets[read.reading.lists[l]] =
        frame->base_cycle * Ticks{g.gMacroPerCycle} + (frame->slot - 1) * Ticks{g.gdStaticSlot};
  }
  return offsets;
}

AgeBounds age_bounds(const model::Cluster& cluster, const PlannedChain& chain) {
  const TaskId to{chain.node, chain.task};
  if (fuses(cluster, to)) {
    for (const analysis::AgePath& path : analysis::measurement_ages(cluster))
      if (path.sensor == chain.from) return {path.fused_best, path.fused_worst};
    for (const analysis::AgePath& path : analysis::odometry_ages(cluster))
      if (path.sensor == chain.from) return {path.fused_best, path.fused_worst};
    return {};
  }
  std::vector<analysis::Reading> readings;
  for (const Hop& hop : way_to(cluster, chain.from, to))
    if (hop.list != nullptr) readings.push_back({hop.list, hop.at.node, &task_at(cluster, hop.at)});
  const analysis::Path path = path_along(cluster, chain.from, readings);
  if (path.stages.empty()) return {};
  const auto ages = analysis::ages_along(cluster, {path});
  return {ages.front().use_best, ages.front().use_worst};
}

}  // namespace ttf::schedules::synthesis::instants
