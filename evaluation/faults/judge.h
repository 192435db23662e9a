// Whether a fault harmed those that have none, and who noticed it: from what controllers tell their hosts, and the
// clocks' spread.
//
// A fault-free node is one that the fault does not name. From the beginning of the fault on, it is harmed when
//   H1  it leaves normal active
//   H2  it is not normal active when the run is over, and never was since the beginning (of a run that begins with
//       start-up)
//   H3  the global times of the fault-free nodes are further apart than the assumed precision
//   H4  it is normal active and receives a frame of another fault-free, normal active node on none of the channels that
//       both share with the frame
//   H5  it accepts as valid, in a slot of a fault-free node, what that node did not send there in this cycle
// A frame that a fault-free node sends is owed to every fault-free node that is normal active when it leaves; it is
// overdue two cycles later, or when the run is over. Frames that leave in the last two cycles are not owed.
//
// Who noticed it: the checks of the fault-free nodes' controllers and of the guardians; the faulty node's own are kept
// apart.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bus/controller/controller.h"
#include "core/ids.h"
#include "core/time.h"
#include "faults/plan.h"
#include "schedules/model/cluster.h"

namespace ttf::evaluation::faults {

enum class Check : std::uint8_t {
  kSyntax,
  kContent,
  kBoundary,
  kConflict,
  kNoFrame,  // of a slot: bus::SlotStatus
  kMissingTerm,
  kLimit,  // of clock correction
  kPassive,
  kHalt,      // states
  kGuardian,  // kept something from the others
};
inline constexpr std::array kAllChecks = {Check::kSyntax,  Check::kContent,     Check::kBoundary, Check::kConflict,
                                          Check::kNoFrame, Check::kMissingTerm, Check::kLimit,    Check::kPassive,
                                          Check::kHalt,    Check::kGuardian};
std::string_view name_of(Check check);

enum class Harm : std::uint8_t { kLeftActive, kNotStarted, kPrecision, kFrameLost, kFrameForged };
inline constexpr std::array kAllHarms = {Harm::kLeftActive, Harm::kNotStarted, Harm::kPrecision, Harm::kFrameLost,
                                         Harm::kFrameForged};
std::string_view name_of(Harm harm);

// Those of `all` whose bit is set, joined by "+".
template <class All> std::string names_of(unsigned bits, const All& all) {
  std::string out;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if ((bits >> i & 1u) == 0) continue;
    if (!out.empty()) out += '+';
    out += name_of(all[i]);
  }
  return out;
}

// The nodes that the fault names, or takes the supply of, by NodeId.
std::vector<bool> named_by(const ttf::faults::Fault& fault, const schedules::model::Cluster& cluster);
// Whose frame is expected there in this cycle; kNoNode: nobody's.
NodeId owner_of(const schedules::model::Cluster& cluster, int slot, schedules::model::Channel channel,
                std::int64_t cycle);

// What the judge has found.
struct Judgement {
  using Since = std::optional<TrueTime>;                  // the first time, if any
  std::array<Since, kAllChecks.size()> seen_by_others{};  // by Check
  std::array<Since, kAllChecks.size()> seen_by_itself{};  // by the faulty node's own controller
  struct Harmed {
    TrueTime first{};
    NodeId node = kNoNode;    // the harmed one; kNoNode: of the precision
    NodeId sender = kNoNode;  // whose frame it is about
    int slot = 0;
  };
  std::array<std::optional<Harmed>, kAllHarms.size()> harms{};  // by Harm
  Since passive, halt;                                          // of any node, the faulty one included
  // Of any node that lost normal active or its supply: the longest time until it was normal active again, from then or
  // from the end of the fault, whichever was later; and how many did not come back.
  std::optional<Duration> reintegration;
  int still_out = 0;

  bool harmed() const;
  Since detected() const;  // by others
};

struct JudgeSettings {
  std::vector<bool> faulty;  // by NodeId: named by the fault
  TrueTime from{};           // the fault begins: what was before does not count
  TrueTime until{};          // it ends
  Duration assumed_precision{};
  bool starts_up = false;  // the run begins with start-up, so all fault-free nodes have to become active
  // What the same start-up shows without the fault, and until when: these checks count from then on only.
  TrueTime settled{};
  std::array<bool, kAllChecks.size()> usual{};
};

class FaultJudge {
 public:
  FaultJudge(const schedules::model::Cluster& cluster, JudgeSettings settings);

  // The nodes' states where a run begins integrated; else they are without supply.
  void begins_active(NodeId node) { nodes_[index_of(node)].state = bus::poc::PocKind::kNormalActive; }

  // What happened, in the order of time.
  void state_changed(NodeId node, bus::poc::PocKind from, bus::poc::PocKind to, TrueTime at);
  void lost_supply(NodeId node, TrueTime at);
  void slot_problem(NodeId node, bus::controller::SlotStatus status, TrueTime at);
  void clock_corrected(NodeId node, bool missing, bool limit_reached, TrueTime at);
  // `frame` only during the call.
  void frame_sent(NodeId node, int slot, schedules::model::Channel channel, const bus::wire::DecodedFrame& frame,
                  TrueTime at);
  void frame_received(NodeId node, int slot, schedules::model::Channel channel, const bus::wire::DecodedFrame& frame,
                      TrueTime at);
  void guardian_intervened(TrueTime at) { notice(Check::kGuardian, kNoNode, at); }
  // Among the fault-free nodes that are synchronised.
  void precision(Duration apart, TrueTime at);

  bool all_fault_free_active() const;
  // What there is to say once nothing more happens until `at`.
  const Judgement& finish(TrueTime at);

 private:
  struct Node {
    bus::poc::PocKind state = bus::poc::PocKind::kDefaultConfig;
    schedules::model::Channels channels{};
    bool faulty = false;
    bool was_active = false;
    std::optional<TrueTime> out_since;  // lost normal active, or its supply
  };
  // A frame as its controller sent it.
  struct Sent {
    bool any = false;
    TrueTime at{};
    bus::wire::FrameHeader header;
    std::array<std::byte, bus::wire::kMaxPayloadBytes> bytes;
    std::size_t size = 0;
    std::span<const std::byte> payload() const { return std::span<const std::byte>(bytes).first(size); }
    bool says(const bus::wire::DecodedFrame& frame) const;
  };
  // The newest frame of a slot, and which fault-free nodes still have to receive it.
  struct Owed {
    NodeId sender = kNoNode;
    TrueTime sent{};
    std::vector<bool> receivers;  // by NodeId
    std::array<Sent, 2> as_sent;  // by channel
  };
  bool faulty(NodeId node) const { return node != kNoNode && nodes_[index_of(node)].faulty; }
  bool counts(TrueTime at) const { return at >= settings_.from; }
  void notice(Check check, NodeId by, TrueTime at);
  void harm(Harm harm, TrueTime at, NodeId node, NodeId sender = kNoNode, int slot = 0);
  void collect(Owed& owed, int slot);
  void came_back(Node& node, TrueTime at);

  const schedules::model::Cluster& cluster_;
  JudgeSettings settings_;
  std::vector<Node> nodes_;
  std::vector<Owed> owed_;  // by slot
  Judgement judgement_;
};

}  // namespace ttf::evaluation::faults
