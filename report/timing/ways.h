// The ways of measurements and images through a cluster, reconstructed from the records of a time window.
//
// A list is recognised by its PDU, the low eight bits of its sequence number (a counter on the wire wraps)
// and nearness in time.
#pragma once

#include <compare>
#include <cstdint>
#include <string>
#include <vector>

#include "report/drawing/names.h"
#include "report/timing/data.h"

namespace ttf::report::timing {

// Where something happens: index is a sensor, a CAN bus, a node (with its task) or a channel.
struct LaneKey {
  enum class Kind : std::uint8_t { kSensor, kCan, kTask, kChannel };
  Kind kind = Kind::kSensor;
  std::size_t index = 0;
  std::uint8_t task = 0;
  constexpr auto operator<=>(const LaneKey&) const = default;
};

// Frames of one list on one medium, merged.
struct Transfer {
  LaneKey lane;
  TrueTime start{}, end{};
  PduId pdu = kNoPdu;
  std::uint32_t sequence = 0;
};
std::vector<Transfer> transfers_of(const TimingData& data);

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
  MeasurementId id;  // of an image: sensor kNoSensor and the image's sequence number
  std::vector<Leg> legs;
  bool out_of_sequence = false;  // reached the fusion node after a newer measurement
  bool dropped = false;          // ends without being fused: too old, duplicate, torn or overwritten
  Stop last;
};

// One way per measurement, in the order of the records; from its instant to the fusion step that used it.
std::vector<Way> measurement_ways(const TimingData& data, const drawing::Names& names,
                                  const std::vector<Transfer>& transfers);
// One way per image: from the task that wrote it to the use by the feature service.
std::vector<Way> image_ways(const TimingData& data, const drawing::Names& names,
                            const std::vector<Transfer>& transfers);

struct Lane {
  LaneKey key;
  std::string label;
  int section = 0;  // 0 sensors, 1 up to the gateway, 2 FlexRay, 3 fusion, 4 features
};
// From top to bottom; section 1 in the order in which measurements pass.
std::vector<Lane> lanes_of(const TimingData& data, const drawing::Names& names, const std::vector<Way>& ways);

}  // namespace ttf::report::timing
