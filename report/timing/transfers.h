// Frames of one list on one medium as one box. A list is told from others by its PDU, its number, and a gap in time
// where the same numbers come round again.
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
