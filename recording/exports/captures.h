// Exports a log's frames for other programs; the same log gives the same bytes.
//
//   pcapng   Wireshark: FlexRay (link type 210) and every private CAN (227), each an interface of its own. FlexRay
//            frames are as they were on the channel, with error flags from our own checks of the logged bytes. An
//            undecodable frame is a packet without header and payload, or with the bytes before it broke off. Symbols
//            are packets of their own kind. A packet's comment names the measurement that its frame carries, the list
//            and the fragment. The start of the drive is 1970-01-01 00:00:00 UTC.
//   candump  canplayer, log2asc: the private CANs' frames, `(1000000001.234567) laser_can 100##1DEADBEEF`, in
//            microseconds, the unit of these programs. The start of the drive is second 1000000000, as log2asc takes
//            second 0 for "no start yet". A CAN is called canN by its index if its name cannot be an interface's.
//   csv      one row per frame of any bus, nanoseconds since the start of the drive; see frame_columns()
#pragma once

#include <string>
#include <vector>

#include "recording/exports/columns.h"
#include "recording/exports/frames.h"

namespace ttf::recording::exports {

// Returns the columns of a frame, without its time.
//
// id: slot or CAN identifier, decimal. kind: frame, null, noise, symbol (FlexRay), can, can_fd, can_error. flags: names
// joined by '+': sync, startup, preamble, header_crc_error, frame_crc_error, coding_error, frame_end_error
// (FlexRay), extended, brs (CAN). A symbol has cas, wakeup or media_test. A CAN's error has its words, to_text(CanTrouble).
// measurement: sensor and sequence. payload: hex. Symbols have no id and no cycle. Noise has no id. A frame that no
// controller sent has no cycle, and noise without a sending node has no sender.
std::vector<Column> frame_columns();
// Returns a frame's fields in these columns, with commas between.
std::string frame_fields(const FrameCollector& collector, const LoggedFrame& frame, const LogNames& names);

// `frames` are those of collector.in_order().
std::string export_pcapng(const FrameCollector& collector, const std::vector<LoggedFrame>& frames,
                          const LogNames& names);
std::string export_candump(const FrameCollector& collector, const std::vector<LoggedFrame>& frames,
                           const LogNames& names);
// The first line names the columns: `time_ns`, and frame_columns().
std::string csv_header();
std::string export_csv(const FrameCollector& collector, const std::vector<LoggedFrame>& frames, const LogNames& names);

}  // namespace ttf::recording::exports
