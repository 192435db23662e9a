// A packing as a FlexRay bus: a cluster without tasks, and its FIBEX file with the signals in their frames.
//
// The static slots are as short as the payload allows. A dynamic segment without frames fills the rest of the cycle.
// The parameters of controllers follow from the largest drifts that FlexRay allows
// (schedules/exchange/fibex/assumptions.h). Three nodes start the cluster up and synchronise it.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/time.h"
#include "schedules/model/cluster.h"
#include "schedules/packing/frames.h"

namespace ttf::schedules::packing {

struct BusRequest {
  std::string name, file;  // the file is for messages
  Duration cycle;
  int slots = 0;                      // static slots, at least those with frames
  std::map<int, int> key_slots = {};  // by node; without an entry, the node's lowest one
  std::set<int> starters = {};        // none: starters_of() these frames
};

// Returns the nodes that start up the vehicles of several variants, each with its frames: in each vehicle three or
// more, or all its nodes. A node has the same role in all of them. Those of many vehicles come first, then those of low
// numbers.
std::set<int> starters_of(const std::vector<std::vector<PackedFrame>>& vehicles);

// Returns the bus of these frames, in their order. Each of their nodes needs a key slot (frames.h). All slots are on
// the same channels, and numbered from 1. Throws InputError if the slots do not fit the cycle, or the cycle is no whole
// number of microseconds.
model::Cluster bus_of(const Instance& instance, const std::vector<PackedFrame>& frames, const BusRequest& request);

// Returns the FIBEX 3.1 file of that bus. Each frame with signals is a PDU, and bit 0 of it is the most significant one
// of byte 0.
std::string bus_fibex(const Instance& instance, const Assignment& assignment, const std::vector<PackedFrame>& frames,
                      const model::Cluster& bus);

}  // namespace ttf::schedules::packing
