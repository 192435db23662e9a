// The kinds of faults: one row says all that a plan needs to know of a kind. Two other tables have a row for each
// kind, too: one says how its faults work (sim/faults/families.cc), one what may be their doing
// (evaluation/faults/reach.cc). is_one_row_a_kind() holds every table to this list.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace ttf::faults {

// Values are part of recordings and campaigns' streams: append only, before kEnd.
enum class FaultKind : std::uint8_t {
  kCrash,          // the node loses its supply; with a duration it starts cold afterwards
  kOmission,       // frames do not leave it, or do not reach it
  kBabblingIdiot,  // it sends besides its schedule
  kMasquerading,   // it sends what claims to be another's
  kSosTiming,      // slightly off the specification: frames early or late, so that receivers disagree
  kSosValue,       // the same of the signal's shape: some receivers cannot make it out
  kBitFlipHeader,  // bits of its frames are inverted on the way
  kBitFlipPayload,
  kBitFlipTrailer,
  kChannelSwap,         // what it sends on one channel appears on the other
  kByzantineClock,      // its frames say another time to every receiver
  kDrift,               // its oscillator runs at another rate
  kLoneColdstart,       // the only coldstart node that has a supply
  kDuplicateColdstart,  // it starts the cluster while others do, or again and again
  kWrongSchedule,       // it believes in another schedule than the cluster's
  kNoise,               // activity on a channel that nobody sent
  kTransient,           // everything on the channels is destroyed
  kEnd,                 // no kind: their number
};
inline constexpr std::size_t kFaultKinds = static_cast<std::size_t>(FaultKind::kEnd);
constexpr std::size_t index_of(FaultKind kind) { return static_cast<std::size_t>(kind); }
inline constexpr auto kAllFaultKinds = [] {
  std::array<FaultKind, kFaultKinds> all{};
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = static_cast<FaultKind>(k);
  return all;
}();

// Whether a table has one row for every kind, in their order. Rows begin with a `kind`.
template <class Table> constexpr bool is_one_row_a_kind(const Table& table) {
  std::size_t row = 0;
  for (const auto& one : table)
    if (index_of(one.kind) != row++) return false;
  return row == kFaultKinds;
}

// Who fails.
enum class Failing : std::uint8_t {
  kNode,    // the one that the fault names
  kOthers,  // the others, or some of them: the one that the fault names is left alone
  kMedium,  // the channels: the fault names no node
};
// What the node that a fault names has to be, besides on FlexRay.
enum class NodeDemand : std::uint8_t { kNothing, kColdstart, kBothChannels };

// What a plan says of a fault beside kind and node: a key, or some that go together (parameters.h).
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
  kFrom,           // `from`: it stays to the end
  kPassing,        // `from`, `duration`: it has to pass
  kEnd,            // no parameter: their number
};
inline constexpr std::size_t kFaultParameters = static_cast<std::size_t>(FaultParameter::kEnd);
constexpr std::size_t index_of(FaultParameter parameter) { return static_cast<std::size_t>(parameter); }

// Whether a table has one row for every parameter, in their order. Rows begin with a `parameter`.
template <class Table> constexpr bool is_one_row_a_parameter(const Table& table) {
  std::size_t row = 0;
  for (const auto& one : table)
    if (index_of(one.parameter) != row++) return false;
  return row == kFaultParameters;
}

struct FaultKindRow {
  FaultKind kind{};
  std::string_view name;                       // as in YAML and in recordings: "babbling_idiot"
  std::array<FaultParameter, 5> parameters{};  // as they are written, in that order; kNone behind the last
  Failing failing = Failing::kNode;
  NodeDemand demand = NodeDemand::kNothing;
};
const FaultKindRow& row_of(FaultKind kind);

inline std::string_view name_of(FaultKind kind) { return row_of(kind).name; }
inline bool has_node(FaultKind kind) { return row_of(kind).failing != Failing::kMedium; }
// Whether a fault of this kind has the parameter; its mode may still do without (applies(), plan.h).
bool takes(FaultKind kind, FaultParameter parameter);

}  // namespace ttf::faults
