// The ways of measurements and images through a cluster, from the records of a time window, as arrows between the lanes
// of a timing diagram. recording/exports/measurement_ways.h follows the stops; here they become legs.
#pragma once

#include <compare>
#include <cstdint>
#include <set>
#include <vector>

#include "report/timing/data.h"

namespace ttf::report::timing {

// The place of an event: index is a sensor, a CAN bus, a node (with its task) or a channel.
struct LaneKey {
  enum class Kind : std::uint8_t { kSensor, kCan, kTask, kChannel };
  Kind kind = Kind::kSensor;
  std::size_t index = 0;
  std::uint8_t task = 0;
  constexpr auto operator<=>(const LaneKey&) const = default;
};

struct Stop {
  LaneKey lane;
  TrueTime at{};
};
struct Leg {
  Stop from, to;
  enum class Kind : std::uint8_t {
    kMoves,   // from lane to lane
    kHeld,    // held back by the strategy, along the fusion lane
    kStored,  // waits in the receiver's CNI
  };
  Kind kind = Kind::kMoves;
};
struct Way {
  MeasurementId id;  // for an image: sensor kNoSensor and the image's sequence number
  std::vector<Leg> legs;
  bool out_of_sequence = false;  // reached the fusion node after a newer measurement
  bool dropped = false;          // ends without being fused: too old, duplicate, torn or overwritten
  Stop last;
};

struct Ways {
  std::vector<Way> measurements;  // in the order of the records: from the instant to the step that fused it
  std::vector<Way> images;        // in the order of time: from the task that wrote it to the use by the feature service
};
Ways ways_of(const TimingData& data);

// Returns the nodes that reported steps or images.
std::set<NodeId> fusion_nodes(const TimingData& data);

}  // namespace ttf::report::timing
