// Media access: decides which frames and symbols leave, and when (FlexRay 2.1A, chapter 5).
#include <algorithm>
#include <array>

#include "bus/controller/state.h"
#include "core/check.h"

namespace ttf::bus::controller {

using schedules::model::Channel;
using schedules::model::FrameSlot;

namespace {

constexpr std::array<std::byte, wire::kMaxPayloadBytes> kZeros{};  // a null frame's payload

}  // namespace

// Advances next_static to the next own slot of this cycle.
void FlexRayController::State::skip_to_own_static() {
  const auto own = slots.own_static();
  while (next_static < own.size() && !in_cycle(*own[next_static], counter)) ++next_static;
}

void FlexRayController::State::send_static(Microticks at) {
  const FrameSlot& slot = *slots.own_static()[next_static];
  ++next_static;
  skip_to_own_static();
  const poc::MacMode mode = mac_mode(poc);
  if (mode == poc::MacMode::kNothing || (mode != poc::MacMode::kAll && slot.slot != p.pKeySlotId)) return;
  const bool starting = mode == poc::MacMode::kStartupFrame;
  const cni::Cni::Fragment content = starting ? cni::Cni::Fragment{} : cni.fetch(slot, clock->cycle());
  const bool null_frame = starting || (slot.pdu != kNoPdu && content.payload.empty());
  const Microticks end = at + static_frame;
  if (slot.network_management && !null_frame) network_management.combine(network_management.own());
  const bool sync_frame = p.pKeySlotUsedForSync && slot.slot == p.pKeySlotId;
  if (slot.channels == schedules::model::Channels::kAB && !in_bytes(Channel::kA) && !in_bytes(Channel::kB)) {
    send_on_both(slot, at, end, content, null_frame);
    if (sync_frame) sync.own(slot.slot, slot.channels);
    return;
  }
  const Channel last_channel = includes(slot.channels, Channel::kB) ? Channel::kB : Channel::kA;
  unsigned left = 0;  // bits of Channels
  for (const Channel channel : schedules::model::kBothChannels)
    if (includes(slot.channels, channel) &&
        send_frame(slot, channel, at, end, content, null_frame, content.last && channel == last_channel))
      left |= 1u << index_of(channel);
  // An unsent sync frame says no more about the cluster's time to this node than to the others.
  if (left != 0 && sync_frame) sync.own(slot.slot, static_cast<schedules::model::Channels>(left));
}

wire::DecodedFrame FlexRayController::State::frame_of(const FrameSlot& slot, const cni::Cni::Fragment& content,
                                                      bool null_frame) {
  const bool is_static = slot.slot <= g.gNumberOfStaticSlots;
  wire::FrameHeader header;
  header.frame_id = static_cast<std::uint16_t>(slot.slot);
  header.cycle = static_cast<std::uint8_t>(counter);
  header.sync = is_static && p.pKeySlotUsedForSync && slot.slot == p.pKeySlotId;
  header.startup = header.sync && p.pKeySlotUsedForStartup;
  header.null_frame = null_frame;
  header.payload_preamble = !null_frame && (slot.network_management || slot.message_id);
  const std::size_t preamble = preamble_bytes(slot);
  const std::size_t length = is_static ? 2 * static_cast<std::size_t>(g.gPayloadLengthStatic)
                                       : (preamble + content.payload.size() + 1) / 2 * 2;
  header.payload_words = static_cast<std::uint8_t>(length / 2);
  if (null_frame) return {wire::FrameError::kNone, header, std::span<const std::byte>(kZeros).first(length)};
  if (preamble == 0 && content.payload.size() == length) return {wire::FrameError::kNone, header, content.payload};
  std::fill_n(payload.begin(), length, std::byte{0});
  std::copy(content.payload.begin(), content.payload.end(), payload.begin() + static_cast<std::ptrdiff_t>(preamble));
  if (header.payload_preamble && slot.message_id) {
    payload[0] = static_cast<std::byte>(*slot.message_id >> 8);
    payload[1] = static_cast<std::byte>(*slot.message_id & 0xFF);
  } else if (header.payload_preamble) {
    std::copy_n(network_management.own().begin(), preamble, payload.begin());
  }
  return {wire::FrameError::kNone, header, std::span<const std::byte>(payload).first(length)};
}

bool FlexRayController::State::send_frame(const FrameSlot& slot, Channel channel, Microticks at, Microticks end,
                                          const cni::Cni::Fragment& content, bool null_frame, bool last) {
  if (!port.may_leave(channel, slot.slot, at)) return false;
  const wire::DecodedFrame said = frame_of(slot, content, null_frame);
  const std::size_t size = in_bytes(channel) ? wire::encode_frame(said.header, channel, said.payload, frame) : 0;
  const ports::Transmission transmission{
      channel, ports::Signal::kFrame, at, end, slot.slot, std::span<const std::byte>(frame).first(size), said};
  sending_from[index_of(channel)] = at;
  sending_to[index_of(channel)] = end;
  port.transmit(transmission);
  events.frame_sent(transmission, clock->cycle(), null_frame, slot.pdu, content.sequence, slot.fragment, last);
  return true;
}

// Sends a static frame on both channels without its bytes.
void FlexRayController::State::send_on_both(const FrameSlot& slot, Microticks at, Microticks end,
                                            const cni::Cni::Fragment& content, bool null_frame) {
  ports::Transmission transmission{
      Channel::kA, ports::Signal::kFrame, at, end, slot.slot, {}, frame_of(slot, content, null_frame)};
  sending_from = {at, at};
  sending_to = {end, end};
  by_content->transmit_on_both(transmission);
  for (const Channel channel : schedules::model::kBothChannels) {
    transmission.channel = channel;
    events.frame_sent(transmission, clock->cycle(), null_frame, slot.pdu, content.sequence, slot.fragment,
                      content.last && channel == Channel::kB);
  }
}

// Finds this node's next dynamic slot on the channel by the present slot counter. A reception changes the
// counter, and so the plan.
void FlexRayController::State::plan_dynamic(Channel channel, Microticks now) {
  Dynamic& d = dynamic[index_of(channel)];
  const auto own = slots.own_dynamic(channel);
  d.due = kNever<Microticks>;
  for (; d.next < own.size(); ++d.next) {
    const FrameSlot& slot = *own[d.next];
    d.minislot = d.counter.minislot_of(slot.slot);
    if (d.minislot == 0 || !in_cycle(slot, counter)) continue;
    // Later slots are later still: this cycle has no further transmission.
    if (d.minislot > std::min(p.pLatestTx, minislots.count())) return;
    d.due = clock->start_of(minislots.action_point(d.minislot));
    if (d.due >= now) return;
    d.due = kNever<Microticks>;  // missed: the clocks differ by more than a minislot
  }
}

void FlexRayController::State::send_dynamic(Channel channel, Microticks at) {
  Dynamic& d = dynamic[index_of(channel)];
  // An earlier slot is in use; the counter goes on from its end.
  if (port.carrier(channel)) {
    d.due = kNever<Microticks>;
    return;
  }
  const FrameSlot& slot = *slots.own_dynamic(channel)[d.next];
  ++d.next;
  if (mac_mode(poc) == poc::MacMode::kAll && cni.pending(slot, channel, clock->cycle())) {
    const cni::Cni::Fragment content = cni.fetch(slot, clock->cycle());
    cni.carried(slot, channel);
    const int words = static_cast<int>((preamble_bytes(slot) + content.payload.size() + 1) / 2);
    const int last = minislots.dts_end(*clock, at + bits(schedules::model::frame_bits(g, words)), bits(1));
    TTF_CHECK(last <= minislots.count(), "slot {} ends in minislot {}: pLatestTx {} is too late for its frame",
              slot.slot, last, p.pLatestTx);
    const Microticks end = clock->start_of(minislots.action_point(last));
    d.counter.occupied(d.minislot, last);
    send_frame(slot, channel, at, end, content, false, content.last);
  }
  plan_dynamic(channel, at);
}

void FlexRayController::State::send_symbol(ports::Signal signal, Channel channel, Microticks at, Microticks end) {
  if (!port.may_leave(channel, 0, at)) return;
  sending_from[index_of(channel)] = at;
  sending_to[index_of(channel)] = end;
  port.transmit({channel, signal, at, end, 0, {}});
  events.symbol_sent(signal, channel, at, end);
}

Microticks FlexRayController::State::cas_length() const {
  return bits(g.gdTSSTransmitter + schedules::model::kCasBits);
}

void FlexRayController::State::send_cas(Microticks at) {
  const Microticks end = at + cas_length();
  for (const Channel channel : schedules::model::kBothChannels)
    if (includes(p.pChannels, channel)) send_symbol(ports::Signal::kCas, channel, at, end);
  const Microticks macrotick{(p.pMicroPerCycle + g.gMacroPerCycle - 1) / g.gMacroPerCycle};
  begin_schedule(end + macrotick, 0, 0);
  segment = Segment::kBefore;
}

void FlexRayController::State::send_wakeup_pattern(Microticks at) {
  wakeup_sent = at + bits(p.pWakeupPattern * (g.gdWakeupSymbolTxLow + g.gdWakeupSymbolTxIdle));
  send_symbol(ports::Signal::kWakeup, p.pWakeupChannel, at, wakeup_sent);
}

}  // namespace ttf::bus::controller
