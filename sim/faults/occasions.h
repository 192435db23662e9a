// Chooses the frames that a fault befalls: every n-th, with a probability. The signals that one node sends at
// one instant, on both channels, are one occasion, together with their arrivals at all receivers.
#pragma once

#include <cstdint>
#include <limits>

#include "core/ids.h"
#include "core/time.h"

namespace ttf::sim::faults {

class Occasions {
 public:
  Occasions(int every, double probability) : every_(static_cast<std::uint32_t>(every)), probability_(probability) {}

  // Returns whether the fault befalls the present signal of `sender`; `draws(index)` makes the stream of that index.
  template <class Draws> bool chosen(TrueTime now, NodeId sender, const Draws& draws) {
    if (now == now_ && sender == sender_) return chosen_;
    now_ = now;
    sender_ = sender;
    const std::uint32_t number = count_++;
    chosen_ = number % every_ == 0 && (probability_ >= 1.0 || draws(2 * number).uniform() < probability_);
    return chosen_;
  }
  // Returns the index of a stream for this occasion's other draws.
  std::uint32_t content() const { return 2 * (count_ - 1) + 1; }

 private:
  std::uint32_t every_;
  double probability_;
  TrueTime now_{std::numeric_limits<std::int64_t>::min()};
  NodeId sender_ = kNoNode;
  std::uint32_t count_ = 0;
  bool chosen_ = false;
};

}  // namespace ttf::sim::faults
