// The schedule initialisation derives a clock from the startup frames of a running cluster (FlexRay 2.1A,
// chapters 7.2.3 and 8.4: clock synchronisation startup; the state INITIALIZE_SCHEDULE).
//
// A startup frame of an even cycle fixes the position of the cluster's cycle. The same node's startup frame in
// the next odd cycle gives the length of a cycle in this node's microticks. The node listens to both channels;
// the first complete pair wins.
//
// Interpretation: on each channel the node waits for the partner of the first startup frame of an even cycle.
// A pair more than pRateCorrectionOut away from pMicroPerCycle is refused, and listening begins anew. A failed
// attempt leaves no trace: deriving begins "as soon as a valid startup frame has been received" (SPNU563A
// 26.2.6.7.4, 26.2.6.7.5). So the same node may be tried again and again if it is received first
// (docs/results/fault_findings.md shows the possible cost).
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/time.h"
#include "schedules/model/cluster.h"

namespace ttf::bus::controller {

// A valid startup frame, as received by a node without a schedule.
struct StartupFrame {
  schedules::model::Channel channel{};
  int frame_id = 0;
  int cycle = 0;       // 0..63, from the frame
  Microticks start{};  // first bit of its TSS
};

// The data that start the clock in the middle of an odd cycle.
struct InitialSchedule {
  int frame_id = 0;          // identifies the node whose schedule is taken
  int cycle = 0;             // the running odd cycle
  Microticks cycle_start{};  // when that cycle began
  int rate = 0;              // rate correction in force [uT per cycle]
};

class ScheduleInitialisation {
 public:
  ScheduleInitialisation(const schedules::model::GlobalParameters& flexray,
                         const schedules::model::NodeParameters& node);

  void reset();
  std::optional<InitialSchedule> receive(const StartupFrame& frame);

 private:
  const schedules::model::GlobalParameters& flexray_;
  const schedules::model::NodeParameters& node_;
  std::array<std::optional<StartupFrame>, 2> even_;  // by channel
};

}  // namespace ttf::bus::controller
