// The faults of a drive as data: a list of faults, each of one kind. A scenario has it under `faults:`
//
//   faults:
//     - {kind: crash, node: camera_host, from: 800 ms, duration: 200 ms}
//     - {kind: bit_flip_payload, node: fusion, flips: 3, probability: 0.1}
//
// and a campaign makes it in code. Nodes do not have the plan: sim/faults injects its faults into media, clocks
// and supplies. docs/reference/faults.md describes the effect of every kind and the checks that should detect it.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
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
  kInSlot,   // an extra frame in the other's slot; it collides unless that slot is free or its owner silent
  kOwnSlot,  // its own frames carry the other's frame id
};
enum class ByzantinePattern : std::uint8_t {
  kRandom,     // every frame to every receiver by its own amount, evenly drawn
  kPullApart,  // late at receivers with even ids, early at the others
  kPullRates,  // the same, but reversed in every other cycle: double cycles seem too long or too short
};
enum class DuplicateMode : std::uint8_t {
  kCas,            // sends a collision avoidance symbol at intervals
  kStartupFrames,  // sends its startup frame once a cycle, on its own grid that begins at `from`
  kSameKeySlot,    // uses another coldstart node's key slot as its own
};
enum class WrongSchedule : std::uint8_t {
  kShiftedSlots,   // sends all frames `by` slots later
  kCycleLength,    // the network idle time, and with it the cycle, is `by` macroticks longer
  kStaticSlot,     // static slots are `by` macroticks longer, the network idle time shorter
  kPayloadLength,  // static frames are `by` words longer
  kKeySlot,        // the key slot is `slot`
};

// One fault. Times count from the start of cycle 0, in a cold drive from its time zero. docs/reference/faults.md lists the
// keys of each kind; other members keep their defaults.
struct Fault {
  static constexpr Duration kToTheEnd{std::numeric_limits<std::int64_t>::max() / 4};

  FaultKind kind{};
  NodeId node = kNoNode;  // the faulty node; kNoNode for faults of the medium, and before resolve()
  schedules::model::Channels channels = schedules::model::Channels::kAB;
  Duration from{};
  Duration duration = kToTheEnd;

  // Selection of single frames. A frame on both channels is one occasion. Every `every`-th occasion, from the
  // first on, is chosen with `probability`.
  double probability = 1.0;                          // 0..1
  int every = 1;                                     // 1..1'000'000
  std::vector<NodeId> receivers;                     // empty: all (sos_value: each is drawn with probability one half)
  FaultDirection direction = FaultDirection::kSend;  // omission
  std::vector<int> bits;                             // bit flips: 0 is the region's first bit on the bus; empty: drawn
  int flips = 1;                                     // bit flips: how many different bits are drawn, 1..24
  Duration shift{};                                  // sos_timing: late, if negative early; byzantine_clock: most off
  ByzantinePattern pattern = ByzantinePattern::kRandom;

  // Signals without a schedule: bursts, the first at `from`. From start to start they are `interval` plus an
  // evenly drawn 0..`jitter` apart.
  FaultSignal signal = FaultSignal::kNoise;       // babbling_idiot
  Duration length = Duration::microseconds(30);   // a burst's; frames have their own length
  Duration interval = Duration::milliseconds(1);  // shorter than the burst: back to back
  Duration jitter{};

  int slot = 0;  // the other's static slot; duplicate_coldstart, 0: the next coldstart node's
  MasqueradeMode masquerade = MasqueradeMode::kInSlot;
  DuplicateMode duplicate = DuplicateMode::kCas;
  WrongSchedule wrong = WrongSchedule::kShiftedSlots;
  int by = 0;                  // wrong_schedule: slots, macroticks or words
  std::int64_t drift_ppb = 0;  // drift: from `from` on, within +-kMostDriftPpb
  bool all_others = false;     // lone_coldstart: all other nodes are off, not only coldstart nodes

  // Faults on a private CAN.
  static constexpr std::size_t kNoCan = std::numeric_limits<std::size_t>::max();
  std::size_t can = kNoCan;      // index in Cluster::can_buses; kNoCan before resolve()
  std::optional<int> bit;        // can_corruption: 0 is the start of frame, stuff bits count; absent: drawn
  std::uint32_t identifier = 0;  // can_babbling: of its frames

  // Names as written, until resolve().
  std::string node_name;
  std::vector<std::string> receiver_names;
  std::string can_name;
  int line = 0;

  bool operator==(const Fault&) const = default;
};
inline constexpr std::int64_t kMostDriftPpb = 50'000'000;

// Returns whether the fault has the parameter, which its kind takes: some modes lack it.
bool applies(FaultParameter parameter, const Fault& fault);

struct FaultPlan {
  std::string file;  // for messages
  std::vector<Fault> faults;

  bool empty() const { return faults.empty(); }
};

// Reads the list `faults` of a mapping; empty if absent. `latest` is the largest permitted `from`. Findings go
// to the mapping. Names are not looked up here: a scenario's clusters need not have been read.
FaultPlan load_fault_plan(YamlMap& yaml, Duration latest);
// Reads a file that has such a list and nothing else. Throws InputError.
FaultPlan read_fault_plan(const StrictYaml& file, Duration latest);
// Reads one entry of such a list.
Fault load_fault(YamlMap& yaml, Duration latest);

// Returns a fault's keys beside `kind` and `node`, as its kind and mode have them. The values are YAML and parse
// to the same fault. Defaults are left out: `duration` to the end, `receivers` for all nodes, `slot` for the
// next coldstart node's. Times are in nanoseconds. The fault is resolved for the cluster.
std::vector<std::pair<std::string_view, std::string>> keys_of(const Fault& fault,
                                                              const schedules::model::Cluster& cluster);
// Returns the whole entry in one line for people: "{kind: crash, node: fusion, from: 20 us}".
std::string entry_of(const Fault& fault, const schedules::model::Cluster& cluster);

// Returns the plan with its names looked up, and slots, bits and identifiers checked against the cluster. Throws
// InputError with every finding: unknown names, nodes off FlexRay or off their CAN, slots and bits out of range.
FaultPlan resolve(FaultPlan plan, const schedules::model::Cluster& cluster);

}  // namespace ttf::faults
