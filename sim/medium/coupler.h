// The middle of a star, one per channel: decides which signals go through. It receives a signal when its first bit
// arrives there, and forwards it without delay. A coupler that inspects a frame's header first holds back all
// signals for the same time. This delay would be part of gdMinPropagationDelay and gdMaxPropagationDelay.
#pragma once

#include "bus/wire/flexray_frame.h"
#include "sim/medium/disturbance.h"

namespace ttf::sim::medium {

class Coupler {
 public:
  virtual ~Coupler() = default;
  // Decides about a signal of node `signal.sender` that begins at the coupler; its instants are the coupler's.
  // `frame` is the content of a frame. False: the signal goes nowhere. A cut signal ends earlier and is
  // undecodable. A held one ends later, with the same content. Called in the order of arrival.
  virtual bool pass(Leaving& signal, const bus::wire::DecodedFrame* frame) = 0;
  // Takes in a signal without a sender, which reaches all nodes and the coupler, too.
  virtual void disturbed(const Leaving& signal) = 0;
  // The node has lost its supply: its signal ends at the coupler at `at`. Returns the end of the forwarded
  // signal there: at `at`, or later if it is held, but not after its regular end. It is undecodable either way.
  virtual TrueTime fell_silent(NodeId branch, TrueTime at) = 0;
};

}  // namespace ttf::sim::medium
