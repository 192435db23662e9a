// Finds the frames that did not reach their receivers, from the frames themselves: sent and received frames are
// compared byte by byte.
//
// A frame of a fault-free node is owed to every fault-free node that is normal active when it leaves. It is
// overdue two cycles later, or when the next frame leaves in its slot. Frames of a drive's last two cycles are
// not owed. Records show a little less: slot_ledger.h.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "bus/wire/flexray_frame.h"
#include "core/ids.h"
#include "core/time.h"
#include "evaluation/faults/slot_loss.h"
#include "evaluation/faults/standings.h"
#include "schedules/model/cluster.h"

namespace ttf::evaluation::faults {

class FrameLedger {
 public:
  // `on_loss` is called for every loss between fault-free nodes. `standings` must outlive this object.
  FrameLedger(const schedules::model::Cluster& cluster, const Standings& standings,
              std::function<void(const SlotLoss&)> on_loss);

  // Calls come in the order of time; `frame` is valid during the call only.
  void sent(NodeId node, int slot, schedules::model::Channel channel, const bus::wire::DecodedFrame& frame,
            TrueTime at);
  void received(NodeId node, int slot, schedules::model::Channel channel, const bus::wire::DecodedFrame& frame,
                TrueTime at);
  // Ends the drive at `at`.
  void finish(TrueTime at);

 private:
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
  // The newest frame of a slot, and the nodes that have still to receive it.
  struct Owed {
    NodeId sender = kNoNode;
    TrueTime sent{};
    std::int64_t cycle = 0;
    std::vector<bool> receivers;  // by NodeId
    std::array<Sent, 2> as_sent;  // by channel
  };
  bool has(int slot) const { return slot >= 0 && static_cast<std::size_t>(slot) < owed_.size(); }
  bool is_copy(const Owed& owed, NodeId node, int slot, schedules::model::Channel channel,
               const bus::wire::DecodedFrame& frame, TrueTime at) const;
  void owe(Owed& owed, NodeId sender, int slot);
  void collect(Owed& owed, int slot);

  const schedules::model::Cluster& cluster_;
  const Standings& standings_;
  std::function<void(const SlotLoss&)> on_loss_;
  std::vector<Owed> owed_;  // by slot
};

}  // namespace ttf::evaluation::faults
