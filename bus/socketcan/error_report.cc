#include "bus/socketcan/error_report.h"

#include <linux/can/error.h>

#include "recording/records/records.h"

namespace ttf::bus::socketcan {
namespace {

using recording::records::CanError;
using recording::records::CanState;

// Older kernels' headers lack it: the frame has both error counters.
constexpr canid_t kHasCounters = 0x200U;
constexpr std::size_t kController = 1, kProtocol = 2, kLocation = 3, kTransmitErrors = 6, kReceiveErrors = 7;

CanError error_of(const canfd_frame& can) {
  if ((can.can_id & CAN_ERR_ACK) != 0) return CanError::kAcknowledgement;
  if ((can.can_id & CAN_ERR_PROT) == 0) return CanError::kNone;
  const unsigned kind = can.data[kProtocol];
  if ((kind & CAN_ERR_PROT_STUFF) != 0) return CanError::kStuff;
  if ((kind & CAN_ERR_PROT_FORM) != 0) return CanError::kForm;
  if (can.data[kLocation] == CAN_ERR_PROT_LOC_CRC_SEQ) return CanError::kCrc;
  if (can.data[kLocation] == CAN_ERR_PROT_LOC_ACK) return CanError::kAcknowledgement;
  if ((kind & (CAN_ERR_PROT_BIT | CAN_ERR_PROT_BIT0 | CAN_ERR_PROT_BIT1)) != 0) return CanError::kBit;
  return CanError::kNone;
}

std::optional<CanState> state_of(const canfd_frame& can) {
  if ((can.can_id & CAN_ERR_BUSOFF) != 0) return CanState::kBusOff;
  if ((can.can_id & CAN_ERR_RESTARTED) != 0) return CanState::kActive;
  if ((can.can_id & CAN_ERR_CRTL) == 0) return std::nullopt;
  const unsigned controller = can.data[kController];
  if ((controller & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) != 0) return CanState::kPassive;
  // Warnings are of an error-active controller.
  if ((controller & (CAN_ERR_CRTL_ACTIVE | CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING)) != 0)
    return CanState::kActive;
  return std::nullopt;
}

}  // namespace

std::optional<ports::CanReport> error_report_of(const canfd_frame& can) {
  if ((can.can_id & CAN_ERR_FLAG) == 0) return std::nullopt;
  ports::CanReport report;
  report.error = error_of(can);
  report.as_transmitter = report.error == CanError::kAcknowledgement ||
                          ((can.can_id & CAN_ERR_PROT) != 0 && (can.data[kProtocol] & CAN_ERR_PROT_TX) != 0);
  report.state = state_of(can);
  if (report.error == CanError::kNone && !report.state) return std::nullopt;
  if ((can.can_id & kHasCounters) != 0) {
    report.transmit_errors = can.data[kTransmitErrors];
    report.receive_errors = can.data[kReceiveErrors];
  }
  return report;
}

}  // namespace ttf::bus::socketcan
