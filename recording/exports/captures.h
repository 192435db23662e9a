// A log's frames as other people's programs read them; the same log gives the same bytes.
//
//   pcapng   Wireshark: FlexRay (link type 210) and every private CAN (227), each an interface of its own. FlexRay
//            frames are as they were on the channel, with error flags from our own checks of the logged bytes; one that
//            no decoder makes out is a packet without header and payload, or with the bytes that were there before it
//            broke off. Symbols are packets of their own kind. A packet's comment names the measurement its frame
//            carries something of, and the list and fragment. The start of the run is 1970-01-01 00:00:00 UTC.
//   candump  canplayer, log2asc: the private CANs' frames, `(1000000001.234567) laser_can 100##1DEADBEEF`;
//            microseconds, as these programs read no more. The start of the run is second 1000000000: log2asc takes
//            second 0 for "no start yet". A CAN whose name cannot be a network interface's is called canN by its index.
//   csv      one row per frame of any bus, nanoseconds since the start of the run; see kCsvHeader
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "recording/exports/frames.h"

namespace ttf::recording::exports {

// id: slot or CAN identifier, decimal. kind: frame, null, noise, symbol (FlexRay), can, can_fd. flags: names joined by
// '+': sync, startup, preamble, header_crc_error, frame_crc_error, coding_error, frame_end_error (FlexRay), extended,
// brs (CAN); of a symbol cas, wakeup or media_test. measurement: sensor and sequence. payload: hex. What no controller
// sent has no cycle, noise no id, and what came out of nothing no sender; a symbol has neither cycle nor id.
inline constexpr std::string_view kCsvHeader =
    "time_ns,bus,channel,cycle,id,sender,kind,flags,pdu,sequence,fragment,measurement,payload\n";

// `frames` as from collector.in_order().
std::string export_pcapng(const FrameCollector& collector, const std::vector<LoggedFrame>& frames,
                          const LogNames& names);
std::string export_candump(const FrameCollector& collector, const std::vector<LoggedFrame>& frames,
                           const LogNames& names);
std::string export_csv(const FrameCollector& collector, const std::vector<LoggedFrame>& frames, const LogNames& names);

}  // namespace ttf::recording::exports
