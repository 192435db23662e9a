// The newer format: blocks, each with its type, and with its length at both ends (draft-ietf-opsawg-pcapng).
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/int128.h"
#include "recording/capture/parser.h"

namespace ttf::recording::capture {
namespace {

// Keeps differences of stamps within 64 bits, with room to spare.
constexpr std::int64_t kLatest = std::numeric_limits<std::int64_t>::max() / 2;
constexpr std::uint32_t kMostBlockBytes = 16u << 20;

// The unit and origin of an interface's time stamps.
struct Clock {
  bool binary = false;  // 2^-digits s, else 10^-digits s
  int digits = 6;
  std::int64_t offset_s = 0;
};

Int128 nanoseconds(const Clock& clock, std::uint64_t ticks) {
  Int128 per_second = 1;
  for (int i = 0; i < clock.digits; ++i) per_second *= clock.binary ? 2 : 10;
  const Int128 count = ticks;
  return (count / per_second) * kSecond_ns + (count % per_second) * kSecond_ns / per_second +
         Int128{clock.offset_s} * kSecond_ns;
}

class PcapngParser : CaptureParser {
 public:
  using CaptureParser::CaptureParser;

  void parse() {
    while (left() > 0) block();
  }

 private:
  void block() {
    if (left() < kBlockFrame) return torn("block before " + next_packet());
    const bool section = number<std::uint32_t>(0) == static_cast<std::uint32_t>(BlockType::kSection);
    if (section) byte_order();
    type_ = number<std::uint32_t>(0);
    size_ = number<std::uint32_t>(4);
    if (size_ < kBlockFrame || size_ % 4 != 0 || size_ > kMostBlockBytes)
      damaged("block before " + next_packet(), fmt::format("{} bytes", size_),
              fmt::format("must be {}..{} and whole 32-bit words", kBlockFrame, kMostBlockBytes));
    if (left() < size_) return torn("block before " + next_packet());
    if (const auto again = number<std::uint32_t>(size_ - 4); again != size_)
      damaged("block before " + next_packet(), fmt::format("{} and {} bytes", size_, again),
              "must state the same length at both ends");
    switch (static_cast<BlockType>(type_)) {
      case BlockType::kSection: begin_section(); break;
      case BlockType::kInterface: interface(); break;
      case BlockType::kEnhancedPacket: enhanced_packet(); break;
      case BlockType::kObsoletePacket: obsolete_packet(); break;
      case BlockType::kSimplePacket: simple_packet(); break;
      default: break;  // statistics, names, and other programs' blocks
    }
    at_ += size_;
  }

  void byte_order() {
    swapped_ = false;
    if (number<std::uint32_t>(8) == kByteOrderMagic) return;
    swapped_ = true;
    if (number<std::uint32_t>(8) != kByteOrderMagic)
      damaged("section before " + next_packet(), fmt::format("{:#x}", number<std::uint32_t>(8)),
              "must have the byte order magic 0x1a2b3c4d");
  }

  // Checks that the block has `fields` bytes before its options.
  void need(std::size_t fields, const std::string& what) const {
    if (size_ < kBlockFrame + fields)
      damaged(what, fmt::format("{} bytes", size_), fmt::format("must have at least {}", kBlockFrame + fields));
  }

  void begin_section() {
    need(16, "section before " + next_packet());
    if (const auto version = number<std::uint16_t>(12); version != 1)
      damaged("section before " + next_packet(), fmt::format("version {}", version), "must be version 1 of pcapng");
    first_interface_ = capture_.interfaces.size();
    clocks_.clear();
    snap_bytes_ = 0;
  }

  // Calls take(code, begin, size) for every option from `offset` in the block on.
  template <class Take> void options(std::size_t offset, const std::string& what, Take&& take) const {
    const std::size_t end = size_ - sizeof(std::uint32_t);
    while (offset + 4 <= end) {
      const auto code = number<std::uint16_t>(offset);
      const std::size_t size = number<std::uint16_t>(offset + 2);
      if (code == static_cast<std::uint16_t>(BlockOption::kEnd)) return;
      if (padded(size) > end - offset - 4) damaged(what, fmt::format("option of {} bytes", size), "must fit its block");
      take(static_cast<BlockOption>(code), at_ + offset + 4, size);
      offset += 4 + padded(size);
    }
  }

  void interface() {
    const std::string what = fmt::format("interface {} before {}", clocks_.size(), next_packet());
    need(8, what);
    CaptureSource source{number<std::uint16_t>(8), ""};
    Clock clock;
    options(16, what, [&](BlockOption code, std::size_t begin, std::size_t size) {
      if (code == BlockOption::kInterfaceName) source.name = std::string(bytes_.substr(begin, size));
      if (code == BlockOption::kTimeResolution && size == 1) {
        const auto value = static_cast<unsigned char>(bytes_[begin]);
        clock.binary = (value & 0x80) != 0;
        clock.digits = value & 0x7f;
        if (clock.digits > (clock.binary ? 63 : 19))
          damaged(what, fmt::format("time resolution {}", value), "must be down to 10^-19 or 2^-63 s");
      }
      if (code == BlockOption::kTimeOffset && size == 8)
        clock.offset_s = number_at<std::int64_t>(bytes_, begin, swapped_);
    });
    if (clocks_.empty()) snap_bytes_ = number<std::uint32_t>(12);
    clocks_.push_back(clock);
    capture_.interfaces.push_back(std::move(source));
  }

  void check_interface(std::size_t index) const {
    if (index >= clocks_.size())
      damaged(next_packet(), fmt::format("interface {}", index),
              fmt::format("must be of one of the section's {} interfaces", clocks_.size()));
  }

  void add(std::size_t interface, std::optional<std::int64_t> time_ns, std::size_t data, std::uint32_t size,
           std::uint32_t original) {
    if (size > kMostPacketBytes || size > size_ - kBlockFrame - (data - 8))
      damaged(next_packet(), fmt::format("{} bytes", size), "must fit its block");
    CapturedPacket packet;
    packet.number = capture_.packets.size() + 1;
    packet.interface = first_interface_ + interface;
    packet.time_ns = time_ns;
    packet.data_begin = at_ + data;
    packet.data_size = size;
    packet.original_size = original;
    capture_.packets.push_back(std::move(packet));
  }

  void stamped_packet(std::size_t interface) {
    check_interface(interface);
    const std::uint64_t ticks = (std::uint64_t{number<std::uint32_t>(12)} << 32) | number<std::uint32_t>(16);
    const Int128 time = nanoseconds(clocks_[interface], ticks);
    if (time < 0 || time > kLatest)
      damaged(next_packet(), fmt::format("time stamp {}", ticks), "must be between 1970 and 2116");
    const std::string what = next_packet();
    const auto size = number<std::uint32_t>(20);
    add(interface, static_cast<std::int64_t>(time), 28, size, number<std::uint32_t>(24));
    std::string& comment = capture_.packets.back().comment;
    const std::size_t first_option = std::min<std::size_t>(28 + padded(size), size_);
    options(first_option, what, [&](BlockOption code, std::size_t begin, std::size_t bytes) {
      if (code != BlockOption::kComment) return;
      if (!comment.empty()) comment += '\n';
      comment += bytes_.substr(begin, bytes);
    });
  }

  void enhanced_packet() {
    need(20, next_packet());
    stamped_packet(number<std::uint32_t>(8));
  }
  // As above, but the interface has 16 bits, and the number of lost packets has the other 16.
  void obsolete_packet() {
    need(20, next_packet());
    stamped_packet(number<std::uint16_t>(8));
  }
  void simple_packet() {
    need(4, next_packet());
    check_interface(0);
    const auto original = number<std::uint32_t>(8);
    add(0, std::nullopt, 12, snap_bytes_ == 0 ? original : std::min(original, snap_bytes_), original);
  }

  std::uint32_t type_ = 0, size_ = 0;  // the block's
  std::size_t first_interface_ = 0;    // the section's
  std::vector<Clock> clocks_;          // by interface of the section
  std::uint32_t snap_bytes_ = 0;       // its first interface's
};

}  // namespace

void parse_pcapng(Capture& capture, const std::string& name) { PcapngParser(capture, name).parse(); }

}  // namespace ttf::recording::capture
