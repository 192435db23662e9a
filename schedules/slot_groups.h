// A list's slots on FlexRay, cycle by cycle.
#pragma once

#include <optional>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "schedules/cluster.h"

namespace ttf::schedules {

// The slots of one list in the cycles of one base and repetition.
struct SlotGroup {
  int base_cycle = 0, repetition = 1;
  int first = 0, last = 0;       // slots
  int first_fragment = 0;        // slot of fragment 0
};

// By base cycle and repetition; empty for a PDU that is not on FlexRay.
std::vector<SlotGroup> slot_groups(const Cluster& cluster, PduId pdu);

// Macrotick at which a slot (1..) begins.
Macroticks slot_start(const GlobalParameters& flexray, int slot);

// The shortest time between the beginnings of two sendings of a PDU, over all 64 cycles, and how much later than its beginning
// one can be complete. Nothing if it has no slots.
struct SlotGap {
  Duration gap{};
  Duration spread{};
};
std::optional<SlotGap> shortest_slot_gap(const Cluster& cluster, PduId pdu);

}  // namespace ttf::schedules
