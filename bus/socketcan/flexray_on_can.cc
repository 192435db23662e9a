#include "bus/socketcan/flexray_on_can.h"

#include <algorithm>
#include <limits>

#include "bus/wire/flexray_crc.h"
#include "core/check.h"
#include "schedules/analysis/can_load.h"

namespace ttf::bus::socketcan {
namespace {

// Frames with identifier 0: content, then the CRC; one zero follows that of a follow-up.
constexpr std::size_t kSymbolSays = 5, kFollowUpSays = 8;
constexpr std::size_t kSymbolBytes = kSymbolSays + wire::kTrailerBytes;
constexpr std::size_t kFollowUpBytes = 12;
constexpr unsigned kFollowUpKind = 4;
constexpr int kLastCycle = 63;
constexpr unsigned kFragmentMark = 0x80, kFragmentUnused = 0x40;

std::span<const std::byte> data_of(const canfd_frame& can) { return std::as_bytes(std::span(can.data)).first(can.len); }

// Zeros where nothing is written.
canfd_frame empty_frame(int identifier, std::size_t bytes) {
  canfd_frame can{};
  can.can_id = static_cast<canid_t>(identifier);
  can.len = static_cast<std::uint8_t>(can_fd_length(bytes));
  can.flags = CANFD_BRS | CANFD_FDF;
  return can;
}

void put(canfd_frame& can, std::size_t at, std::span<const std::byte> bytes) {
  std::copy(bytes.begin(), bytes.end(), std::as_writable_bytes(std::span(can.data)).begin() + static_cast<int>(at));
}

std::size_t fragments_of(std::size_t length) { return (length + kFragmentBytes - 1) / kFragmentBytes; }

unsigned cycle_of(std::span<const std::byte> frame) { return static_cast<unsigned>(frame[4]) & 0x3f; }

bool all_zero(std::span<const std::byte> bytes) {
  return std::all_of(bytes.begin(), bytes.end(), [](std::byte byte) { return byte == std::byte{0}; });
}

// Returns the frame's length by its own header; no value if the header is wrong for that slot.
std::optional<std::size_t> stated_length(int slot, std::span<const std::byte> frame) {
  const std::optional<wire::FrameHeader> header = wire::header_of(frame);
  const bool reserved = header && (frame[0] & std::byte{kFragmentMark}) != std::byte{0};
  if (!header || reserved || header->frame_id != slot) return std::nullopt;
  if (wire::header_crc(header->sync, header->startup, header->frame_id, header->payload_words) != header->header_crc)
    return std::nullopt;
  return wire::kHeaderBytes + std::size_t{2} * header->payload_words + wire::kTrailerBytes;
}

bool goes_whole(int slot, std::span<const std::byte> frame) {
  return frame.size() <= CANFD_MAX_DLEN && stated_length(slot, frame) == frame.size();
}

// A CAN FD frame in the form of a fragment, its own three bytes checked.
struct Fragment {
  std::size_t index = 0;
  std::size_t length = 0;  // the whole frame's
  unsigned cycle = 0;
  std::span<const std::byte> bytes;  // the whole frame
};

std::optional<Fragment> fragment_of(int slot, std::span<const std::byte> data) {
  if (data.size() <= kFragmentHeaderBytes) return std::nullopt;
  const auto byte = [&](std::size_t i) { return static_cast<unsigned>(data[i]); };
  Fragment part;
  part.index = byte(0) & 7;
  part.length = std::size_t{(byte(1) & 0x80) << 1 | byte(2)};
  part.cycle = byte(1) & 0x3f;
  const std::size_t last = byte(0) >> 3 & 7;
  if (((byte(0) | byte(1)) & kFragmentUnused) != 0 || part.length < wire::kHeaderBytes + wire::kTrailerBytes ||
      part.length > wire::kMaxFrameBytes || last + 1 != fragments_of(part.length) || part.index > last)
    return std::nullopt;
  const std::size_t here = std::min(kFragmentBytes, part.length - part.index * kFragmentBytes);
  if (data.size() != can_fd_length(kFragmentHeaderBytes + here)) return std::nullopt;
  part.bytes = data.subspan(kFragmentHeaderBytes, here);
  if (!all_zero(data.subspan(kFragmentHeaderBytes + here))) return std::nullopt;
  if (part.index != 0) return part;
  if (cycle_of(part.bytes) != part.cycle) return std::nullopt;
  // A frame that fits whole is never sent in fragments.
  if (part.length <= CANFD_MAX_DLEN && stated_length(slot, part.bytes) == part.length) return std::nullopt;
  return part;
}

void put_big_endian(canfd_frame& can, std::size_t at, std::uint32_t value, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; ++i) can.data[at + i] = static_cast<std::uint8_t>(value >> (8 * (bytes - 1 - i)));
}

// Writes the CRC of the first `says` bytes after them.
void put_crc(canfd_frame& can, schedules::model::Channel channel, std::size_t says) {
  put_big_endian(can, says, wire::frame_crc(channel, data_of(can).first(says)), wire::kTrailerBytes);
}

std::uint32_t big_endian(std::span<const std::byte> bytes) {
  std::uint32_t value = 0;
  for (const std::byte byte : bytes) value = value << 8 | static_cast<std::uint32_t>(byte);
  return value;
}

bool crc_holds(schedules::model::Channel channel, std::span<const std::byte> data, std::size_t says) {
  return wire::frame_crc(channel, data.first(says)) == big_endian(data.subspan(says, wire::kTrailerBytes));
}

}  // namespace

std::size_t can_fd_length(std::size_t bytes) {
  TTF_CHECK(bytes <= CANFD_MAX_DLEN, "{} bytes", bytes);
  return static_cast<std::size_t>(*schedules::analysis::can_data_length(true, static_cast<int>(bytes)));
}

CanFrames frame_to_can(int slot, std::span<const std::byte> frame) {
  TTF_CHECK(slot >= 1 && slot <= kLastSlot, "slot {}", slot);
  TTF_CHECK(frame.size() >= wire::kHeaderBytes + wire::kTrailerBytes && frame.size() <= wire::kMaxFrameBytes,
            "{} bytes", frame.size());
  CanFrames can;
  if (goes_whole(slot, frame)) {
    can.count = 1;
    can.frames[0] = empty_frame(slot, frame.size());
    put(can.frames[0], 0, frame);
    return can;
  }
  can.count = fragments_of(frame.size());
  for (std::size_t i = 0; i < can.count; ++i) {
    const auto part = frame.subspan(i * kFragmentBytes, std::min(kFragmentBytes, frame.size() - i * kFragmentBytes));
    canfd_frame& one = can.frames[i] = empty_frame(slot, kFragmentHeaderBytes + part.size());
    one.data[0] = static_cast<std::uint8_t>(kFragmentMark | (can.count - 1) << 3 | i);
    one.data[1] = static_cast<std::uint8_t>((frame.size() >> 8) << 7 | cycle_of(frame));
    one.data[2] = static_cast<std::uint8_t>(frame.size() & 0xff);
    put(one, kFragmentHeaderBytes, part);
  }
  return can;
}

canfd_frame symbol_to_can(schedules::model::Channel channel, ports::Signal symbol, Duration duration) {
  TTF_CHECK(symbol != ports::Signal::kFrame, "a frame is no symbol");
  TTF_CHECK(duration.ns >= 0 && duration.ns <= std::numeric_limits<std::uint32_t>::max(), "{} ns", duration.ns);
  canfd_frame can = empty_frame(kSymbolIdentifier, kSymbolBytes);
  can.data[0] = symbol == ports::Signal::kCas ? 1 : symbol == ports::Signal::kWakeup ? 2 : 3;
  put_big_endian(can, 1, static_cast<std::uint32_t>(duration.ns), 4);
  put_crc(can, channel, kSymbolSays);
  return can;
}

bool fits_follow_up(Duration late) {
  using Limits = std::numeric_limits<std::int32_t>;
  return late.ns >= Limits::min() && late.ns <= Limits::max();
}

canfd_frame follow_up_to_can(schedules::model::Channel channel, const FollowUp& follow_up) {
  TTF_CHECK(follow_up.slot >= 1 && follow_up.slot <= kLastSlot, "slot {}", follow_up.slot);
  TTF_CHECK(follow_up.cycle_counter <= kLastCycle, "cycle {}", follow_up.cycle_counter);
  TTF_CHECK(fits_follow_up(follow_up.late), "{} ns", follow_up.late.ns);
  canfd_frame can = empty_frame(kSymbolIdentifier, kFollowUpBytes);
  can.data[0] = kFollowUpKind;
  put_big_endian(can, 1, static_cast<std::uint32_t>(follow_up.slot), 2);
  can.data[3] = follow_up.cycle_counter;
  put_big_endian(can, 4, static_cast<std::uint32_t>(follow_up.late.ns), 4);
  put_crc(can, channel, kFollowUpSays);
  return can;
}

Arrival Reassembly::arrive(const canfd_frame& can) {
  Arrival arrival;
  const canid_t flags = can.can_id & (CAN_EFF_FLAG | CAN_RTR_FLAG | CAN_ERR_FLAG);
  if ((can.flags & CANFD_FDF) == 0 || flags != 0 || can.can_id > CAN_SFF_MASK) {
    arrival.outcome = Outcome::kForeign;
  } else if (can.len > CANFD_MAX_DLEN || can.len == 0) {
    arrival.outcome = Outcome::kMalformed;
  } else {
    const auto slot = static_cast<int>(can.can_id);
    const std::span<const std::byte> data = data_of(can);
    if (slot != kSymbolIdentifier && (can.data[0] & kFragmentMark) != 0) {
      arrival = fragment(slot, data);
    } else {
      const bool said_later = slot == kSymbolIdentifier && data[0] == std::byte{kFollowUpKind};
      arrival = said_later ? follow_up(data) : slot == kSymbolIdentifier ? symbol(data) : whole(slot, data);
      // Another complete signal of ours where a fragment was due.
      arrival.abandoned = arrival.outcome == Outcome::kComplete && !said_later && next_ != 0;
      if (arrival.abandoned) next_ = 0;
    }
  }
  ++counts_[static_cast<std::size_t>(arrival.outcome)];
  if (arrival.abandoned) ++abandoned_;
  return arrival;
}

Arrival Reassembly::symbol(std::span<const std::byte> data) const {
  Arrival arrival{.outcome = Outcome::kMalformed};
  if (data.size() != kSymbolBytes) return arrival;
  const auto kind = static_cast<unsigned>(data[0]);
  if (kind < 1 || kind > 3) return arrival;
  if (!crc_holds(channel_, data, kSymbolSays)) return arrival;
  arrival.outcome = Outcome::kComplete;
  arrival.signal = kind == 1 ? ports::Signal::kCas : kind == 2 ? ports::Signal::kWakeup : ports::Signal::kUndecodable;
  arrival.duration = Duration::nanoseconds(big_endian(data.subspan(1, 4)));
  return arrival;
}

Arrival Reassembly::follow_up(std::span<const std::byte> data) const {
  Arrival arrival{.outcome = Outcome::kMalformed};
  if (data.size() != kFollowUpBytes || !all_zero(data.subspan(kFollowUpSays + wire::kTrailerBytes))) return arrival;
  if (!crc_holds(channel_, data, kFollowUpSays)) return arrival;
  const auto slot = static_cast<int>(big_endian(data.subspan(1, 2)));
  const auto cycle = static_cast<int>(data[3]);
  if (slot < 1 || slot > kLastSlot || cycle > kLastCycle) return arrival;
  arrival.outcome = Outcome::kComplete;
  arrival.follow_up = FollowUp{.slot = slot,
                               .cycle_counter = static_cast<std::uint8_t>(cycle),
                               .late = {static_cast<std::int32_t>(big_endian(data.subspan(4, 4)))}};
  return arrival;
}

Arrival Reassembly::whole(int slot, std::span<const std::byte> data) const {
  Arrival arrival{.outcome = Outcome::kMalformed};
  const std::optional<std::size_t> length = stated_length(slot, data);
  if (!length || *length > CANFD_MAX_DLEN || can_fd_length(*length) != data.size()) return arrival;
  if (!all_zero(data.subspan(*length))) return arrival;
  arrival.outcome = Outcome::kComplete;
  arrival.slot = slot;
  arrival.signal = ports::Signal::kFrame;
  arrival.frame = data.first(*length);
  return arrival;
}

Arrival Reassembly::fragment(int slot, std::span<const std::byte> data) {
  Arrival arrival{.outcome = Outcome::kMalformed};
  const std::optional<Fragment> proved = fragment_of(slot, data);
  if (!proved) return arrival;
  const Fragment& part = *proved;
  arrival.outcome = Outcome::kFragment;
  arrival.slot = slot;
  const auto place = bytes_.begin() + static_cast<std::ptrdiff_t>(part.index * kFragmentBytes);
  const bool of_begun = next_ != 0 && slot == slot_ && part.length == length_ && part.cycle == cycle_of(bytes_);
  if (of_begun && part.index < next_ && std::equal(part.bytes.begin(), part.bytes.end(), place)) {
    arrival.outcome = Outcome::kDisplaced;  // already here: harmless
    return arrival;
  }
  if (part.index == 0 || !of_begun || part.index != next_) {
    arrival.abandoned = next_ != 0;
    next_ = 0;
    if (part.index != 0) {
      arrival.outcome = Outcome::kDisplaced;
      return arrival;
    }
    slot_ = slot;
    length_ = part.length;
  }
  std::copy(part.bytes.begin(), part.bytes.end(), place);
  next_ = part.index + 1;
  if (part.index + 1 < fragments_of(length_)) return arrival;
  next_ = 0;
  arrival.outcome = Outcome::kComplete;
  arrival.signal = ports::Signal::kFrame;
  arrival.frame = std::span(bytes_).first(length_);
  return arrival;
}

}  // namespace ttf::bus::socketcan
