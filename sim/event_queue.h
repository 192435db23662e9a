// What is to happen in virtual time, in one total order: (true time, phase, node, rank, sequence). Never addresses, hash order
// or thread arrival. The order is written here and nowhere else.
#pragma once

#include <cstdint>
#include <queue>
#include <vector>

#include "core/ids.h"
#include "core/time.h"

namespace ttf::sim {

// At one instant arrivals come first, then the nodes' own events, then the CANs decide who sends next, then observers.
enum class Phase : std::uint8_t { kArrival = 0, kNode = 1, kArbitration = 2, kObserver = 3 };

struct EventOrder {
  TrueTime time{};
  Phase phase{};
  std::uint8_t node = 0;           // receiver, or bus
  std::uint16_t rank = 0;          // among the arrivals at one receiver: channel, then sender
  std::uint64_t sequence = 0;      // order of being scheduled
  auto operator<=>(const EventOrder&) const = default;
};

template <class Payload>
class EventQueue {
 public:
  // The queue takes room for `capacity` pending events once.
  explicit EventQueue(std::size_t capacity) {
    std::vector<Event> room;
    room.reserve(capacity);
    heap_ = Heap(Later{}, std::move(room));
  }
  void schedule(TrueTime time, Phase phase, std::uint8_t node, const Payload& payload, std::uint16_t rank = 0) {
    heap_.push({{time, phase, node, rank, next_sequence_++}, payload});
  }
  bool empty() const { return heap_.empty(); }
  const EventOrder& next() const { return heap_.top().order; }
  Payload pop() {
    const Payload payload = heap_.top().payload;
    heap_.pop();
    return payload;
  }

 private:
  struct Event {
    EventOrder order;
    Payload payload;
  };
  struct Later {
    bool operator()(const Event& a, const Event& b) const { return a.order > b.order; }
  };
  using Heap = std::priority_queue<Event, std::vector<Event>, Later>;
  Heap heap_;
  std::uint64_t next_sequence_ = 0;
};

}  // namespace ttf::sim
