#include "schedules/slot_groups.h"

#include <algorithm>
#include <map>
#include <utility>

#include "schedules/round.h"

namespace ttf::schedules {

std::vector<SlotGroup> slot_groups(const Cluster& cluster, PduId pdu) {
  std::map<std::pair<int, int>, SlotGroup> groups;
  for (const FrameSlot& frame : cluster.frames) {
    if (frame.pdu != pdu) continue;
    const auto [entry, fresh] = groups.try_emplace({frame.base_cycle, frame.repetition},
                                                   SlotGroup{frame.base_cycle, frame.repetition, frame.slot, frame.slot,
                                                             frame.slot});
    SlotGroup& group = entry->second;
    group.first = std::min(group.first, frame.slot);
    group.last = std::max(group.last, frame.slot);
    if (frame.fragment == 0) group.first_fragment = frame.slot;
  }
  std::vector<SlotGroup> list;
  for (const auto& [cycles, group] : groups) list.push_back(group);
  return list;
}

Macroticks slot_start(const GlobalParameters& g, int slot) {
  return {static_cast<std::int64_t>(slot - 1) * g.gdStaticSlot};
}

std::optional<SlotGap> shortest_slot_gap(const Cluster& cluster, PduId pdu) {
  const GlobalParameters& g = cluster.flexray;
  std::vector<std::int64_t> starts;
  SlotGap result;
  for (const SlotGroup& group : slot_groups(cluster, pdu)) {
    for (std::int64_t cycle = group.base_cycle; cycle < kCycles; cycle += group.repetition)
      starts.push_back(time_of(g, cycle, slot_start(g, group.first)).ns);
    const GlobalTime first = time_of(g, 0, slot_start(g, group.first)), end = time_of(g, 0, slot_start(g, group.last + 1));
    result.spread = std::max(result.spread, end - first);
  }
  if (starts.empty()) return std::nullopt;
  std::sort(starts.begin(), starts.end());
  result.gap = {starts.front() + time_of(g, kCycles, Macroticks{0}).ns - starts.back()};
  for (std::size_t i = 1; i < starts.size(); ++i) result.gap = std::min(result.gap, Duration{starts[i] - starts[i - 1]});
  return result;
}

}  // namespace ttf::schedules
