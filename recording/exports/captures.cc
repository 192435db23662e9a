#include "recording/exports/captures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "recording/capture/packet.h"
#include "recording/exports/pcapng_writer.h"
#include "recording/records/enumerations.h"

namespace ttf::recording::exports {
namespace {

constexpr char kFlexRayName[] = "FlexRay";
constexpr std::size_t kLongestDevice = 15;  // IFNAMSIZ minus the closing zero
constexpr std::int64_t kMicrosecond = 1'000, kSecond = 1'000'000'000;
constexpr std::int64_t kCandumpStart_s = 1'000'000'000;

constexpr std::int64_t kUsualBit_ps = 100'000;  // 10 Mbit/s

schedules::model::Channel channel_of(const LoggedFrame& frame) {
  return static_cast<schedules::model::Channel>(frame.channel);
}

void put_hex(std::string& out, std::span<const std::byte> bytes) {
  constexpr char kDigits[] = "0123456789ABCDEF";
  for (const std::byte byte : bytes) {
    out += kDigits[static_cast<unsigned>(byte) >> 4];
    out += kDigits[static_cast<unsigned>(byte) & 0xf];
  }
}

// Checks a frame's bytes anew; errors of coding and of the frame's end come from the log.
capture::CheckedFlexRayFrame checked(const LoggedFrame& frame, std::span<const std::byte> bytes) {
  if (!has(frame.state, records::ChannelState::kCoding)) return capture::check_flexray_frame(channel_of(frame), bytes);
  capture::CheckedFlexRayFrame broken = capture::check_broken_frame(channel_of(frame), bytes);
  broken.errors |= capture::kCodingError;
  if (has(frame.state, records::ChannelState::kCut)) broken.errors |= capture::kFrameEndError;
  return broken;
}

// Returns the origin of a frame, if its own header does not give it truly.
std::string origin_of(const LoggedFrame& frame, const LogNames& names) {
  if (!frame.flexray || frame.as_sent) return "";
  if (frame.of_controller) return fmt::format("slot {} of {}", frame.id, names.node(frame.sender));
  if (frame.sender == kNoNode) return "no node sent it";
  return fmt::format("the controller of {} did not send it", names.node(frame.sender));
}

std::string list_of(const LoggedFrame& frame, const LogNames& names) {
  if (frame.pdu == kNoPdu || frame.null_frame) return "";
  const std::string measurement = names.measurement(frame);
  if (measurement.empty())
    return fmt::format("{} {}, fragment {}", names.pdu(frame.pdu), frame.sequence, frame.fragment);
  return fmt::format("measurement {}: {}, fragment {}", measurement, names.pdu(frame.pdu), frame.fragment);
}

std::int64_t bits_of(const LoggedFrame& symbol, const LogNames& names) {
  const std::int64_t bit = names.manifest().bit_ps > 0 ? names.manifest().bit_ps : kUsualBit_ps;
  const double bits = static_cast<double>(symbol.duration_ns) * 1e3 / static_cast<double>(bit);
  return std::llround(std::clamp(bits, 0.0, static_cast<double>(capture::kLongestSymbolBits)));
}

std::string comment_of(const LoggedFrame& frame, const LogNames& names) {
  if (frame.symbol)
    return fmt::format("{} of {}, {:.1f} us", to_text(*frame.symbol), names.node(frame.sender),
                       static_cast<double>(frame.duration_ns) * 1e-3);
  const std::string origin = origin_of(frame, names), list = list_of(frame, names);
  return origin + (origin.empty() || list.empty() ? "" : "; ") + list;
}

bool can_be_a_device(const std::string& name) {
  return !name.empty() && name.size() <= kLongestDevice && name != "." && name != ".." &&
         std::all_of(name.begin(), name.end(),
                     [](char c) { return c > 0x20 && c < 0x7f && c != '/' && c != ':' && c != '=' && c != '%'; });
}

// Returns a field of a comma-separated row (RFC 4180).
std::string quoted(const std::string& text) {
  if (std::none_of(text.begin(), text.end(), [](char c) { return c == ',' || c == '"' || c == '\n' || c == '\r'; }))
    return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

std::string_view flag_of(records::Symbol symbol) {
  switch (symbol) {
    case records::Symbol::kCas: return "cas";
    case records::Symbol::kWakeup: return "wakeup";
    case records::Symbol::kMediaTest: return "media_test";
  }
  return "";
}

std::string flexray_flags(const capture::CheckedFlexRayFrame& frame) {
  const std::pair<bool, const char*> flags[] = {{frame.header.sync, "sync"},
                                                {frame.header.startup, "startup"},
                                                {frame.header.payload_preamble, "preamble"},
                                                {(frame.errors & capture::kHeaderCrcError) != 0, "header_crc_error"},
                                                {(frame.errors & capture::kFrameCrcError) != 0, "frame_crc_error"},
                                                {(frame.errors & capture::kCodingError) != 0, "coding_error"},
                                                {(frame.errors & capture::kFrameEndError) != 0, "frame_end_error"}};
  std::string text;
  for (const auto& [set, name] : flags)
    if (set) text += (text.empty() ? "" : "+") + std::string(name);
  return text;
}

std::string flexray_kind(const LoggedFrame& frame) {
  if (!frame.of_controller && has(frame.state, records::ChannelState::kCoding)) return "noise";
  return frame.null_frame ? "null" : "frame";
}

std::string can_flags(const LoggedFrame& frame) {
  if (frame.can_error) return "";
  std::string text = frame.id > capture::kLargestBaseIdentifier ? "extended" : "";
  if (frame.flexible_data_rate) text += text.empty() ? "brs" : "+brs";
  return text;
}

}  // namespace

std::string export_pcapng(const FrameCollector& collector, const std::vector<LoggedFrame>& frames,
                          const LogNames& names) {
  std::size_t buses = names.can_buses();
  for (const LoggedFrame& frame : frames)
    if (!frame.flexray) buses = std::max<std::size_t>(buses, frame.channel + std::size_t{1});
  std::vector<CaptureInterface> interfaces{{capture::LinkType::kFlexRay, kFlexRayName}};
  for (std::size_t b = 0; b < buses; ++b) interfaces.push_back({capture::LinkType::kCan, names.can_bus(b)});
  const log::LogManifest& drive = names.manifest();
  std::string out;
  CaptureWriter writer(out, interfaces,
                       fmt::format("{} with {} on {}, seed {}; time 0 is the start of the drive", drive.scenario_name,
                                   drive.strategy, drive.cluster_name, drive.seed));
  std::string packet;
  for (const LoggedFrame& frame : frames) {
    packet.clear();
    if (frame.symbol)
      capture::put_symbol_packet(packet, channel_of(frame), bits_of(frame, names));
    else if (frame.flexray)
      put_flexray_packet(packet, channel_of(frame), checked(frame, collector.data(frame)));
    else
      capture::put_can_packet(packet, frame.id, frame.flexible_data_rate, collector.data(frame));
    writer.packet(frame.flexray ? 0 : frame.channel + std::size_t{1}, frame.time_ns, packet, comment_of(frame, names));
  }
  return out;
}

std::string export_candump(const FrameCollector& collector, const std::vector<LoggedFrame>& frames,
                           const LogNames& names) {
  std::string out;
  for (const LoggedFrame& frame : frames) {
    if (frame.flexray) continue;
    const std::int64_t time = std::max<std::int64_t>(frame.time_ns, 0);
    const std::string bus = names.can_bus(frame.channel);
    out += fmt::format("({}.{:06}) {} ", kCandumpStart_s + time / kSecond, time % kSecond / kMicrosecond,
                       can_be_a_device(bus) ? bus : fmt::format("can{}", frame.channel));
    out +=
        frame.id > capture::kLargestBaseIdentifier ? fmt::format("{:08X}", frame.id) : fmt::format("{:03X}", frame.id);
    out += frame.flexible_data_rate ? fmt::format("##{:X}", capture::kBitRateSwitch) : "#";
    put_hex(out, collector.data(frame));
    out += '\n';
  }
  return out;
}

std::string csv_fields(const FrameCollector& collector, const LoggedFrame& frame, const LogNames& names) {
  if (frame.symbol)
    return fmt::format("{},{},,,{},symbol,{},,,,,", kFlexRayName, letter(channel_of(frame)),
                       quoted(names.node(frame.sender)), flag_of(*frame.symbol));
  const bool list = frame.pdu != kNoPdu;
  std::string out, flags;
  std::span<const std::byte> payload = collector.data(frame);
  if (frame.flexray) {
    const capture::CheckedFlexRayFrame there = checked(frame, payload);
    flags = flexray_flags(there);
    payload = there.header_and_payload;
    payload = payload.subspan(std::min(payload.size(), bus::wire::kHeaderBytes));
    out = fmt::format("{},{},{},", kFlexRayName, letter(channel_of(frame)),
                      frame.of_controller ? std::to_string(frame.cycle) : "");
  } else {
    flags = can_flags(frame);
    out = fmt::format("{},,,", quoted(names.can_bus(frame.channel)));
  }
  const std::string kind = frame.flexray              ? flexray_kind(frame)
                           : frame.can_error          ? "can_error"
                           : frame.flexible_data_rate ? "can_fd"
                                                      : "can";
  out += fmt::format("{},{},{},{},{},{},{},{},", kind == "noise" ? "" : std::to_string(frame.id),
                     frame.sender == kNoNode ? "" : quoted(names.node(frame.sender)), kind, flags,
                     list ? quoted(names.pdu(frame.pdu)) : "", list ? std::to_string(frame.sequence) : "",
                     list ? std::to_string(frame.fragment) : "", quoted(names.measurement(frame)));
  put_hex(out, payload);
  return out;
}

std::string export_csv(const FrameCollector& collector, const std::vector<LoggedFrame>& frames, const LogNames& names) {
  std::string out(kCsvHeader);
  for (const LoggedFrame& frame : frames)
    out += fmt::format("{},{}\n", frame.time_ns, csv_fields(collector, frame, names));
  return out;
}

}  // namespace ttf::recording::exports
