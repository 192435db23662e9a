// How many objects a cluster can be about: an object that is followed is in every list on FlexRay, those of the sensors
// and the image, each of which is cut into fragments of so many objects, a slot for each.
#pragma once

#include <vector>

#include "schedules/model/cluster.h"

namespace ttf::schedules::analysis {

// A list on FlexRay: what it has room for.
struct ListRoom {
  PduId pdu{};
  int slots = 0;      // with a fragment of its own
  int objects = 0;    // as the list is said to have at most, and as many as its slots carry
  int countable = 0;  // that its header can count and number the fragments of
};

struct ObjectCeiling {
  std::vector<ListRoom> lists;  // in the order of their slots
  int carried = 0;              // the fewest objects of any list: as the cluster is
  // The most, if all static slots but those of status frames were shared out among the same lists, each still with
  // slots of its own: the largest n with sum of ceil(n / objects in a fragment) <= slots, and not more than headers can
  // count. Dynamic lists counted in as if they were static. What CANs, tasks and ages then say is the checker's
  // business. Not fewer than are carried: lists that take turns in the same slots, or are dealt out to both channels,
  // do better than that.
  int with_all_static_slots = 0;
  int free_for_lists = 0;  // static slots without status frames
};

// Of a cluster with lists of any number of objects on FlexRay; all zero without.
ObjectCeiling object_ceiling(const model::Cluster& cluster);

}  // namespace ttf::schedules::analysis
