// Runs tshark on a capture, and gives the expected output for a log's frames.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bus/wire/flexray_frame.h"
#include "recording/exports/captures.h"
#include "recording/log/reader.h"
#include "tests/recording/log/log_fixture.h"
#include "tests/sim/drives/drive_fixture.h"

namespace ttf::recording::exports {

// The fields requested from tshark, in the order of the compared lines.
inline constexpr char kFields[] =
    "-e frame.time_epoch -e frame.interface_name -e frame.comment -e flexray.ch -e flexray.fid -e flexray.cc "
    "-e flexray.ppi -e flexray.nfi -e flexray.sfi -e flexray.stfi -e flexray.pl -e flexray.hcrc -e flexray.hcrc_err "
    "-e flexray.fcrc_err -e flexray.fes_err -e flexray.cod_err -e flexray.tss_viol "
    "-e flexray.malformed_frame_payload -e flexray.stfi_flag "
    "-e can.id -e can.flags.xtd -e can.len -e canfd.flags.brs "
    "-e flexray.sl -e flexray.malformed_symbol_frame";

struct CapturedLine {
  std::int64_t time_ns = 0;
  std::string text;
};

inline std::string seconds(std::int64_t ns) { return fmt::format("{}.{:09}", ns / 1'000'000'000, ns % 1'000'000'000); }

struct Flags {
  bool header_crc = false, frame_crc = false, frame_end = false, coding = false;
};

// tshark's expected output for a packet with these bytes of a frame. Includes the trailer if the frame is
// complete.
inline std::string flexray_text(const std::string& comment, int channel, std::span<const std::byte> bytes,
                                const Flags& flags) {
  const std::string errors =
      fmt::format("{:d}\t{:d}\t{:d}\t{:d}\t0", flags.header_crc, flags.frame_crc, flags.frame_end, flags.coding);
  if (bytes.empty())
    return fmt::format("FlexRay\t{}\t{}{}{}{}", comment, channel, std::string(9, '\t'), errors, std::string(8, '\t'));
  const bus::wire::FrameHeader h = bus::wire::header_of(bytes).value();
  const std::size_t payload = bytes.size() - bus::wire::kHeaderBytes - (flags.frame_end ? 0 : bus::wire::kTrailerBytes);
  return fmt::format("FlexRay\t{}\t{}\t{}\t{}\t{:d}\t{:d}\t{:d}\t{:d}\t{}\t{}\t{}\t{}\t{}\t\t\t\t\t\t", comment,
                     channel, h.frame_id, h.cycle, h.payload_preamble, !h.null_frame, h.sync, h.startup,
                     h.payload_words, h.header_crc, errors, payload == 2U * h.payload_words ? "" : "1",
                     h.startup && !h.sync ? "1" : "");
}

// Sync to the end of the header CRC.
inline bool in_header_crc(std::size_t bit) { return bit >= 3 && bit <= 33; }

// Reads a log: every frame goes on to the export, and its expected tshark output into `lines`. One bit of
// every `flip_every`-th FlexRay frame is flipped, as if disturbed on the wire.
class Expectation : public records::Sink {
 public:
  Expectation(FrameCollector& collector, const log::LogManifest& manifest, std::vector<SensorId> pdu_sensors,
              std::size_t flip_every)
      : collector_(collector), manifest_(manifest), pdu_sensors_(std::move(pdu_sensors)), flip_every_(flip_every) {}

  using records::Sink::on;
  void on(const records::SlotFrameSent& record) override {
    std::vector<std::byte> bytes(record.bytes.begin(), record.bytes.end());
    Flags flags;
    if (flip_every_ > 0 && ++frames_ % flip_every_ == 0) {
      const std::size_t bit = flipped_++ % (bytes.size() * 8);
      bytes[bit / 8] ^= static_cast<std::byte>(0x80 >> bit % 8);
      flags.frame_crc = true;
      flags.header_crc = in_header_crc(bit);
    }
    records::SlotFrameSent sent = record;
    sent.bytes = bytes;
    collector_.on(sent);
    lines.push_back({record.stamp.true_time.ns,
                     flexray_text(comment(record.pdu, record.sequence, record.fragment, record.null_frame),
                                  record.channel, bytes, flags)});
    if (flags.frame_crc) return;
    const bus::wire::FrameHeader h =
        bus::wire::decode_frame(static_cast<schedules::model::Channel>(record.channel), bytes).header;
    // The frame's bytes agree with the log's fields.
    EXPECT_EQ(h.frame_id, record.slot);
    EXPECT_EQ(h.cycle, record.cycle % 64);
    EXPECT_EQ(h.null_frame, record.null_frame);
  }
  void on(const records::CanFrameSent& record) override {
    collector_.on(record);
    lines.push_back(
        {record.end.true_time.ns,
         fmt::format("{}\t{}\t\t\t\t\t\t\t\t\t\t\t\t\t\t\t\t\t{}\t0\t{}\t{}\t\t", manifest_.can_bus_names[record.bus],
                     comment(record.pdu, record.sequence, record.fragment, false), record.identifier,
                     record.data.size(), record.flexible_data_rate ? "1" : "")});
  }
  // A collision avoidance symbol's TSS of 9 bits is low, too, followed by 30 more. A wake-up pattern has more
  // than 127.
  void on(const records::SymbolSent& record) override {
    collector_.on(record);
    const bool cas = record.kind == records::Symbol::kCas;
    ++(cas ? cas_ : wakeup_);
    const double us = (record.end.true_time - record.stamp.true_time).seconds() * 1e6;
    const std::string text = fmt::format("{} of {}, {:.1f} us", cas ? "collision avoidance symbol" : "wake-up pattern",
                                         node(record.stamp.node), us);
    lines.push_back({record.stamp.true_time.ns, fmt::format("FlexRay\t{}\t{}{}{}\t", text, record.channel,
                                                            std::string(20, '\t'), cas ? 39 : 127)});
  }
  std::vector<CapturedLine> lines;
  int cas() const { return cas_; }
  int wakeup() const { return wakeup_; }
  std::size_t flipped() const { return flipped_; }

 protected:
  std::string comment(PduId pdu, std::uint32_t sequence, int fragment, bool null_frame) const {
    if (pdu == kNoPdu || null_frame) return "";
    const SensorId sensor = pdu_sensors_[index_of(pdu)];
    const std::string& list = manifest_.pdu_names[index_of(pdu)];
    if (sensor == kNoSensor) return fmt::format("{} {}, fragment {}", list, sequence, fragment);
    return fmt::format("measurement {} {}: {}, fragment {}", manifest_.sensor_names[index_of(sensor)], sequence, list,
                       fragment);
  }
  const std::string& node(NodeId id) const { return manifest_.node_names[index_of(id)]; }
  FrameCollector& collector_;

 private:
  const log::LogManifest& manifest_;
  std::vector<SensorId> pdu_sensors_;
  std::size_t flip_every_, frames_ = 0, flipped_ = 0;
  int cas_ = 0, wakeup_ = 0;
};

inline std::vector<std::string> tshark(const std::string& file) {
  const std::string command = fmt::format("tshark -n -r '{}' -T fields {} 2>/dev/null", file, kFields);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(::popen(command.c_str(), "r"), &::pclose);
  std::string text;
  char block[4096];
  while (const std::size_t got = std::fread(block, 1, sizeof block, pipe.get())) text.append(block, got);
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

inline bool has_tshark() { return std::system("tshark --version >/dev/null 2>&1") == 0; }

// A log of the paper's first scenario.
inline std::string drive_log(const sim::drives::Drive& drive) {
  log::LogManifest manifest;
  manifest.scenario_name = drive.scenario.name;
  manifest.bit_ps = drive.cluster.flexray.gdBit_ps;
  for (const schedules::model::Node& node : drive.cluster.nodes) manifest.node_names.push_back(node.name);
  for (const schedules::model::PduLayout& pdu : drive.cluster.pdus) manifest.pdu_names.push_back(pdu.name);
  for (const schedules::model::Sensor& sensor : drive.cluster.sensors) manifest.sensor_names.push_back(sensor.name);
  for (const schedules::model::CanBus& bus : drive.cluster.can_buses) manifest.can_bus_names.push_back(bus.name);
  const std::string path = log::scratch("drive.mcap");
  log::LogWriter log(path, manifest);
  drive.run(log);
  log.close();
  return path;
}

}  // namespace ttf::recording::exports
