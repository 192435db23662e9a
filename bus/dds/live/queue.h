// What has arrived on one line and has not been handed over yet: filled by DDS' threads, one at a time, emptied by one
// other, and neither waits for the other. All its memory is there from the beginning.
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
  std::size_t size = 0;
  std::array<std::byte, wire::kMaxFrameBytes> bytes{};
};

class LiveQueue {
 public:
  // A second's worth of FlexRay frames of 5 ms cycles, and more.
  static constexpr std::size_t kRoom = 4096;

  LiveQueue();  // throws std::system_error where there are no more descriptors
  ~LiveQueue();
  LiveQueue(const LiveQueue&) = delete;
  LiveQueue& operator=(const LiveQueue&) = delete;

  // Of who fills it. Where the next item goes; nullptr: there is no room. push() makes it be there.
  LiveItem* room();
  void push();

  // Of who empties it. What has been there longest, copied to `item`; false: nothing is there.
  bool pop(LiveItem& item);
  // Readable from when something is there until pop() has found that nothing is, as long as it is watched.
  int descriptor() const { return event_; }
  void watch(bool on);

 private:
  void call() const;
  bool empty() const;

  const std::unique_ptr<std::array<LiveItem, kRoom>> items_;
  const int event_;
  // Both count on for ever. Sequentially consistent, as is `watched_`: either who fills sees that somebody watches, or
  // who begins to watch sees that something is there.
  std::atomic<std::size_t> filled_{0}, emptied_{0};
  std::atomic<bool> watched_{false};
};

}  // namespace ttf::bus::dds::live
