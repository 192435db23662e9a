// What is to happen in virtual time, in one total order: (true time, phase, node, rank, sequence). Never addresses, hash order
// or thread arrival. The order is written here and nowhere else.
#pragma once

#include <algorithm>
#include <cstdint>
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

template <class Payload>
class EventQueue {
 public:
  // The queue takes room for `capacity` pending events once.
  explicit EventQueue(std::size_t capacity) { heap_.reserve(capacity); }
  // Returns the event's place in the order of being scheduled.
  std::uint64_t schedule(TrueTime time, Phase phase, std::uint8_t node, const Payload& payload,
                         std::uint16_t rank = 0) {
    push({{time, phase, node, rank, next_sequence_}, payload});
    return next_sequence_++;
  }
  // What goes on that was scheduled before, in `order.sequence` and not before it happened last.
  void go_on(const EventOrder& order, const Payload& payload) { push({order, payload}); }
  bool empty() const { return heap_.size() == (hole_ ? 1 : 0); }
  // Whether this comes before all that is pending.
  bool is_first(const EventOrder& order) const {
    if (!hole_) return heap_.empty() || order < heap_.front().order;
    for (std::size_t child = 1; child < std::min<std::size_t>(3, heap_.size()); ++child)
      if (heap_[child].order < order) return false;
    return true;
  }
  const EventOrder& next() {
    fill();
    return heap_.front().order;
  }
  Payload pop() {
    fill();
    hole_ = true;
    return heap_.front().payload;
  }

 private:
  struct Event {
    EventOrder order;
    Payload payload;
  };
  // What was popped leaves a hole at the top, which the next event to come takes: most go not far.
  void push(const Event& event) {
    if (hole_) {
      hole_ = false;
      sink(event);
      return;
    }
    heap_.push_back(event);
    std::push_heap(heap_.begin(), heap_.end(), later);
  }
  void fill() {
    if (!hole_) return;
    hole_ = false;
    const Event last = heap_.back();
    heap_.pop_back();
    if (!heap_.empty()) sink(last);
  }
  // Puts the event at the top, and lets it sink to where it belongs.
  void sink(const Event& event) {
    std::size_t at = 0;
    for (std::size_t child = 1; child < heap_.size(); child = 2 * at + 1) {
      if (child + 1 < heap_.size() && later(heap_[child], heap_[child + 1])) ++child;
      if (!later(event, heap_[child])) break;
      heap_[at] = heap_[child];
      at = child;
    }
    heap_[at] = event;
  }
  static bool later(const Event& a, const Event& b) { return b.order < a.order; }

  std::vector<Event> heap_;
  bool hole_ = false;
  std::uint64_t next_sequence_ = 0;
};

}  // namespace ttf::sim
