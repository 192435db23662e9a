// Reads a logged frame's bytes for rooms that read logs and do not see the wire: only bus/wire knows a header's
// layout.
#pragma once

#include "recording/records/records.h"

namespace ttf::recording::exports {

// Returns whether the header has the startup frame indicator; false if the log lacks the whole header.
bool is_startup_frame(const records::SlotFrameSent& frame);

}  // namespace ttf::recording::exports
