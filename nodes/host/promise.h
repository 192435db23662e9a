// A node's promise to others: until when it does nothing that they could notice. An act leaves the node: a bus
// signal on FlexRay, a frame for a CAN, a trigger or a strobe. All instants are the node's microticks.
#pragma once

#include "core/time.h"

namespace ttf::nodes::host {

struct Promise {
  static constexpr Microticks kNever = ttf::kNever<Microticks>;

  Microticks silent_until{};  // no act before it, unless something arrives until then
  // The shortest time from an arrival to an act that it causes; kNever: it causes none.
  Microticks after_flexray = kNever;  // any arrival on FlexRay
  Microticks after_can = kNever;      // a frame on any CAN
  Microticks after_trigger = kNever;

  bool operator==(const Promise&) const = default;
};

}  // namespace ttf::nodes::host
