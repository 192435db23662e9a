// What the faults of a run did: injected, seen by which check and in how many cycles, which nodes changed state, and whether a
// node without a fault was harmed. From the records alone, so that a live run's report and its log's are the same.
//
// Checks and harms are those of experiments/fault_judge.h, which judges single faults from inside a simulation. Records tell a
// little less:
//   - a node is without a fault until a fault that names it begins
//   - H3 is told from when frames begin (experiments/frame_clocks.h), H4 and H5 from who reports which slot
//     (experiments/slot_ledger.h), in the static segment
//   - interventions of guardians leave no record: what they keep from the bus is seen by its absence
// With several faults, what is seen or harmed belongs to the fault that began or acted last.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "experiments/fault_judge.h"
#include "experiments/frame_clocks.h"
#include "experiments/slot_ledger.h"
#include "recording/records/records.h"
#include "schedules/cluster.h"

namespace ttf::experiments {

// One check, as seen by nodes of one side: those without a fault, or those with one.
struct CheckSeen {
  std::uint64_t cycles = 0;            // in which it was seen
  TrueTime first{};                    // where there are any
  std::vector<NodeId> nodes;           // in the order in which they saw it first
};

struct StateSeen {
  NodeId node{};
  std::string from, to, why;           // as at the first time; to "without supply", "with supply" where its power went or came
  TrueTime first{};
  std::uint64_t times = 0;
};

struct FaultSeen {
  std::uint32_t fault = 0;             // index in the plan
  std::string kind, text;              // as the plan names it; what it did first, empty if nothing
  NodeId node = kNoNode;               // kNoNode: the medium's
  TrueTime begins{};
  std::optional<TrueTime> ends, first_act;
  std::uint64_t acts = 0;
  std::array<CheckSeen, kAllChecks.size()> by_others, by_faulty;      // by Check
  std::vector<StateSeen> states;
  std::array<std::optional<Judgement::Harmed>, kAllHarms.size()> harms;   // by Harm, the first of each
  bool harmed() const;
};

class FaultReport final : public records::Sink {
 public:
  // `begins_integrated`: the nodes are in normal operation from the start; else they have no supply until they say so.
  FaultReport(const schedules::Cluster& cluster, bool begins_integrated);

  // The run is over: who has not become normal active since the beginning is harmed (H2), if the run began with start-up.
  void finish(TrueTime at);
  // In the order in which they began.
  const std::vector<FaultSeen>& faults() const { return faults_; }
  bool harmed() const;

  using records::Sink::on;
  void on(const records::FaultActivity&) override;
  void on(const records::StateChanged&) override;
  void on(const records::PowerChanged&) override;
  void on(const records::SlotProblem&) override;
  void on(const records::ClockCorrected&) override;
  void on(const records::SlotFrameSent&) override;

 private:
  struct Node {
    bool active = false, faulty = false;
    bool has_to_start = false;             // and has not yet
  };
  // A cycle is counted once however many nodes and slots it is about: by its counter, where that comes again after a round.
  using Counted = std::array<std::array<std::optional<TrueTime>, 64>, 2 * kAllChecks.size()>;

  bool counts(NodeId node) const { return nodes_[index_of(node)].active && !nodes_[index_of(node)].faulty; }
  FaultSeen* latest() { return latest_ ? &faults_[*latest_] : nullptr; }
  void notice(Check check, NodeId node, std::int64_t cycle, TrueTime at);
  void changed(NodeId node, std::string_view from, std::string_view to, std::string_view why, TrueTime at);
  void left_active(NodeId node, TrueTime at);
  void harm(Harm harm, TrueTime at, NodeId node, NodeId sender = kNoNode, int slot = 0);

  Duration cycle_, assumed_precision_;
  std::vector<Node> nodes_;                // by NodeId
  FrameClocks clocks_;
  SlotLedger ledger_;
  std::vector<FaultSeen> faults_;
  std::vector<Counted> counted_;           // by index in faults_
  std::optional<std::size_t> latest_;      // the fault that began or acted last
};

}  // namespace ttf::experiments
