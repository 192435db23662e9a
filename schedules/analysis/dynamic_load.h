// How full the dynamic segment can get: what a cluster's dynamic frames take of it when all of them are sent in one
// cycle.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/ids.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::analysis {

// The fullest cycle of one channel.
struct DynamicLoad {
  model::Channel channel{};
  std::int64_t minislots =
      0;               // to the end of the last frame, idle phase and unused slots before it included; 0: no frames
  double share = 0.0;  // of gNumberOfMinislots; above one: not all of them fit
};

// A row of slots that carry one list's fragments, and when they may be sent.
struct DynamicList {
  PduId pdu{};
  NodeId sender{};
  model::Channels channels = model::Channels::kAB;
  int first_slot = 0, last_slot = 0;
  int first_fragment = 0, last_fragment = 0;
  int base_cycle = 0, repetition = 1;
  std::int64_t minislots_each = 0;  // idle phase included
  std::int64_t earliest_turn = 0,
               latest_turn = 0;  // minislots: of the first slot at the earliest, of the last at the latest
  bool always_in_time = true;    // in its cycle, whatever the others send; else it may have to wait for later ones
};

// Both channels; in slot order. The cluster must have passed check().
std::vector<DynamicLoad> dynamic_load(const model::Cluster& cluster);
std::vector<DynamicList> dynamic_lists(const model::Cluster& cluster);

// Both as a table for people; empty where nothing is sent in the dynamic segment.
std::string dynamic_text(const model::Cluster& cluster);

}  // namespace ttf::schedules::analysis
