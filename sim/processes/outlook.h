// A node as the others see it: the instant of its next turn. All processes with the same arrivals and promises
// come to the same answer, the node's own process included.
#pragma once

#include <algorithm>

#include "core/time.h"
#include "nodes/host/promise.h"

namespace ttf::sim::processes {

class Outlook {
 public:
  using Promise = nodes::host::Promise;

  // Returns the end of its promise: then it must take a turn, if only to go on being silent. Never: it is off.
  Microticks turn() const { return turn_; }

  void begins(Microticks now) { promises({now, Microticks{}, Microticks{}, Microticks{}}); }
  void ends() { promises({kNever<Microticks>}); }
  void promises(const Promise& promise) {
    promise_ = promise;
    turn_ = promise.silent_until;
  }

  void hears_flexray(Microticks now) { moves(now, promise_.after_flexray); }
  void hears_can(Microticks now) { moves(now, promise_.after_can); }
  void hears_trigger(Microticks now) { moves(now, promise_.after_trigger); }

 private:
  void moves(Microticks now, Microticks after) {
    if (after != kNever<Microticks>) turn_ = std::min(turn_, now + after);
  }

  Promise promise_{kNever<Microticks>};
  Microticks turn_ = kNever<Microticks>;
};

}  // namespace ttf::sim::processes
