// What a node that is powered on cold begins with.
#pragma once

#include <cstdint>

#include "core/time.h"

namespace ttf::nodes::host {

enum class ColdStart : std::uint8_t {
  kStarts,  // its controller starts up
  kWakes,   // its controller sends a wake-up pattern, then starts up
  kSleeps,  // it waits for a wake-up pattern, and starts up some time after that
};

struct NodeStart {
  ColdStart how = ColdStart::kStarts;
  Duration after{};  // power-on: from the start of the drive, of who sleeps from the wake-up pattern on
};

}  // namespace ttf::nodes::host
