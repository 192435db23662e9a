// The older format: a file header, then a header of 16 bytes before each packet (draft-ietf-opsawg-pcap).
#include <fmt/format.h>

#include <algorithm>

#include "recording/capture/parser.h"

namespace ttf::recording::capture {
namespace {

constexpr std::size_t kFileHeader = 24, kPacketHeader = 16;
constexpr std::uint32_t kLinkTypeMask = 0x03ffffff;  // the bits above: presence and length of a frame check sequence

class PcapParser : CaptureParser {
 public:
  using CaptureParser::CaptureParser;

  void parse() {
    const auto magic = number<std::uint32_t>(0);
    swapped_ = magic != kPcapMicroseconds && magic != kPcapNanoseconds;
    unit_ns_ = number<std::uint32_t>(0) == kPcapNanoseconds ? 1 : 1000;
    if (left() < kFileHeader) damaged("file header", fmt::format("{} bytes", left()), "must have 24 bytes");
    if (const auto version = number<std::uint16_t>(4); version != 2)
      damaged("file header", fmt::format("version {}", version), "must be version 2 of pcap");
    most_ = std::max(number<std::uint32_t>(16), kMostPacketBytes);
    capture_.interfaces.push_back({number<std::uint32_t>(20) & kLinkTypeMask, ""});
    at_ = kFileHeader;
    while (left() > 0) packet();
  }

 private:
  void packet() {
    if (left() < kPacketHeader) return torn(next_packet());
    const auto second = number<std::uint32_t>(0), fraction = number<std::uint32_t>(4);
    const auto size = number<std::uint32_t>(8);
    if (size > most_)
      damaged(next_packet(), fmt::format("{} bytes", size), fmt::format("must have at most {} bytes", most_));
    if (fraction >= kSecond_ns / unit_ns_)
      damaged(next_packet(), fmt::format("{} {}", fraction, unit_ns_ == 1 ? "ns" : "us"),
              "must be a fraction of a second");
    if (left() - kPacketHeader < size) return torn(next_packet());
    CapturedPacket packet;
    packet.number = capture_.packets.size() + 1;
    packet.time_ns = std::int64_t{second} * kSecond_ns + fraction * unit_ns_;
    packet.data_begin = at_ + kPacketHeader;
    packet.data_size = size;
    packet.original_size = number<std::uint32_t>(12);
    capture_.packets.push_back(std::move(packet));
    at_ += kPacketHeader + size;
  }

  std::int64_t unit_ns_ = 1000;
  std::uint32_t most_ = kMostPacketBytes;
};

}  // namespace

void parse_pcap(Capture& capture, const std::string& name) { PcapParser(capture, name).parse(); }

}  // namespace ttf::recording::capture
