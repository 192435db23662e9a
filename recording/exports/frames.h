// The frames of a log, of all buses, and the symbols on FlexRay, in one form and in the order of time: what the exports
// write.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/ids.h"
#include "recording/log/manifest.h"
#include "recording/records/records.h"

namespace ttf::recording::exports {

struct LoggedFrame {
  std::int64_t time_ns = 0;  // true time: a FlexRay frame's start, a CAN frame's end, as the log's own stamps
  bool flexray = false;
  std::uint8_t channel = 0;         // FlexRay: 0 A, 1 B; else index of the CAN
  std::uint32_t id = 0;             // slot or CAN identifier
  std::int64_t cycle = 0;           // running; FlexRay only
  bool null_frame = false;          // FlexRay only
  bool flexible_data_rate = false;  // CAN only
  NodeId sender{};
  PduId pdu = kNoPdu;
  SensorId sensor = kNoSensor;  // with `sequence` the measurement the frame carries something of
  std::uint32_t sequence = 0;
  std::uint8_t fragment = 0;
  bool as_sent = true;           // FlexRay: by a controller, and so it was on the channel
  bool of_controller = true;     // FlexRay: else nobody's; then `cycle` is not known, and `id` is what the frame says
  std::uint8_t state = 0;        // FlexRay: of records::ChannelFrame; never kChannelNothing
  std::uint8_t symbol = 0;       // FlexRay: records::kSymbolCas, ...: no frame, and has but time, channel and sender
  std::int64_t duration_ns = 0;  // of a symbol
  std::size_t data_begin = 0, data_size = 0;  // FlexRay: header, payload and trailer, as far as they were there
};

// The names that a log's numbers stand for; numbers without one are written out.
class LogNames {
 public:
  explicit LogNames(log::LogManifest manifest) : manifest_(std::move(manifest)) {}

  std::string node(NodeId id) const;
  std::string task(NodeId node, std::uint8_t task) const;
  std::string pdu(PduId id) const;
  std::string can_bus(std::size_t index) const;
  std::size_t can_buses() const { return manifest_.can_bus_names.size(); }
  std::string sensor(SensorId id) const;
  // "laser 12"; empty for a frame that carries nothing of a single measurement.
  std::string measurement(const LoggedFrame& frame) const;
  const log::LogManifest& manifest() const { return manifest_; }

 private:
  log::LogManifest manifest_;
};

struct SymbolName {
  const char* flag;
  const char* words;
};
SymbolName name_of_symbol(std::uint8_t symbol);  // records::kSymbolCas, ...

// Collects frames while a log is read. FlexRay frames are as they were on the channel: what reached nobody is none, and
// what nobody sent is one. Symbols are as they were sent: no log knows more of them.
class FrameCollector final : public records::Sink {
 public:
  using records::Sink::on;
  void on(const records::SlotFrameSent& record) override;
  void on(const records::CanFrameSent& record) override;
  void on(const records::ChannelFrame& record) override;
  void on(const records::SymbolSent& record) override;

  // All so far, by time; frames of the same instant as they were recorded.
  std::vector<LoggedFrame> in_order() const;
  std::span<const std::byte> data(const LoggedFrame& frame) const {
    return std::span(bytes_).subspan(frame.data_begin, frame.data_size);
  }

 private:
  // What became of a frame that was sent.
  struct OnChannel {
    std::int64_t sent_ns = 0;
    NodeId sender{};
    std::uint8_t sent_channel = 0;
    bool nothing = false;
    LoggedFrame frame;  // without what only the sender's record says
  };
  LoggedFrame with_data(LoggedFrame frame, std::span<const std::byte> data);

  std::vector<LoggedFrame> frames_;
  std::vector<OnChannel> on_channel_;
  std::vector<std::byte> bytes_;
};

}  // namespace ttf::recording::exports
