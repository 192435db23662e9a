// The largest number of objects that a cluster can follow. Each followed object is in every list on FlexRay,
// those of the sensors and the image. A list is cut into fragments of some objects each, one slot per fragment.
#pragma once

#include <vector>

#include "schedules/model/cluster.h"

namespace ttf::schedules::analysis {

// The capacity of a list on FlexRay.
struct ListRoom {
  PduId pdu{};
  int slots = 0;      // one per fragment
  int objects = 0;    // the smaller of the list's maximum and the capacity of its slots
  int countable = 0;  // limit by the bits of its header for counts and fragment numbers
};

struct ObjectCeiling {
  std::vector<ListRoom> lists;  // in the order of their slots
  int carried = 0;              // the fewest objects of any list, in the cluster as it is
  // The most objects if these lists shared all static slots but those of status frames, each with slots of its
  // own. It is the largest n with sum of ceil(n / objects in a fragment) <= slots, and at most as many as the
  // headers can count. Dynamic lists count as static. The checker judges the effect on CANs, tasks and ages. The
  // value is at least `carried`: lists that take turns in the same slots, or are split between both channels,
  // carry more than this formula.
  int with_all_static_slots = 0;
  int free_for_lists = 0;  // static slots without those of status frames
};

// Returns the ceiling of a cluster; all zero if no list of objects is on FlexRay.
ObjectCeiling object_ceiling(const model::Cluster& cluster);

}  // namespace ttf::schedules::analysis
