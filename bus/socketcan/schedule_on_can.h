// Checks whether a schedule holds on real CAN FD hardware, which is slower than FlexRay. Each channel has one
// CAN; the frames are those of flexray_on_can.h, with as many stuff bits as possible
// (schedules/analysis/can_load.h). Only bits count; the delays of controllers and drivers come on top.
//
//   static slots    the sync frame of a key slot with its follow-up, or a frame of gPayloadLengthStatic, must take no
//                   longer than a static slot: from action point to action point
//   dynamic slots   each frame must take no longer than the minislots of its length (schedules/analysis/minislots.h)
//
// A frame that begins at its action point and holds has left the bus before the next action point. A frame that
// does not hold delays the frames after it. No frame is lost by it, but arrival windows may be missed.
#pragma once

#include <cstdint>
#include <vector>

#include "core/time.h"
#include "schedules/model/cluster.h"

namespace ttf::bus::socketcan {

struct BitRates {
  std::int64_t nominal = 0, data = 0;  // bit/s; data at least nominal
};

// The frames of one slot with the same room.
struct SlotOnCan {
  int slot = 0;
  schedules::model::Channels channels{};  // all channels on which such a frame is sent
  bool dynamic = false;
  int can_frames = 0;  // for the longest frame, its follow-up included
  Duration frame{};    // the longest frame without its follow-up, rounded up
  Duration needs{};    // the longest frame with its follow-up
  Duration has{};      // as scheduled, rounded down

  bool holds(std::int64_t time_scale_ppm) const;
};

// Returns slots ordered by number, then room. The cluster must have passed check().
std::vector<SlotOnCan> slots_on_can(const schedules::model::Cluster& cluster, BitRates rates);

// Returns the smallest time scale [ppm] at which all slots hold; it may exceed schedules::kLargestTimeScale.
std::int64_t smallest_time_scale(const std::vector<SlotOnCan>& slots);

}  // namespace ttf::bus::socketcan
