// The reports of a CAN interface about its bus, as the kernel's drivers make them: frames with CAN_ERR_FLAG
// (linux/can/error.h). Interfaces of hardware send them, vcan passes on those that a process writes.
#pragma once

#include <linux/can.h>

#include <optional>

#include "bus/ports/live_medium.h"

namespace ttf::bus::socketcan {

// Returns an error frame's error, or the controller's new state, or both. Nothing for other frames, and for reports about
// something else: a lost arbitration, the transceiver, an overflow. A warning is of an error-active controller.
std::optional<ports::CanReport> error_report_of(const canfd_frame& can);

}  // namespace ttf::bus::socketcan
