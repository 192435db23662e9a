// The frames of a log, of all buses, in one form and in the order of time: what the exports write.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/ids.h"
#include "recording/log_manifest.h"
#include "recording/records/records.h"

namespace ttf::recording {

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
  std::size_t data_begin = 0, data_size = 0;  // FlexRay: header, payload and trailer
};

// The names that a log's numbers stand for; numbers without one are written out.
class LogNames {
 public:
  explicit LogNames(LogManifest manifest) : manifest_(std::move(manifest)) {}

  std::string node(NodeId id) const;
  std::string pdu(PduId id) const;
  std::string can_bus(std::size_t index) const;
  std::size_t can_buses() const { return manifest_.can_bus_names.size(); }
  // "laser 12"; empty for a frame that carries nothing of a single measurement.
  std::string measurement(const LoggedFrame& frame) const;
  const LogManifest& manifest() const { return manifest_; }

 private:
  LogManifest manifest_;
};

// Collects frames while a log is read.
class FrameCollector final : public records::Sink {
 public:
  using records::Sink::on;
  void on(const records::SlotFrameSent& record) override;
  void on(const records::CanFrameSent& record) override;

  // All so far, by time; frames of the same instant as they were recorded.
  std::vector<LoggedFrame> in_order() const;
  std::span<const std::byte> data(const LoggedFrame& frame) const {
    return std::span(bytes_).subspan(frame.data_begin, frame.data_size);
  }

 private:
  void keep(LoggedFrame frame, std::span<const std::byte> data);
  std::vector<LoggedFrame> frames_;
  std::vector<std::byte> bytes_;
};

}  // namespace ttf::recording
