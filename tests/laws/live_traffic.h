// Members' utterances for the laws of bus/ports/live_medium.h: the number-th utterance of a member on a line.
// A hearer identifies it from its content, and compares it with the expected one.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "bus/ports/live_medium.h"
#include "bus/wire/flexray_frame.h"
#include "core/time.h"

namespace ttf::laws {

enum class Traffic {
  kAll,     // frames of all lengths, null frames, sync frames with their lateness, broken frames, all symbols
  kFrames,  // only frames of 24 bytes
};

// The speaker, and the number of members (1..16, the speaker included).
struct Speaker {
  std::size_t index = 0;
  std::size_t members = 0;
};

class Utterance {
 public:
  // `fast`: of a CAN line, whether it carries CAN FD.
  Utterance(bus::ports::Line line, Speaker speaker, std::size_t number, Traffic traffic, bool fast = false)
      : line_(line), speaker_(speaker), number_(number) {
    for (std::size_t i = 0; i < bytes_.size(); ++i)
      bytes_[i] = static_cast<std::byte>((number * 0x9E3779B9u + speaker.index * 89 + i * 0x85EBCA6Bu) >> 13);
    if (is_can())
      make_can(fast);
    else
      make_signal(traffic);
  }

  bool is_can() const { return line_ >= bus::ports::line_of_can(0); }
  bus::ports::LiveSignal signal() const {
    return {.channel = static_cast<schedules::model::Channel>(line_),
            .signal = what_,
            .slot = slot(),
            .duration = duration_,
            .bytes = std::span(bytes_).first(size_),
            .states_late = late_.has_value()};
  }
  bus::ports::CanFrame can() const {
    return {static_cast<std::uint32_t>(number_ % 100 * speaker_.members + speaker_.index), fast_,
            std::span(bytes_).first(size_)};
  }
  std::uint8_t cycle() const { return static_cast<std::uint8_t>(number_ % 64); }
  int slot() const { return static_cast<int>(1 + number_ % 50 * speaker_.members + speaker_.index); }
  // The lateness of a sync frame that carries it, when it is handed over.
  std::optional<Duration> late() const { return late_; }

  bus::ports::LiveStatus send(bus::ports::LiveMedium& medium) const {
    return is_can() ? medium.send_can(line_ - bus::ports::line_of_can(0), can())
                    : medium.send(signal(), bus::ports::host_now() - late_.value_or(Duration{}));
  }
  // Invalidates the bytes.
  void scribble() { bytes_.fill(std::byte{0xEE}); }

  // Returns whether this has arrived; ignores sync frames' lateness.
  bool is(const bus::ports::LiveArrival& received) const {
    if (is_can())
      return received.kind == bus::ports::LiveArrival::Kind::kCan &&
             bus::ports::line_of_can(received.can_bus) == line_ && received.can.identifier == can().identifier &&
             received.can.flexible_data_rate == fast_ && std::ranges::equal(received.can.data, can().data);
    if (received.kind != bus::ports::LiveArrival::Kind::kFlexRay ||
        bus::ports::line_of(received.signal.channel) != line_ || received.signal.signal != what_)
      return false;
    if (what_ != bus::ports::Signal::kFrame) return received.signal.duration == duration_;
    return received.signal.slot == slot() && std::ranges::equal(received.signal.bytes, signal().bytes);
  }

 private:
  void make_can(bool fast) {
    static constexpr std::array<std::size_t, 16> kLengths{0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64};
    fast_ = fast;
    size_ = kLengths[number_ % (fast ? 16 : 9)];
  }
  void make_signal(Traffic traffic) {
    static constexpr std::array<int, 8> kEdges{0, 127, 1, 28, 29, 27, 30, 126};  // where media begin to cut frames up
    const std::size_t form = traffic == Traffic::kFrames ? 2 : number_ % 8;
    if (form == 3) return make_symbol(bus::ports::Signal::kCas);
    if (form == 5) return make_symbol(bus::ports::Signal::kWakeup);
    if (form == 6) return make_symbol(bus::ports::Signal::kUndecodable);
    if (form == 1) late_ = Duration::microseconds(1000 + static_cast<std::int64_t>(number_ % 1000));
    const int words = traffic == Traffic::kFrames ? 8
                      : form == 0                 ? kEdges[number_ / 8 % 8]
                                                  : static_cast<int>(number_ * 37 % 128);
    const std::array<std::byte, bus::wire::kMaxFrameBytes> payload = bytes_;
    bus::wire::FrameHeader header;
    header.null_frame = form == 4;
    header.sync = form == 1;
    header.startup = form == 1 && number_ % 16 == 1;
    header.frame_id = static_cast<std::uint16_t>(slot());
    header.cycle = cycle();
    size_ = bus::wire::encode_frame(header, static_cast<schedules::model::Channel>(line_),
                                    std::span(payload).first(static_cast<std::size_t>(2 * words)), bytes_);
    if (form == 7) bytes_[number_ % 16 == 7 ? 4 : size_ - 1] ^= std::byte{0x40};  // its header CRC, its frame CRC
  }
  void make_symbol(bus::ports::Signal what) {
    what_ = what;
    size_ = 0;
    duration_ = Duration::milliseconds(1 + static_cast<std::int64_t>(speaker_.index)) +
                Duration::nanoseconds(static_cast<std::int64_t>(number_));
  }

  bus::ports::Line line_;
  Speaker speaker_;
  std::size_t number_;
  bus::ports::Signal what_ = bus::ports::Signal::kFrame;
  Duration duration_{};
  std::optional<Duration> late_;
  bool fast_ = false;
  std::size_t size_ = 0;
  std::array<std::byte, bus::wire::kMaxFrameBytes> bytes_{};
};

inline bus::ports::Line line_of(const bus::ports::LiveArrival& received) {
  return received.kind == bus::ports::LiveArrival::Kind::kCan ? bus::ports::line_of_can(received.can_bus)
                                                              : bus::ports::line_of(received.signal.channel);
}

// The speaker of an utterance above.
inline std::size_t speaker_of(const bus::ports::LiveArrival& received, std::size_t members) {
  if (received.kind == bus::ports::LiveArrival::Kind::kCan) return received.can.identifier % members;
  if (received.kind == bus::ports::LiveArrival::Kind::kFollowUp || received.signal.signal == bus::ports::Signal::kFrame)
    return static_cast<std::size_t>(received.signal.slot - 1) % members;
  return static_cast<std::size_t>(received.signal.duration.ns / 1'000'000 - 1);
}

}  // namespace ttf::laws
