// An arrival at a receiver on the simulated FlexRay, and the parts common to both kinds of flights
// (sim/medium/flights.h, sim/medium/clear_flights.h).
#pragma once

#include <cstdint>
#include <optional>

#include "bus/ports/flexray_port.h"
#include "core/ids.h"
#include "core/time.h"
#include "sim/medium/channel_log.h"
#include "sim/medium/frame_pool.h"
#include "sim/medium/medium_queue.h"

namespace ttf::sim::medium {

struct Arrival {
  TrueTime start{}, end{};
  std::uint32_t frame = 0;  // in the pool, if it is a frame
  schedules::model::Channel channel{};
  bus::ports::Signal signal{};
  ChannelLog::Id logged = ChannelLog::kNone;  // while its receiver may still decode it

  bool operator==(const Arrival&) const = default;
  Arrival later_by(Duration delay) const { return {start + delay, end + delay, frame, channel, signal, logged}; }
};

// Ends the use of an arrival's frame, if it is one.
inline void release(FramePool& pool, const Arrival& arrival) {
  if (arrival.signal == bus::ports::Signal::kFrame) pool.release(arrival.frame);
}

// One stop of a signal that goes from receiver to receiver: its arrival there, and whether it goes on. The
// arrival is absent if the signal was merged into another.
struct Stopover {
  std::optional<Arrival> arrival;
  bool goes_on = false;
};

// The number by which an event in the queue refers to its flight.
using FlightNumber = std::uint32_t;

// The parts of a flight's place in the queue.
struct FlightPlace {
  NodeId sender{};
  schedules::model::Channel channel{};  // the next stop's
  std::uint64_t sequence = 0;           // its number in the order of scheduling
};

inline MediumEvent event_of(FlightNumber number) {
  MediumEvent event;
  event.kind = MediumEvent::Kind::kFlexRayArrival;
  event.frame = number;
  return event;
}

inline EventOrder order_of(const FlightPlace& place, NodeId receiver, TrueTime end) {
  const auto rank = static_cast<std::uint16_t>((index_of(place.channel) << 8) | index_of(place.sender));
  return {end, Phase::kArrival, static_cast<std::uint8_t>(receiver), rank, place.sequence};
}

// Turns the flight's event into that of its stop at `receiver`, which ends at `end`.
inline EventOrder next_stop(MediumEvent& event, const FlightPlace& place, NodeId receiver, TrueTime end) {
  event.node = static_cast<std::uint8_t>(receiver);
  event.channel_or_bus = static_cast<std::uint8_t>(place.channel);
  return order_of(place, receiver, end);
}

}  // namespace ttf::sim::medium
