// A log's frames on all buses, and its symbols on FlexRay, in one form and in the order of time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/ids.h"
#include "recording/log/manifest.h"
#include "recording/records/records.h"

namespace ttf::recording::exports {

// A controller's error on a private CAN, or its new state.
using CanTrouble = std::variant<records::CanError, records::CanState>;
// Returns "bit error", "error passive" and the like; "error 9" or "state 9" in a damaged log.
std::string to_text(const CanTrouble& trouble);

struct LoggedFrame {
  std::int64_t time_ns = 0;  // true time: a FlexRay frame's start, a CAN frame's end, as in the log
  bool flexray = false;
  std::uint8_t channel = 0;             // FlexRay: 0 A, 1 B; else the index of the CAN
  std::uint32_t id = 0;                 // slot or CAN identifier
  std::int64_t cycle = 0;               // running; FlexRay only
  bool null_frame = false;              // FlexRay only
  bool flexible_data_rate = false;      // CAN only
  std::optional<CanTrouble> can_error;  // CAN: an error frame, for an error or a controller's new state
  NodeId sender{};
  PduId pdu = kNoPdu;
  SensorId sensor = kNoSensor;  // with `sequence`, the measurement that the frame carries
  std::uint32_t sequence = 0;
  std::uint8_t fragment = 0;
  bool as_sent = true;            // FlexRay: sent by a controller, and unchanged on the channel
  bool of_controller = true;      // FlexRay: if false, `cycle` is unknown, and `id` is that of the frame's header
  records::ChannelState state{};  // FlexRay: of the records::ChannelFrame; never kNothing
  std::optional<records::Symbol> symbol;      // FlexRay: a symbol, with time, channel and sender only
  std::int64_t duration_ns = 0;               // of a symbol
  std::size_t data_begin = 0, data_size = 0;  // FlexRay: header, payload and trailer, as far as they were there
};

// The names behind a log's numbers; a number without a name is written out.
class LogNames {
 public:
  explicit LogNames(log::LogManifest manifest) : manifest_(std::move(manifest)) {}

  std::string node(NodeId id) const;
  std::string task(NodeId node, std::uint8_t task) const;
  std::string pdu(PduId id) const;
  std::string can_bus(std::size_t index) const;
  std::size_t can_buses() const { return manifest_.can_bus_names.size(); }
  std::string sensor(SensorId id) const;
  // "laser 12"; empty for a frame that carries no single measurement.
  std::string measurement(const LoggedFrame& frame) const;
  const log::LogManifest& manifest() const { return manifest_; }

 private:
  log::LogManifest manifest_;
};

// Collects frames while a log is read. FlexRay frames are as they were on the channel: without those that
// reached no receiver, and with noise. Symbols are as sent; a log has no more about them.
class FrameCollector final : public records::Sink {
 public:
  using records::Sink::on;
  void on(const records::SlotFrameSent& record) override;
  void on(const records::CanFrameSent& record) override;
  void on(const records::ChannelFrame& record) override;
  void on(const records::SymbolSent& record) override;
  void on(const records::CanErrorFrame& record) override { can_error(record); }
  void on(const records::CanStateChanged& record) override { can_error(record); }

  // Returns all frames so far, by time; frames of the same instant in the order of their records.
  std::vector<LoggedFrame> in_order() const;
  std::span<const std::byte> data(const LoggedFrame& frame) const {
    return std::span(bytes_).subspan(frame.data_begin, frame.data_size);
  }

 private:
  // A sent frame as it was on the channel.
  struct OnChannel {
    std::int64_t sent_ns = 0;
    NodeId sender{};
    std::uint8_t sent_channel = 0;
    bool nothing = false;
    LoggedFrame frame;  // without the fields that only the sender's record has
  };
  template <class Record> void can_error(const Record& record);
  LoggedFrame with_data(LoggedFrame frame, std::span<const std::byte> data);

  std::vector<LoggedFrame> frames_;
  std::vector<OnChannel> on_channel_;
  std::vector<std::byte> bytes_;
};

}  // namespace ttf::recording::exports
