// What a node promises to those who cannot look into it: until when it does nothing that others could notice. An act is
// what leaves the node: a signal on FlexRay, a frame for a CAN, a trigger or a strobe. All in the node's microticks.
#pragma once

#include "core/time.h"

namespace ttf::nodes::host {

struct Promise {
  static constexpr Microticks kNever = ttf::kNever<Microticks>;

  Microticks silent_until{};  // no act before it, if nothing arrives until then
  // An arrival moves that forward to no sooner than this long after it; kNever: not at all.
  Microticks after_flexray = kNever;  // anything on FlexRay
  Microticks after_can = kNever;      // a frame on any CAN
  Microticks after_trigger = kNever;

  bool operator==(const Promise&) const = default;
};

}  // namespace ttf::nodes::host
