// A list's slots on FlexRay, cycle by cycle.
#pragma once

#include <optional>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::analysis {

// The slots of one list in the cycles of one base and repetition, and when in a cycle a list goes out.
struct SlotGroup {
  int base_cycle = 0, repetition = 1;
  int first = 0, last = 0;  // slots
  int first_fragment = 0;   // slot of fragment 0
  bool dynamic = false;
  // The controller takes the newest list at the action point of the first slot: at the earliest and at the latest then,
  // as macroticks of the cycle. In the static segment `taken_from` is the slot's beginning, which is on the safe side.
  Macroticks taken_from{}, taken_by{};
  Macroticks complete_by{};  // the end of the last fragment's slot; in the dynamic segment with all slots in use
  // Sent whole in the cycle it is taken in. Of a dynamic list that may have to wait for later cycles this is not so,
  // and the times above are none.
  bool bounded = true;
};

// By base cycle and repetition; empty for a PDU that is not on FlexRay.
std::vector<SlotGroup> slot_groups(const model::Cluster& cluster, PduId pdu);

// Macrotick at which a static slot (1..) begins.
Macroticks slot_start(const model::GlobalParameters& flexray, int slot);

// The shortest and the longest time between the beginnings of two sendings of a PDU that follow each other, over all 64
// cycles, and how much later than its beginning one can be complete. Nothing if it has no slots, or if some sending has
// no bound.
struct SlotGap {
  Duration gap{};
  Duration longest{};
  Duration spread{};
};
std::optional<SlotGap> shortest_slot_gap(const model::Cluster& cluster, PduId pdu);

}  // namespace ttf::schedules::analysis
