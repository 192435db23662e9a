// From the startup frames of a running cluster to a clock of one's own (FlexRay 2.1A, chapter 7.2.3 and 8.4:
// clock synchronisation startup; the state INITIALIZE_SCHEDULE).
//
// A startup frame of an even cycle fixes where the cluster's cycle stands, that of the same node in the odd
// cycle after it how long a cycle lasts in this node's microticks. Both channels are listened to; the first
// complete pair wins.
//
// Readings taken: the first startup frame of an even cycle is the one whose partner is waited for, on each
// channel by itself; a pair more than pRateCorrectionOut away from pMicroPerCycle is refused, and listening
// begins anew. Nothing is remembered of an attempt that failed: deriving begins "as soon as a valid startup frame has
// been received" (SPNU563A 26.2.6.7.4, 26.2.6.7.5), with the same node's again and again if it is the first to be heard
// (docs/fault_campaign.md says what that may cost).
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/time.h"
#include "schedules/model/cluster.h"

namespace ttf::bus::controller {

// A valid startup frame, as a node hears it that has no schedule yet.
struct StartupFrame {
  schedules::model::Channel channel{};
  int frame_id = 0;
  int cycle = 0;       // 0..63, from the frame
  Microticks start{};  // first bit of its TSS
};

// What it takes to set the clock going, in the middle of an odd cycle.
struct InitialSchedule {
  int frame_id = 0;          // of the node that is integrated on
  int cycle = 0;             // the odd cycle that is under way
  Microticks cycle_start{};  // when it began
  int rate = 0;              // rate correction in force [uT per cycle]
};

class ScheduleInitialisation {
 public:
  ScheduleInitialisation(const schedules::model::GlobalParameters& flexray,
                         const schedules::model::NodeParameters& node);

  void reset();
  std::optional<InitialSchedule> hear(const StartupFrame& frame);

 private:
  const schedules::model::GlobalParameters& flexray_;
  const schedules::model::NodeParameters& node_;
  std::array<std::optional<StartupFrame>, 2> even_;  // by channel
};

}  // namespace ttf::bus::controller
