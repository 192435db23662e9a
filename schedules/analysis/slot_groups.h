// A list's slots on FlexRay, cycle by cycle.
#pragma once

#include <optional>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::analysis {

// The slots of one list in the cycles of one base and repetition, and its sending times in a cycle.
struct SlotGroup {
  int base_cycle = 0, repetition = 1;
  int first = 0, last = 0;  // slots
  int first_fragment = 0;   // slot of fragment 0
  bool dynamic = false;
  // The earliest and latest action point of the first slot, when the controller takes the newest list, as
  // macroticks of the cycle. In the static segment `taken_from` is the slot's beginning, which is safe.
  Macroticks taken_from{}, taken_by{};
  Macroticks complete_by{};  // end of the last fragment's slot; in the dynamic segment with all slots in use
  // The list is sent whole in the cycle in which it is taken. False for a dynamic list that may wait for later
  // cycles; the times above are then invalid.
  bool bounded = true;
};

// Returns the groups by base cycle and repetition; empty for a PDU that is not on FlexRay.
std::vector<SlotGroup> slot_groups(const model::Cluster& cluster, PduId pdu);

// Returns the macrotick at which a static slot (1..) begins.
Macroticks slot_start(const model::GlobalParameters& flexray, int slot);

// The shortest and longest time between the beginnings of two successive sendings of a PDU, and the longest
// duration of one, over all cycles of a round. Absent if the PDU has no slots, or if some sending has no bound.
struct SlotGap {
  Duration gap{};
  Duration longest{};
  Duration spread{};
};
std::optional<SlotGap> shortest_slot_gap(const model::Cluster& cluster, PduId pdu);

}  // namespace ttf::schedules::analysis
