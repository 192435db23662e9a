// Whether a schedule holds where its frames travel on real CAN FD hardware, which is slower than FlexRay: as
// flexray_on_can.h maps them, one CAN for each channel, at worst (schedules/analysis/can_load.h: as many stuff bits as
// there can be). Only bits are counted; what controllers and drivers take comes on top.
//
//   static slots    the sync frame of a key slot and its follow-up, or a frame of gPayloadLengthStatic, must take no
//                   longer than a static slot: from action point to action point
//   dynamic slots   each frame no longer than the minislots that its length takes (schedules/analysis/minislots.h)
//
// What begins at its action point and holds has left the bus before the next action point. What does not hold delays
// those behind it, and is delayed: nothing is lost by it, but arrival windows may be missed.
#pragma once

#include <cstdint>
#include <vector>

#include "core/time.h"
#include "schedules/model/cluster.h"

namespace ttf::bus::socketcan {

struct BitRates {
  std::int64_t nominal = 0, data = 0;  // bit/s; data at least nominal
};

// The frames of one slot that have the same room.
struct SlotOnCan {
  int slot = 0;
  schedules::model::Channels channels{};  // all that such a frame is sent on
  bool dynamic = false;
  int can_frames = 0;  // of the longest, its follow-up included
  Duration frame{};    // the longest without its follow-up, rounded up
  Duration needs{};    // with it
  Duration has{};      // as scheduled, rounded down

  bool holds(std::int64_t time_scale_ppm) const;
};

// Ordered by slot, then room. The cluster must have passed check().
std::vector<SlotOnCan> slots_on_can(const schedules::model::Cluster& cluster, BitRates rates);

// At which all of them hold, in parts per million; it may be beyond schedules::kLargestTimeScale.
std::int64_t smallest_time_scale(const std::vector<SlotOnCan>& slots);

}  // namespace ttf::bus::socketcan
