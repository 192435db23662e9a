// What goes wrong in a run, as data: a list of faults, each of one kind. A scenario gives it under `faults:`
//
//   faults:
//     - {kind: crash, node: camera_host, from: 800 ms, duration: 200 ms}
//     - {kind: bit_flip_payload, node: fusion, flips: 3, probability: 0.1}
//
// and a campaign makes it in code. The nodes know nothing of it: sim/faults injects it into media, clocks and supplies.
// docs/faults.md says what every kind does and which check should see it.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/ids.h"
#include "core/strict_yaml.h"
#include "core/time.h"
#include "faults/kinds.h"
#include "schedules/model/cluster.h"

namespace ttf::faults {

enum class FaultDirection : std::uint8_t { kSend = 1, kReceive = 2, kBoth = 3 };
enum class FaultSignal : std::uint8_t { kNoise, kFrame };
enum class MasqueradeMode : std::uint8_t {
  kInSlot,   // a frame more, in the other's slot; a collision unless that is free or its owner silent
  kOwnSlot,  // its own frames carry the other's frame id
};
enum class ByzantinePattern : std::uint8_t {
  kRandom,     // every frame to every receiver by an amount of its own, evenly drawn
  kPullApart,  // late at receivers with even ids, early at the others
  kPullRates,  // the same, and the other way round in every other cycle: double cycles seem too long or too short
};
enum class DuplicateMode : std::uint8_t {
  kCas,            // sends a collision avoidance symbol at intervals
  kStartupFrames,  // sends its startup frame once a cycle, on a grid of its own that begins at `from`
  kSameKeySlot,    // believes another coldstart node's key slot to be its own
};
enum class WrongSchedule : std::uint8_t {
  kShiftedSlots,   // sends everything `by` slots later
  kCycleLength,    // the network idle time, and the cycle with it, is `by` macroticks longer
  kStaticSlot,     // static slots are `by` macroticks longer, the network idle time shorter
  kPayloadLength,  // static frames are `by` words longer
  kKeySlot,        // the key slot is `slot`
};

// One fault. Times count from the start of cycle 0; in a cold run from its time zero. Which members a kind has is
// what its keys in docs/faults.md say; the others are left as they are here.
struct Fault {
  static constexpr Duration kToTheEnd{std::numeric_limits<std::int64_t>::max() / 4};

  FaultKind kind{};
  NodeId node = kNoNode;  // the faulty one; kNoNode for the medium's, and before resolve()
  schedules::model::Channels channels = schedules::model::Channels::kAB;
  Duration from{};
  Duration duration = kToTheEnd;

  // What happens to single frames. A frame on both channels is one occasion: every `every`-th, the first included, is
  // chosen with `probability`.
  double probability = 1.0;                          // 0..1
  int every = 1;                                     // 1..1'000'000
  std::vector<NodeId> receivers;                     // empty: all (sos_value: each one drawn, by half)
  FaultDirection direction = FaultDirection::kSend;  // omission
  std::vector<int> bits;                             // bit flips: 0 is the region's first on the bus; empty: drawn
  int flips = 1;                                     // bit flips: how many different ones are drawn, 1..24
  Duration shift{};                                  // sos_timing: late, or early; byzantine_clock: the most it is off
  ByzantinePattern pattern = ByzantinePattern::kRandom;

  // What comes out of nothing: bursts, the first at `from`, from start to start `interval` and an evenly drawn
  // 0..`jitter`.
  FaultSignal signal = FaultSignal::kNoise;       // babbling_idiot
  Duration length = Duration::microseconds(30);   // of a burst of noise; frames last as long as they are
  Duration interval = Duration::milliseconds(1);  // shorter than what is sent: back to back
  Duration jitter{};

  int slot = 0;  // of another, static; duplicate_coldstart, 0: the next coldstart node's
  MasqueradeMode masquerade = MasqueradeMode::kInSlot;
  DuplicateMode duplicate = DuplicateMode::kCas;
  WrongSchedule wrong = WrongSchedule::kShiftedSlots;
  int by = 0;                  // wrong_schedule: slots, macroticks or words
  std::int64_t drift_ppb = 0;  // drift: from then on, within +-kMostDriftPpb
  bool all_others = false;     // lone_coldstart: not only the coldstart nodes among the others are off

  // As written, until resolve().
  std::string node_name;
  std::vector<std::string> receiver_names;
  int line = 0;

  bool operator==(const Fault&) const = default;
};
inline constexpr std::int64_t kMostDriftPpb = 50'000'000;

// Whether the fault has the parameter, which its kind takes: some modes do without.
bool applies(FaultParameter parameter, const Fault& fault);

struct FaultPlan {
  std::string file;  // for messages
  std::vector<Fault> faults;

  bool empty() const { return faults.empty(); }
};

// The list `faults` of a mapping, empty where there is none; `latest`: the largest `from` that makes sense. Findings
// are the mapping's. Names are kept as they are: a scenario's clusters need not have been read.
FaultPlan load_fault_plan(YamlMap& yaml, Duration latest);
// One entry of such a list.
Fault load_fault(YamlMap& yaml, Duration latest);

// A fault's keys beside `kind` and `node`: those that its kind and mode have, with their values as in YAML, so that
// they are read again as they are. Left out: `duration` of what lasts to the end, `receivers` that are all, `slot`
// that is the next coldstart node's. The fault is resolved for the cluster.
std::vector<std::pair<std::string_view, std::string>> keys_of(const Fault& fault,
                                                              const schedules::model::Cluster& cluster);
// The whole entry in one line: "{kind: crash, node: fusion, from: 0 ns}".
std::string entry_of(const Fault& fault, const schedules::model::Cluster& cluster);

// The same plan with its names looked up, and slots and bits within what the cluster has. Throws InputError with every
// finding: names nobody has, nodes that are off FlexRay, slots and bits beyond the end.
FaultPlan resolve(FaultPlan plan, const schedules::model::Cluster& cluster);

}  // namespace ttf::faults
