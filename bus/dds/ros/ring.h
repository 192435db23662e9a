// A queue of slots made beforehand, from one thread to one other. Neither ever waits, and nothing is allocated.
#pragma once

#include <atomic>
#include <cstddef>
#include <vector>

namespace ttf::bus::dds::ros {

template <class Slot> class Ring {
 public:
  // Slots are made of `of`, each its own.
  template <class... Of> explicit Ring(std::size_t slots, const Of&... of) {
    slots_.reserve(slots);
    for (std::size_t i = 0; i < slots; ++i) slots_.emplace_back(of...);
  }

  // For the thread that fills: the slot to fill next, nullptr where there is no room; push() hands it over.
  Slot* room() {
    const std::size_t filled = filled_.load(std::memory_order_relaxed);
    if (filled - emptied_.load(std::memory_order_acquire) == slots_.size()) return nullptr;
    return &slots_[filled % slots_.size()];
  }
  void push() { filled_.store(filled_.load(std::memory_order_relaxed) + 1, std::memory_order_release); }

  // For the thread that empties: the slot that waits longest, nullptr where none does; pop() gives it back.
  const Slot* first() const {
    const std::size_t emptied = emptied_.load(std::memory_order_relaxed);
    if (emptied == filled_.load(std::memory_order_acquire)) return nullptr;
    return &slots_[emptied % slots_.size()];
  }
  void pop() { emptied_.store(emptied_.load(std::memory_order_relaxed) + 1, std::memory_order_release); }

 private:
  std::vector<Slot> slots_;
  std::atomic<std::size_t> filled_{0};   // ever; written by who fills
  std::atomic<std::size_t> emptied_{0};  // ever; written by who empties
};

}  // namespace ttf::bus::dds::ros
