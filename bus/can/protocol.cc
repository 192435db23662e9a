#include "bus/can/protocol.h"

#include "core/check.h"

namespace ttf::bus::can {
namespace {

constexpr int kFlagBits = 6;
constexpr int kDelimiterBits = 8;
constexpr int kIntermissionBits = 3;
constexpr int kSuspendBits = 8;
constexpr int kSequenceBits = 11;  // recessive ones, of a bus without traffic
constexpr int kDominantBits = 8;   // behind a flag, until they count as an error

using E = ConfinementEvent;

}  // namespace

void Protocol::become(Phase phase) {
  phase_ = phase;
  count_ = 0;
  drives_ = true;
}

void Protocol::power_on(bool integrated) {
  confinement_ = {};
  transmitter_ = false;
  become(integrated ? Phase::kIdle : Phase::kIntegrating);
}

void Protocol::hold_off() {
  confinement_ = bus_off(confinement_);
  become(Phase::kOff);
}

void Protocol::release() {
  TTF_CHECK(phase_ == Phase::kOff && confinement_.state == CanState::kBusOff, "released in phase {}",
            static_cast<int>(phase_));
  become(Phase::kBusOff);
}

bool Protocol::waits() const {
  switch (phase_) {
    case Phase::kIntegrating:
    case Phase::kIdle:
    case Phase::kIntermission:
    case Phase::kSuspend:
    case Phase::kBusOff: return true;
    case Phase::kOff:
    case Phase::kFrame:
    case Phase::kActiveFlag:
    case Phase::kPassiveFlag:
    case Phase::kBehindFlag:
    case Phase::kDelimiter: return false;
  }
  TTF_CHECK(false, "phase {}", static_cast<int>(phase_));
}

bool Protocol::endures_dominance() const {
  if (phase_ == Phase::kBehindFlag)
    return !transmitter_ && count_ > 0 && confinement_.receive_errors == kMostReceiveErrors;
  return phase_ == Phase::kOff || phase_ == Phase::kIntegrating || phase_ == Phase::kBusOff;
}

void Protocol::start(const FrameBits& frame) {
  TTF_CHECK(phase_ == Phase::kIdle, "a frame starts in phase {}", static_cast<int>(phase_));
  become(Phase::kFrame);
  frame_ = frame;
  bit_ = 0;
  transmitter_ = true;
  decoder_.begin(flexible_data_rate_);
  drive_next();
}

// The bit that is over was another's start of frame.
void Protocol::receive_start() {
  become(Phase::kFrame);
  transmitter_ = false;
  decoder_.begin(flexible_data_rate_);
  (void)decoder_.take(false);
}

void Protocol::drive_next() {
  drives_ = transmitter_ ? frame_[bit_].recessive : !(acknowledging_ && decoder_.acknowledges());
}

void Protocol::count(ConfinementEvent of_transmitter, ConfinementEvent of_receiver) {
  confinement_ = step(confinement_, transmitter_ ? of_transmitter : of_receiver);
  if (confinement_.state == CanState::kBusOff) become(Phase::kBusOff);
}

Protocol::Brought Protocol::end_of_bit(bool recessive) {
  switch (phase_) {
    case Phase::kOff: return {};
    case Phase::kIntegrating:
      count_ = recessive ? count_ + 1 : 0;
      if (count_ == kSequenceBits) become(Phase::kIdle);
      return {};
    case Phase::kIdle:
      if (!recessive) receive_start();
      return {};
    case Phase::kFrame: return frame_bit(recessive);
    case Phase::kActiveFlag: return active_flag_bit(recessive), Brought{};
    case Phase::kPassiveFlag: return passive_flag_bit(recessive), Brought{};
    case Phase::kBehindFlag: return behind_flag_bit(recessive), Brought{};
    case Phase::kDelimiter: return delimiter_bit(recessive);
    case Phase::kIntermission: return intermission_bit(recessive), Brought{};
    case Phase::kSuspend:
      if (!recessive)
        receive_start();
      else if (++count_ == kSuspendBits)
        become(Phase::kIdle);
      return {};
    case Phase::kBusOff: return bus_off_bit(recessive), Brought{};
  }
  TTF_CHECK(false, "phase {}", static_cast<int>(phase_));
}

void Protocol::pass_by() {
  switch (phase_) {
    case Phase::kIntegrating:
    case Phase::kSuspend: return become(Phase::kIdle);
    case Phase::kBusOff: count_ = 0; return;
    case Phase::kOff:
    case Phase::kIdle:
    case Phase::kFrame:
    case Phase::kActiveFlag:
    case Phase::kPassiveFlag:
    case Phase::kBehindFlag:
    case Phase::kDelimiter:
    case Phase::kIntermission: return;
  }
  TTF_CHECK(false, "phase {}", static_cast<int>(phase_));
}

Protocol::Brought Protocol::frame_bit(bool recessive) {
  const Decoder::Taken taken = decoder_.take(recessive);
  const Brought brought = transmitter_ ? transmitted(recessive, taken) : received(recessive, taken);
  if (phase_ == Phase::kFrame) drive_next();
  return brought;
}

// A transmitter receives itself: what it sees is what it sent, or an error, or another's lower identifier.
Protocol::Brought Protocol::transmitted(bool recessive, const Decoder::Taken& taken) {
  const FrameBit& sent = frame_[bit_];
  if (sent.acknowledgement) {
    if (recessive) return fail(CanError::kAcknowledgement);
  } else if (sent.recessive != recessive) {
    if (!sent.arbitration || recessive) return fail(CanError::kBit);
    if (sent.stuff) return fail(CanError::kStuff, true);
    transmitter_ = false;  // it has lost the arbitration
    return received(recessive, taken);
  }
  ++bit_;
  Brought brought;
  brought.accepted = taken.accepted;
  if (bit_ < frame_.size()) return brought;
  brought.sent = true;
  count(E::kSent, E::kSent);
  become(Phase::kIntermission);
  return brought;
}

Protocol::Brought Protocol::received(bool recessive, const Decoder::Taken& taken) {
  if (!drives_ && recessive) return fail(CanError::kBit);  // its own acknowledgement
  if (taken.error != CanError::kNone) return fail(taken.error);
  Brought brought;
  if (taken.accepted) {
    brought.accepted = true;
    count(E::kReceived, E::kReceived);
  }
  if (taken.overload)
    raise_flag(true, false);
  else if (taken.over)
    become(Phase::kIntermission);
  return brought;
}

// The state before the error decides which flag it sends.
Protocol::Brought Protocol::fail(CanError error, bool stuff_bit_overwritten) {
  const bool active = confinement_.state == CanState::kActive;
  lone_ = !active && transmitter_ && error == CanError::kAcknowledgement;
  Brought brought;
  brought.error = error;
  brought.as_transmitter = transmitter_;
  raise_flag(active, true);
  if (stuff_bit_overwritten)
    count(E::kStuffBitOverwritten, E::kStuffBitOverwritten);
  else if (!lone_)
    count(E::kTransmitterError, E::kReceiverError);
  return brought;
}

void Protocol::raise_flag(bool active, bool of_error) {
  become(active ? Phase::kActiveFlag : Phase::kPassiveFlag);
  error_flag_ = of_error;
  drives_ = !active;
}

void Protocol::active_flag_bit(bool recessive) {
  if (recessive) {
    // A bit error in its own flag: it sends another.
    const bool active = confinement_.state == CanState::kActive;
    raise_flag(active, true);
    return count(E::kTransmitterFlagError, E::kReceiverFlagError);
  }
  if (++count_ == kFlagBits) become(Phase::kBehindFlag);
}

// It is over after six equal bits of whatever sender.
void Protocol::passive_flag_bit(bool recessive) {
  if (!recessive && lone_) {
    lone_ = false;
    count(E::kTransmitterError, E::kTransmitterError);
    if (phase_ != Phase::kPassiveFlag) return;
  }
  count_ = count_ > 0 && recessive == last_ ? count_ + 1 : 1;
  last_ = recessive;
  if (count_ < kFlagBits) return;
  if (lone_) count(E::kLoneTransmitter, E::kLoneTransmitter);
  lone_ = false;
  become(Phase::kBehindFlag);
}

void Protocol::behind_flag_bit(bool recessive) {
  if (recessive) {
    become(Phase::kDelimiter);
    count_ = 1;
    return;
  }
  const bool outlasted = count_ == 0 && error_flag_ && !transmitter_;
  count_ = count_ % kDominantBits + 1;
  if (outlasted) confinement_ = step(confinement_, E::kReceiverOutlasted);
  if (count_ == kDominantBits) count(E::kTransmitterDominant, E::kReceiverDominant);
}

Protocol::Brought Protocol::delimiter_bit(bool recessive) {
  if (recessive) {
    if (++count_ == kDelimiterBits) become(Phase::kIntermission);
    return {};
  }
  if (count_ < kDelimiterBits - 1) return fail(CanError::kForm);
  raise_flag(true, false);  // its last bit is dominant: an overload condition
  return {};
}

void Protocol::intermission_bit(bool recessive) {
  if (!recessive) return count_ < kIntermissionBits - 1 ? raise_flag(true, false) : receive_start();
  if (++count_ < kIntermissionBits) return;
  become(transmitter_ && confinement_.state == CanState::kPassive ? Phase::kSuspend : Phase::kIdle);
}

void Protocol::bus_off_bit(bool recessive) {
  count_ = recessive ? count_ + 1 : 0;
  if (count_ < kSequenceBits) return;
  count_ = 0;
  confinement_ = step(confinement_, E::kElevenRecessive);
  if (confinement_.state == CanState::kBusOff) return;
  transmitter_ = false;
  become(Phase::kIdle);
}

}  // namespace ttf::bus::can
