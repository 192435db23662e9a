#include "bus/controller.h"

#include <algorithm>
#include <array>

#include "bus/wire/flexray_frame.h"
#include "core/check.h"

namespace ttf::bus {
namespace {

using schedules::Channel;
using schedules::FrameSlot;

bool in_cycle(const FrameSlot& frame, std::int64_t cycle) { return cycle % frame.repetition == frame.base_cycle; }

const schedules::NodeParameters& parameters(const schedules::Cluster& cluster, NodeId node) {
  TTF_CHECK(cluster.node(node).flexray.has_value(), "{} is not on FlexRay", cluster.node(node).name);
  return *cluster.node(node).flexray;
}

timebase::CycleGeometry geometry(const schedules::GlobalParameters& g, const schedules::NodeParameters& p) {
  return {g.gMacroPerCycle, g.gdMacrotick_ps, p.pMicroPerCycle, g.gOffsetCorrectionStart};
}

}  // namespace

struct FlexRayController::State {
  // A list this node sends. The cycle's first slot latches it, so that a write in the middle of its slots tears nothing.
  struct Sent {
    OutgoingList current, latched;
    std::int64_t latched_cycle = -1;
    std::optional<std::uint32_t> completed;   // newest sequence that left completely
    explicit Sent(const schedules::PduLayout& layout) : current(layout), latched(layout) {}
  };
  // What was seen in one slot of this cycle, per channel.
  struct Seen {
    std::array<bool, 2> valid{};
    std::array<std::uint8_t, 2> errors{};
  };
  enum class Next : std::uint8_t { kOwnSlot, kStaticEnd, kCycleEnd };

  const schedules::Cluster& cluster;
  const schedules::GlobalParameters& g;
  const schedules::NodeParameters p;
  NodeId node;
  FlexRayPort& port;
  ControllerEvents& events;
  std::vector<const FrameSlot*> own;                       // by slot
  std::vector<std::vector<const FrameSlot*>> expected;     // by slot - 1, of the other nodes
  std::vector<std::unique_ptr<Sent>> sent;                 // by PduId
  std::vector<std::unique_ptr<IncomingList>> received;     // by PduId
  std::vector<Seen> seen;                                  // by slot - 1
  timebase::SyncMeasurements sync;
  int next_rate = 0;
  Next next = Next::kOwnSlot;
  std::size_t next_own = 0;
  std::array<std::byte, wire::kMaxPayloadBytes> payload{};
  std::array<std::byte, wire::kMaxFrameBytes> frame{};

  State(const schedules::Cluster& c, NodeId n, FlexRayPort& medium, ControllerEvents& host)
      : cluster(c), g(c.flexray), p(parameters(c, n)), node(n), port(medium), events(host),
        expected(static_cast<std::size_t>(g.gNumberOfStaticSlots)),
        sent(c.pdus.size()), received(c.pdus.size()), seen(static_cast<std::size_t>(g.gNumberOfStaticSlots)) {
    for (const FrameSlot& slot : c.frames) {
      const std::size_t pdu = index_of(slot.pdu);
      if (slot.sender == n) {
        own.push_back(&slot);
        if (slot.pdu != kNoPdu && !sent[pdu]) sent[pdu] = std::make_unique<Sent>(c.pdus[pdu]);
      } else {
        expected[static_cast<std::size_t>(slot.slot - 1)].push_back(&slot);
        if (slot.pdu != kNoPdu && !received[pdu]) received[pdu] = std::make_unique<IncomingList>(c.pdus[pdu]);
      }
    }
    std::stable_sort(own.begin(), own.end(), [](const auto* a, const auto* b) { return a->slot < b->slot; });
  }

  int counter(std::int64_t cycle) const { return static_cast<int>(cycle % (g.gCycleCountMax + 1)); }
  Macroticks slot_start(int slot) const { return {static_cast<std::int64_t>(slot - 1) * g.gdStaticSlot}; }
  Macroticks action_point(int slot) const { return slot_start(slot) + Macroticks{g.gdActionPointOffset}; }
  Macroticks static_end() const { return slot_start(g.gNumberOfStaticSlots + 1); }

  const FrameSlot* expected_in(int slot, std::int64_t cycle, Channel channel) const {
    for (const FrameSlot* frame_slot : expected[static_cast<std::size_t>(slot - 1)])
      if (in_cycle(*frame_slot, counter(cycle)) && includes(frame_slot->channels, channel)) return frame_slot;
    return nullptr;
  }

  void start_cycle(std::int64_t cycle) {
    std::fill(seen.begin(), seen.end(), Seen{});
    (cycle % 2 == 0 ? sync.even_count : sync.odd_count) = 0;
    if (p.pKeySlotUsedForSync) {
      // A node's own sync frame is exactly where it expects it.
      measure(cycle, p.pKeySlotId, Channel::kA, 0);
      measure(cycle, p.pKeySlotId, Channel::kB, 0);
    }
    next_own = 0;
    next = Next::kOwnSlot;
    skip_foreign_cycles(cycle);
  }

  // Leaves next_own at the next slot that is sent in this cycle, or goes on to the end of the static segment.
  void skip_foreign_cycles(std::int64_t cycle) {
    while (next_own < own.size() && !in_cycle(*own[next_own], counter(cycle))) ++next_own;
    if (next_own == own.size()) next = Next::kStaticEnd;
  }

  void measure(std::int64_t cycle, int frame_id, Channel channel, int deviation) {
    auto& list = cycle % 2 == 0 ? sync.even : sync.odd;
    int& count = cycle % 2 == 0 ? sync.even_count : sync.odd_count;
    int index = 0;
    while (index < count && list[static_cast<std::size_t>(index)].frame_id != frame_id) ++index;
    if (index == timebase::kMaxSyncNodes) return;   // more sync nodes than the schedule allows: the first ones count
    timebase::SyncDeviation& entry = list[static_cast<std::size_t>(index)];
    if (index == count) {
      entry = {frame_id, std::nullopt, std::nullopt};
      ++count;
    }
    (channel == Channel::kA ? entry.a : entry.b) = deviation;
  }
};

FlexRayController::FlexRayController(const schedules::Cluster& cluster, NodeId node, InitialClock clock,
                                     FlexRayPort& port, ControllerEvents& events)
    : clock_(geometry(cluster.flexray, parameters(cluster, node)), clock.cycle_start, clock.rate),
      state_(std::make_unique<State>(cluster, node, port, events)) {
  state_->next_rate = clock.rate;
  state_->start_cycle(0);
}

FlexRayController::~FlexRayController() = default;

Microticks FlexRayController::next_event() const {
  const State& s = *state_;
  switch (s.next) {
    case State::Next::kOwnSlot: return clock_.start_of(s.action_point(s.own[s.next_own]->slot));
    case State::Next::kStaticEnd: return clock_.start_of(s.static_end());
    case State::Next::kCycleEnd: return clock_.cycle_end();
  }
  return {};
}

void FlexRayController::advance(Microticks now) {
  State& s = *state_;
  for (Microticks at = next_event(); at <= now; at = next_event()) {
    switch (s.next) {
      case State::Next::kOwnSlot:
        send_slot(at);
        ++s.next_own;
        s.skip_foreign_cycles(clock_.cycle());
        break;
      case State::Next::kStaticEnd:
        close_static_segment(at);
        s.next = State::Next::kCycleEnd;
        break;
      case State::Next::kCycleEnd:
        clock_.next_cycle(s.next_rate);
        s.start_cycle(clock_.cycle());
        break;
    }
  }
}

void FlexRayController::send_slot(Microticks at) {
  State& s = *state_;
  const FrameSlot& slot = *s.own[s.next_own];
  const std::int64_t cycle = clock_.cycle();
  wire::FrameHeader header;
  header.frame_id = static_cast<std::uint16_t>(slot.slot);
  header.cycle = static_cast<std::uint8_t>(s.counter(cycle));
  header.sync = s.p.pKeySlotUsedForSync && slot.slot == s.p.pKeySlotId;
  header.startup = header.sync && s.p.pKeySlotUsedForStartup;
  s.payload.fill(std::byte{0});
  std::uint32_t sequence = 0;
  bool last = false;
  if (slot.pdu != kNoPdu) {
    State::Sent& list = *s.sent[index_of(slot.pdu)];
    if (list.latched_cycle != cycle) {
      list.latched_cycle = cycle;
      list.latched = list.current;   // same capacity: no allocation
    }
    const auto fragment = list.latched.fragment(slot.fragment);
    header.null_frame = fragment.empty();
    std::copy(fragment.begin(), fragment.end(), s.payload.begin());
    sequence = list.latched.sequence();
    last = !header.null_frame && slot.fragment == list.latched.fragments() - 1 && list.completed != sequence;
    if (last) list.completed = sequence;
  }
  const auto words = static_cast<std::size_t>(s.g.gPayloadLengthStatic);
  const Channel last_channel = includes(slot.channels, Channel::kB) ? Channel::kB : Channel::kA;
  for (const Channel channel : {Channel::kA, Channel::kB}) {
    if (!includes(slot.channels, channel)) continue;
    const std::size_t size =
        wire::encode_frame(header, channel, std::span<const std::byte>(s.payload).first(2 * words), s.frame);
    const Transmission transmission{channel, at, slot.slot, std::span<const std::byte>(s.frame).first(size)};
    s.port.transmit(transmission);
    s.events.frame_sent(transmission, cycle, header.null_frame, slot.pdu, sequence, slot.fragment,
                        last && channel == last_channel);
  }
}

// All frames of the cycle have been heard: what is missing is reported, and in odd cycles the corrections are computed.
void FlexRayController::close_static_segment(Microticks at) {
  State& s = *state_;
  const std::int64_t cycle = clock_.cycle();
  for (int slot = 1; slot <= s.g.gNumberOfStaticSlots; ++slot)
    for (const Channel channel : {Channel::kA, Channel::kB}) {
      const auto c = static_cast<std::size_t>(channel);
      const State::Seen& seen = s.seen[static_cast<std::size_t>(slot - 1)];
      const bool owned = s.expected_in(slot, cycle, channel) != nullptr;
      std::uint8_t status = seen.errors[c];
      if (owned && !seen.valid[c] && status == 0) status = kNoFrame;
      if (status != 0) s.events.slot_problem(cycle, slot, channel, static_cast<SlotStatus>(status), at);
    }
  if (cycle % 2 == 0) return;
  const timebase::Correction offset = timebase::offset_correction(
      {s.sync.odd.data(), static_cast<std::size_t>(s.sync.odd_count)}, s.p.pOffsetCorrectionOut);
  const timebase::Correction rate = timebase::rate_correction(s.sync, clock_.rate_correction(),
                                                              s.p.pClusterDriftDamping, s.p.pRateCorrectionOut);
  if (s.cluster.synchronisation) {
    clock_.set_offset_correction(offset.value);
    s.next_rate = rate.value;
  }
  s.events.clock_corrected(cycle, offset, rate, at);
}

void FlexRayController::receive(const Reception& reception) {
  State& s = *state_;
  const std::int64_t cycle = clock_.cycle();
  // Which of this node's slots the frame started in.
  if (reception.start < clock_.cycle_start() || reception.start >= clock_.start_of(s.static_end())) return;
  int low = 1, high = s.g.gNumberOfStaticSlots;
  while (low < high) {
    const int middle = (low + high + 1) / 2;
    if (clock_.start_of(s.slot_start(middle)) <= reception.start)
      low = middle;
    else
      high = middle - 1;
  }
  const int slot = low;
  const auto c = static_cast<std::size_t>(reception.channel);
  State::Seen& seen = s.seen[static_cast<std::size_t>(slot - 1)];
  const wire::DecodedFrame decoded = wire::decode_frame(reception.channel, reception.bytes);

  std::uint8_t errors = 0;
  if (decoded.error != wire::FrameError::kNone) errors |= kSyntaxError;
  if (reception.end > clock_.start_of(s.slot_start(slot + 1))) errors |= kBoundaryViolation;
  const FrameSlot* expected = s.expected_in(slot, cycle, reception.channel);
  if (errors == 0 &&
      (decoded.header.frame_id != slot || decoded.header.cycle != s.counter(cycle) ||
       decoded.header.payload_words != s.g.gPayloadLengthStatic || expected == nullptr ||
       (decoded.header.startup && !decoded.header.sync)))
    errors |= kContentError;
  if (seen.valid[c]) errors |= kTransmissionConflict;   // a second frame in one slot
  seen.errors[c] |= errors;
  if (errors != 0) return;
  seen.valid[c] = true;

  if (decoded.header.sync) {
    // The medium reports when the first bit of the TSS arrived, so no decoding time has to be taken off
    // (pDecodingCorrection); the bus' mean propagation delay is the schedule's to compensate.
    const int compensation = reception.channel == Channel::kA ? s.p.pDelayCompensationA : s.p.pDelayCompensationB;
    const Microticks deviation = reception.start - clock_.start_of(s.action_point(slot)) - Microticks{compensation};
    s.measure(cycle, slot, reception.channel, static_cast<int>(deviation.value));
  }
  if (expected->pdu == kNoPdu || decoded.header.null_frame) return;
  IncomingList& list = *s.received[index_of(expected->pdu)];
  const auto bytes = static_cast<std::size_t>(s.cluster.pdu(expected->pdu).fragment_bytes);
  const ArrivalEffect effect = list.arrive(decoded.payload.first(bytes), expected->fragment);
  if (effect == ArrivalEffect::kMalformed) seen.errors[c] |= kContentError;   // a frame, but not of this slot's list
  s.events.list_arrived(expected->pdu, effect, list.arrived(), list.torn(), reception.end);
}

OutgoingList& FlexRayController::outgoing(PduId pdu) {
  TTF_CHECK(state_->sent[index_of(pdu)] != nullptr, "{} does not send {}",
            state_->cluster.node(state_->node).name, state_->cluster.pdu(pdu).name);
  return state_->sent[index_of(pdu)]->current;
}

IncomingList& FlexRayController::incoming(PduId pdu) {
  TTF_CHECK(state_->received[index_of(pdu)] != nullptr, "{} does not receive {}",
            state_->cluster.node(state_->node).name, state_->cluster.pdu(pdu).name);
  return *state_->received[index_of(pdu)];
}

}  // namespace ttf::bus
