#include "bus/can/confinement.h"

#include <algorithm>

#include "core/check.h"

namespace ttf::bus::can {
namespace {

using E = ConfinementEvent;
using S = CanState;

// Rules 9 to 11: the counters of a controller on the bus set its state.
Confinement judged(Confinement c) {
  const bool passive = c.transmit_errors >= kErrorPassiveFrom || c.receive_errors >= kErrorPassiveFrom;
  c.state = c.transmit_errors >= kBusOffFrom ? S::kBusOff : passive ? S::kPassive : S::kActive;
  return c;
}
Confinement receive_errors(Confinement c, int more) {
  c.receive_errors = std::min(c.receive_errors + more, kMostReceiveErrors);
  return judged(c);
}
Confinement transmit_errors(Confinement c, int more) {
  c.transmit_errors += more;
  return judged(c);
}

Confinement nothing(const Confinement& c) { return c; }
Confinement received_wrong(const Confinement& c) { return receive_errors(c, 1); }
Confinement receiver_by_8(const Confinement& c) { return receive_errors(c, 8); }
Confinement transmitter_by_8(const Confinement& c) { return transmit_errors(c, 8); }
Confinement sent(const Confinement& c) { return transmit_errors(c, c.transmit_errors > 0 ? -1 : 0); }
// From above 127 to a value between 119 and 127; here the highest.
Confinement received(const Confinement& c) {
  Confinement next = c;
  next.receive_errors =
      c.receive_errors >= kErrorPassiveFrom ? kErrorPassiveFrom - 1 : std::max(0, c.receive_errors - 1);
  return judged(next);
}
Confinement recovers(const Confinement& c) {
  if (c.sequences + 1 == kRecoverySequences) return {};
  Confinement next = c;
  ++next.sequences;
  return next;
}

struct Row {
  S state{};
  E event{};
  Confinement (*next)(const Confinement&);
};

constexpr std::array<Row, recording::records::kCanStates * kConfinementEvents> kTable{{
    {S::kActive, E::kReceiverError, received_wrong},
    {S::kActive, E::kReceiverOutlasted, receiver_by_8},
    {S::kActive, E::kTransmitterError, transmitter_by_8},
    {S::kActive, E::kLoneTransmitter, transmitter_by_8},  // the exception is for error-passive ones
    {S::kActive, E::kStuffBitOverwritten, nothing},
    {S::kActive, E::kTransmitterFlagError, transmitter_by_8},
    {S::kActive, E::kReceiverFlagError, receiver_by_8},
    {S::kActive, E::kTransmitterDominant, transmitter_by_8},
    {S::kActive, E::kReceiverDominant, receiver_by_8},
    {S::kActive, E::kSent, sent},
    {S::kActive, E::kReceived, received},
    {S::kActive, E::kElevenRecessive, nothing},
    {S::kPassive, E::kReceiverError, received_wrong},
    {S::kPassive, E::kReceiverOutlasted, receiver_by_8},
    {S::kPassive, E::kTransmitterError, transmitter_by_8},
    {S::kPassive, E::kLoneTransmitter, nothing},
    {S::kPassive, E::kStuffBitOverwritten, nothing},
    {S::kPassive, E::kTransmitterFlagError, transmitter_by_8},
    {S::kPassive, E::kReceiverFlagError, receiver_by_8},
    {S::kPassive, E::kTransmitterDominant, transmitter_by_8},
    {S::kPassive, E::kReceiverDominant, receiver_by_8},
    {S::kPassive, E::kSent, sent},
    {S::kPassive, E::kReceived, received},
    {S::kPassive, E::kElevenRecessive, nothing},
    {S::kBusOff, E::kReceiverError, nothing},
    {S::kBusOff, E::kReceiverOutlasted, nothing},
    {S::kBusOff, E::kTransmitterError, nothing},
    {S::kBusOff, E::kLoneTransmitter, nothing},
    {S::kBusOff, E::kStuffBitOverwritten, nothing},
    {S::kBusOff, E::kTransmitterFlagError, nothing},
    {S::kBusOff, E::kReceiverFlagError, nothing},
    {S::kBusOff, E::kTransmitterDominant, nothing},
    {S::kBusOff, E::kReceiverDominant, nothing},
    {S::kBusOff, E::kSent, nothing},
    {S::kBusOff, E::kReceived, nothing},
    {S::kBusOff, E::kElevenRecessive, recovers},
}};
constexpr std::size_t place_of(S state, E event) {
  return static_cast<std::size_t>(state) * kConfinementEvents + static_cast<std::size_t>(event);
}
constexpr bool is_in_order() {
  for (std::size_t row = 0; row < kTable.size(); ++row)
    if (place_of(kTable[row].state, kTable[row].event) != row || kTable[row].next == nullptr) return false;
  return true;
}
static_assert(is_in_order(), "a pair without a row, or rows in another order");

}  // namespace

Confinement step(const Confinement& now, ConfinementEvent event) {
  TTF_CHECK(event < E::kEnd, "event {}", static_cast<int>(event));
  return kTable[place_of(now.state, event)].next(now);
}

Confinement bus_off(const Confinement& now) {
  return {S::kBusOff, std::max(now.transmit_errors, kBusOffFrom), now.receive_errors, 0};
}

}  // namespace ttf::bus::can
