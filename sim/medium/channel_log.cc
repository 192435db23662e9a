#include "sim/medium/channel_log.h"

#include <algorithm>

#include "core/check.h"

namespace ttf::sim::medium {
namespace {

using bus::ports::Signal;
using recording::records::ChannelState;

// Every byte is sent with the two bits of its byte start sequence, and the frame start sequence is one bit
// (FlexRay 2.1A, 3.2.1.1).
constexpr std::int64_t kBitsPerByte = 10;
constexpr std::int64_t kFrameStartBits = 1;

ChannelState crc_state(const bus::wire::FrameCrcs& crcs) {
  return (crcs.header_holds ? ChannelState::kSound : ChannelState::kHeaderCrc) |
         (crcs.frame_holds ? ChannelState::kSound : ChannelState::kFrameCrc);
}

}  // namespace

ChannelLog::ChannelLog(const schedules::model::GlobalParameters& flexray, std::size_t room,
                       recording::records::Sink& sink)
    : bit_ps_(flexray.gdBit_ps), bits_before_bytes_(flexray.gdTSSTransmitter + kFrameStartBits), sink_(sink) {
  add_ways(room);
}

void ChannelLog::add_ways(std::size_t count) {
  const std::size_t before = ways_.size();
  TTF_CHECK(before + count < kNone, "{} signals on their way", before);
  ways_.resize(before + count);
  free_.reserve(ways_.size());
  for (std::size_t w = ways_.size(); w-- > before;) free_.push_back(static_cast<Id>(w));
}

void ChannelLog::Bytes::set(std::span<const std::byte> bytes) {
  std::copy(bytes.begin(), bytes.end(), room.begin());
  size = bytes.size();
}

ChannelLog::Way& ChannelLog::take(Id& id) {
  if (free_.empty()) add_ways(ways_.size());
  id = free_.back();
  free_.pop_back();
  Way& way = ways_[id];
  way.record = {};
  way.bytes.size = way.other.size = 0;
  way.receivers = way.lost = way.changed = 0;
  way.used = true;
  way.altered = way.unlike = false;
  return way;
}

ChannelLog::Id ChannelLog::sent(NodeId sender, const bus::ports::Transmission& transmission, TrueTime start,
                                TrueTime end) {
  if (transmission.signal != Signal::kFrame) return kNone;
  Id id = kNone;
  Way& way = take(id);
  way.frame = true;
  way.bytes.set(transmission.bytes);
  way.breaks_off = end;
  recording::records::ChannelFrame& record = way.record;
  record.start = record.sent = start;
  record.end = end;
  record.sender = sender;
  record.channel = record.sent_channel = static_cast<std::uint8_t>(transmission.channel);
  record.slot = static_cast<std::uint16_t>(transmission.slot);
  record.cycle_counter = transmission.content.header.cycle;
  return id;
}

ChannelLog::Id ChannelLog::appears(const Leaving& signal) {
  if (signal.signal != Signal::kFrame && signal.signal != Signal::kUndecodable) return kNone;
  Id id = kNone;
  Way& way = take(id);
  way.frame = signal.signal == Signal::kFrame;
  way.bytes.set(signal.bytes);
  way.altered = true;
  way.breaks_off = signal.end;
  way.record.start = signal.start;
  way.record.end = signal.end;
  way.record.sender = signal.sender;
  way.record.channel = static_cast<std::uint8_t>(signal.channel);
  return id;
}

void ChannelLog::leaves(Id id, const Leaving& signal) {
  if (id == kNone) return;
  Way& way = ways_[id];
  recording::records::ChannelFrame& record = way.record;
  const auto channel = static_cast<std::uint8_t>(signal.channel);
  way.altered |= channel != record.channel || signal.start != record.start || signal.end != record.end;
  record.channel = channel;
  record.start = signal.start;
  record.end = way.breaks_off = signal.end;
  way.frame = way.frame && signal.signal == Signal::kFrame;
  if (signal.bytes.empty() || std::ranges::equal(signal.bytes, way.bytes.all())) return;
  way.altered = true;
  way.bytes.set(signal.bytes);
}

void ChannelLog::regenerated(Id id, const Leaving& arrived, const Leaving& forwarded, Duration branch) {
  if (id == kNone) return;
  Way& way = ways_[id];
  const bool broken_off = way.breaks_off < way.record.end;
  Leaving at_sender = arrived;
  at_sender.start = arrived.start - branch;
  at_sender.end = arrived.end - branch;
  // A frame that its sender broke off arrives undecodable.
  if (!broken_off) leaves(id, at_sender);
  if (arrived.signal == Signal::kFrame && forwarded.signal != Signal::kFrame)
    way.breaks_off = std::min(way.breaks_off, forwarded.end - branch);
}

void ChannelLog::breaks_off(NodeId sender, TrueTime at) {
  for (Way& way : ways_)
    if (way.used && way.record.sender == sender) way.breaks_off = std::min(way.breaks_off, at);
}

void ChannelLog::spreads(Id id, int receivers) {
  if (id != kNone) ways_[id].receivers = receivers;
}
void ChannelLog::lost(Id id) {
  if (id != kNone) ++ways_[id].lost;
}
void ChannelLog::not_received(Id id) {
  if (id != kNone) --ways_[id].receivers;
}
void ChannelLog::changed(Id id, std::span<const std::byte> bytes) {
  if (id == kNone) return;
  Way& way = ways_[id];
  if (way.changed++ == 0)
    way.other.set(bytes);
  else
    way.unlike |= !std::ranges::equal(bytes, way.other.all());
}

void ChannelLog::withheld(Id id) {
  if (id == kNone) return;
  Way& way = ways_[id];
  way.record.state = ChannelState::kNothing;
  // A signal without a controller and without receivers was nowhere.
  if (way.record.slot != 0) sink_.on(way.record);
  way.used = false;
  free_.push_back(id);
}

void ChannelLog::arrived(Id id) {
  if (id == kNone) return;
  Way& way = ways_[id];
  report(way);
  way.used = false;
  free_.push_back(id);
}

void ChannelLog::report(Way& way) {
  recording::records::ChannelFrame& record = way.record;
  if (way.changed > 0 && !way.unlike && way.changed + way.lost == way.receivers) {
    way.altered = true;
    way.bytes.set(way.other.all());
  }
  const bool broken_off = way.breaks_off < record.end;
  const bool out_of_reach = !way.frame || (way.receivers > 0 && way.lost >= way.receivers);
  if (!way.altered && !broken_off && !out_of_reach) return;
  record.end = std::min(record.end, way.breaks_off);
  if (record.end <= record.start) {
    record.state = ChannelState::kNothing;
    record.end = record.start;
    if (record.slot == 0) return;
  } else if (out_of_reach) {
    record.state = ChannelState::kCoding;
  } else {
    record.bytes = way.bytes.all().first(broken_off ? bytes_until_break(way) : way.bytes.size);
    bus::wire::FrameCrcs crcs =
        bus::wire::check_crcs(static_cast<schedules::model::Channel>(record.channel), record.bytes);
    // A missing CRC is not wrong.
    crcs.header_holds |= broken_off && record.bytes.size() < bus::wire::kHeaderBytes;
    crcs.frame_holds |= broken_off && record.bytes.size() < way.bytes.size;
    record.state = crc_state(crcs);
    if (broken_off) record.state |= ChannelState::kCoding | ChannelState::kCut;
  }
  sink_.on(record);
}

std::size_t ChannelLog::bytes_until_break(const Way& way) const {
  const std::int64_t bits = (way.breaks_off - way.record.start).ns * 1000 / bit_ps_;
  const std::int64_t whole = std::max<std::int64_t>(0, bits - bits_before_bytes_) / kBitsPerByte;
  return std::min(way.bytes.size, static_cast<std::size_t>(whole));
}

}  // namespace ttf::sim::medium
