// Inverts bits of a frame on its way: in the header, the payload or the trailer; for all receivers, or for some.
#include <array>

#include "sim/faults/families.h"
#include "sim/faults/frame_fault.h"

namespace ttf::sim::faults {
namespace {

constexpr int kBitsOfAByte = 8;

enum class FramePart { kHeader, kPayload, kTrailer };

class BitFlips final : public FrameFault {
 public:
  BitFlips(const FaultSetting& setting, FramePart part) : FrameFault(setting), part_(part) {}

  bool touches(NodeId sender, schedules::model::Channel channel) const override {
    return sender == fault().node && on(channel);
  }
  bool leaving(medium::Leaving& signal) override {
    if (!befalls(signal)) return true;
    Frame& frame = frames_[index_of(signal.channel)];
    std::copy(signal.bytes.begin(), signal.bytes.end(), frame.bytes.begin());
    frame.size = signal.bytes.size();
    const int flips = flip(frame, index_of(signal.channel));
    if (flips == 0) return true;
    if (fault().receivers.empty()) signal.bytes = frame.whole();
    acted("{} bit{} of a frame of {} on {} {} inverted", flips, flips == 1 ? "" : "s", name(signal.sender),
          letter(signal.channel), flips == 1 ? "is" : "are");
    return true;
  }
  bool arriving(medium::Arriving& signal) override {
    if (!fault().receivers.empty() && befallen(signal) && at_receiver(signal.receiver))
      signal.bytes = frames_[index_of(signal.channel)].whole();
    return true;
  }

 private:
  struct Frame {
    std::array<std::byte, bus::wire::kMaxFrameBytes> bytes{};
    std::size_t size = 0;
    std::span<const std::byte> whole() const { return std::span<const std::byte>(bytes).first(size); }
  };
  // Bits of a frame; bit 0 is the first on the bus.
  struct Region {
    int first = 0, count = 0;
  };
  Region region(std::size_t bytes) const {
    constexpr int kHeader = kBitsOfAByte * static_cast<int>(bus::wire::kHeaderBytes);
    constexpr int kTrailer = kBitsOfAByte * static_cast<int>(bus::wire::kTrailerBytes);
    const int bits = kBitsOfAByte * static_cast<int>(bytes);
    switch (part_) {
      case FramePart::kHeader: return {0, kHeader};
      case FramePart::kPayload: return {kHeader, bits - kHeader - kTrailer};
      case FramePart::kTrailer: return {bits - kTrailer, kTrailer};
    }
    return {};
  }

  // Inverts bits of the frame, and returns how many.
  int flip(Frame& frame, std::size_t channel) const {
    const Region where = region(frame.size);
    if (!fault().bits.empty()) {
      int flips = 0;
      for (const int bit : fault().bits)
        if (bit < where.count) invert(frame, where.first + bit), ++flips;  // a dynamic frame may be shorter
      return flips;
    }
    const int flips = std::min(fault().flips, where.count);
    // The k-th of the remaining bits, so that all are different: R. Floyd's way of drawing a set (Bentley, CACM 1987).
    std::array<int, 24> drawn{};
    RandomStream stream = frame_draws(static_cast<std::uint32_t>(channel));
    for (int i = 0; i < flips; ++i) {
      const int last = where.count - flips + i;
      const int bit = static_cast<int>(stream.integer(0, last));
      const auto end = drawn.begin() + i;
      drawn[static_cast<std::size_t>(i)] = std::find(drawn.begin(), end, bit) == end ? bit : last;
      invert(frame, where.first + drawn[static_cast<std::size_t>(i)]);
    }
    return flips;
  }
  static void invert(Frame& frame, int bit) {
    frame.bytes[static_cast<std::size_t>(bit / kBitsOfAByte)] ^= std::byte{0x80} >> (bit % kBitsOfAByte);
  }

  FramePart part_;
  std::array<Frame, 2> frames_;  // by channel, the last frame befallen, with its bits inverted
};

}  // namespace

std::unique_ptr<ActiveFault> make_header_flips(const FaultSetting& setting) {
  return std::make_unique<BitFlips>(setting, FramePart::kHeader);
}
std::unique_ptr<ActiveFault> make_payload_flips(const FaultSetting& setting) {
  return std::make_unique<BitFlips>(setting, FramePart::kPayload);
}
std::unique_ptr<ActiveFault> make_trailer_flips(const FaultSetting& setting) {
  return std::make_unique<BitFlips>(setting, FramePart::kTrailer);
}

}  // namespace ttf::sim::faults
