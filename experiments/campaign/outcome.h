// The outcome of one fault in one variant, whatever its bus: a draw, its effects, and its story in words.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "faults/plan.h"

namespace ttf::experiments::campaign {

struct DrawnFault {
  faults::Fault fault;     // resolved
  bool starts_up = false;  // injected into a start-up
};

// Times in nanoseconds. The bits' names: Words (campaign_bus.h).
struct FaultOutcome {
  bool activated = false;            // the fault acted
  bool starts_without = true;        // for a start-up: all nodes became active without the fault
  std::uint16_t seen_by_others = 0;  // bits by check
  std::uint16_t seen_by_itself = 0;
  std::uint8_t harms = 0;                     // bits by harm
  NodeId harmed = kNoNode, sender = kNoNode;  // those in the first harm
  int frame_id = 0;                           // the frame in the first harm: its slot, or its identifier on a CAN
  std::int16_t still_out = 0;                 // nodes that lost normal active (on a CAN error active) for good
  // After the fault's first act, of any node; halt: on a CAN bus off.
  std::optional<std::int64_t> detected_after, passive_after, halt_after;
  std::optional<std::int64_t> harmed_after;
  std::optional<std::int64_t> reintegrated_after;  // after the loss or the fault's end, whichever was later

  bool operator==(const FaultOutcome&) const = default;
};

// The events of a trial as sentences, in the order in which they became known.
class Story {
 public:
  enum class Of : std::uint8_t { kOthers, kFault, kGuardians, kErrorFrames };
  struct Line {
    TrueTime at;
    Of of;
    std::string text;
  };
  void say(TrueTime at, std::string text, Of of = Of::kOthers) { lines_.push_back({at, of, std::move(text)}); }
  const std::vector<Line>& lines() const { return lines_; }

 private:
  std::vector<Line> lines_;
};

}  // namespace ttf::experiments::campaign
