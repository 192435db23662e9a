#include "recording/exports/logged_frame.h"

#include "bus/wire/flexray_frame.h"

namespace ttf::recording::exports {

bool is_startup_frame(const records::SlotFrameSent& frame) {
  const auto header = bus::wire::header_of(frame.bytes);
  return header && header->startup;
}

}  // namespace ttf::recording::exports
