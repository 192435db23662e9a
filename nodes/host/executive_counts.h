// Counts a node's problems since its power-on.
#pragma once

#include <cstdint>

namespace ttf::nodes::host {

struct ExecutiveCounts {
  std::uint64_t overruns = 0;  // activations of a task that still waited
  std::uint64_t deadlines_missed = 0;
  std::uint64_t torn_lists = 0;  // displaced before they were complete
  std::uint64_t overwritten_lists = 0;
  std::uint64_t discarded_lists = 0;  // read, but without a known time of measurement
  std::uint64_t slot_problems = 0;
  std::uint64_t saturated_signals = 0;
  std::uint64_t refused_fragments = 0;   // stale or malformed (bus/cni/list_buffer.h), on any bus
  std::uint64_t refused_can_frames = 0;  // not in the schedule (bus/cni/can_controller.h)
  std::uint64_t unlisted_fates = 0;      // fates of lists without a record (fusion/strategies/strategy.h)
};

}  // namespace ttf::nodes::host
