// Reads a logged frame's header for modules that do not include bus/wire.
#pragma once

#include "recording/records/records.h"

namespace ttf::recording::exports {

// Returns whether the header has the startup frame indicator; false if the log lacks the whole header.
bool is_startup_frame(const records::SlotFrameSent& frame);

}  // namespace ttf::recording::exports
