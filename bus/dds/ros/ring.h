// A ring is a queue of preallocated slots from one thread to another. Neither waits, and nothing is allocated.
#pragma once

#include <atomic>
#include <cstddef>
#include <vector>

namespace ttf::bus::dds::ros {

template <class Slot> class Ring {
 public:
  // Makes each slot from `of`.
  template <class... Of> explicit Ring(std::size_t slots, const Of&... of) {
    slots_.reserve(slots);
    for (std::size_t i = 0; i < slots; ++i) slots_.emplace_back(of...);
  }

  // For the filling thread: returns the next slot to fill, nullptr without room; push() hands it over.
  Slot* room() {
    const std::size_t filled = filled_.load(std::memory_order_relaxed);
    if (filled - emptied_.load(std::memory_order_acquire) == slots_.size()) return nullptr;
    return &slots_[filled % slots_.size()];
  }
  void push() { filled_.store(filled_.load(std::memory_order_relaxed) + 1, std::memory_order_release); }

  // For the emptying thread: returns the slot that waits longest, nullptr if none does; pop() gives it back.
  const Slot* first() const {
    const std::size_t emptied = emptied_.load(std::memory_order_relaxed);
    if (emptied == filled_.load(std::memory_order_acquire)) return nullptr;
    return &slots_[emptied % slots_.size()];
  }
  void pop() { emptied_.store(emptied_.load(std::memory_order_relaxed) + 1, std::memory_order_release); }

 private:
  std::vector<Slot> slots_;
  std::atomic<std::size_t> filled_{0};   // ever; written by the filling thread
  std::atomic<std::size_t> emptied_{0};  // ever; written by the emptying thread
};

}  // namespace ttf::bus::dds::ros
