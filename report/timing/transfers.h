// The frames of one list on one medium, as one box. A list differs from others by its PDU, its number, and a
// gap in time after which numbers repeat.
#pragma once

#include <cstdint>
#include <vector>

#include "report/timing/data.h"
#include "report/timing/ways.h"

namespace ttf::report::timing {

struct Transfer {
  LaneKey lane;
  TrueTime start{}, end{};
  PduId pdu = kNoPdu;
  std::uint32_t sequence = 0;
};
std::vector<Transfer> transfers_of(const TimingData& data);

}  // namespace ttf::report::timing
