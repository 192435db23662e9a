// Finds the static slots in which a receiver did not get its sender's frame, from both nodes' reports.
//
// A receiver in normal operation reports, per channel, every slot without exactly one valid frame. A slot
// without a report thus had a valid frame: the sender's if it sent there, another node's otherwise. A reported
// slot counts as not received, even if a valid frame preceded the disturbance: reports do not distinguish that.
// The frames themselves show more: frame_ledger.h.
//
// A cycle is settled two cycles later, when all nodes have reported, or at the end of the drive; then only its
// ended slots count. Each node counts whole rounds of the cycle counter for itself.
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
  // `on_loss` is called for every loss between nodes that count, both in the slot and when it is settled.
  // `standings` must outlive this object.
  SlotLedger(const schedules::model::Cluster& cluster, const Standings& standings,
             std::function<void(const SlotLoss&)> on_loss);

  void on(const recording::records::SlotFrameSent& frame);
  void on(const recording::records::SlotProblem& problem);
  // Ends the drive at `at` and settles the open cycles. A slot counts if a node without its frame must have
  // reported it by then, that is, if its static segment is over.
  void finish(TrueTime at);

 private:
  static constexpr std::size_t kCycles = 4;  // open at a time: the present one, and those that may lack reports
  struct Slot {
    bool counted = false;  // its sender counted when it sent
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
  std::function<void(const SlotLoss&)> on_loss_;
  std::array<Cycle, kCycles> cycles_;
  std::int64_t newest_ = -1;  // counter of the cycle opened last
  Duration slot_;             // length of a static slot
};

}  // namespace ttf::evaluation::faults
