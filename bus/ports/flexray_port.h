// The FlexRay port: what a controller and a medium owe each other. One small interface, many media (simulated,
// SocketCAN, DDS); all pass the laws below (tests/laws/).
//
// The wall is where FlexRay's own is between coding and frame processing (2.1A, chapters 3 and 6): bits, symbols and
// CRCs are the medium's, slots, cycles and clocks the controller's. Instants are microticks of the node that states
// them; converting them to true time or to a real clock is the business of whoever turns the crank.
//   L1  every transmission reaches every other controller on that channel exactly once, unchanged
//   L2  a controller does not hear itself
//   L3  receptions reach one controller in the order of their end; ties: channel (on one channel there are none: L6)
//   L4  a signal is delivered at its end, never before it has left completely
//   L5  the medium keeps no reference to the bytes after transmit() returns, the controller none after receive()
//   L6  signals that overlap at a receiver reach it as one undecodable signal from the first start to the last end;
//       overlapping collision avoidance symbols remain one such symbol
//   L7  carrier() is true from the start of a reception (not before it) until it is delivered
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "bus/wire/flexray_frame.h"
#include "core/time.h"
#include "schedules/model/cluster.h"

namespace ttf::bus::ports {

enum class Signal : std::uint8_t {
  kFrame,
  kCas,          // collision avoidance symbol, media access test symbol: the same bits
  kWakeup,       // a wake-up pattern
  kUndecodable,  // activity that is neither: noise, a collision, a frame without an end
};

struct Transmission {
  schedules::model::Channel channel{};
  Signal signal = Signal::kFrame;
  Microticks start{};                // the action point: first bit leaves
  Microticks end{};                  // last bit has left, a dynamic frame's trailing sequence included
  int slot = 0;                      // for the log
  std::span<const std::byte> bytes;  // of a frame: header, payload, trailer; empty where nobody wants them
  wire::DecodedFrame content{};      // of a frame: what the bytes say or would say, but for the header CRC
};

struct Reception {
  schedules::model::Channel channel{};
  Signal signal = Signal::kFrame;
  Microticks start{};        // when the first bit arrived, receiver's clock
  Microticks end{};          // when the last bit arrived, receiver's clock
  wire::DecodedFrame frame;  // of a frame
};

// The same on channel B, of a frame that is on both channels at once and says channel A.
inline Transmission on_b(Transmission transmission) {
  transmission.channel = schedules::model::Channel::kB;
  return transmission;
}
inline Reception on_b(Reception reception) {
  reception.channel = schedules::model::Channel::kB;
  return reception;
}

class FlexRayPort {
 public:
  virtual ~FlexRayPort() = default;
  virtual void transmit(const Transmission& transmission) = 0;
  // The same frame on both channels at once, of which nobody wants the bytes; `transmission` says channel A.
  virtual void transmit_on_both(const Transmission& transmission) {
    transmit(transmission);
    transmit(on_b(transmission));
  }
  // Whether a frame or, in slot 0, a symbol that should leave at `start` still may: else it is not sent at all. Only
  // real time knows of too late.
  virtual bool may_leave(schedules::model::Channel channel, int slot, Microticks start) {
    return (void)channel, (void)slot, (void)start, true;
  }
  // How long after its end a reception may still be handed over: in real time what comes late, or waits for word of how
  // late it left. A medium in virtual time hands it over at its end (L4).
  virtual Microticks handed_over_within() const { return {}; }
  // Whether something is arriving just now.
  virtual bool carrier(schedules::model::Channel channel) const = 0;
  // Whether the next transmission's bytes are looked at; a medium that carries contents can do without, in virtual
  // time, where all may leave.
  virtual bool wants_bytes(schedules::model::Channel channel) const { return (void)channel, true; }
};

}  // namespace ttf::bus::ports
