// Which static slots brought a receiver what their sender sent, told from what senders and receivers report.
//
// A receiver in normal operation reports every slot that was anything but one valid frame, per channel. So a slot that
// it does not report was a valid frame: of the sender, if that sent there, of somebody else otherwise. A slot it
// reports counts as not received, though a valid frame may have come before what disturbed it: reports do not tell
// these apart. Who has the frames themselves knows more: frame_ledger.h.
//
// A cycle is settled two cycles after it, when all have reported, or when the run is over: then those of its slots that
// have ended. Nodes count whole rounds of the cycle counter each for itself.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "evaluation/faults/slot_loss.h"
#include "evaluation/faults/standings.h"
#include "recording/records/records.h"
#include "schedules/model/cluster.h"

namespace ttf::evaluation::faults {

class SlotLedger {
 public:
  // `told`: of every loss between nodes that count, both at the time of the slot and when it is settled. `standings`
  // outlives this.
  SlotLedger(const schedules::model::Cluster& cluster, const Standings& standings,
             std::function<void(const SlotLoss&)> told);

  void on(const recording::records::SlotFrameSent& frame);
  void on(const recording::records::SlotProblem& problem);
  // The run is over at `at`: settles what is open still. A slot counts if those that have not received anything in it
  // must have reported by then, which they do when their static segment is over.
  void finish(TrueTime at);

 private:
  static constexpr std::size_t kCycles =
      4;  // open at a time: the present one, and those whose reports may be missing still
  struct Slot {
    bool counted = false;  // its sender did when it sent
    TrueTime at{};
    std::array<bool, 2> sent{};                 // by channel
    std::array<std::vector<bool>, 2> reported;  // by channel and receiver
  };
  struct Cycle {
    std::int64_t counter = -1;
    std::vector<bool> counted;  // by NodeId, when the cycle began
    std::vector<Slot> slots;    // by Cluster::frames
  };
  Cycle& open(std::int64_t cycle);
  void settle(const Cycle& cycle, TrueTime over);

  const schedules::model::Cluster& cluster_;
  const Standings& standings_;
  std::function<void(const SlotLoss&)> told_;
  std::array<Cycle, kCycles> cycles_;
  std::int64_t newest_ = -1;  // counter of the cycle that was opened last
  Duration slot_;             // how long a static one lasts
};

}  // namespace ttf::evaluation::faults
