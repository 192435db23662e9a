// The plain way of a private CAN: bit by bit.
#include <algorithm>

#include "core/check.h"
#include "sim/medium/can_medium.h"

namespace ttf::sim::medium {

using Phase_ = bus::can::Protocol::Phase;

namespace {

// Returns whether the controller leaves the bus to others.
bool leaves_bus(Phase_ phase) {
  switch (phase) {
    case Phase_::kOff:
    case Phase_::kIntegrating:
    case Phase_::kIdle:
    case Phase_::kSuspend:
    case Phase_::kBusOff: return true;
    case Phase_::kFrame:
    case Phase_::kActiveFlag:
    case Phase_::kPassiveFlag:
    case Phase_::kBehindFlag:
    case Phase_::kDelimiter:
    case Phase_::kIntermission: return false;
  }
  TTF_CHECK(false, "phase {}", static_cast<int>(phase));
}

}  // namespace

bool CanMedium::is_free() const {
  for (std::size_t m = 0; m < line_.size(); ++m)
    if (!leaves_bus(line_[m].phase())) return false;
  return true;
}

// A host may restart its controller in the middle of a frame, whose bits matter then.
bool CanMedium::is_clean() const {
  for (std::size_t m = 0; m < line_.size(); ++m) {
    const Phase_ phase = line_[m].phase();
    if (phase == Phase_::kOff) {
      if (recovery_ == CanRecovery::kByHost && m < members_.size() && members_[m].on) return false;
    } else if (phase != Phase_::kIdle || line_[m].confinement() != bus::can::Confinement{}) {
      return false;
    }
  }
  return true;
}

// Returns whether recessive bits change nothing.
bool CanMedium::is_still() const {
  for (std::size_t m = 0; m < line_.size(); ++m)
    if (line_[m].phase() != Phase_::kOff && line_[m].phase() != Phase_::kIdle) return false;
  return true;
}

void CanMedium::begin_bits(TrueTime now) {
  bits_ = true;
  resting_ = false;
  free_ = true;
  error_frame_ = false;
  looked_ = now;
  line_.align(now);
}

// Begins the plain way, or takes it up again where no bit was looked at for a while: on an idle line, or on one that is
// held.
void CanMedium::wake(TrueTime now) {
  pass_others(now);
  const Duration bit{1'000'000'000 / can().nominal_bit_rate + 1};
  if (bits_ && !resting_ && line_.next() <= std::max(now, idle_from_) + bit) return;
  if (!bits_) begin_bits(now);
  resting_ = false;
  line_.align(now);
  if (idle_from_ > now) line_.pass_by(idle_from_);
}

// Every idle controller begins its first frame; of two with one identifier the lower node does.
void CanMedium::start_frames(TrueTime now) {
  wake(now);
  went_by(now);
  error_frame_ = false;  // its frame is another's, even if some controllers are in their intermission
  const Pending* first = nullptr;
  std::size_t bits = 0;
  for (std::size_t m = 0; m < members_.size(); ++m) {
    if (!is_idle(m)) continue;
    const Pending* frame = nullptr;
    for (const Pending& one : pending_)
      if (one.sender == m && (frame == nullptr || goes_before(one, *frame))) frame = &one;
    const auto sends_it = [&](const Member& other) {
      return other.sends && other.began == now && frame != nullptr &&
             std::any_of(pending_.begin(), pending_.end(), [&](const Pending& one) {
               return one.order == *other.sends && one.identifier == frame->identifier;
             });
    };
    if (frame == nullptr || std::any_of(members_.begin(), members_.end(), sends_it)) continue;
    const bool passive = line_[m].confinement().state == bus::can::CanState::kPassive;
    frame_bits_ = bus::can::FrameBits(can().flexible_data_rate, frame->identifier, pool_.bytes(frame->frame), passive);
    line_.start(m, frame_bits_, now);
    members_[m].sends = frame->order;
    members_[m].began = now;
    report_begin(*frame, now, now);
    if (first == nullptr || goes_before(*frame, *first)) {
      first = frame;
      bits = frame_bits_.size();
    }
  }
  inverted_.reset();
  if (first != nullptr) {
    free_ = false;
    CanBeginning beginning{bus_, members_[first->sender].node, bits, std::nullopt, {}};
    if (touched(now + Duration{1})) disturbance_->begins_on_can(beginning);
    inverted_ = beginning.inverted;
    for (std::size_t m = 0; m < inverted_for_.size(); ++m)
      inverted_for_[m] = beginning.seen_by.empty() ||
                         (m < members_.size() && std::find(beginning.seen_by.begin(), beginning.seen_by.end(),
                                                           members_[m].node) != beginning.seen_by.end());
  }
  go_on(now);
}

void CanMedium::went_by(TrueTime now) {
  if (!free_) busy_ += now - looked_;
  looked_ = now;
}

void CanMedium::end_bits(TrueTime now) {
  if (bits_due_ == now) bits_due_ = {};                  // bits of other lengths may end in the same nanosecond
  if (!bits_ || resting_ || line_.next() > now) return;  // the event is out of date
  pass_others(now - Duration{1});
  if (line_.next() > now) return go_on(now);  // a frame of theirs goes by
  went_by(now);
  const bool disturbed = touched(now + Duration{1});
  if (disturbed || was_disturbed_)
    for (std::size_t m = 0; m < members_.size(); ++m)
      line_.set_acknowledging(m, !disturbed || disturbance_->acknowledges_on_can(bus_, members_[m].node));
  was_disturbed_ = disturbed;
  const TrueTime held = disturbed ? disturbance_->holds_can(bus_) : TrueTime{};
  const bool others_were_idle = are_others_idle();
  const auto& all = line_.step({held > now, inverted_, &inverted_for_});
  for (std::size_t m = 0; m < members_.size(); ++m) brought(m, all[m], now);
  for (std::size_t m = 0; m < members_.size(); ++m) report_state(m, now);
  if (recovery_ != CanRecovery::kAutomatic) stay_off();
  free_ = is_free() && held <= now;
  if (free_) error_frame_ = false;
  if (are_others_idle() && !others_were_idle) idle_from_ = std::max(idle_from_, now);
  if (held > now && line_.endures_dominance()) {
    resting_ = held == kNever<TrueTime>;
    if (resting_) return;
    line_.endure(held);
  }
  go_on(now);
}

void CanMedium::brought(std::size_t member, const bus::can::Protocol::Brought& brought, TrueTime now) {
  Member& here = members_[member];
  if (brought.error != bus::can::CanError::kNone) {
    here.sends.reset();  // it will be sent again
    report_error(member, brought, now);
    return;
  }
  if (brought.accepted && line_[member].transmits()) {
    schedule_sent(now, member, here.began);
  } else if (brought.accepted) {
    const bus::can::Decoder& decoder = line_[member].decoder();
    std::size_t sender = member;  // stands for a transmitter that is gone
    for (std::size_t m = 0; m < members_.size(); ++m)
      if (line_[m].transmits()) sender = m;
    if (!touched(now + Duration{1}) || disturbance_->arrives_from_can(bus_, here.node))
      schedule_arrival(now, {member, sender, decoder.identifier(), pool_.put(decoder.data(), 1)},
                       sender == member ? now : members_[sender].began);
  }
  if (!brought.sent) return;
  const auto sent =
      std::find_if(pending_.begin(), pending_.end(), [&](const Pending& frame) { return frame.order == here.sends; });
  TTF_CHECK(sent != pending_.end(), "{} has sent a frame that it did not begin", cluster_.node(here.node).name);
  forget(sent);
  here.sends.reset();
}

void CanMedium::leave_bits(TrueTime now) {
  if (!bits_ || bit_by_bit_ || !is_clean() || touched(now + Duration{1})) return;
  bits_ = false;
}

// Returns whether a controller may begin a frame. In the middle of one few are idle, and many frames may wait.
bool CanMedium::offers() const {
  for (std::size_t m = 0; m < members_.size(); ++m)
    if (is_idle(m) && members_[m].waiting > 0) return true;
  return false;
}

// Schedules what comes next: an arbitration, the next bit, or the fast way.
void CanMedium::go_on(TrueTime now) {
  leave_bits(now);
  if (!arbitration_due_ && offers()) arbitrate_at(std::max(now, idle_from_));
  if (!bits_) return;
  // An idle line needs no look at its bits.
  resting_ = is_still() && held(now) <= now;
  if (!resting_) schedule_bits();
}

void CanMedium::schedule_bits() {
  const TrueTime next = line_.next();
  if (next == kNever<TrueTime> || next == bits_due_) return;
  bits_due_ = next;
  MediumEvent event;
  event.kind = MediumEvent::Kind::kCanBits;
  event.channel_or_bus = static_cast<std::uint8_t>(bus_);
  queue_.schedule(next, Phase::kArrival, 0, event);
}

// The first flag of an error frame shows its cause; the others only answer it.
void CanMedium::report_error(std::size_t member, const bus::can::Protocol::Brought& brought, TrueTime now) {
  if (error_frame_) return;
  error_frame_ = true;
  recording::records::CanErrorFrame error;
  error.stamp.true_time = now;
  error.stamp.node = members_[member].node;
  error.bus = static_cast<std::uint8_t>(bus_);
  error.error = brought.error;
  error.as_transmitter = brought.as_transmitter;
  error.transmit_errors = static_cast<std::uint16_t>(line_[member].confinement().transmit_errors);
  error.receive_errors = static_cast<std::uint16_t>(line_[member].confinement().receive_errors);
  sink_.on(error);
}

void CanMedium::report_state(std::size_t member, TrueTime now) {
  const bus::can::Confinement& confinement = line_[member].confinement();
  bus::can::CanState& before = members_[member].state;
  if (confinement.state == before) return;
  recording::records::CanStateChanged change;
  change.stamp.true_time = now;
  change.stamp.node = members_[member].node;
  change.bus = static_cast<std::uint8_t>(bus_);
  change.from = before;
  change.to = confinement.state;
  change.transmit_errors = static_cast<std::uint16_t>(confinement.transmit_errors);
  change.receive_errors = static_cast<std::uint16_t>(confinement.receive_errors);
  before = confinement.state;
  sink_.on(change);
}

void CanMedium::hold_off(NodeId node, TrueTime now) {
  const auto m = member_of(node);
  if (!m || !members_[*m].on) return;
  unfold(now);
  pass_others(now);
  members_[*m].sends.reset();
  members_[*m].held = true;
  members_[*m].recovers = false;
  if (bits_ || recovery_ == CanRecovery::kByHost) wake(now);
  line_.hold_off(*m);
  report_state(*m, now);
  if (bits_) go_on(now);
}

void CanMedium::release(NodeId node, TrueTime now) {
  const auto m = member_of(node);
  // It may have lost its supply since.
  if (!m || !members_[*m].held) return;
  members_[*m].held = false;
  if (recovery_ != CanRecovery::kAutomatic) return;
  wake(now);
  line_.release(*m, std::max(now, idle_from_ - integration()));
  go_on(now);
}

// Keeps controllers off the bus that do not ask to recover.
void CanMedium::stay_off() {
  for (std::size_t m = 0; m < members_.size(); ++m) {
    if (line_[m].phase() != Phase_::kBusOff)
      members_[m].recovers = false;
    else if (!members_[m].recovers)
      line_.hold_off(m);
  }
}

bool CanMedium::restart(NodeId node, TrueTime now) {
  const auto m = member_of(node);
  if (!m || !members_[*m].on || members_[*m].held || line_[*m].phase() != Phase_::kOff) return false;
  forget_all(*m);
  wake(now);
  line_.release(*m, std::max(now, idle_from_ - integration()));
  members_[*m].recovers = true;
  go_on(now);
  return true;
}

void CanMedium::look(TrueTime now) {
  wake(now);
  go_on(now);
}

}  // namespace ttf::sim::medium
