// The start of a node that is powered on cold.
#pragma once

#include <cstdint>

#include "core/time.h"

namespace ttf::nodes::host {

enum class ColdStart : std::uint8_t {
  kStarts,  // its controller starts up
  kWakes,   // its controller sends a wake-up pattern, then starts up
  kSleeps,  // it waits for a wake-up pattern, and starts up some time later
};

struct NodeStart {
  ColdStart how = ColdStart::kStarts;
  Duration after{};  // start of the drive (a sleeping node: the wake-up pattern) to power-on
};

}  // namespace ttf::nodes::host
