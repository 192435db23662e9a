#include "nodes/host/node_records.h"

#include "bus/wire/pdu_codec.h"
#include "recording/records/enumerations.h"

namespace ttf::nodes::host {

void NodeRecords::frame_sent(const bus::ports::Transmission& transmission, std::int64_t cycle, bool null_frame,
                             PduId pdu, std::uint32_t sequence, int fragment, bool last) {
  // A frame ends in the cycle of its start, so the clock already has the end.
  const recording::records::Stamp end = time_.stamp(transmission.end);
  if (wants_frames_) {
    recording::records::SlotFrameSent sent;
    sent.stamp = time_.stamp(transmission.start);
    sent.end = end;
    sent.cycle = cycle;
    sent.slot = static_cast<std::uint16_t>(transmission.slot);
    sent.channel = static_cast<std::uint8_t>(transmission.channel);
    sent.null_frame = null_frame;
    sent.pdu = pdu;
    if (pdu != kNoPdu) sent.sensor = cluster_.pdu(pdu).sensor;
    sent.sequence = sequence;
    sent.fragment = static_cast<std::uint8_t>(fragment);
    sent.bytes = transmission.bytes;
    sink_.on(sent);
  }
  if (last) hop(end, recording::records::Hop::kSent, pdu, sequence, schedules::model::kFlexRay);
}

// Finds the message of a frame. A foreign frame stays without one; receivers ignore it, too.
void NodeRecords::identify(recording::records::CanFrameSent& frame, const bus::cni::CanController& sender) const {
  for (const schedules::model::CanMessage& message : cluster_.can_buses[frame.bus].messages) {
    if (message.identifier != frame.identifier) continue;
    const schedules::model::PduLayout& layout = cluster_.pdu(message.pdu);
    const auto bytes = static_cast<std::size_t>(layout.fragment_bytes);
    if (frame.data.size() < bytes) return;
    const auto payload = frame.data.first(bytes);
    frame.pdu = message.pdu;
    frame.sensor = layout.sensor;
    frame.fragment = static_cast<std::uint8_t>(
        bus::wire::read_header_raw(layout, payload, bus::wire::header_signal(layout, "fragment")));
    frame.sequence =
        sender.sent_sequence(frame.pdu, static_cast<std::uint32_t>(bus::wire::read_header_raw(
                                            layout, payload, bus::wire::header_signal(layout, "sequence"))));
  }
}

void NodeRecords::can_frame_sent(recording::records::CanFrameSent frame, const bus::cni::CanController& sender,
                                 Microticks now) {
  const TrueTime end = frame.end.true_time;
  frame.end = time_.stamp(now);
  frame.end.true_time = end;
  identify(frame, sender);
  sink_.on(frame);
  if (frame.pdu == kNoPdu) return;
  const schedules::model::PduLayout& layout = cluster_.pdu(frame.pdu);
  const auto payload = frame.data.first(static_cast<std::size_t>(layout.fragment_bytes));
  const auto count = bus::wire::read_header_raw(layout, payload, bus::wire::header_signal(layout, "count"));
  const bool last = frame.fragment == layout.fragments_of(static_cast<int>(count)) - 1;
  if (last)
    hop(frame.end, recording::records::Hop::kSent, frame.pdu, frame.sequence,
        schedules::model::MediumId::can(frame.bus));
}

void NodeRecords::slot_problem(std::int64_t cycle, int slot, schedules::model::Channel channel,
                               bus::controller::SlotStatus status, Microticks at) {
  ++counts_.slot_problems;
  sink_.on(recording::records::SlotProblem{time_.stamp(at), cycle, static_cast<std::uint16_t>(slot),
                                           static_cast<std::uint8_t>(channel), status});
}

void NodeRecords::clock_corrected(std::int64_t cycle, const timebase::Correction& offset,
                                  const timebase::Correction& rate, Microticks at) {
  // One instant on both clocks, from which others compute the clocks' difference. So true time is when this
  // clock showed that instant, however late it was read.
  recording::records::Stamp both = time_.stamp(at);
  both.true_time = time_.oscillator().time_of(at);
  sink_.on(recording::records::ClockCorrected{both, cycle, offset.value, rate.value, offset.missing, rate.missing,
                                              offset.limit_reached, rate.limit_reached});
}

void NodeRecords::symbol_sent(bus::ports::Signal signal, schedules::model::Channel channel, Microticks start,
                              Microticks end) {
  // A collision avoidance symbol comes before there is a schedule; within a schedule the same bits test the medium.
  using recording::records::Symbol;
  const Symbol kind = signal == bus::ports::Signal::kWakeup ? Symbol::kWakeup
                      : time_.global() != nullptr           ? Symbol::kMediaTest
                                                            : Symbol::kCas;
  sink_.on(
      recording::records::SymbolSent{time_.stamp(start), time_.stamp(end), static_cast<std::uint8_t>(channel), kind});
}

void NodeRecords::state_changed(bus::poc::PocKind from, const bus::poc::PocStep& step, Microticks at) {
  const bus::poc::PocKind to = step.next.kind;
  sink_.on(recording::records::StateChanged{time_.stamp(at), from, to, to_text(from), to_text(to), to_text(step.reason),
                                            to_text(step.consequence)});
}

void NodeRecords::hop(const recording::records::Stamp& at, recording::records::Hop what, PduId pdu,
                      std::uint32_t sequence, schedules::model::MediumId medium) {
  sink_.on(recording::records::ListHop{at, what, pdu, cluster_.pdu(pdu).sensor, sequence, medium.number()});
}

}  // namespace ttf::nodes::host
