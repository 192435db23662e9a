// The arrivals of one line that wait to be handed over. DDS' threads fill it, one at a time; one other thread
// empties it, and neither waits for the other. All its memory is allocated at construction.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <memory>

#include "bus/ports/live_medium.h"
#include "bus/wire/flexray_frame.h"

namespace ttf::bus::dds::live {

struct LiveItem {
  ports::LiveArrival arrival;  // its spans are empty: the bytes are below
  bool malformed = false;      // for a listener: no node ever sees one
  std::size_t size = 0;
  std::array<std::byte, wire::kMaxFrameBytes> bytes{};
};

class LiveQueue {
 public:
  // A second's worth of FlexRay frames of 5 ms cycles, and more.
  static constexpr std::size_t kRoom = 4096;

  LiveQueue();  // throws std::system_error if there are no more descriptors
  ~LiveQueue();
  LiveQueue(const LiveQueue&) = delete;
  LiveQueue& operator=(const LiveQueue&) = delete;

  // For the filling thread: returns the place of the next item, nullptr without room. push() adds the item.
  LiveItem* room();
  void push();

  // For the emptying thread: copies the oldest item to `item`; false if the queue is empty.
  bool pop(LiveItem& item);
  // Returns a descriptor that is readable, while watched, from the first item until pop() has found the queue empty.
  int descriptor() const { return event_; }
  void watch(bool on);

 private:
  void call() const;
  bool empty() const;

  const std::unique_ptr<std::array<LiveItem, kRoom>> items_;
  const int event_;
  // Both counts only grow. They and `watched_` are sequentially consistent: either the filling thread sees the
  // watch, or the thread that begins to watch sees the item.
  std::atomic<std::size_t> filled_{0}, emptied_{0};
  std::atomic<bool> watched_{false};
};

}  // namespace ttf::bus::dds::live
