// Numbers of the pcapng and pcap formats, shared by writer and reader. Private to the module.
#pragma once

#include <cstddef>
#include <cstdint>

namespace ttf::recording::capture {

enum class BlockType : std::uint32_t {
  kInterface = 1,
  kObsoletePacket = 2,
  kSimplePacket = 3,
  kEnhancedPacket = 6,
  kSection = 0x0a0d0d0a,  // the same in either byte order
};

enum class BlockOption : std::uint16_t {
  kEnd = 0,
  kComment = 1,
  kInterfaceName = 2,
  kTimeResolution = 9,
  kTimeOffset = 14,
};

inline constexpr std::uint32_t kByteOrderMagic = 0x1a2b3c4d;
inline constexpr std::uint32_t kPcapMicroseconds = 0xa1b2c3d4, kPcapNanoseconds = 0xa1b23c4d;
inline constexpr std::size_t kBlockFrame = 12;             // type, length, length again
inline constexpr std::uint32_t kMostPacketBytes = 262144;  // libpcap's limit, too

// Blocks, options and data are padded to whole 32-bit words.
constexpr std::size_t padded(std::size_t bytes) { return (bytes + 3) & ~std::size_t{3}; }

}  // namespace ttf::recording::capture
