// Reads captures of other programs: pcap (either byte order, microseconds or nanoseconds) and pcapng (sections
// of either byte order; interfaces, enhanced, simple and obsolete packet blocks; others are skipped).
//
// The file is not trusted. Damage is an error, one sentence that names the file and the packet. Only a file
// that ends within a packet or block, as after the capturing program was killed, is read up to there, with a
// warning.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ttf::recording::capture {

// One interface. A pcap file has one, without a name.
struct CaptureSource {
  std::uint32_t link_type = 0;  // https://www.tcpdump.org/linktypes.html
  std::string name;
};

struct CapturedPacket {
  std::uint64_t number = 0;             // from 1, in the order of the file, as Wireshark counts
  std::size_t interface = 0;            // index in Capture::interfaces
  std::optional<std::int64_t> time_ns;  // between 1970 and 2116; simple packet blocks have no stamp
  std::uint64_t data_begin = 0;         // in the file
  std::uint32_t data_size = 0;
  std::uint32_t original_size = 0;  // before the capture cut it
  std::string comment;              // all comments of the packet, one per line
};

struct Capture {
  std::string bytes;                      // the file's
  std::vector<CaptureSource> interfaces;  // from all sections
  std::vector<CapturedPacket> packets;
  std::string warning;  // one line, empty for a whole file

  std::span<const std::byte> data(const CapturedPacket& packet) const {
    return std::as_bytes(std::span(bytes)).subspan(packet.data_begin, packet.data_size);
  }
  std::uint32_t link_type(const CapturedPacket& packet) const { return interfaces[packet.interface].link_type; }
};

// Both throw InputError; errors call the file `name`.
Capture read_capture(const std::string& path);
Capture parse_capture(std::string bytes, const std::string& name);

}  // namespace ttf::recording::capture
