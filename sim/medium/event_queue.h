// Events in virtual time, in one total order: (true time, phase, node, rank, sequence). The order never depends
// on addresses, hash order or thread arrival. Only this file defines it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/ids.h"
#include "core/time.h"

namespace ttf::sim::medium {

// At one instant arrivals come first, then the nodes' own events, then the CANs' arbitration, then observers.
enum class Phase : std::uint8_t { kArrival = 0, kNode = 1, kArbitration = 2, kObserver = 3 };

struct EventOrder {
  TrueTime time{};
  Phase phase{};
  std::uint8_t node = 0;       // receiver, or bus
  std::uint16_t rank = 0;      // among the arrivals at one receiver: channel, then sender
  std::uint64_t sequence = 0;  // order of scheduling
  bool operator==(const EventOrder&) const = default;
  friend bool operator<(const EventOrder& a, const EventOrder& b) {
    if (a.time != b.time) return a.time < b.time;
    const std::uint32_t place_a = a.place(), place_b = b.place();
    return place_a != place_b ? place_a < place_b : a.sequence < b.sequence;
  }

 private:
  std::uint32_t place() const {
    return static_cast<std::uint32_t>(phase) << 24 | static_cast<std::uint32_t>(node) << 16 | rank;
  }
};

template <class Payload> class EventQueue {
 public:
  // Reserves room for `capacity` pending events once.
  explicit EventQueue(std::size_t capacity) { pending_.reserve(capacity); }
  // Schedules an event. Returns its number in the order of scheduling.
  std::uint64_t schedule(TrueTime time, Phase phase, std::uint8_t node, const Payload& payload,
                         std::uint16_t rank = 0) {
    push({{time, phase, node, rank, next_sequence_}, payload});
    return next_sequence_++;
  }
  // Continues an event that was scheduled before, with `order.sequence`, and not before its last instant.
  void go_on(const EventOrder& order, const Payload& payload) { push({order, payload}); }
  // Takes the events away whose payload `chosen` names.
  template <class Predicate> void remove_if(Predicate chosen) {
    std::erase_if(pending_, [&](const Event& event) { return chosen(event.payload); });
  }
  bool empty() const { return pending_.empty(); }
  // Returns whether this comes before all pending events.
  bool is_first(const EventOrder& order) const { return empty() || order < next(); }
  const EventOrder& next() const { return pending_.back().order; }
  Payload pop() {
    const Payload first = pending_.back().payload;
    pending_.pop_back();
    return first;
  }

 private:
  struct Event {
    EventOrder order;
    Payload payload;
  };
  // Few events are pending at a time, and most new ones are among the first of them.
  void push(const Event& event) {
    std::size_t at = pending_.size();
    pending_.push_back(event);
    if (at == 0 || event.order < pending_[at - 1].order) return;
    for (; at > 0 && pending_[at - 1].order < event.order; --at) pending_[at] = pending_[at - 1];
    pending_[at] = event;
  }

  std::vector<Event> pending_;  // the first at the end
  std::uint64_t next_sequence_ = 0;
};

}  // namespace ttf::sim::medium
