// The records that the start-up diagram keeps, in the order of arrival. A record with views has a struct of its own here, which
// holds its values.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "recording/records/records.h"
#include "report/drawing/fault_lanes.h"

namespace ttf::report::startup {

struct StartupData {
  struct Change {
    TrueTime at;
    NodeId node;
    recording::records::PocKind from, to;
    std::string from_name, to_name, why, consequence;
  };
  struct Frame {
    TrueTime start, end;
    NodeId node;
    std::int64_t cycle;
    std::uint16_t slot;
    std::uint8_t channel;
    bool null_frame, startup;
  };

  std::vector<Change> changes;                          // from the whole log: a state lasts until it is left
  std::vector<recording::records::PowerChanged> power;  // likewise
  std::vector<drawing::FaultEvent> faults;              // likewise
  std::vector<recording::records::SymbolSent> symbols;  // up to the window's end: the cycles count from one of them
  std::vector<Frame> frames;                            // likewise
};

}  // namespace ttf::report::startup
