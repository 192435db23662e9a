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

std::string_view flexray_kind(const LoggedFrame& frame) {
  if (!frame.of_controller && has(frame.state, records::ChannelState::kCoding)) return "noise";
  return frame.null_frame ? "null" : "frame";
}

std::string can_flags(const LoggedFrame& frame) {
  if (frame.can_error) return to_text(*frame.can_error);
  std::string text = frame.id > capture::kLargestBaseIdentifier ? "extended" : "";
  if (frame.flexible_data_rate) text += text.empty() ? "brs" : "+brs";
  return text;
}

std::string_view can_kind(const LoggedFrame& frame) {
  return frame.can_error ? "can_error" : frame.flexible_data_rate ? "can_fd" : "can";
}

// A frame or a symbol as a row, with everything that more than one column shows.
struct FrameRow {
  FrameRow(const FrameCollector& collector, const LoggedFrame& logged, const LogNames& all_names)
      : frame(logged), names(all_names), list(logged.pdu != kNoPdu), payload(collector.data(logged)) {
    if (frame.symbol) {
      kind = "symbol";
      flags = flag_of(*frame.symbol);
    } else if (frame.flexray) {
      const capture::CheckedFlexRayFrame there = checked(frame, payload);
      kind = flexray_kind(frame);
      flags = flexray_flags(there);
      payload = there.header_and_payload;
      payload = payload.subspan(std::min(payload.size(), bus::wire::kHeaderBytes));
    } else {
      kind = can_kind(frame);
      flags = can_flags(frame);
    }
  }

  const LoggedFrame& frame;
  const LogNames& names;
  bool list;
  std::span<const std::byte> payload;
  std::string_view kind;
  std::string flags;
};

template <class Value> std::optional<Value> value_if(bool there, Value value) {
  return there ? std::optional(std::move(value)) : std::nullopt;
}

constexpr ColumnOf<FrameRow> kFrameColumns[] = {
    {"bus", [](auto& r) { return r.frame.flexray ? std::string(kFlexRayName) : r.names.can_bus(r.frame.channel); }},
    {"channel", [](auto& r) { return r.frame.flexray ? std::string(1, letter(channel_of(r.frame))) : std::string(); }},
    {"cycle",
     [](auto& r) { return value_if(r.frame.flexray && !r.frame.symbol && r.frame.of_controller, r.frame.cycle); }},
    {"id", [](auto& r) { return value_if(!r.frame.symbol && r.kind != "noise", r.frame.id); }},
    {"sender",
     [](auto& r) {
       return r.frame.sender == kNoNode && !r.frame.symbol ? std::string() : r.names.node(r.frame.sender);
     }},
    {"kind", [](auto& r) { return r.kind; }},
    {"flags", [](auto& r) { return r.flags; }},
    {"pdu", [](auto& r) { return r.list ? r.names.pdu(r.frame.pdu) : std::string(); }},
    {"sequence", [](auto& r) { return value_if(r.list, r.frame.sequence); }},
    {"fragment", [](auto& r) { return value_if(r.list, r.frame.fragment); }},
    {"measurement", [](auto& r) { return r.names.measurement(r.frame); }},
    {"payload",
     [](auto& r) {
       std::string hex;
       put_hex(hex, r.payload);
       return hex;
     }},
};

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

std::vector<Column> frame_columns() { return columns_of(kFrameColumns); }

std::string frame_fields(const FrameCollector& collector, const LoggedFrame& frame, const LogNames& names) {
  return fields_line(kFrameColumns, FrameRow(collector, frame, names));
}

std::string csv_header() { return "time_ns," + names_line(frame_columns()) + '\n'; }

std::string export_csv(const FrameCollector& collector, const std::vector<LoggedFrame>& frames, const LogNames& names) {
  std::string out = csv_header();
  for (const LoggedFrame& frame : frames)
    out += fmt::format("{},{}\n", frame.time_ns, frame_fields(collector, frame, names));
  return out;
}

}  // namespace ttf::recording::exports
