// The FlexRay port is the contract between a controller and a medium. Every medium behind it (simulated,
// SocketCAN, DDS) passes the laws below (tests/laws/).
//
// The boundary lies between coding and frame processing, as in FlexRay itself (2.1A, chapters 3 and 6). The medium
// has bits, symbols and CRCs; the controller has slots, cycles and clocks. Instants are microticks of the node
// that states them. The engine converts them to true time, or the runner to a machine's clock.
//   L1  every transmission reaches every other controller on that channel exactly once, unchanged
//   L2  a controller does not receive itself
//   L3  receptions reach one controller in the order of their end; ties: channel (on one channel there are none: L6)
//   L4  a signal is delivered at its end, never before it has left completely
//   L5  the medium keeps no reference to the bytes after transmit() returns, the controller none after receive()
//   L6  signals that overlap at a receiver reach it as one undecodable signal from the first start to the last end.
//       Collision avoidance symbols remain one symbol. Wake-up patterns remain one if they wake (bus/wire/symbols.h)
//   L7  carrier() is true from the start of a reception (not before it) until it is delivered
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "bus/wire/flexray_frame.h"
#include "core/time.h"
#include "schedules/model/cluster.h"

namespace ttf::bus::ports {

enum class Signal : std::uint8_t {
  kFrame,
  kCas,          // collision avoidance symbol or media access test symbol, which have the same bits
  kWakeup,       // a wake-up pattern
  kUndecodable,  // any other activity: noise, a collision, a frame without an end
};
constexpr std::string_view to_text(Signal signal) {
  switch (signal) {
    case Signal::kFrame: return "a frame";
    case Signal::kCas: return "a collision avoidance symbol";
    case Signal::kWakeup: return "a wake-up pattern";
    case Signal::kUndecodable: return "noise";
  }
  return "";
}

struct Transmission {
  schedules::model::Channel channel{};
  Signal signal = Signal::kFrame;
  Microticks start{};                // the action point: the first bit leaves
  Microticks end{};                  // the last bit has left, a dynamic frame's trailing sequence included
  int slot = 0;                      // for the log
  std::span<const std::byte> bytes;  // a frame's header, payload, trailer; empty if unwanted
  wire::DecodedFrame content{};      // a frame's decoded bytes, except the header CRC
};

struct Reception {
  schedules::model::Channel channel{};
  Signal signal = Signal::kFrame;
  Microticks start{};        // when the first bit arrived, receiver's clock
  Microticks end{};          // when the last bit arrived, receiver's clock
  wire::DecodedFrame frame;  // of a frame
};

// Returns the copy for channel B of a frame that is on both channels at once and says channel A.
inline Transmission on_b(Transmission transmission) {
  transmission.channel = schedules::model::Channel::kB;
  return transmission;
}
inline Reception on_b(Reception reception) {
  reception.channel = schedules::model::Channel::kB;
  return reception;
}

// The fast way beside the contract, in virtual time alone: every frame may leave, and the medium may carry its content in
// place of its bytes (docs/architecture.md).
class ContentPort {
 public:
  virtual ~ContentPort() = default;
  // Returns whether the medium needs the next transmission's bytes.
  virtual bool wants_bytes(schedules::model::Channel channel) const = 0;
  // Sends one frame on both channels at once, without bytes; `transmission` says channel A.
  virtual void transmit_on_both(const Transmission& transmission) = 0;
};

class FlexRayPort {
 public:
  virtual ~FlexRayPort() = default;
  virtual void transmit(const Transmission& transmission) = 0;
  // Returns whether a frame, or in slot 0 a symbol, may still leave at `start`; otherwise it is not sent. Only
  // a medium in real time can be too late.
  virtual bool may_leave(schedules::model::Channel channel, int slot, Microticks start) {
    return (void)channel, (void)slot, (void)start, true;
  }
  // Returns how long after its end a reception may still be handed over. In real time a frame may come late,
  // or wait for its follow-up. In virtual time it is handed over at its end (L4).
  virtual Microticks handed_over_within() const { return {}; }
  // Returns whether a signal is arriving now.
  virtual bool carrier(schedules::model::Channel channel) const = 0;
  // Returns the medium's fast way, or null if it has none.
  virtual ContentPort* by_content() { return nullptr; }
};

}  // namespace ttf::bus::ports
