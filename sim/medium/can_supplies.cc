// Supplies on a private CAN that come and go, also in the middle of a frame.
#include <algorithm>

#include "core/check.h"
#include "sim/medium/can_medium.h"

namespace ttf::sim::medium {
namespace {

constexpr std::int64_t kIntegrationBits = 11;

}  // namespace

Duration CanMedium::integration() const {
  return {(kIntegrationBits * 1'000'000'000 + can().nominal_bit_rate - 1) / can().nominal_bit_rate};
}

// Takes up the whole frame on the bus, if there is one, bit by bit: as if it had gone so from its start of frame. The
// events of its end are taken back.
void CanMedium::unfold(TrueTime now) {
  if (bits_ || !whole_ || whole_->idle <= now) return;
  const Whole whole = *whole_;
  whole_.reset();
  queue_.remove_if([&](const MediumEvent& event) {
    if (event.channel_or_bus != bus_) return false;
    if (event.kind == MediumEvent::Kind::kCanArrival) pool_.release(event.frame);
    return event.kind == MediumEvent::Kind::kCanArrival || event.kind == MediumEvent::Kind::kCanSent ||
           event.kind == MediumEvent::Kind::kCanArbitration;
  });
  arbitration_due_ = false;
  busy_ -= whole.idle - now;
  idle_from_ = whole.start;

  begin_bits(whole.start);
  free_ = false;
  inverted_.reset();
  for (std::size_t m = 0; m < members_.size(); ++m) line_.set_acknowledging(m, true);
  Member& sender = members_[whole.frame.sender];
  ++sender.waiting;
  pending_.push_back(whole.frame);
  frame_bits_ = bus::can::FrameBits(can().flexible_data_rate, whole.frame.identifier, pool_.bytes(whole.frame.frame));
  line_.start(whole.frame.sender, frame_bits_, whole.start);
  sender.sends = whole.frame.order;
  sender.began = whole.start;
  while (line_.next() <= now) {
    // Its receivers have had it, if it was accepted.
    if (!line_.step({})[whole.frame.sender].sent) continue;
    forget(pending_.end() - 1);
    sender.sends.reset();
  }
  looked_ = now;
}

void CanMedium::power_off(NodeId node, TrueTime now) {
  const auto m = member_of(node);
  if (!m || !members_[*m].on) return;
  unfold(now);
  pass_others(now);
  members_[*m].on = members_[*m].held = false;
  members_[*m].sends.reset();
  forget_all(*m);
  if (!bits_) return line_.power_off(*m);
  wake(now);
  went_by(now);
  line_.power_off(*m);
  // No controller may be left to see the frame's end.
  if (!free_ && is_free() && held(now) <= now) {
    free_ = true;
    idle_from_ = std::max(idle_from_, now);
  }
  go_on(now);
}

void CanMedium::power_on(NodeId node, TrueTime now) {
  const auto m = member_of(node);
  if (!m || members_[*m].on) return;
  unfold(now);
  members_[*m].on = true;
  pass_others(now);
  // A frame of other traffic ends with eleven recessive bits.
  const bool behind_others = idle_from_ >= now + integration();
  if (!behind_others) wake(now);
  line_.power_on(*m, behind_others, behind_others ? idle_from_ : now);
  report_state(*m, now);
  if (bits_) go_on(now);
}

}  // namespace ttf::sim::medium
