// What stands in the middle of a star and decides what goes through, one per channel. It hears a signal when its first
// bit arrives there, and forwards it without delay: a coupler that looks at a frame's header first holds back all it
// forwards for the same time, which would be part of gdMinPropagationDelay and gdMaxPropagationDelay.
#pragma once

#include "bus/wire/flexray_frame.h"
#include "sim/medium/disturbance.h"

namespace ttf::sim::medium {

class Coupler {
 public:
  virtual ~Coupler() = default;
  // A signal of node `signal.sender` begins at the coupler; its instants are the coupler's. `frame`: what a frame says.
  // False: it goes nowhere. It may be cut: then it ends earlier, and is undecodable. Or held: then it ends later, and
  // says what it said.
  // Called in the order of arrival.
  virtual bool pass(Leaving& signal, const bus::wire::DecodedFrame* frame) = 0;
  // What comes out of nothing reaches everybody, and the coupler too.
  virtual void disturbed(const Leaving& signal) = 0;
  // The node has lost its supply: what it was sending ends at the coupler at `at`. When what the coupler sends on of it
  // ends there: at `at`, or, held, later, but not after it would have ended anyway. It is undecodable either way.
  virtual TrueTime fell_silent(NodeId branch, TrueTime at) = 0;
};

}  // namespace ttf::sim::medium
