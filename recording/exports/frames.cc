#include "recording/exports/frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <tuple>

#include "bus/wire/flexray_frame.h"
#include "recording/capture/packet.h"
#include "recording/records/records.h"

namespace ttf::recording::exports {
namespace {

// Errors on private CANs as SocketCAN's drivers report them: frames with an error flag in the identifier and eight bytes
// (Linux, include/uapi/linux/can/error.h). So captures show them to candump and Wireshark.
struct CanErrorBytes {
  std::uint32_t identifier = 0;  // capture::kErrorFrame and the classes
  std::array<std::byte, 8> data{};
};

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

CanTrouble trouble_of(const records::CanErrorFrame& error) { return error.error; }
CanTrouble trouble_of(const records::CanStateChanged& change) { return change.to; }

std::string name_or_number(const std::vector<std::string>& names, std::size_t index, const char* what) {
  return index < names.size() && !names[index].empty() ? names[index] : fmt::format("{} {}", what, index);
}

}  // namespace

std::string to_text(const CanTrouble& trouble) {
  const std::string_view words = std::visit([](auto one) { return to_text(one); }, trouble);
  const bool is_error = std::holds_alternative<records::CanError>(trouble);
  if (words.empty())
    return fmt::format("{} {}", is_error ? "error" : "state",
                       std::visit([](auto one) { return index_of(one); }, trouble));
  return std::string(words) + (is_error ? " error" : "");
}

std::string LogNames::node(NodeId id) const { return name_or_number(manifest_.node_names, index_of(id), "node"); }
std::string LogNames::task(NodeId node, std::uint8_t task) const {
  return index_of(node) < manifest_.task_names.size()
             ? name_or_number(manifest_.task_names[index_of(node)], task, "task")
             : fmt::format("task {}", task);
}
std::string LogNames::sensor(SensorId id) const {
  return name_or_number(manifest_.sensor_names, index_of(id), "sensor");
}
std::string LogNames::pdu(PduId id) const { return name_or_number(manifest_.pdu_names, index_of(id), "pdu"); }
std::string LogNames::can_bus(std::size_t index) const { return name_or_number(manifest_.can_bus_names, index, "can"); }

std::string LogNames::measurement(const LoggedFrame& frame) const {
  if (frame.null_frame || frame.sensor == kNoSensor) return "";
  return fmt::format("{} {}", sensor(frame.sensor), frame.sequence);
}

void FrameCollector::on(const records::SlotFrameSent& record) {
  LoggedFrame frame;
  frame.time_ns = record.stamp.true_time.ns;
  frame.flexray = true;
  frame.channel = record.channel == 0 ? 0 : 1;
  frame.id = record.slot;
  frame.cycle = record.cycle;
  frame.null_frame = record.null_frame;
  frame.sender = record.stamp.node;
  frame.pdu = record.pdu;
  frame.sensor = record.sensor;
  frame.sequence = record.sequence;
  frame.fragment = record.fragment;
  frames_.push_back(with_data(frame, record.bytes));
}

void FrameCollector::on(const records::CanFrameSent& record) {
  LoggedFrame frame;
  frame.time_ns = record.end.true_time.ns;
  frame.channel = record.bus;
  frame.id = record.identifier;
  frame.flexible_data_rate = record.flexible_data_rate;
  frame.sender = record.end.node;
  frame.pdu = record.pdu;
  frame.sensor = record.sensor;
  frame.sequence = record.sequence;
  frame.fragment = record.fragment;
  frames_.push_back(with_data(frame, record.data));
}

template <class Record> void FrameCollector::can_error(const Record& record) {
  const CanErrorBytes bytes = error_bytes_of(record);
  LoggedFrame frame;
  frame.time_ns = record.stamp.true_time.ns;
  frame.channel = record.bus;
  frame.id = bytes.identifier;
  frame.can_error = trouble_of(record);
  frame.sender = record.stamp.node;
  frames_.push_back(with_data(frame, bytes.data));
}
template void FrameCollector::can_error(const records::CanErrorFrame&);
template void FrameCollector::can_error(const records::CanStateChanged&);

void FrameCollector::on(const records::ChannelFrame& record) {
  LoggedFrame frame;
  frame.time_ns = record.start.ns;
  frame.flexray = true;
  frame.as_sent = false;
  frame.of_controller = record.slot != 0;
  frame.channel = record.channel == 0 ? 0 : 1;
  frame.sender = record.sender;
  frame.state = record.state;
  if (const auto header = bus::wire::header_of(record.bytes)) {
    frame.id = header->frame_id;
    frame.null_frame = header->null_frame;
  }
  frame = with_data(frame, record.bytes);
  const bool nothing = has(record.state, records::ChannelState::kNothing);
  if (frame.of_controller)
    on_channel_.push_back({record.sent.ns, record.sender, std::uint8_t{record.sent_channel != 0}, nothing, frame});
  else if (!nothing)
    frames_.push_back(frame);
}

void FrameCollector::on(const records::SymbolSent& record) {
  LoggedFrame symbol;
  symbol.time_ns = record.stamp.true_time.ns;
  symbol.flexray = true;
  symbol.channel = record.channel == 0 ? 0 : 1;
  symbol.sender = record.stamp.node;
  symbol.symbol = record.kind;
  symbol.duration_ns = record.end.true_time.ns - record.stamp.true_time.ns;
  frames_.push_back(symbol);
}

LoggedFrame FrameCollector::with_data(LoggedFrame frame, std::span<const std::byte> data) {
  frame.data_begin = bytes_.size();
  frame.data_size = data.size();
  bytes_.insert(bytes_.end(), data.begin(), data.end());
  return frame;
}

std::vector<LoggedFrame> FrameCollector::in_order() const {
  // A frame may have two records: one as sent, and one as it was on the channel if that differs.
  using Key = std::tuple<std::int64_t, std::uint8_t, NodeId>;
  std::map<Key, const OnChannel*> became;
  for (const OnChannel& one : on_channel_) became[{one.sent_ns, one.sent_channel, one.sender}] = &one;
  std::vector<LoggedFrame> frames;
  frames.reserve(frames_.size());
  for (const LoggedFrame& frame : frames_) {
    const bool sent = frame.flexray && !frame.symbol && frame.of_controller;
    const auto found = sent ? became.find({frame.time_ns, frame.channel, frame.sender}) : became.end();
    if (found == became.end()) {
      frames.push_back(frame);
      continue;
    }
    const OnChannel& other = *found->second;
    if (other.nothing) continue;
    LoggedFrame there = frame;
    there.as_sent = false;
    there.time_ns = other.frame.time_ns;
    there.channel = other.frame.channel;
    there.state = other.frame.state;
    there.data_begin = other.frame.data_begin;
    there.data_size = other.frame.data_size;
    frames.push_back(there);
  }
  std::stable_sort(frames.begin(), frames.end(),
                   [](const LoggedFrame& a, const LoggedFrame& b) { return a.time_ns < b.time_ns; });
  return frames;
}

}  // namespace ttf::recording::exports
