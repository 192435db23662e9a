#include "schedules/analysis/slot_groups.h"

#include <algorithm>
#include <map>
#include <utility>

#include "schedules/analysis/minislots.h"
#include "schedules/model/round.h"

namespace ttf::schedules::analysis {
namespace {

void set_static_times(const model::GlobalParameters& g, SlotGroup& group) {
  group.taken_from = slot_start(g, group.first);
  group.taken_by = group.taken_from + Macroticks{g.gdActionPointOffset};
  group.complete_by = slot_start(g, group.last + 1);
}

// Takes the latest turn and the latest end over both channels.
void set_dynamic_times(const model::Cluster& cluster, PduId pdu, SlotGroup& group) {
  const model::GlobalParameters& g = cluster.flexray;
  std::int64_t taken_by = 0, over = 0;
  for (const model::FrameSlot& frame : cluster.frames) {
    if (frame.pdu != pdu || frame.base_cycle != group.base_cycle || frame.repetition != group.repetition) continue;
    const std::int64_t turn = latest_turn(cluster, frame);
    if (frame.slot == group.first) taken_by = std::max(taken_by, turn);
    over = std::max(over, turn + minislots_of(g, dynamic_words(cluster, frame)));
    group.bounded &= always_in_time(cluster, frame);
  }
  group.taken_from = minislot_start(g, group.first - g.gNumberOfStaticSlots);
  group.taken_by = minislot_start(g, taken_by) + Macroticks{g.gdMinislotActionPointOffset};
  group.complete_by = minislot_start(g, over);
}

}  // namespace

std::vector<SlotGroup> slot_groups(const model::Cluster& cluster, PduId pdu) {
  std::map<std::pair<int, int>, SlotGroup> groups;
  for (const model::FrameSlot& frame : cluster.frames) {
    if (frame.pdu != pdu) continue;
    SlotGroup fresh;
    fresh.base_cycle = frame.base_cycle;
    fresh.repetition = frame.repetition;
    fresh.first = fresh.last = fresh.first_fragment = frame.slot;
    SlotGroup& group = groups.try_emplace({frame.base_cycle, frame.repetition}, fresh).first->second;
    group.first = std::min(group.first, frame.slot);
    group.last = std::max(group.last, frame.slot);
    if (frame.fragment == 0) group.first_fragment = frame.slot;
    group.dynamic |= is_dynamic(cluster.flexray, frame);
  }
  std::vector<SlotGroup> list;
  for (auto& [cycles, group] : groups) {
    if (group.dynamic)
      set_dynamic_times(cluster, pdu, group);
    else
      set_static_times(cluster.flexray, group);
    list.push_back(group);
  }
  return list;
}

Macroticks slot_start(const model::GlobalParameters& g, int slot) {
  return {static_cast<std::int64_t>(slot - 1) * g.gdStaticSlot};
}

std::optional<SlotGap> shortest_slot_gap(const model::Cluster& cluster, PduId pdu) {
  const model::GlobalParameters& g = cluster.flexray;
  std::vector<std::int64_t> starts;
  SlotGap result;
  for (const SlotGroup& group : slot_groups(cluster, pdu)) {
    if (!group.bounded) return std::nullopt;
    for (std::int64_t cycle = group.base_cycle; cycle < cycles_per_round(g); cycle += group.repetition)
      starts.push_back(time_of(g, cycle, group.taken_from).ns);
    result.spread = std::max(result.spread, time_of(g, 0, group.complete_by) - time_of(g, 0, group.taken_from));
  }
  if (starts.empty()) return std::nullopt;
  std::sort(starts.begin(), starts.end());
  result.gap = result.longest = {starts.front() + time_of(g, cycles_per_round(g), Macroticks{0}).ns - starts.back()};
  for (std::size_t i = 1; i < starts.size(); ++i) {
    const Duration next{starts[i] - starts[i - 1]};
    result.gap = std::min(result.gap, next);
    result.longest = std::max(result.longest, next);
  }
  return result;
}

}  // namespace ttf::schedules::analysis
