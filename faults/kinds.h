// The kinds of faults: one row holds a plan's data about a kind. Two other tables also have a row for each kind:
// the effect of its faults (sim/faults/families.cc) and their possible consequences
// (evaluation/faults/reach.cc). is_one_row_a_kind() checks every table against this list.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace ttf::faults {

// The values are part of recordings and of campaigns' streams: append only, before kEnd.
enum class FaultKind : std::uint8_t {
  kCrash,          // the node loses its supply; with a duration it starts cold afterwards
  kOmission,       // frames do not leave it or do not reach it
  kBabblingIdiot,  // it sends outside its schedule
  kMasquerading,   // its frames claim to be another node's
  kSosTiming,      // slightly off the specification: frames early or late, so that receivers disagree
  kSosValue,       // the same for the signal's shape: some receivers cannot decode it
  kBitFlipHeader,  // bits of its frames are inverted on the bus
  kBitFlipPayload,
  kBitFlipTrailer,
  kChannelSwap,           // its signal for one channel appears on the other
  kByzantineClock,        // its frames show a different time to every receiver
  kDrift,                 // its oscillator runs at another rate
  kLoneColdstart,         // it is the only coldstart node with a supply
  kDuplicateColdstart,    // it starts the cluster while others do, or repeatedly
  kWrongSchedule,         // it follows another schedule than the cluster's
  kNoise,                 // activity without a sender on a channel
  kTransient,             // everything on the channels is destroyed
  kCanOmission,           // on a private CAN: frames do not leave the node's host, or do not reach it
  kCanCorruption,         // a bit of its frames is inverted
  kCanBabbling,           // it sends frames outside the schedule
  kCanBusOff,             // its controller is bus off
  kCanStuckDominant,      // its driver holds the line
  kCanNoAcknowledgement,  // its controller does not acknowledge
  kEnd,                   // not a kind: their number
};
inline constexpr std::size_t kFaultKinds = static_cast<std::size_t>(FaultKind::kEnd);
constexpr std::size_t index_of(FaultKind kind) { return static_cast<std::size_t>(kind); }
inline constexpr auto kAllFaultKinds = [] {
  std::array<FaultKind, kFaultKinds> all{};
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = static_cast<FaultKind>(k);
  return all;
}();

// Returns whether a table has one row for every kind, in their order. Rows begin with a `kind`.
template <class Table> constexpr bool is_one_row_a_kind(const Table& table) {
  std::size_t row = 0;
  for (const auto& one : table)
    if (index_of(one.kind) != row++) return false;
  return row == kFaultKinds;
}

// The faulty part.
enum class Failing : std::uint8_t {
  kNode,    // the node that the fault names
  kOthers,  // some or all other nodes; the named node works
  kMedium,  // the channels: the fault names no node
};
// A demand on the named node, besides being on FlexRay; kOnCan: it must be on the fault's CAN instead.
enum class NodeDemand : std::uint8_t { kNothing, kColdstart, kBothChannels, kOnCan };

// A parameter of a fault beside kind and node: one key, or several that belong together (parameters.h).
enum class FaultParameter : std::uint8_t {
  kNone,
  kDirection,      // `direction`
  kSignal,         // `signal`
  kLength,         // `length`, of noise
  kBursts,         // `interval`, `jitter`
  kMasquerade,     // `mode`, `slot`
  kShift,          // `shift`, to one side
  kLie,            // `shift`, to either side, and `pattern`
  kHeaderBits,     // `bits` or `flips`
  kPayloadBits,    // the same
  kTrailerBits,    // the same
  kDrift,          // `drift`
  kOthers,         // `others`
  kDuplicate,      // `mode`, `slot`
  kWrongSchedule,  // `mode`, `by` or `slot`
  kReceivers,      // `receivers`
  kOccasions,      // `probability`, `every`
  kChannels,       // `channels`
  kWindow,         // `from`, `duration`
  kFrom,           // `from`: it lasts to the end
  kPassing,        // `from`, `duration`: it must end
  kCan,            // `can`
  kCanBit,         // `bit`, of a CAN frame
  kIdentifier,     // `identifier`, of a CAN frame
  kEnd,            // not a parameter: their number
};
inline constexpr std::size_t kFaultParameters = static_cast<std::size_t>(FaultParameter::kEnd);
constexpr std::size_t index_of(FaultParameter parameter) { return static_cast<std::size_t>(parameter); }

// Returns whether a table has one row for every parameter, in their order. Rows begin with a `parameter`.
template <class Table> constexpr bool is_one_row_a_parameter(const Table& table) {
  std::size_t row = 0;
  for (const auto& one : table)
    if (index_of(one.parameter) != row++) return false;
  return row == kFaultParameters;
}

struct FaultKindRow {
  FaultKind kind{};
  std::string_view name;                       // in YAML and in recordings: "babbling_idiot"
  std::array<FaultParameter, 5> parameters{};  // in the order of their keys; then kNone
  Failing failing = Failing::kNode;
  NodeDemand demand = NodeDemand::kNothing;
};
const FaultKindRow& row_of(FaultKind kind);

inline std::string_view name_of(FaultKind kind) { return row_of(kind).name; }
inline bool is_on_can(FaultKind kind) { return row_of(kind).demand == NodeDemand::kOnCan; }
inline bool has_node(FaultKind kind) { return row_of(kind).failing != Failing::kMedium; }
// Returns whether faults of this kind have the parameter; some modes may lack it (applies(), plan.h).
bool takes(FaultKind kind, FaultParameter parameter);

}  // namespace ttf::faults
