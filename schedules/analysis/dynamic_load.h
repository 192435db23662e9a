// The load of the dynamic segment when all dynamic frames of a cycle are sent.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::analysis {

// The fullest cycle of one channel.
struct DynamicLoad {
  model::Channel channel{};
  std::int64_t minislots = 0;  // to the end of the last frame, with idle phase and unused slots before it; 0: no frames
  double share = 0.0;          // part of gNumberOfMinislots; above one: not all frames fit
};

// A row of slots with one list's fragments, or one slot without a PDU, and the turns of these slots.
struct DynamicList {
  PduId pdu{};
  NodeId sender{};
  model::Channels channels = model::Channels::kAB;
  int first_slot = 0, last_slot = 0;
  int first_fragment = 0, last_fragment = 0;
  int base_cycle = 0, repetition = 1;
  std::int64_t minislots_each = 0;  // idle phase included
  std::int64_t earliest_turn = 0,
               latest_turn = 0;  // minislots: earliest turn of the first slot, latest of the last
  bool always_in_time = true;    // its turn always comes in its cycle; otherwise it may wait for later cycles
  // The longest time from the end of the task that writes it to the end of its last frame. If its turn may be too late, it
  // is bounded by theory (schedules/timing/response/flexray_dynamic.h). None: the frames of lower slots can keep it
  // waiting without end, or theory does not apply. Where it is not known how often a list is written, or it is written
  // more often than sent, each of its cycles counts.
  std::optional<Duration> sent_within = Duration{};
  bool theory_applies = true;  // all repetitions on its channels are powers of two
};

// Return both channels, and the lists in slot order. The cluster must have passed check().
std::vector<DynamicLoad> dynamic_load(const model::Cluster& cluster);
std::vector<DynamicList> dynamic_lists(const model::Cluster& cluster);

// Returns both as a table for people; empty if the dynamic segment is unused.
std::string dynamic_text(const model::Cluster& cluster);

}  // namespace ttf::schedules::analysis
