// The records that the start-up diagram keeps: plain values without views, in the order of arrival.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "report/drawing/fault_lanes.h"

namespace ttf::report::startup {

struct StartupData {
  struct Change {
    TrueTime at;
    NodeId node;
    std::uint8_t from, to;  // E-Ray CCSV.POCS
    std::string from_name, to_name, why, consequence;
  };
  struct Power {
    TrueTime at;
    NodeId node;
    bool on;
  };
  struct Symbol {
    TrueTime start, end;
    NodeId node;
    std::uint8_t channel, kind;
  };
  struct Frame {
    TrueTime start, end;
    NodeId node;
    std::int64_t cycle;
    std::uint16_t slot;
    std::uint8_t channel;
    bool null_frame, startup;
  };

  std::vector<Change> changes;              // from the whole log: a state lasts until it is left
  std::vector<Power> power;                 // likewise
  std::vector<drawing::FaultEvent> faults;  // likewise
  std::vector<Symbol> symbols;              // up to the window's end: the cycles count from one of them
  std::vector<Frame> frames;                // likewise
};

// States that the picture and the leading node's cycles depend on.
inline constexpr std::uint8_t kStateDefaultConfig = 0x00, kStateReady = 0x01, kStateNormalActive = 0x02,
                              kStateNormalPassive = 0x03, kStateHalt = 0x04, kStateConfig = 0x0F,
                              kStateWakeupListen = 0x11, kStateWakeupSend = 0x12, kStateWakeupDetect = 0x13,
                              kStateColdstartListen = 0x21, kStateCollisionResolution = 0x22,
                              kStateConsistencyCheck = 0x23, kStateColdstartGap = 0x24, kStateColdstartJoin = 0x25,
                              kStateIntegrationColdstartCheck = 0x26, kStateIntegrationListen = 0x27,
                              kStateIntegrationConsistencyCheck = 0x28, kStateInitialiseSchedule = 0x29;

}  // namespace ttf::report::startup
