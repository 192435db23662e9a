#include "recording/exports/can_error_bytes.h"

#include <algorithm>

#include "recording/capture/packet.h"

namespace ttf::recording::exports {
namespace {

// Classes, in the identifier.
constexpr std::uint32_t kController = 0x4, kProtocol = 0x8, kAcknowledgement = 0x20, kBusOff = 0x40, kBusError = 0x80,
                        kRestarted = 0x100, kCounters = 0x200;
// Bytes of the data, and their values.
constexpr std::size_t kControllerByte = 1, kKindByte = 2, kPlaceByte = 3, kTransmitByte = 6, kReceiveByte = 7;
constexpr unsigned kReceivePassive = 0x10, kTransmitPassive = 0x20, kActive = 0x40;
constexpr unsigned kBit = 0x1, kForm = 0x2, kStuff = 0x4, kInTransmission = 0x80;
constexpr unsigned kCrcSequence = 0x08, kAcknowledgementSlot = 0x19;
constexpr unsigned kErrorPassiveFrom = 128;

std::byte byte_of(unsigned value) { return static_cast<std::byte>(std::min(value, 255u)); }

CanErrorBytes with_counters(std::uint32_t classes, unsigned transmit_errors, unsigned receive_errors) {
  CanErrorBytes bytes;
  bytes.identifier = capture::kErrorFrame | classes | kCounters;
  bytes.data[kTransmitByte] = byte_of(transmit_errors);
  bytes.data[kReceiveByte] = byte_of(receive_errors);
  return bytes;
}

}  // namespace

CanErrorBytes error_bytes_of(const records::CanErrorFrame& error) {
  const bool unanswered = error.error == records::CanError::kAcknowledgement;
  CanErrorBytes bytes = with_counters(kProtocol | kBusError | (unanswered ? kAcknowledgement : 0),
                                      error.transmit_errors, error.receive_errors);
  unsigned kind = error.as_transmitter ? kInTransmission : 0, place = 0;
  switch (error.error) {
    case records::CanError::kBit: kind |= kBit; break;
    case records::CanError::kStuff: kind |= kStuff; break;
    case records::CanError::kForm: kind |= kForm; break;
    case records::CanError::kCrc: place = kCrcSequence; break;
    case records::CanError::kAcknowledgement: place = kAcknowledgementSlot; break;
    case records::CanError::kNone: break;
  }
  bytes.data[kKindByte] = byte_of(kind);
  bytes.data[kPlaceByte] = byte_of(place);
  return bytes;
}

CanErrorBytes error_bytes_of(const records::CanStateChanged& change) {
  if (change.to == records::CanState::kBusOff)
    return with_counters(kBusOff, change.transmit_errors, change.receive_errors);
  const bool restarted = change.from == records::CanState::kBusOff;
  CanErrorBytes bytes =
      with_counters(restarted ? kRestarted : kController, change.transmit_errors, change.receive_errors);
  if (restarted) return bytes;
  const unsigned passive = change.transmit_errors >= kErrorPassiveFrom ? kTransmitPassive : kReceivePassive;
  bytes.data[kControllerByte] = byte_of(change.to == records::CanState::kPassive ? passive : kActive);
  return bytes;
}

}  // namespace ttf::recording::exports
