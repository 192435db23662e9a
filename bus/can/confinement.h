// Error confinement of a CAN controller as a pure step: two error counters, three states (ISO 11898-1:2015, 12.1;
// Bosch CAN Specification 2.0, part B, chapter 8, whose rule numbers stand at the events).
//
// Error active: the controller sends active error flags. Error passive, from 128 of either counter on: its flags
// are recessive, and after a frame of its own it waits longer. Bus off, from 256 transmit errors on: it has no
// effect on the bus. It recovers by itself, with both counters 0, after 128 sequences of 11 recessive bits
// (rule 12).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "recording/records/enumerations.h"

namespace ttf::bus::can {

using recording::records::CanState;

enum class ConfinementEvent : std::uint8_t {
  kReceiverError,         // 1: a receiver detected an error, not a bit error in a flag of its own
  kReceiverOutlasted,     // 2: a receiver's first bit behind its error flag is dominant
  kTransmitterError,      // 3: a transmitter begins an error flag
  kLoneTransmitter,       // 3, exception 1: error passive, no acknowledgement, and no dominant bit during its flag
  kStuffBitOverwritten,   // 3, exception 2: a recessive stuff bit in the arbitration was overwritten
  kTransmitterFlagError,  // 4: a transmitter's bit error in its active error flag or overload flag
  kReceiverFlagError,     // 5: the same of a receiver
  kTransmitterDominant,   // 6: a transmitter saw eight more dominant bits behind a flag
  kReceiverDominant,      // 6: the same of a receiver
  kSent,                  // 7
  kReceived,              // 8
  kElevenRecessive,       // 12: eleven recessive bits one after the other, counted anew after each
  kEnd,                   // not an event: their number
};
inline constexpr std::size_t kConfinementEvents = static_cast<std::size_t>(ConfinementEvent::kEnd);

inline constexpr int kErrorPassiveFrom = 128;
inline constexpr int kBusOffFrom = 256;
inline constexpr int kMostReceiveErrors = 255;  // an eight-bit register; all from 128 on mean the same
inline constexpr int kRecoverySequences = 128;

struct Confinement {
  CanState state = CanState::kActive;
  int transmit_errors = 0;  // bus off: at least 256
  int receive_errors = 0;   // 0..255
  int sequences = 0;        // bus off: of eleven recessive bits so far

  bool operator==(const Confinement&) const = default;
};

// Returns the state after the event. Every pair of state and event has a row (confinement.cc).
Confinement step(const Confinement& now, ConfinementEvent event);

// Returns a controller that is bus off from now on, whatever it was.
Confinement bus_off(const Confinement& now);

}  // namespace ttf::bus::can
