// What a logged frame's bytes say, for rooms that read logs and do not see the wire: the layout of a header is known to
// bus/wire alone.
#pragma once

#include "recording/records/records.h"

namespace ttf::recording::exports {

// Whether the header has the startup frame indicator; not where the log has less of the frame than its header.
bool is_startup_frame(const records::SlotFrameSent& frame);

}  // namespace ttf::recording::exports
